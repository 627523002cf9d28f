"""Merges that SysML v2 does without: a step that one of several successions may lead to."""

from sysmlc.ir import Edge, Element, Graph, Kind

_STEPS = (Kind.ACTION, Kind.STRUCTURED)


def step_behind(graph: Graph, element: Element | None) -> Element | None:
    """The step that the flows into a merge lead to in the text; None when it is written.

    A succession whose guard does not hold is none (SysML 2.0, 8.4.13.5): where one of those that
    lead to a step has a guard, the step waits for those only that are.
    """
    if element is None or element.subkind != "merge" or element.name or len(element.attrs) > 1:
        return None
    into, out = _flows(graph, element, Edge.FLOW_TARGET), _flows(graph, element, Edge.FLOW_SOURCE)
    if len(into) < 2 or len(out) != 1 or not all(_is_plain(one) for one in out):
        return None
    step = graph.target(out[0], Edge.FLOW_TARGET)
    if step is None or step.kind not in _STEPS or step.owner != element.owner:
        return None
    is_only = _flows(graph, step, Edge.FLOW_TARGET) == out
    are_control = all(one.kind is Kind.CONTROL_FLOW for one in into)
    is_guarded = any("guard" in one.attrs for one in into)
    is_plain = not graph.targets(element, Edge.IN_PARTITION)
    return step if is_only and are_control and is_guarded and is_plain else None


def _flows(graph: Graph, node: Element, edge: Edge) -> list[Element]:
    kinds = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
    return [one for one in graph.sources(node, edge) if one.kind in kinds]


def _is_plain(flow: Element) -> bool:
    return flow.kind is Kind.CONTROL_FLOW and not flow.name and not flow.attrs
