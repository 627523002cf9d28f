"""What AutomationML has besides structure: facets, groups, documents, further information."""

from sysmlc.backends.sysml import annotations
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.words import comment_lines, quoted
from sysmlc.ir import AttrValue, Edge, Kind

_HIDDEN = frozenset({"external", "library", "subkind", "unresolved"})


def group(book: Book, entry: Entry) -> list[Line]:
    """A facet or a group: metadata about what it shows."""
    element = entry.element
    assert element is not None
    kind = book.ours(entry.parent, str(element.kind))
    name = f"{quoted(entry.name)} : " if entry.name else ""
    names = book.names(entry.parent, element, Edge.REFERENCES)
    about = f" about {', '.join(names)}" if names else ""
    return [Line(f"metadata {name}{kind}{about}", annotations.of(book, entry))]


def facts(book: Book, entry: Entry) -> list[Line]:
    """A document, an alias or further information: a comment that lists what is known of it."""
    element = entry.element
    assert element is not None
    known = sorted((key, one) for key, one in element.attrs.items() if key not in _HIDDEN)
    found = [f"{key} = {_text(value)}" for key, value in known]
    title = f"{element.kind} {element.subkind}".strip()
    body = comment_lines("\n".join([title, *found]))
    inner = [line for one in entry.members for line in book.member(one)]
    names = [
        name
        for one in book.graph.targets(element, Edge.REFERENCES)
        if one.kind in (Kind.PORT, Kind.PROPERTY, Kind.CLASS)
        and (name := book.name(entry.parent, element, Edge.REFERENCES, one)) is not None
    ]
    about = f" about {', '.join(names)}" if names else ""
    name = f" {quoted(entry.name)}" if entry.name else ""
    return [Line(f"comment{name}{about}", text=body), *inner]


def _text(value: AttrValue) -> str:
    if isinstance(value, tuple):
        return ", ".join(_text(one) for one in value)
    return str(value)
