"""Assignments of an activity that can leave the range of what they assign (SM428).

What the values on the way to an assignment rule out is not asked further. Of the rest all states
are looked at that the activity can reach, whatever the environment decides; where there are too
many of them the finding says so.
"""

from collections.abc import Iterator

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.logic import domains
from sysmlc.logic.activities.bound_search import reduced, search
from sysmlc.logic.activities.spread import MOST_VALUES, Spread
from sysmlc.logic.activities.together import Together
from sysmlc.logic.activities.tokens import Store, TokenGraph, Write
from sysmlc.logic.machines.moves import SATURATES

_CAN, _CANNOT, _MAY = "can", "", "may (it has too many states to tell)"


def report_stops(graph: Graph, tokens: TokenGraph, sink: Sink) -> None:
    """Report each write that can leave the range of its variable, or may for all we know."""
    for store, write, can in _decided(tokens):
        if can:
            node, name = tokens.node(write.node), store.variable.name
            subject = graph.subject(graph[node.origin])
            sink.report(SATURATES, subject, transition=node.label, can=can, variable=name)


def _decided(tokens: TokenGraph) -> Iterator[tuple[Store, Write, str]]:
    """Whether each write that has stops can come to one."""
    could = [(store, one) for store in tokens.stores for one in store.writes if one.stops]
    if not could:
        return
    together = Together(tokens)
    said = [_said_of_all_ways(tokens, together, *one) for one in could]
    pairs = list(zip(could, said, strict=True))
    found = search(tokens, [write for (_, write), can in pairs if can == _MAY])
    for (store, write), can in pairs:
        if can == _MAY and found.is_complete:
            can = _CANNOT
        yield store, write, _CAN if write in found.writes else can


def _said_of_all_ways(tokens: TokenGraph, together: Together, store: Store, write: Write) -> str:
    if domains.size(store.variable.domain) > MOST_VALUES:
        return _MAY
    spread = Spread(reduced(tokens, [write]), together, store)
    if not spread.may_stop(write):
        return _CANNOT
    return _CAN if spread.is_exact else _MAY
