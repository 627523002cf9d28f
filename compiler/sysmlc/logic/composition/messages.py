"""Messages between members: a signal or call of one member occurs at the members joined to it.

An output of the sender states that a message is sent, and an event of the receiver states that it
occurs, both in the same step. If several messages are sent to one receiver in one step, only one of
them occurs, because a step of a state machine has one event (by UML 2.5.1 clause 14.2.3.9.1, events
are taken from the pool one by one).
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic import formula as f
from sysmlc.logic.composition.members import Block, Member, Wire, name_in_composite
from sysmlc.logic.composition.structure import ITSELF, join_path
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    EnumerationDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formula import Const, Formula
from sysmlc.logic.identifiers import identifier
from sysmlc.logic.machines.machine import NO_EVENT

_EVENT = "event"


class Receipt(Struct, frozen=True):
    """A message that a member can receive; ``occurs`` is true in the step in which it occurs."""

    member: Member
    message: str
    occurs: Formula
    origin: str


class Sending(Struct, frozen=True):
    """A message that a member sends; ``is_sent`` is true in the step in which it is sent."""

    member: Member
    is_sent: Formula


def derive_wiring(
    block: Block, members: Sequence[Member], wires: Iterable[Wire]
) -> Iterator[Conjunct]:
    """Yield the conjuncts that relate sent messages to their occurrences at the receivers."""
    for member, receipts in iter_listeners(block, members, tuple(wires)):
        yield from _derive_occurrences(member, receipts, is_reachable_from_outside(block, member))


def derive_exclusions(
    block: Block, members: Sequence[Member], wires: Iterable[Wire]
) -> Iterator[Conjunct]:
    """Yield the conjuncts that no two messages are sent to one member in the same step.

    Otherwise a message is lost. No contract of a member guarantees this, so that it is checked.
    """
    for member, receipts in iter_listeners(block, members, tuple(wires)):
        sent = [
            (receipt, sending)
            for receipt, sendings in receipts
            for sending in sendings
            # A Boolean input has its own variable: only values of one event exclude one another.
            if not isinstance(receipt.occurs, f.Var)
        ]
        for (receipt, sending), (second_receipt, second_sending) in combinations(sent, 2):
            first, second = (
                _describe_sending(receipt, sending),
                _describe_sending(second_receipt, second_sending),
            )
            text = f"{first} and {second} are sent to '{member.name}'."
            coincidence = f.both(sending.is_sent, second_sending.is_sent)
            yield Conjunct(f.negate(coincidence), Class.SAFETY, receipt.origin, text)


def _describe_sending(receipt: Receipt, sending: Sending) -> str:
    return f"'{receipt.message}' by '{sending.member.name}'"


_Receipts = Sequence[tuple[Receipt, list[Sending]]]


def iter_listeners(
    block: Block, members: Sequence[Member], wires: tuple[Wire, ...]
) -> Iterator[tuple[Member, _Receipts]]:
    """Yield each member that receives messages of others, with its receipts and their senders."""
    for member in members:
        receipts = [
            (receipt, sendings)
            for receipt in _iter_receipts(block.graph, member, wires)
            if (sendings := list(_iter_sendings(block, members, receipt, wires)))
        ]
        if receipts:
            yield member, receipts


def iter_unsent(
    block: Block, members: Sequence[Member], wires: tuple[Wire, ...]
) -> Iterator[tuple[Receipt, str]]:
    """Yield each message that a member names a port for and no member sends there, and the port."""
    for member in members:
        for receipt in _iter_receipts(block.graph, member, wires):
            port = member.ports.get(receipt.message)
            if port and not any(_iter_sendings(block, members, receipt, wires)):
                yield receipt, port


def is_reachable_from_outside(block: Block, member: Member) -> bool:
    """Whether a port of the block leads to the member, so that others can send to it."""
    ports = query.ports(block.graph, block.element)
    reached = (block.channels.list_reached((ITSELF, port.name)) for port in ports)
    ends = set(_iter_ends(block, member))
    return member.path != ITSELF and not all(map(ends.isdisjoint, reached))


def _derive_occurrences(member: Member, receipts: _Receipts, is_open: bool) -> Iterator[Conjunct]:
    """Yield the conjuncts that messages occur only if they are sent, and that sent ones occur."""
    sent_formulas = [
        f.either(*(sending.is_sent for sending in sendings)) for _, sendings in receipts
    ]
    if not is_open:
        for (receipt, sendings), is_sent in zip(receipts, sent_formulas, strict=True):
            senders = " or ".join(dict.fromkeys(f"'{sending.member.name}'" for sending in sendings))
            text = f"'{receipt.message}' occurs at '{member.name}' only when {senders} sends it."
            yield Conjunct(f.implies(receipt.occurs, is_sent), Class.SAFETY, receipt.origin, text)
    for group, text in _group_receipts(member, receipts, sent_formulas):
        occurrences = [f.both(receipt.occurs, is_sent) for receipt, is_sent in group]
        formula = f.implies(f.either(*(is_sent for _, is_sent in group)), f.either(*occurrences))
        yield Conjunct(formula, Class.SAFETY, group[0][0].origin, text)


def _group_receipts(
    member: Member, receipts: _Receipts, sent_formulas: Sequence[Formula]
) -> Iterator[tuple[list[tuple[Receipt, Formula]], str]]:
    """Yield groups of receipts with a text for their conjunct.

    Receipts that are values of the same event exclude each other and form one group.
    """
    pairs = [
        (receipt, is_sent) for (receipt, _), is_sent in zip(receipts, sent_formulas, strict=True)
    ]
    values = [pair for pair in pairs if not isinstance(pair[0].occurs, f.Var)]
    if values:
        names = ", ".join(f"'{receipt.message}'" for receipt, _ in values)
        yield values, f"What is sent to '{member.name}' of {names} occurs, one in a step."
    for pair in pairs:
        if pair not in values:
            yield [pair], f"'{pair[0].message}' occurs at '{member.name}' when it is sent."


# -- outputs and events of members ---------------------------------------------------------------


def _iter_receipts(graph: Graph, member: Member, wires: tuple[Wire, ...]) -> Iterator[Receipt]:
    inputs = {
        variable.name: variable
        for variable in member.contract.variables
        if variable.owner is Owner.ENVIRONMENT
    }
    event = inputs.get(_EVENT)
    feature_variables = member.features.values()
    if event is not None and isinstance(event.domain, EnumerationDomain):
        value = f.var(name_in_composite(member, _EVENT, wires))
        for literal in event.domain.literals:
            if literal != NO_EVENT:
                yield Receipt(member, literal, f.eq(value, Const(literal)), event.origin)
    for name, variable in inputs.items():
        prefix, _, message = name.partition("_")
        if prefix in ("receive", "call") and message and name not in feature_variables:
            occurs = f.var(name_in_composite(member, name, wires))
            yield Receipt(member, message, occurs, variable.origin)


def _iter_sendings(
    block: Block, members: Iterable[Member], receipt: Receipt, wires: tuple[Wire, ...]
) -> Iterator[Sending]:
    for sender in members:
        addressed = set(_addressed_names(block, sender, receipt))
        # Several behaviours and actions of a member may send one message.
        for message, variable in _iter_outputs(block.graph, sender):
            if message in addressed:
                yield Sending(sender, f.var(name_in_composite(sender, variable, wires)))


def _addressed_names(block: Block, sender: Member, receipt: Receipt) -> Iterator[str]:
    """Yield the names of outputs with which a sender can address the receiver's event."""
    receiver = receipt.member
    if sender is not receiver and _are_joined(block, sender, receiver, receipt.message):
        yield receipt.message
    if sender.path == ITSELF and receiver.path != ITSELF:
        yield identifier(join_path(receiver.path, receipt.message))


def _are_joined(block: Block, left: Member, right: Member, message: str) -> bool:
    """Whether connectors can lead a message from one member to the other.

    Each end is the member itself or a port.
    """
    ends = set(_iter_ends(block, right, message))
    return any(
        not ends.isdisjoint(block.channels.list_reached(end))
        for end in _iter_ends(block, left, message)
    )


def _iter_ends(block: Block, member: Member, message: str = "") -> Iterator[tuple[str, str]]:
    """Yield the ends of connectors at a member through which a message can pass."""
    if message in member.ports:
        yield member.path, member.ports[message]
        return
    yield member.path, ""
    element = block.element if member.path == ITSELF else _type_of(block, member)
    for port in query.ports(block.graph, element):
        yield member.path, port.name


def _type_of(block: Block, member: Member) -> Element:
    element = block.graph[member.origin]
    return query.type_of(block.graph, element) or element


def _iter_outputs(graph: Graph, member: Member) -> Iterator[tuple[str, str]]:
    """Yield each message that a member can send, with the name of its output variable."""
    for variable in member.contract.variables:
        is_output = variable.owner is Owner.SYSTEM and isinstance(variable.domain, BooleanDomain)
        if is_output and variable.name not in member.features.values():
            yield find_message_name(graph, variable), variable.name


def find_message_name(graph: Graph, output: Variable) -> str:
    """Return the name of the signal or operation that an output sends, or else its own name."""
    element = graph.get(output.origin)
    if element is not None and element.kind is Kind.ACTION:
        target = graph.target(element, Edge.CALLS)
        is_sent = element.subkind in ("send", "broadcast", "call-operation") and target is not None
        return identifier(target.name) if is_sent and target is not None else ""
    return output.name.removeprefix("send_")
