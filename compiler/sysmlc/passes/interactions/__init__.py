"""Pass ``interactions``: whether what sequence diagrams tell can happen."""

from collections.abc import Iterator
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Rule, Sink
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.query import interactions
from sysmlc.passes.interactions import rules

_ONE_OPERAND = frozenset({"opt", "loop", "break", "assert", "neg"})
_Place = tuple[str, int]
"""The interaction or operand that holds an occurrence, and the position in it."""


class Interactions(Struct, frozen=True):
    """Check every interaction; the graph stays as it is.

    Assumes features and generalizations (``inherit``). What is reported is in the graph as the
    model has it: diagrams draw it as far as they can.
    """

    name: ClassVar[str] = "interactions"
    after: ClassVar[tuple[str, ...]] = ("inherit",)

    def run(self, graph: Graph, sink: Sink) -> None:
        """Report what is wrong; see the class."""
        for interaction in graph.of_kind(Kind.INTERACTION):
            places = dict(_places(graph, interaction))
            for message in interactions.messages(graph, interaction):
                _message(graph, sink, interaction, message, places)
            for item in graph.subtree(interaction):
                if item.kind is Kind.FRAGMENT:
                    _operands(graph, sink, interaction, item)
                elif item.kind is Kind.EXECUTION:
                    _execution(graph, sink, interaction, item, places)
            _destructions(graph, sink, interaction)
            _creations(graph, sink, interaction)


def _places(graph: Graph, interaction: Element) -> Iterator[tuple[str, _Place]]:
    for container in interactions.iter_containers(graph, interaction):
        for position, item in enumerate(interactions.interaction_fragments(graph, container)):
            yield item.id, (container.id, position)


# -- messages ----------------------------------------------------------------------------------


def _message(
    graph: Graph, sink: Sink, interaction: Element, message: Element, places: dict[str, _Place]
) -> None:
    problem = _problem(graph, message)
    if problem and not message.attrs.get("unresolved"):
        _report(graph, sink, rules.MESSAGE_WITHOUT_LIFELINE, interaction, message, problem=problem)
    ends = (graph.target(message, Edge.SEND_EVENT), graph.target(message, Edge.RECEIVE_EVENT))
    found = [places.get(end.id) for end in ends if end is not None]
    if len(found) == 2 and found[0] is not None and found[1] is not None:
        (sent_in, sent_at), (received_in, received_at) = found[0], found[1]
        if sent_in != received_in:
            _report(graph, sink, rules.ACROSS_OPERANDS, interaction, message)
        elif received_at < sent_at:
            _report(graph, sink, rules.RECEIVED_FIRST, interaction, message)
    _signature(graph, sink, interaction, message)


def _problem(graph: Graph, message: Element) -> str:
    """What is missing at the ends; a gate is an end, and so is a lost or found message's."""
    if message.attrs.get("message_kind") == "unknown":
        return "has no lifeline at either end"
    for event, lifeline, verb in (
        (Edge.SEND_EVENT, Edge.FLOW_SOURCE, "sent"),
        (Edge.RECEIVE_EVENT, Edge.FLOW_TARGET, "received"),
    ):
        end = graph.target(message, event)
        is_occurrence = end is not None and end.kind is Kind.OCCURRENCE
        if is_occurrence and graph.target(message, lifeline) is None:
            return f"is {verb} at an occurrence that no lifeline has"
    return ""


def _signature(graph: Graph, sink: Sink, interaction: Element, message: Element) -> None:
    operation = graph.target(message, Edge.CALLS)
    lifeline = graph.target(message, Edge.FLOW_TARGET)
    if operation is None or operation.kind is not Kind.OPERATION or lifeline is None:
        return
    represented = interactions.participant(graph, lifeline)
    type_ = interactions.type_of(graph, lifeline)
    if message.subkind == "reply" or represented is None or represented.kind is not Kind.PROPERTY:
        return
    if type_ is not None and not _offers(graph, type_, operation):
        names = {"operation": operation.name, "type": type_.name}
        _report(graph, sink, rules.NOT_OFFERED, interaction, message, **names)


def _offers(graph: Graph, type_: Element, operation: Element) -> bool:
    """Whether the type has the operation: own, inherited, realised, or at one of its ports."""
    owner = graph.owner(operation)
    if owner is None or operation.attrs.get("external"):
        return True
    offering = {one.id: one for one in _offering(graph, type_)}
    is_open = any(one.attrs.get("external") for one in offering.values())
    return is_open or owner.id in offering or _holds_type(owner)


def _offering(graph: Graph, type_: Element) -> Iterator[Element]:
    """The type, its generals and realised interfaces, and the same of its ports' types."""
    types = [graph.target(port, Edge.TYPED_BY) for port in query.ports(graph, type_)]
    for one in (type_, *(found for found in types if found is not None)):
        for general in (one, *query.generals(graph, one)):
            yield general
            for realised in graph.targets(general, Edge.REALIZES):
                yield from (realised, *query.generals(graph, realised))


def _holds_type(owner: Element) -> bool:
    """An operation of an interaction or collaboration is nobody's in particular."""
    return owner.kind is Kind.INTERACTION or owner.subkind == "collaboration"


# -- fragments, executions, destructions -------------------------------------------------------


def _operands(graph: Graph, sink: Sink, interaction: Element, fragment: Element) -> None:
    if fragment.subkind in (*interactions.INTERACTION_USES, "state-invariant", "continuation"):
        return
    count = len(interactions.operands(graph, fragment))
    is_single = fragment.subkind in _ONE_OPERAND
    if count == 0 or (is_single and count != 1):
        sink.report(
            rules.OPERANDS,
            graph.subject(fragment),
            operator=fragment.subkind,
            interaction=graph.qualified_name(interaction),
            count=count,
            wanted="it has exactly one" if is_single else "it has at least one",
        )


def _execution(
    graph: Graph, sink: Sink, interaction: Element, execution: Element, places: dict[str, _Place]
) -> None:
    ends = (graph.target(execution, Edge.START), graph.target(execution, Edge.FINISH))
    found = [places.get(end.id) for end in ends if end is not None]
    if len(found) == 2 and found[0] is not None and found[1] is not None:
        is_same = found[0][0] == found[1][0]
        if is_same and found[1][1] < found[0][1]:
            sink.report(
                rules.EXECUTION_BACKWARDS,
                graph.subject(execution),
                execution=execution.name or "without name",
                interaction=graph.qualified_name(interaction),
            )


def _destructions(graph: Graph, sink: Sink, interaction: Element) -> None:
    for container in interactions.iter_containers(graph, interaction):
        destroyed: dict[str, Element] = {}
        for item in interactions.interaction_fragments(graph, container):
            if item.kind is not Kind.OCCURRENCE:
                continue
            for lifeline in interactions.covered_lifelines(graph, item):
                if lifeline.id in destroyed:
                    _report_destroyed(graph, sink, interaction, item, lifeline)
                elif item.subkind == "destruction":
                    destroyed[lifeline.id] = lifeline


def _creations(graph: Graph, sink: Sink, interaction: Element) -> None:
    begun: set[str] = set()
    for item in graph.subtree(interaction):
        if item.kind is not Kind.OCCURRENCE:
            continue
        message = interactions.received_message(graph, item)
        for lifeline in interactions.covered_lifelines(graph, item):
            is_created = message is not None and message.subkind == "create-message"
            if message is not None and is_created and lifeline.id in begun:
                name = lifeline.name or "without name"
                _report(graph, sink, rules.CREATED_LATE, interaction, message, lifeline=name)
            begun.add(lifeline.id)


def _report_destroyed(
    graph: Graph, sink: Sink, interaction: Element, item: Element, lifeline: Element
) -> None:
    sink.report(
        rules.AFTER_DESTRUCTION,
        graph.subject(item),
        lifeline=lifeline.name or "without name",
        interaction=graph.qualified_name(interaction),
    )


def _report(
    graph: Graph, sink: Sink, what: Rule, interaction: Element, message: Element, **facts: str
) -> None:
    called = graph.target(message, Edge.CALLS)
    sink.report(
        what,
        graph.subject(message),
        message=message.name or (called.name if called is not None else "") or "without name",
        interaction=graph.qualified_name(interaction),
        **facts,  # type: ignore[arg-type]
    )
