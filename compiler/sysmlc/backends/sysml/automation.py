"""What AutomationML has besides structure: facets, groups, documents, further information."""

from sysmlc.backends.sysml import annotations
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.kept import whole
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.words import comment_lines, quoted
from sysmlc.ir import AttrValue, Edge, Element, Kind

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
    """A document, an alias or further information: metadata, at the top a comment that lists it."""
    element = entry.element
    assert element is not None
    if _is_below(entry) and not book.graph.owned(element):
        return [_kept(book, entry, element)]
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
    # What is below another comment stands beside it: two of them may have the same name.
    is_named = bool(entry.name) and (entry.parent is None or _is_below(entry))
    name = f" {quoted(entry.name)}" if is_named else ""
    return [Line(f"comment{name}{about}", text=body), *inner]


def _is_below(entry: Entry) -> bool:
    above = entry.parent
    return above is not None and above.shape.keyword != "comment"


def _kept(book: Book, entry: Entry, element: Element) -> Line:
    """The same below something else: metadata, which gives it back."""
    owner = book.graph.owner(element)
    known: dict[str, AttrValue] = {"kind": str(element.kind), "name": element.name}
    if entry.parent is not None and entry.parent.element is not owner:
        known["isOfType"] = True
    return annotations.ours(book, entry, "Element", known | {"attributes": whole(book, element)})


def _text(value: AttrValue) -> str:
    if isinstance(value, tuple):
        return ", ".join(_text(one) for one in value)
    return str(value)
