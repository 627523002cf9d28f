"""Pins, parameter nodes and object nodes: directed and stored features of actions."""

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.calls import parameter_of
from sysmlc.backends.sysml.declarations import Head, feature_head
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.references import is_around
from sysmlc.backends.sysml.structure import contents
from sysmlc.backends.sysml.values import value
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element


def pin(book: Book, entry: Entry) -> list[Line]:
    """A pin: a parameter of its action, which redefines that of what is called."""
    element = entry.element
    assert element is not None
    head = feature_head(book, entry)
    if not any(one in head.prefixes for one in ("in", "out", "inout")):
        head.prefixes = ["in", *(one for one in head.prefixes if one != "ref")]
    formal = parameter_of(book, element)
    if formal is not None:
        _redefine(book, entry, formal, head)
    text = value(book, entry.parent, element, element) or _result(book, entry, element)
    head.value = f" = {text}" if text else ""
    return [Line(head.text(), contents(book, entry))]


def _redefine(book: Book, entry: Entry, formal: Element, head: Head) -> None:
    name = book.redefined(entry.parent, formal)
    if name is None:
        return
    head.redefines = [*(head.redefines or ()), name]
    if name == quoted(entry.name):
        head.name = ""
        element = entry.element
        types = [] if element is None else book.graph.targets(element, Edge.TYPED_BY)
        if types == book.graph.targets(formal, Edge.TYPED_BY):
            head.types = []


def _result(book: Book, entry: Entry, element: Element) -> str:
    """The value that a value action gives out, or the feature that a read action reads."""
    action = book.graph.owner(element)
    if action is None or element.attrs.get("direction") != "out":
        return ""
    if action.subkind == "value":
        return value(book, entry.parent, element, action)
    if action.subkind != "read":
        return ""
    feature = book.graph.target(action, Edge.CALLS)
    other = book.plan.entry(feature)
    if feature is None or other is None or not is_around(book.plan, entry.parent, other):
        return ""
    return book.name(entry.parent, action, Edge.CALLS, feature) or ""


def object_node(book: Book, entry: Entry) -> list[Line]:
    """A buffer or a data store: an item that the activity keeps."""
    element = entry.element
    assert element is not None
    head = feature_head(book, entry)
    return [Line(head.text(), contents(book, entry))]
