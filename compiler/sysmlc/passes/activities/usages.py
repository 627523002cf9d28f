"""Usages of activities that are drawn elsewhere: operations by a library, what adds no steps."""

from sysmlc.ir import Edge, Element, Graph, Kind, query

_STEPS = (Kind.ACTION, Kind.CONTROL, Kind.STRUCTURED)


def has_steps(graph: Graph, activity: Element) -> bool:
    """Whether something is drawn in the activity itself."""
    return any(one.kind in _STEPS for one in graph.owned(activity))


def drawn_of(graph: Graph, usage: Element) -> Element:
    """The activity whose steps a usage performs: its method's, or those of the nearest that it
    specialises when it draws none; the usage itself when there is no other.
    """
    method = graph.target(usage, Edge.METHOD) if usage.kind is Kind.OPERATION else usage
    if method is None or has_steps(graph, method):
        return method or usage
    drawn = (one for one in query.generals(graph, method) if has_steps(graph, one))
    return next(drawn, usage)
