"""Elements that the text elides because it expresses them with another element.

A merge is elided if the step after it accepts several successions. A property-specific class is
elided if its members become members of the feature that it types.
"""

from collections.abc import Iterator

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import follows_v2, has_guard

_STEPS = (Kind.ACTION, Kind.STRUCTURED)
_CLASSES = (Kind.CLASS, Kind.DATA_TYPE)
_FEATURES = (Kind.PROPERTY, Kind.FLOW_PROPERTY, Kind.PORT)
_EXPRESSED_BY_USAGE = frozenset({"role", "property_specific", "variation"})
"""Attributes of a property-specific class that a usage can express."""
_REFERRING = tuple(edge for edge in Edge if edge not in (Edge.TYPED_BY, Edge.OWNS, Edge.FEATURE))


# -- merges --------------------------------------------------------------------------------------


def find_step_after_merge(graph: Graph, element: Element | None) -> Element | None:
    """Return the step that follows an elided merge; None for all other elements.

    A succession whose guard is false does not exist (SysML 2.0, 8.4.13.5). If a succession to a
    step has a guard, the step therefore waits only for the successions that exist, so that it
    needs no merge before it.
    """
    if element is None or element.subkind != "merge" or element.name or len(element.attrs) > 1:
        return None
    owners = graph.ancestors(element)
    activity = next((owner for owner in owners if owner.kind is Kind.ACTIVITY), None)
    if activity is None or not follows_v2(graph, activity):
        return None
    incoming = _list_flows(graph, element, Edge.FLOW_TARGET)
    outgoing = _list_flows(graph, element, Edge.FLOW_SOURCE)
    if len(incoming) < 2 or len(outgoing) != 1 or not _is_bare_control_flow(outgoing[0]):
        return None
    step = graph.target(outgoing[0], Edge.FLOW_TARGET)
    if step is None or step.kind not in _STEPS or step.owner != element.owner:
        return None
    is_only_way = _list_flows(graph, step, Edge.FLOW_TARGET) == outgoing
    are_control_flows = all(flow.kind is Kind.CONTROL_FLOW for flow in incoming)
    is_guarded = any(has_guard(graph, flow) for flow in incoming)
    has_partition = bool(graph.targets(element, Edge.IN_PARTITION))
    return step if is_only_way and are_control_flows and is_guarded and not has_partition else None


def _list_flows(graph: Graph, node: Element, edge: Edge) -> list[Element]:
    kinds = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
    return [flow for flow in graph.sources(node, edge) if flow.kind in kinds]


def _is_bare_control_flow(flow: Element) -> bool:
    return flow.kind is Kind.CONTROL_FLOW and not flow.name and not flow.attrs


# -- property-specific classes -------------------------------------------------------------------


def find_specific_feature(graph: Graph, element: Element) -> Element | None:
    """Return the feature of a property-specific class (SysML 1.6, 8.3.2.10), else None.

    Such a class has the name of the feature or none, has the same owner, and only this feature
    refers to it.
    """
    if not element.attrs.get("property_specific") or element.kind not in _CLASSES:
        return None
    features = graph.sources(element, Edge.TYPED_BY)
    if len(features) != 1 or features[0].kind not in _FEATURES:
        return None
    if not _EXPRESSED_BY_USAGE.issuperset(element.attrs):
        return None
    (feature,) = features
    has_same_owner = feature.owner == element.owner and element.name in ("", feature.name)
    is_only_type = graph.targets(feature, Edge.TYPED_BY) == [element]
    is_referred_to = any(graph.sources(element, edge) for edge in _REFERRING)
    return feature if has_same_owner and is_only_type and not is_referred_to else None


def iter_types(graph: Graph, feature: Element) -> Iterator[Element]:
    """Yield the types of a feature; a property-specific class is replaced by its generals."""
    for type_ in graph.targets(feature, Edge.TYPED_BY):
        if find_specific_feature(graph, type_) is feature:
            yield from graph.targets(type_, Edge.SPECIALIZES)
        else:
            yield type_
