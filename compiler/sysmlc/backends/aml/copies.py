"""Instances are copies in AutomationML: they say again what their classes say of attributes."""

from collections.abc import Iterator

from sysmlc.backends.aml.book import Book
from sysmlc.backends.aml.families import Family
from sysmlc.backends.aml.node import Node
from sysmlc.ir import Edge, Element

_COPIED = frozenset({"DefaultValue", "Value", "RefSemantic", "Constraint", "Attribute"})
_FEATURES = frozenset({"Attribute", "ExternalInterface"})
_TYPE = "RefAttributeType"
_IDENTITY = frozenset({"ID", "ChangeMode"})


def write(book: Book) -> None:
    """Complete every internal element by the attributes that its classes have and it has not."""
    known = {path for _, family, path in book.paths if family is Family.ATTRIBUTE}
    for node, declared in book.copies:
        for child in _features(book, declared):
            if child.tag == "Attribute":
                _complete(node, child, known)
            else:
                _interface(node, child, known)


def _features(book: Book, type_: Element) -> Iterator[Node]:
    """What a class has of its own and inherits: of one name what is nearest."""
    seen: set[tuple[str, str]] = set()
    for node in _chain(book, type_):
        for child in node.children:
            key = (child.tag, child.attributes.get("Name", ""))
            if child.tag in _FEATURES and key not in seen:
                seen.add(key)
                # What a part of a class gives a value is known of that part alone.
                if not child.is_copy:
                    yield child


def _chain(book: Book, type_: Element) -> Iterator[Node]:
    """The nodes of a class and of those that it specialises, the nearest first."""
    seen: set[str] = set()
    one: Element | None = type_
    while one is not None and one.id not in seen:
        seen.add(one.id)
        node = book.nodes.get(one.id)
        if node is not None:
            yield node
        one = book.graph.target(one, Edge.SPECIALIZES)


def _interface(node: Node, of_class: Node, types: set[str]) -> None:
    """The attributes of an interface that the element repeats."""
    found = node.child("ExternalInterface", of_class.attributes["Name"])
    if found is not None and found.is_copy:
        for child in of_class.children:
            if child.tag == "Attribute":
                _complete(found, child, types)


def _complete(node: Node, of_class: Node, types: set[str]) -> None:
    """Add an attribute; of one that is there what it does not say itself."""
    waiting = [(node, of_class)]
    while waiting:
        above, known = waiting.pop()
        found = above.child("Attribute", known.attributes["Name"])
        if found is None:
            found = above.add(Node("Attribute", is_copy=True))
            found.attributes = {k: v for k, v in known.attributes.items() if k not in _IDENTITY}
            if found.attributes.get(_TYPE) not in types:
                found.attributes.pop(_TYPE, None)
        if not found.is_copy:
            continue
        said = {child.tag for child in found.children}
        for child in known.children:
            if child.tag == "Attribute":
                waiting.append((found, child))
            elif child.tag in _COPIED and child.tag not in said:
                found.add(child)
