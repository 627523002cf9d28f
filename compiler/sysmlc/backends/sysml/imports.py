"""Imports of packages and elements."""

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.library import scalar_of
from sysmlc.backends.sysml.printing import Line
from sysmlc.ir import Edge, Element, Kind

_PRIMITIVES = ("PrimitiveTypes", "UMLPrimitiveTypes", "PrimitiveValueTypes")


def import_(book: Book, entry: Entry) -> list[Line]:
    """An import; without a visibility of its own it is public, as in UML."""
    element = entry.element
    assert element is not None
    if element.subkind == "alias":
        return book.writers[str(Kind.DOCUMENT)](book, entry)
    word = "private" if element.attrs.get("visibility") == "private" else "public"
    lines = []
    for target in book.graph.targets(element, Edge.REFERENCES):
        name = _target(book, entry, target)
        if name is None and target.attrs.get("library"):
            book.approximated(element, f"the import of the library {target.name}", "nothing")
            continue
        if name is None:
            book.lost(element, "references")
            continue
        if target.attrs.get("external") and book.plan.entry(target) is None:
            book.approximated(element, "an import of primitive types", "one of those of SysML v2")
        is_package = target.kind in (Kind.PACKAGE, Kind.PROFILE) and element.subkind != "element"
        lines.append(Line(f"{word} import {name}{'::*' if is_package else ''}"))
    return lines


def _target(book: Book, entry: Entry, target: Element) -> str | None:
    scalar = scalar_of(target)
    if scalar is not None:
        return book.library(entry.parent, scalar)
    if target.name in _PRIMITIVES and target.attrs.get("external"):
        return book.library(entry.parent, "ScalarValues")
    other = book.plan.entry(target)
    if other is None:
        return None
    return book.name(entry.parent, target, Edge.REFERENCES, target)
