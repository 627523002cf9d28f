"""Pass ``interactions``: checks whether the traces of sequence diagrams are possible."""

from collections.abc import Iterator
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Rule, Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.query import interactions
from sysmlc.support.counts import count as count_nouns

MESSAGE_WITHOUT_LIFELINE = rule(
    "SM440",
    "message-without-lifeline",
    Severity.WARNING,
    "message '{message}' of '{interaction}' {problem}",
    help="tie the ends of the message to lifelines again, or delete it",
)
OPERANDS = rule(
    "SM441",
    "wrong-number-of-operands",
    Severity.WARNING,
    "fragment '{operator}' of '{interaction}' has {count}, but {wanted}",
    help="move the contents into one operand, or choose another operator",
)
ACROSS_OPERANDS = rule(
    "SM442",
    "message-across-fragments",
    Severity.WARNING,
    "message '{message}' of '{interaction}' is sent in one operand and received in another",
    help="move both ends of the message into the same operand",
)
AFTER_DESTRUCTION = rule(
    "SM443",
    "occurrence-after-destruction",
    Severity.WARNING,
    "something happens on lifeline '{lifeline}' of '{interaction}' after it was destroyed",
    help="move the destruction to the end of the lifeline",
)
RECEIVED_FIRST = rule(
    "SM444",
    "received-before-sent",
    Severity.WARNING,
    "message '{message}' of '{interaction}' is received before it is sent",
    help="move the message in the modelling tool, which orders its ends again",
)
EXECUTION_BACKWARDS = rule(
    "SM445",
    "execution-ends-before-it-starts",
    Severity.WARNING,
    "execution '{execution}' of '{interaction}' ends before it starts",
    help="draw the execution again in the modelling tool",
)
NOT_OFFERED = rule(
    "SM446",
    "operation-not-offered",
    Severity.WARNING,
    "message '{message}' of '{interaction}' calls '{operation}', which '{type}' does not offer",
    help="add the operation to '{type}', or choose one of its operations for the message",
)
CREATED_LATE = rule(
    "SM447",
    "created-after-its-first-occurrence",
    Severity.WARNING,
    "message '{message}' of '{interaction}' creates lifeline '{lifeline}', on which something has "
    "happened before",
    help="move the message up, or choose another sort of message",
)


_ONE_OPERAND = frozenset({"opt", "loop", "break", "assert", "neg"})
_Position = tuple[str, int]
"""The id of the interaction or operand that contains an occurrence, and the index in it."""


class Interactions(Struct, frozen=True):
    """Check every interaction; the graph stays unchanged.

    Assumes features and generalizations (``inherit``). Faulty elements stay in the graph, and
    diagrams show them as far as possible.
    """

    name: ClassVar[str] = "interactions"
    after: ClassVar[tuple[str, ...]] = ("inherit",)

    def run(self, graph: Graph, sink: Sink) -> None:
        """Report faults; see the class."""
        for interaction in graph.of_kind(Kind.INTERACTION):
            positions_by_id = dict(_locate_occurrences(graph, interaction))
            for message in interactions.messages(graph, interaction):
                _check_message(graph, sink, interaction, message, positions_by_id)
            for item in graph.subtree(interaction):
                if item.kind is Kind.FRAGMENT:
                    _check_operands(graph, sink, interaction, item)
                elif item.kind is Kind.EXECUTION:
                    _check_execution(graph, sink, interaction, item, positions_by_id)
            _check_destructions(graph, sink, interaction)
            _check_creations(graph, sink, interaction)


def _locate_occurrences(graph: Graph, interaction: Element) -> Iterator[tuple[str, _Position]]:
    """Yield the id of each occurrence with its position."""
    for container in interactions.iter_containers(graph, interaction):
        for position, item in enumerate(interactions.interaction_fragments(graph, container)):
            yield item.id, (container.id, position)


# -- messages ----------------------------------------------------------------------------------


def _check_message(
    graph: Graph,
    sink: Sink,
    interaction: Element,
    message: Element,
    positions_by_id: dict[str, _Position],
) -> None:
    problem = _find_missing_end(graph, message)
    if problem and not message.attrs.get("unresolved"):
        _report(graph, sink, MESSAGE_WITHOUT_LIFELINE, interaction, message, problem=problem)
    ends = (graph.target(message, Edge.SEND_EVENT), graph.target(message, Edge.RECEIVE_EVENT))
    sent, received = (positions_by_id.get(end.id) if end else None for end in ends)
    if sent and received and sent[0] != received[0]:
        _report(graph, sink, ACROSS_OPERANDS, interaction, message)
    elif sent and received and received[1] < sent[1]:
        _report(graph, sink, RECEIVED_FIRST, interaction, message)
    _check_operation(graph, sink, interaction, message)


def _find_missing_end(graph: Graph, message: Element) -> str:
    """Return a clause about a missing end of a message, or "" if there is none."""
    # A gate, or the open end of a lost or found message, is no occurrence and needs no lifeline.
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


def _check_operation(graph: Graph, sink: Sink, interaction: Element, message: Element) -> None:
    operation = graph.target(message, Edge.CALLS)
    lifeline = graph.target(message, Edge.FLOW_TARGET)
    if operation is None or operation.kind is not Kind.OPERATION or lifeline is None:
        return
    represented = interactions.participant(graph, lifeline)
    type_ = interactions.type_of(graph, lifeline)
    if message.subkind == "reply" or represented is None or represented.kind is not Kind.PROPERTY:
        return
    if type_ is not None and not _has_operation(graph, type_, operation):
        names = {"operation": operation.name, "type": type_.name}
        _report(graph, sink, NOT_OFFERED, interaction, message, **names)


def _has_operation(graph: Graph, type_: Element, operation: Element) -> bool:
    """Whether the type, a general, a realised interface or the type of a port has the operation."""
    owner = graph.owner(operation)
    if owner is None or operation.attrs.get("external"):
        return True
    offering_classifiers = {
        classifier.id: classifier for classifier in _list_offering(graph, type_)
    }
    # An external stub may have operations that the unit does not show.
    is_open = any(classifier.attrs.get("external") for classifier in offering_classifiers.values())
    return is_open or owner.id in offering_classifiers or _is_shared_namespace(owner)


def _list_offering(graph: Graph, type_: Element) -> Iterator[Element]:
    """Yield the type and the types of its ports, each with its generals and realised interfaces."""
    types = [graph.target(port, Edge.TYPED_BY) for port in query.ports(graph, type_)]
    for type_of_port in (type_, *(port_type for port_type in types if port_type is not None)):
        for general in (type_of_port, *query.generals(graph, type_of_port)):
            yield general
            for realised in graph.targets(general, Edge.REALIZES):
                yield from (realised, *query.generals(graph, realised))


def _is_shared_namespace(owner: Element) -> bool:
    """Whether operations of *owner* may be called on any type (interactions, collaborations)."""
    return owner.kind is Kind.INTERACTION or owner.subkind == "collaboration"


# -- fragments, executions, destructions -------------------------------------------------------


def _check_operands(graph: Graph, sink: Sink, interaction: Element, fragment: Element) -> None:
    if fragment.subkind in (*interactions.INTERACTION_USES, "state-invariant", "continuation"):
        return
    count = len(interactions.operands(graph, fragment))
    is_single = fragment.subkind in _ONE_OPERAND
    if count == 0 or (is_single and count != 1):
        sink.report(
            OPERANDS,
            graph.subject(fragment),
            operator=fragment.subkind,
            interaction=graph.qualified_name(interaction),
            count=count_nouns(count, "operand"),
            wanted="it has exactly one" if is_single else "it has at least one",
        )


def _check_execution(
    graph: Graph,
    sink: Sink,
    interaction: Element,
    execution: Element,
    positions_by_id: dict[str, _Position],
) -> None:
    ends = (graph.target(execution, Edge.START), graph.target(execution, Edge.FINISH))
    start, finish = (positions_by_id.get(end.id) if end else None for end in ends)
    # In different operands, the order depends on the operator of the fragment.
    if start and finish and start[0] == finish[0] and finish[1] < start[1]:
        sink.report(
            EXECUTION_BACKWARDS,
            graph.subject(execution),
            execution=execution.name or "without name",
            interaction=graph.qualified_name(interaction),
        )


def _check_destructions(graph: Graph, sink: Sink, interaction: Element) -> None:
    for container in interactions.iter_containers(graph, interaction):
        destroyed: dict[str, Element] = {}
        for item in interactions.interaction_fragments(graph, container):
            if item.kind is not Kind.OCCURRENCE:
                continue
            for lifeline in interactions.covered_lifelines(graph, item):
                if lifeline.id in destroyed:
                    sink.report(
                        AFTER_DESTRUCTION,
                        graph.subject(item),
                        lifeline=lifeline.name or "without name",
                        interaction=graph.qualified_name(interaction),
                    )
                elif item.subkind == "destruction":
                    destroyed[lifeline.id] = lifeline


def _check_creations(graph: Graph, sink: Sink, interaction: Element) -> None:
    started: set[str] = set()
    for item in graph.subtree(interaction):
        if item.kind is not Kind.OCCURRENCE:
            continue
        message = interactions.received_message(graph, item)
        for lifeline in interactions.covered_lifelines(graph, item):
            is_created = message is not None and message.subkind == "create-message"
            if message is not None and is_created and lifeline.id in started:
                name = lifeline.name or "without name"
                _report(graph, sink, CREATED_LATE, interaction, message, lifeline=name)
            started.add(lifeline.id)


def _report(
    graph: Graph, sink: Sink, rule: Rule, interaction: Element, message: Element, **facts: str
) -> None:
    operation = graph.target(message, Edge.CALLS)
    sink.report(
        rule,
        graph.subject(message),
        message=message.name or (operation.name if operation is not None else "") or "without name",
        interaction=graph.qualified_name(interaction),
        **facts,  # type: ignore[arg-type]
    )
