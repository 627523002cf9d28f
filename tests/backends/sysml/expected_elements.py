"""The elements that the toolkit must find, derived from the graph without the back end."""

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


def list_expected(graph):
    """Return metaclasses and the name of the type, or None, by the path of names.

    Elements with a clashing name, which the back end renames, are omitted with all below them.
    """
    expected, clashing_ids = {}, find_clashing_ids(graph)
    for element in graph:
        owners = [element, *graph.ancestors(element)]
        owners = [owner for owner in owners if not _is_only_region(graph, owner)]
        if element not in owners:
            continue
        if any(owner.attrs.get("external") or owner.id in clashing_ids for owner in owners):
            continue
        if not all(owner.name and owner.kind in _PLAIN_OWNERS for owner in owners[1:]):
            continue
        metaclasses = _list_metaclasses(graph, element)
        if metaclasses and element.name:
            type_name = _find_type_name(graph, element, clashing_ids)
            path = tuple(owner.name for owner in reversed(owners))
            expected[path] = metaclasses, type_name
    return expected


def find_clashing_ids(graph):
    """Return the ids of elements with the name of a sibling, an inherited member or a library."""
    clashing = set()
    for owner in (None, *graph):
        children = graph.roots() if owner is None else graph.owned(owner)
        ids_by_name = {}
        for member in _iter_members(graph, children):
            if member.name and member.kind is not Kind.APPLICATION:
                ids_by_name.setdefault(member.name, []).append(member.id)
        taken = set(IN_BEHAVIOURS)
        taken |= set(LIBRARY) if owner is None else _list_inherited_names(graph, owner)
        for name, ids in ids_by_name.items():
            if len(ids) > 1 or name in taken:
                clashing.update(ids)
    return clashing


def _list_inherited_names(graph, owner):
    """Return the names of members of the generals and types of an element."""
    direct = [*generals(graph, owner)]
    for edge in (Edge.TYPED_BY, Edge.INSTANCE_OF, Edge.REPRESENTS, Edge.REDEFINES):
        direct += graph.targets(owner, edge)
    classifiers = {general.id: general for general in direct}
    for general in direct:
        classifiers |= {indirect.id: indirect for indirect in generals(graph, general)}
    members = (member for general in classifiers.values() for member in graph.owned(general))
    return {member.name for member in members if member.name}


def _iter_members(graph, children):
    """Yield the members of one namespace; those of an only region are among them."""
    for child in children:
        yield child
        if _is_only_region(graph, child):
            yield from graph.owned(child)


def _is_only_region(graph, element):
    """Whether a region has no member: its states belong to the state around it."""
    if element.kind is not Kind.REGION:
        return False
    siblings = graph.owned(graph.owner(element))
    return sum(sibling.kind is Kind.REGION for sibling in siblings) == 1


LIBRARY = ("Quantities", "Items", "Parts", "Ports", "Actions", "Units", "SysML")
"""Packages of the standard library whose names models of the corpus use, too."""


def _list_metaclasses(graph, element):
    if element.kind is Kind.LIFELINE:
        return _list_lifeline_metaclasses(graph, element)
    if element.kind in (Kind.CLASS, Kind.DATA_TYPE) and element.role in ROLES:
        return {ROLES[element.role]}
    if element.kind in DEFINITIONS:
        return {DEFINITIONS[element.kind]}
    if element.kind is Kind.CONTROL and element.subkind in CONTROLS:
        return {CONTROLS[element.subkind]}
    if element.kind is Kind.PROPERTY:
        return PROPERTIES.get(element.role, set())
    return USAGES.get(element.kind, set())


def _list_lifeline_metaclasses(graph, lifeline):
    """Return the metaclass of a port if the lifeline represents a port, else that of a part."""
    represented = graph.targets(lifeline, Edge.REPRESENTS)
    types = [type_of(graph, element) for element in represented]
    is_port = any(type_ is not None and type_.role == "interface block" for type_ in types)
    return {"PortUsage"} if is_port else {"PartUsage", "ReferenceUsage"}


def _find_type_name(graph, element, clashing_ids):
    """Return the name of the type; None if it is in another file or the feature redefines one."""
    if element.kind is not Kind.PROPERTY or graph.targets(element, Edge.REDEFINES):
        return None
    type_ = type_of(graph, element)
    is_plain = type_ is not None and type_.kind in DEFINITIONS and type_.role != "requirement"
    if not is_plain or type_.attrs.get("external") or type_.id in clashing_ids:
        return None
    return type_.name
