"""Signals and calls between members: what one sends occurs at those that it is joined to.

An output says that something is sent, an event of the receiver that it occurs; both are seen in
the same step. Of several things that are sent to one receiver in one step one occurs: a step of a
state machine has one event (UML 2.5.1 clause 14.2.3.9.1 takes them from a pool, one by one).
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic import formula as f
from sysmlc.logic.composition.members import Block, Member
from sysmlc.logic.composition.naming import Wire, own_name
from sysmlc.logic.composition.structure import ITSELF, joined
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    EnumerationDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formula import Const, Formula
from sysmlc.logic.machines.machine import NO_EVENT
from sysmlc.logic.names import identifier

_EVENT = "event"


class Receipt(Struct, frozen=True):
    """Something that can occur at a member: the formula that says so, and its name."""

    member: Member
    what: str
    occurs: Formula
    origin: str


class Sending(Struct, frozen=True):
    """Something that a member sends; ``said`` is true in the step in which it is."""

    member: Member
    said: Formula


def wiring(block: Block, members: Sequence[Member], known: Iterable[Wire]) -> Iterator[Conjunct]:
    """What occurs when something is sent, for each member that listens to others."""
    for member, receipts in _listeners(block, members, tuple(known)):
        yield from _occurrences(member, receipts, _is_open(block, member))


def crowding(block: Block, members: Sequence[Member], known: Iterable[Wire]) -> Iterator[Conjunct]:
    """That nothing is lost because two things are sent to one member in one step.

    Nobody owes it: a component sends what it has to.
    """
    for member, receipts in _listeners(block, members, tuple(known)):
        sent = [
            (receipt, one)
            for receipt, sendings in receipts
            for one in sendings
            if not isinstance(receipt.occurs, f.Var)
        ]
        for (receipt, one), (other, two) in combinations(sent, 2):
            text = f"{_by(receipt, one)} and {_by(other, two)} are sent to '{member.name}'."
            both = f.both(one.said, two.said)
            yield Conjunct(f.negate(both), Class.SAFETY, receipt.origin, text)


def _by(receipt: Receipt, sending: Sending) -> str:
    return f"'{receipt.what}' by '{sending.member.name}'"


_Receipts = Sequence[tuple[Receipt, list[Sending]]]


def _listeners(
    block: Block, members: Sequence[Member], wires: tuple[Wire, ...]
) -> Iterator[tuple[Member, _Receipts]]:
    """The members to which others send something, and what."""
    for member in members:
        receipts = [
            (receipt, sendings)
            for receipt in _receipts(block.graph, member, wires)
            if (sendings := list(_sendings(block, members, receipt, wires)))
        ]
        if receipts:
            yield member, receipts


def _is_open(block: Block, member: Member) -> bool:
    """Whether a port of the block leads to the member, so that others can send to it too."""
    ends = {block.channels.find(end) for end in _ends(block, member)}
    ports = query.ports(block.graph, block.element)
    outer = {block.channels.find((ITSELF, port.name)) for port in ports}
    return member.path != ITSELF and not ends.isdisjoint(outer)


def _occurrences(member: Member, receipts: _Receipts, is_open: bool) -> Iterator[Conjunct]:
    """Nothing occurs unsent; where something is sent, something that is sent occurs."""
    sent = [f.either(*(one.said for one in sendings)) for _, sendings in receipts]
    for (receipt, sendings), said in () if is_open else zip(receipts, sent, strict=True):
        senders = " or ".join(dict.fromkeys(f"'{one.member.name}'" for one in sendings))
        text = f"'{receipt.what}' occurs at '{member.name}' only when {senders} sends it."
        yield Conjunct(f.implies(receipt.occurs, said), Class.SAFETY, receipt.origin, text)
    for group, text in _together(member, receipts, sent):
        some = [f.both(receipt.occurs, said) for receipt, said in group]
        formula = f.implies(f.either(*(said for _, said in group)), f.either(*some))
        yield Conjunct(formula, Class.SAFETY, group[0][0].origin, text)


def _together(
    member: Member, receipts: _Receipts, sent: Sequence[Formula]
) -> Iterator[tuple[list[tuple[Receipt, Formula]], str]]:
    """Receipts that exclude one another, as values of one event; the others by themselves."""
    rows = [(receipt, said) for (receipt, _), said in zip(receipts, sent, strict=True)]
    values = [row for row in rows if not isinstance(row[0].occurs, f.Var)]
    if values:
        named = ", ".join(f"'{receipt.what}'" for receipt, _ in values)
        yield values, f"What is sent to '{member.name}' of {named} occurs, one in a step."
    for row in rows:
        if row not in values:
            yield [row], f"'{row[0].what}' occurs at '{member.name}' when it is sent."


# -- what members send and take ------------------------------------------------------------------


def _receipts(graph: Graph, member: Member, wires: tuple[Wire, ...]) -> Iterator[Receipt]:
    inputs = {one.name: one for one in member.contract.variables if one.owner is Owner.ENVIRONMENT}
    event = inputs.get(_EVENT)
    known = member.features.values()
    if event is not None and isinstance(event.domain, EnumerationDomain):
        value = f.var(own_name(member, _EVENT, wires))
        for literal in event.domain.literals:
            if literal != NO_EVENT:
                yield Receipt(member, literal, f.eq(value, Const(literal)), event.origin)
    for name, one in inputs.items():
        prefix, _, what = name.partition("_")
        if prefix in ("receive", "call") and what and name not in known:
            occurs = f.var(own_name(member, name, wires))
            yield Receipt(member, what, occurs, one.origin)


def _sendings(
    block: Block, members: Iterable[Member], receipt: Receipt, wires: tuple[Wire, ...]
) -> Iterator[Sending]:
    for sender in members:
        names = dict(_sent(block.graph, sender))
        for what in _addressed(block, sender, receipt):
            if what in names:
                yield Sending(sender, f.var(own_name(sender, names[what], wires)))


def _addressed(block: Block, sender: Member, receipt: Receipt) -> Iterator[str]:
    """Names of outputs by which a sender means the receiver's event."""
    receiver = receipt.member
    if sender is not receiver and _are_joined(block, sender, receiver):
        yield receipt.what
    if sender.path == ITSELF and receiver.path != ITSELF:
        yield identifier(joined(receiver.path, receipt.what))


def _are_joined(block: Block, one: Member, other: Member) -> bool:
    """Whether a connector leads from a port of one, or from itself, to the other."""
    mine, theirs = (
        {block.channels.find(end) for end in _ends(block, member)} for member in (one, other)
    )
    return not mine.isdisjoint(theirs)


def _ends(block: Block, member: Member) -> Iterator[tuple[str, str]]:
    yield member.path, ""
    element = block.element if member.path == ITSELF else _type(block, member)
    for port in query.ports(block.graph, element):
        yield member.path, port.name


def _type(block: Block, member: Member) -> Element:
    element = block.graph[member.origin]
    return query.type_of(block.graph, element) or element


def _sent(graph: Graph, member: Member) -> Iterator[tuple[str, str]]:
    """What a member sends or calls, by name, with the output that says so."""
    for one in member.contract.variables:
        is_output = one.owner is Owner.SYSTEM and isinstance(one.domain, BooleanDomain)
        if is_output and one.name not in member.features.values():
            yield _what(graph, one), one.name


def _what(graph: Graph, output: Variable) -> str:
    """The name of what an output sends; of any other output that of the output."""
    element = graph.get(output.origin)
    if element is not None and element.kind is Kind.ACTION:
        called = graph.target(element, Edge.CALLS)
        is_sent = element.subkind in ("send", "broadcast", "call-operation") and called is not None
        return identifier(called.name) if is_sent and called is not None else ""
    return output.name.removeprefix("send_")
