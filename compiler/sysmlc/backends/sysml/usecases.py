"""Use cases with their subjects, actors, inclusions and extensions."""

from collections.abc import Iterator

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.declarations import definition_head
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.structure import contents
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import type_of


def use_case(book: Book, entry: Entry) -> list[Line]:
    """A use case definition."""
    element = entry.element
    assert element is not None
    body = [Line(f"subject : {one}") for one in book.names(entry, element, Edge.SUBJECT)[:1]]
    for more in book.graph.targets(element, Edge.SUBJECT)[1:]:
        book.lost(more, "subject")
    for actor in _actors(book, element):
        name = book.name(entry, element, Edge.REFERENCES, actor)
        body += [] if name is None else [Line(f"actor : {name}")]
    for name in book.names(entry, element, Edge.INCLUDES):
        body.append(Line(f"include use case : {name}"))
    return [Line(definition_head(book, entry).text(), body + contents(book, entry))]


def _actors(book: Book, use_case_: Element) -> Iterator[Element]:
    """Actors that an association joins with the use case."""
    for end in book.graph.sources(use_case_, Edge.TYPED_BY):
        for association in book.graph.sources(end, Edge.END):
            ends = book.graph.targets(association, Edge.END)
            types = [type_of(book.graph, one) for one in ends]
            yield from (one for one in types if one is not None and one.kind is Kind.ACTOR)


def extend(book: Book, entry: Entry) -> list[Line]:
    """An extension: a dependency on the use case that is extended, and on its extension points."""
    element = entry.element
    assert element is not None
    mark = book.ours(entry.parent, "extension")
    owner = "" if entry.parent is None else quoted(entry.parent.name)
    targets = book.names(entry.parent, element, Edge.EXTENDS)
    targets += book.names(entry.parent, element, Edge.REFERENCES)
    if not targets:
        return book.drop(entry, "extends")
    name = f"{quoted(entry.name)} " if entry.name else ""
    head = f"#{mark} dependency {name}from {owner} to {', '.join(targets)}"
    return [Line(head, contents(book, entry))]


def extension_point(book: Book, entry: Entry) -> list[Line]:
    """An extension point: an event of the use case."""
    return [Line(f"event occurrence {quoted(entry.name)}", contents(book, entry))]
