"""Messages of sequence diagrams as lines (UML 2.5.1 clause 17.4)."""

from collections.abc import Iterator

from sysmlc.backends.plantuml.sd_texts import message_text
from sysmlc.backends.plantuml.sd_walk import Walk
from sysmlc.backends.plantuml.views import Step
from sysmlc.ir import Edge, Element, Graph, Kind

_ARROWS = {
    "asynch-call": "->>",
    "asynch-signal": "->>",
    "reply": "-->>",
    "create-message": "-->>",
}
"""Arrows by message sort; a filled head is a synchronous call (17.4.4)."""


def message_steps(walk: Walk, message: Element) -> Iterator[Step]:
    """The message, once: at the first of its two occurrences."""
    source, target = _end(walk, message, Edge.FLOW_SOURCE), _end(walk, message, Edge.FLOW_TARGET)
    if not (source or target) or not walk.is_new(message):
        return
    graph = walk.graph
    ends = [*graph.targets(message, Edge.SEND_EVENT), *graph.targets(message, Edge.RECEIVE_EVENT)]
    about = [message, *(end for end in ends if end.kind is Kind.OCCURRENCE)]
    text, times = walk.text(about, message_text(graph, message))
    if message.subkind == "create-message" and target != source:
        yield Step("create", source=target)
    yield Step(
        "message",
        text,
        source or _outside(graph, message, Edge.SEND_EVENT),
        _ARROWS.get(message.subkind, "->"),
        target or _outside(graph, message, Edge.RECEIVE_EVENT),
        shows=(message.id, *(end.id for end in ends), *times),
    )
    for item in about:
        yield from walk.notes(item, [alias for alias in (source, target) if alias])


def _end(walk: Walk, message: Element, edge: Edge) -> str:
    lifeline = walk.graph.target(message, edge)
    return walk.aliases[lifeline.id] if lifeline is not None and lifeline.id in walk.aliases else ""


def _outside(graph: Graph, message: Element, edge: Edge) -> str:
    """A gate is on the frame; an end that nobody knows is a point (17.4.4)."""
    is_sent = edge is Edge.SEND_EVENT
    end = graph.target(message, Edge.SEND_EVENT if is_sent else Edge.RECEIVE_EVENT)
    if end is not None and end.kind is Kind.GATE:
        return "[" if is_sent else "]"
    return "?o" if is_sent else "o?"
