"""Flows have one source and one target: what to do when a file gives several."""

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.passes.resolve.rules import SEVERAL_TARGETS

_ENDS = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)


def keep_first_ends(graph: Graph, sink: Sink) -> None:
    """Leave each flow and transition its first source and target; report where others go."""
    for flow in graph.of_kind(Kind.CONTROL_FLOW, Kind.OBJECT_FLOW, Kind.TRANSITION):
        for edge in _ENDS:
            ends = graph.targets(flow, edge)
            if len(ends) > 1:
                _keep_first(graph, sink, flow, edge, ends)


def _keep_first(graph: Graph, sink: Sink, flow: Element, edge: Edge, ends: list[Element]) -> None:
    graph.replace_targets(edge, flow, ends[:1])
    sink.report(
        SEVERAL_TARGETS,
        graph.subject(flow),
        relation=edge.value,
        element=graph.qualified_name(flow),
        count=len(ends),
    )
