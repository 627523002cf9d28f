"""Specialisations, subsets and redefinitions of UML that SysML v2 does not allow."""

from collections.abc import Iterable

from sysmlc.backends.sysml.elided_elements import iter_types
from sysmlc.backends.sysml.library import find_scalar_type
from sysmlc.backends.sysml.plan import Member, Plan
from sysmlc.backends.sysml.references import is_accessible
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import bounds, conforms, generals, type_of

_VALUES = frozenset({"attribute", "enum", ""})
_BEHAVIOURS = frozenset({"action", "state", "verification", "use case", "constraint"})
_ALLOWED_TYPES = {
    "attribute": _VALUES,
    "port": frozenset({"port"}),
    "constraint": frozenset({"constraint"}),
    "action": _BEHAVIOURS,
    "state": _BEHAVIOURS,
}
"""Keywords of the types that a usage may have (SysML 2.0, 8.3.6 to 8.3.19)."""
_OBJECTS = frozenset({"item", "part", "occurrence"})
"""Keywords of usages that may have all types except values."""


def is_invalid_subset(plan: Plan, feature: Element, subsetted: Element) -> bool:
    """Whether a feature must not subset another one.

    The owner of the feature has to own or inherit the other feature, and both need compatible
    kinds and multiplicities.
    """
    if is_incompatible(plan, feature, subsetted):
        return True
    owner, general = plan.graph.owner(feature), plan.graph.owner(subsetted)
    return owner is None or not (general is owner or general in generals(plan.graph, owner))


def is_incompatible(plan: Plan, feature: Element, general_feature: Element) -> bool:
    """Whether a feature must not specialise another one.

    A port and a part differ in kind, and a feature may not have more values than its general.
    """
    members = [plan.find(element) for element in (feature, general_feature)]
    keywords = {member.shape.keyword for member in members if member is not None}
    if "port" in keywords and "part" in keywords:
        return True
    general = plan.find(plan.graph.owner(general_feature))
    specific = plan.find(plan.graph.owner(feature))
    if has_incompatible_ends(plan, general, specific):
        return True
    if members[0] is not None and forbids_inherited_types(plan, members[0], [general_feature]):
        return True
    if Kind.PORT in (feature.kind, general_feature.kind):
        return False
    return _upper_bound(feature) > _upper_bound(general_feature)


def forbids_inherited_types(plan: Plan, member: Member, generals: Iterable[Element]) -> bool:
    """Whether a feature with this keyword must not have its own types and those of its generals.

    A reference (``ref``) may have any types.
    """
    keyword = member.shape.keyword
    keywords = _collect_type_keywords(plan, [member.require_element(), *generals])
    types = [type_ for type_ in keywords.values() if type_]
    is_single = keyword in ("attribute", "constraint")
    if is_single and len(types) > 1 and not {"enum", "constraint"}.isdisjoint(types):
        # An enumeration or a constraint definition is the only type of a feature.
        return True
    if keyword in _ALLOWED_TYPES:
        return not _ALLOWED_TYPES[keyword].issuperset(keywords.values())
    return keyword in _OBJECTS and not _VALUES.isdisjoint(keywords.values())


def _collect_type_keywords(plan: Plan, features: Iterable[Element]) -> dict[str, str]:
    """Return the keywords of the types of features and of all that they specialise, by type id.

    The keyword of an attribute without types is empty: it has a value of an unknown type.
    """
    keywords: dict[str, str] = {}
    seen: set[str] = set()
    worklist = list(features)
    while worklist:
        feature = worklist.pop()
        if feature.id in seen:
            continue
        seen.add(feature.id)
        member = plan.find(feature)
        is_port = member is not None and member.shape.keyword == "port"
        for type_ in iter_types(plan.graph, feature):
            type_member = plan.find(type_)
            keyword = "attribute" if find_scalar_type(type_) else ""
            keyword = type_member.shape.usage_keyword if type_member is not None else keyword
            # A type that is no port definition becomes the type of a feature inside the port.
            if keyword and not (is_port and keyword != "port"):
                keywords[type_.id] = keyword
        if member is not None and member.shape.keyword == "attribute":
            keywords[feature.id] = ""
        for edge in (Edge.REDEFINES, Edge.SUBSETS):
            worklist += plan.graph.targets(feature, edge)
    return keywords


def has_incompatible_ends(plan: Plan, general: Member | None, specific: Member | None) -> bool:
    """Whether ends of an association have other types than the ends that they would redefine."""
    graph = plan.graph
    pairs = zip(_list_ends(graph, general), _list_ends(graph, specific), strict=False)
    for general_end, end in pairs:
        general_type, type_ = type_of(graph, general_end), type_of(graph, end)
        if general_type is None or type_ is None:
            continue
        if not conforms(graph, type_, general_type):
            return True
    return False


def _list_ends(graph: Graph, member: Member | None) -> list[Element]:
    """Return the ends of an association; none for any other member."""
    association = None if member is None else member.element
    if association is None or association.kind is not Kind.ASSOCIATION:
        return []
    return graph.targets(association, Edge.END)


def is_without_parameters(graph: Graph, operation: Element, method: Element) -> bool:
    """Whether an operation states no parameters, although its method has some.

    As a specialisation of the method, the operation would inherit them.
    """
    return _has_parameters(graph, method) and not _has_parameters(graph, operation)


def _has_parameters(graph: Graph, element: Element) -> bool:
    return any(child.kind is Kind.PARAMETER for child in graph.owned(element))


def _upper_bound(feature: Element) -> float:
    limits = bounds(str(feature.attrs.get("multiplicity", "1")))
    if limits is None:
        return 1
    return float("inf") if limits[1] is None else limits[1]


def is_lifeline_subset(plan: Plan, lifeline: Member, represented: Element) -> bool:
    """Whether the bare name of a represented feature is allowed where the lifeline stands."""
    feature = plan.find(represented)
    return (
        feature is not None
        and feature.shape.is_usage
        and feature.parent is not None
        and is_accessible(plan, lifeline.parent, feature)
    )
