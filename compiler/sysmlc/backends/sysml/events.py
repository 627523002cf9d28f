"""Triggers as accepted payloads: signals, calls, times, changes."""

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.conditions import condition, duration, instant
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element


def trigger(book: Book, scope: Entry, element: Element) -> str:
    """What is accepted, and at which port."""
    text = _payload(book, scope, element)
    port = book.graph.get(str(element.attrs.get("port", "")))
    name = None if port is None else book.name(scope, element, Edge.ROLE, port)
    return f"accept {text}{f' via {name}' if name else ''}"


def _payload(book: Book, scope: Entry, element: Element) -> str:
    kind = element.subkind
    if kind == "time":
        when = str(element.attrs.get("when", ""))
        if when.replace(".", "", 1).isdigit():
            book.approximated(element, "a time without a unit", "seconds")
        if element.attrs.get("relative"):
            return f"after {duration(book, scope, element, when)}"
        return f"at {instant(book, scope, element, when)}"
    if kind == "change":
        return f"when {condition(book, scope, element, str(element.attrs.get('condition', '')))}"
    return _typed(book, scope, element)


def _typed(book: Book, scope: Entry, element: Element) -> str:
    target = book.graph.target(element, Edge.TYPED_BY)
    other = book.plan.entry(target)
    if element.subkind == "call" and (target is None or other is None):
        return f"call : {book.ours(scope, 'Call')}"
    if target is None or other is None:
        return f"any : {book.library(scope, 'Base::Anything')}"
    if other.shape.is_definition:
        name = book.name(scope, element, Edge.TYPED_BY, target)
        payload = element.attrs.get("payload")
        if payload:
            return f"{quoted(str(payload))} : {name}"
        # The toolkit reads no payload that begins with the root.
        return f": {name}" if str(name).startswith("$") else str(name)
    return f"{quoted(other.name)} : {book.ours(scope, 'Call')}"
