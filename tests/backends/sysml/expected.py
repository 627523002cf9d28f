"""What the toolkit must find of a graph: told by the graph alone, not by the back end."""

from sysmlc.ir import Edge, Kind
from sysmlc.ir.query import generals, type_of

DEFINITIONS = {
    Kind.CLASS: "PartDefinition",
    Kind.COMPONENT: "PartDefinition",
    Kind.ACTOR: "PartDefinition",
    Kind.INTERFACE: "PortDefinition",
    Kind.DATA_TYPE: "AttributeDefinition",
    Kind.ENUMERATION: "EnumerationDefinition",
    Kind.SIGNAL: "ItemDefinition",
    Kind.USE_CASE: "UseCaseDefinition",
    Kind.STEREOTYPE: "MetadataDefinition",
}
ROLES = {
    "block": "PartDefinition",
    "interface block": "PortDefinition",
    "constraint block": "ConstraintDefinition",
    "value type": "AttributeDefinition",
    "requirement": "RequirementUsage",
    "view": "ViewDefinition",
    "viewpoint": "ViewpointDefinition",
}
ACTIONS = {
    "ActionUsage",
    "PerformActionUsage",
    "SendActionUsage",
    "AcceptActionUsage",
    "AssignmentActionUsage",
}
USAGES = {
    Kind.ENUMERATION_LITERAL: {"EnumerationUsage"},
    Kind.OPERATION: {"ActionUsage"},
    Kind.PORT: {"PortUsage", "PartUsage"},
    Kind.PACKAGE: {"Package"},
    Kind.PROFILE: {"Package"},
    Kind.STATE: {"StateUsage"},
    Kind.REGION: {"StateUsage"},
    Kind.STATE_MACHINE: {"StateDefinition", "StateUsage", "ExhibitStateUsage"},
    Kind.ACTIVITY: {"ActionDefinition", "VerificationCaseDefinition"} | ACTIONS,
    Kind.INTERACTION: {"OccurrenceDefinition", "OccurrenceUsage"},
    Kind.ACTION: ACTIONS,
    Kind.STRUCTURED: {"ActionUsage"},
    Kind.PARAMETER: {"AttributeUsage", "ItemUsage", "ReferenceUsage", "ActionUsage", "StateUsage"},
}
CONTROLS = {
    "decision": "DecisionNode",
    "merge": "MergeNode",
    "fork": "ForkNode",
    "join": "JoinNode",
}
PROPERTIES = {
    "part": {"PartUsage", "ItemUsage", "ReferenceUsage", "UseCaseUsage"},
    "value": {"AttributeUsage", "ReferenceUsage"},
    "reference": {"PartUsage", "ItemUsage", "ReferenceUsage", "UseCaseUsage"},
}
_PLAIN_OWNERS = (*DEFINITIONS, *USAGES)
IN_BEHAVIOURS = ("start", "done", "self", "this", "that")
"""Names that all behaviours inherit."""


def expected(graph):
    """Metaclasses and, where there is one, the name of the type, by the path of names.

    What shares its name with something beside it has another one in SysML v2, and so has what
    stands below it.
    """
    found, left_out = {}, clashing(graph)
    for element in graph:
        owners = [element, *graph.ancestors(element)]
        owners = [one for one in owners if not _is_only_region(graph, one)]
        if element not in owners:
            continue
        if any(one.attrs.get("external") or one.id in left_out for one in owners):
            continue
        if not all(one.name and one.kind in _PLAIN_OWNERS for one in owners[1:]):
            continue
        metaclasses = _metaclasses(graph, element)
        if metaclasses and element.name:
            type_ = _type(graph, element, left_out)
            found[tuple(one.name for one in reversed(owners))] = metaclasses, type_
    return found


def clashing(graph):
    """Ids of elements with the name of something beside them or inherited, or of the library."""
    found = set()
    for owner in (None, *graph):
        beside = graph.roots() if owner is None else graph.owned(owner)
        names = {}
        for one in _members(graph, beside):
            if one.name and one.kind is not Kind.APPLICATION:
                names.setdefault(one.name, []).append(one.id)
        found.update(id for ids in names.values() if len(ids) > 1 for id in ids)
        if owner is None:
            found.update(id for name, ids in names.items() if name in LIBRARY for id in ids)
        found.update(id for name in IN_BEHAVIOURS for id in names.get(name, ()))
        if owner is not None:
            inherited = _inherited(graph, owner)
            found.update(id for name, ids in names.items() if name in inherited for id in ids)
    return found


def _inherited(graph, owner):
    """Names of members of what an element specialises or is typed by."""
    first = [*generals(graph, owner)]
    for edge in (Edge.TYPED_BY, Edge.INSTANCE_OF, Edge.REPRESENTS, Edge.REDEFINES):
        first += graph.targets(owner, edge)
    above = {one.id: one for one in first}
    above |= {more.id: more for one in first for more in generals(graph, one)}
    return {one.name for general in above.values() for one in graph.owned(general) if one.name}


def _members(graph, beside):
    """What is beside one another; what a region holds is beside the state or machine too."""
    for one in beside:
        yield one
        if _is_only_region(graph, one):
            yield from graph.owned(one)


def _is_only_region(graph, one):
    """SysML v2 has no regions: states stand in their state, unless there are several regions."""
    if one.kind is not Kind.REGION:
        return False
    return sum(other.kind is Kind.REGION for other in graph.owned(graph.owner(one))) == 1


LIBRARY = ("Quantities", "Items", "Parts", "Ports", "Actions", "Units", "SysML")
"""Packages of the standard library that models of the corpus name theirs like."""


def _metaclasses(graph, element):
    if element.kind is Kind.LIFELINE:
        return _lifeline(graph, element)
    if element.kind in (Kind.CLASS, Kind.DATA_TYPE) and element.role in ROLES:
        return {ROLES[element.role]}
    if element.kind in DEFINITIONS:
        return {DEFINITIONS[element.kind]}
    if element.kind is Kind.CONTROL and element.subkind in CONTROLS:
        return {CONTROLS[element.subkind]}
    if element.kind is Kind.PROPERTY:
        return PROPERTIES.get(element.role, set())
    return USAGES.get(element.kind, set())


def _lifeline(graph, lifeline):
    """A lifeline is a port exactly when the type of what it represents is an interface block."""
    types = [type_of(graph, one) for one in graph.targets(lifeline, Edge.REPRESENTS)]
    is_port = any(one is not None and one.role == "interface block" for one in types)
    return {"PortUsage"} if is_port else {"PartUsage", "ReferenceUsage"}


def _type(graph, element, left_out):
    """The name of the type, unless it is in another file or the feature redefines another."""
    if element.kind is not Kind.PROPERTY or graph.targets(element, Edge.REDEFINES):
        return None
    type_ = type_of(graph, element)
    is_plain = type_ is not None and type_.kind in DEFINITIONS and type_.role != "requirement"
    if not is_plain or type_.attrs.get("external") or type_.id in left_out:
        return None
    return type_.name
