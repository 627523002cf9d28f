"""What sequence diagrams in PlantUML cannot say: messages that are on their way for a while."""

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import interactions

OVERTAKEN = rule(
    "SM710",
    "overtaken-message",
    Severity.INFO,
    "message '{message}' of '{interaction}' is drawn where it is sent, though '{other}' comes "
    "first on lifeline '{lifeline}'",
)


def report(graph: Graph, sink: Sink) -> None:
    """Report each message that something else overtakes on the lifeline that receives it."""
    for interaction in graph.of_kind(Kind.INTERACTION):
        for container in interactions.iter_containers(graph, interaction):
            items = interactions.interaction_fragments(graph, container)
            at = {item.id: number for number, item in enumerate(items)}
            for item in items:
                _check(graph, sink, interaction, items, at, item)


def _check(
    graph: Graph,
    sink: Sink,
    interaction: Element,
    items: list[Element],
    at: dict[str, int],
    sent: Element,
) -> None:
    message = interactions.sent_message(graph, sent)
    received = graph.target(message, Edge.RECEIVE_EVENT) if message is not None else None
    if message is None or received is None or received.id not in at:
        return
    lifelines = {one.id for one in interactions.covered_lifelines(graph, received)}
    for other in items[at[sent.id] + 1 : at[received.id]]:
        found = [one for one in interactions.covered_lifelines(graph, other) if one.id in lifelines]
        if found and _drawn(graph, at, other) > at[sent.id]:
            _report(graph, sink, interaction, message, other, found[0])
            return


def _drawn(graph: Graph, at: dict[str, int], other: Element) -> int:
    """Where it is drawn: a message at the first of its ends, an execution with its ends."""
    if other.kind is Kind.EXECUTION:
        return -1
    message = interactions.received_message(graph, other)
    first = graph.target(message, Edge.SEND_EVENT) if message is not None else None
    return min(at[other.id], at.get(first.id, at[other.id]) if first is not None else at[other.id])


def _report(
    graph: Graph, sink: Sink, interaction: Element, message: Element, other: Element, line: Element
) -> None:
    from sysmlc.backends.plantuml.sd_texts import event_name

    sink.report(
        OVERTAKEN,
        graph.subject(message),
        message=event_name(graph, message),
        interaction=graph.qualified_name(interaction),
        other=event_name(graph, other),
        lifeline=line.name or "without name",
    )
