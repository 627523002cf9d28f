"""Use cases with their subjects, actors, inclusions and extensions."""

from sysmlc.backends.sysml.actors import actors
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.declarations import definition_head
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.structure import contents
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge


def use_case(book: Book, entry: Entry) -> list[Line]:
    """A use case definition."""
    element = entry.element
    assert element is not None
    body = [Line(f"subject : {one}") for one in book.names(entry, element, Edge.SUBJECT)[:1]]
    for more in book.graph.targets(element, Edge.SUBJECT)[1:]:
        book.lost(more, "subject")
    for given, actor in actors(book.graph, element):
        name = book.name(entry, element, Edge.REFERENCES, actor)
        own = f" {quoted(given)}" if given else ""
        body += [] if name is None else [Line(f"actor{own} : {name}")]
    for name in book.names(entry, element, Edge.INCLUDES):
        body.append(Line(f"include use case : {name}"))
    return [Line(definition_head(book, entry).text(), body + contents(book, entry))]


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
