"""Assignments of an activity that can leave the range of what they assign (SM428)."""

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.machines.moves import SATURATES


def report_stops(graph: Graph, tokens: TokenGraph, sink: Sink) -> None:
    """Report each write that can leave the range of its variable, or may for all we know."""
    if not any(one.stops for store in tokens.stores for one in store.writes):
        return
    from sysmlc.logic.activities.bounds import Can, leaving

    for store, write, can in leaving(tokens):
        if can is not Can.NO:
            node, name = tokens.node(write.node), store.variable.name
            subject = graph.subject(graph[node.origin])
            sink.report(SATURATES, subject, transition=node.label, can=can.value, variable=name)
