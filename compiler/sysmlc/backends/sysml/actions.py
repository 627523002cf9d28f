"""Actions and control nodes of an activity, each with the successions that leave it."""

from sysmlc.backends.sysml import annotations
from sysmlc.backends.sysml.behaviours import sequence
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.calls import call_target
from sysmlc.backends.sysml.declarations import visibility
from sysmlc.backends.sysml.effects import statements
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.events import trigger
from sysmlc.backends.sysml.loops import over
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.references import is_around
from sysmlc.backends.sysml.structure import contents
from sysmlc.backends.sysml.successions import first, leaving
from sysmlc.backends.sysml.texts import opaque_lines
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element, Kind

_PLAIN = frozenset(
    {"", "opaque", "call-behavior", "call-operation", "send", "accept", "value", "read"}
)
"""Subkinds that words of SysML v2 say; the others are told by metadata."""


def action(book: Book, entry: Entry) -> list[Line]:
    """An action of an activity, and what follows it."""
    element = entry.element
    assert element is not None
    write = _WRITERS.get(element.subkind, _other)
    line = write(book, entry, element)
    return [line, *leaving(book, entry)]


def _start(book: Book, entry: Entry, element: Element) -> str:
    return " ".join([*visibility(book, element), "action", quoted(entry.name)])


def _contents(book: Book, entry: Entry, element: Element) -> list[Line]:
    notes = (
        []
        if element.subkind in _PLAIN
        else [annotations.ours(book, entry, "Kind", {"name": element.subkind})]
    )
    return notes + contents(book, entry)


def _call(book: Book, entry: Entry, element: Element) -> Line:
    """A call: an action of the behaviour's kind, or the performance of another one."""
    body = _contents(book, entry, element)
    target = book.graph.target(element, Edge.CALLS)
    if target is None:
        return Line(_start(book, entry, element), body)
    other = book.plan.entry(target)
    name = call_target(book, entry, element, target)
    if name is None or other is None:
        return Line(_start(book, entry, element), body)
    if other.shape.is_definition:
        return Line(f"{_start(book, entry, element)} : {name}", body)
    words = " ".join([*visibility(book, element), "perform", "action", quoted(entry.name)])
    return Line(f"{words} ::> {name}", body)


def _opaque(book: Book, entry: Entry, element: Element) -> Line:
    body = _contents(book, entry, element)
    found = statements(book, entry, element)
    if found is None:
        return Line(_start(book, entry, element), body + opaque_lines(book, entry, element))
    if len(found) == 1 and not found[0].startswith("perform"):
        return Line(f"{_start(book, entry, element)} {found[0]}", body)
    return Line(_start(book, entry, element), body + sequence(found))


def _send(book: Book, entry: Entry, element: Element) -> Line:
    body = _contents(book, entry, element)
    name = None
    for signal in book.graph.targets(element, Edge.CALLS):
        name = book.name(entry.parent, element, Edge.CALLS, signal)
    port = book.graph.get(str(element.attrs.get("on_port", element.attrs.get("port", ""))))
    end = "" if port is None else book.name(entry.parent, element, Edge.ROLE, port)
    sent = f" send new {name}()" if name is not None else " send"
    return Line(f"{_start(book, entry, element)}{sent}{f' via {end}' if end else ''}", body)


def _accept(book: Book, entry: Entry, element: Element) -> Line:
    body = _contents(book, entry, element)
    found = book.graph.targets(element, Edge.TRIGGER)
    if not found:
        found = [one for one in book.graph.owned(element) if one.kind is Kind.TRIGGER]
    book.said.update(one.id for one in found)
    texts = [trigger(book, entry, one) for one in found]
    if len(texts) > 1:
        book.approximated(element, "an accept action with several triggers", "its first one")
    return Line(f"{_start(book, entry, element)}{f' {texts[0]}' if texts else ''}", body)


def _other(book: Book, entry: Entry, element: Element) -> Line:
    """Any other action: its kind as metadata, what it is about as a reference."""
    body = _contents(book, entry, element)
    for target in book.graph.targets(element, Edge.CALLS):
        other = book.plan.entry(target)
        name = book.name(entry, element, Edge.CALLS, target)
        if name is not None and other is not None and is_around(book.plan, entry, other):
            mark = ":" if other.shape.is_definition else ":>"
            body.append(Line(f"ref {mark} {name}"))
    return Line(_start(book, entry, element), body + opaque_lines(book, entry, element))


def structured(book: Book, entry: Entry) -> list[Line]:
    """A structured node: an action that holds its nodes, or a loop over a collection."""
    element = entry.element
    assert element is not None
    head, loop = _start(book, entry, element), over(book, entry, element)
    body = contents(book, entry)
    if loop:
        kind = f"@{book.ours(entry, 'Kind')}"
        head, body = f"{head} {loop}", [one for one in body if one.head != kind]
    return [Line(head, body), *leaving(book, entry)]


def control(book: Book, entry: Entry) -> list[Line]:
    """A decision, merge, fork or join; a final node that ends everything terminates."""
    element = entry.element
    assert element is not None
    if entry.shape.keyword == "start":
        return first(book, entry, element)
    body = contents(book, entry)
    if entry.shape.keyword == "action":
        return [Line(f"action {quoted(entry.name)} terminate", body)]
    return [Line(f"{entry.shape.keyword} {quoted(entry.name)}", body), *leaving(book, entry)]


_WRITERS = {
    "call-behavior": _call,
    "call-operation": _call,
    "opaque": _opaque,
    "": _opaque,
    "send": _send,
    "broadcast": _send,
    "accept": _accept,
    "accept-call": _accept,
}


def nothing(_book: Book, _entry: Entry) -> list[Line]:
    """What is written with something else: control flows, with the node that they leave."""
    return []
