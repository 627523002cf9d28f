"""Interactions: lifelines as references to parts, messages between them, fragments around them."""

from sysmlc.backends.sysml import annotations
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.conditions import condition
from sysmlc.backends.sysml.declarations import type_name
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.references import named
from sysmlc.backends.sysml.structure import contents
from sysmlc.backends.sysml.words import quoted, string
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.query import type_of


def lifeline(book: Book, entry: Entry) -> list[Line]:
    """A lifeline: a reference to a part, or to something of its type."""
    element = entry.element
    assert element is not None
    head = f"ref part {quoted(entry.name)}"
    for one in book.graph.targets(element, Edge.REPRESENTS):
        type_ = type_of(book.graph, one)
        shape = book.plan.entry(type_)
        word = "" if shape is None else _LIFELINES.get(shape.shape.keyword, "")
        name = None if type_ is None else type_name(book, entry.parent, element, type_)
        if name is not None:
            head = f"ref {word}{quoted(entry.name)} : {name}"
        book.approximated(element, "what a lifeline represents", "a part of the same type")
    return [Line(head, contents(book, entry))]


_LIFELINES = {"part def": "part ", "item def": "part ", "port def": "port "}
"""What a lifeline is by the definition that types it; messages go between occurrences."""


def message(book: Book, entry: Entry) -> list[Line]:
    """A message: a transfer from one lifeline to another."""
    element = entry.element
    assert element is not None
    ends = [_end(book, entry, element, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
    head = f"message {quoted(entry.name)}"
    head += _payload(book, entry, element)
    if None not in ends:
        head += f" from {ends[0]} to {ends[1]}"
    elif any(one is not None for one in ends):
        book.approximated(element, "a message with one end", "a message without ends")
    _say_ends(book, element)
    return [Line(head, _facts(book, entry, element) + contents(book, entry))]


def _payload(book: Book, entry: Entry, element: Element) -> str:
    """What is transferred: the signal, or the call of an operation."""
    target = book.graph.target(element, Edge.CALLS)
    other = book.plan.entry(target)
    if target is None or other is None:
        return ""
    if other.shape.is_definition:
        return f" of {book.name(entry.parent, element, Edge.CALLS, target)}"
    return f" of {book.ours(entry.parent, 'Call')}"


def _end(book: Book, entry: Entry, element: Element, edge: Edge) -> str | None:
    target = book.graph.target(element, edge)
    return None if target is None else named(book.plan, entry.parent, target)


def _say_ends(book: Book, element: Element) -> None:
    for edge in (Edge.SEND_EVENT, Edge.RECEIVE_EVENT):
        for one in book.graph.targets(element, edge):
            book.said.add(one.id)
            book.approximated(one, "an event of a message", "its end")
            book.approximated(element, "the events of a message", "its ends")


def _facts(book: Book, entry: Entry, element: Element) -> list[Line]:
    given = element.attrs.get("arguments")
    texts = given if isinstance(given, tuple) else ()
    lines = [Line(f"attribute argument{n} = {string(str(one))}") for n, one in enumerate(texts, 1)]
    target = book.graph.target(element, Edge.CALLS)
    called = book.plan.entry(target)
    is_operation = called is not None and not called.shape.is_definition and target is not None
    facts: dict[str, AttrValue] = {
        "name": element.subkind or element.attrs.get("message_kind"),
        "calls": book.graph.qualified_name(target) if is_operation and target else None,
    }
    return [annotations.ours(book, entry, "Kind", facts), *lines] if any(facts.values()) else lines


def fragment(book: Book, entry: Entry) -> list[Line]:
    """A combined fragment or one of its operands: an occurrence of its kind."""
    element = entry.element
    assert element is not None
    kind = element.subkind or str(element.kind).lower()
    body = [annotations.ours(book, entry, "Kind", {"name": kind})]
    guard = element.attrs.get("guard")
    if guard is not None and str(guard) != "else":
        book.approximated(element, "the guard of an operand", "a constraint in it")
        text = condition(book, entry, element, str(guard))
        body.append(Line("assert constraint", [Line("", text=[text])], is_short=True))
    for one in book.graph.targets(element, Edge.CALLS):
        other = book.plan.entry(one)
        name = book.name(entry, element, Edge.CALLS, one)
        if name is not None and other is not None:
            body.append(Line(f"ref {':' if other.shape.is_definition else ':>'} {name}"))
    if element.kind is Kind.FRAGMENT:
        book.approximated(element, "a fragment of an interaction", "an occurrence of its kind")
    return [Line(f"occurrence {quoted(entry.name)}", body + contents(book, entry))]
