"""Comments, documentation, and bodies in other languages."""

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.words import comment_lines, quoted, string
from sysmlc.ir import Edge, Element

_NATURAL = frozenset({"", "english", "natural", "natural language", "text", "plain text", "nl"})


def comment(book: Book, entry: Entry) -> list[Line]:
    """Documentation of its owner, or a comment about what it annotates."""
    element = entry.element
    assert element is not None
    about = book.graph.targets(element, Edge.REFERENCES)
    owner = book.graph.owner(element)
    body = comment_lines(str(element.attrs.get("body", "")))
    name = f" {quoted(entry.name)}" if entry.name else ""
    inner = [line for one in entry.members for line in book.member(one)]
    if about == [owner] or (not about and entry.parent is not None and element.role == ""):
        return [Line(f"doc{name}", text=body), *inner]
    names = book.names(entry.parent, element, Edge.REFERENCES)
    if names:
        return [Line(f"comment{name} about {', '.join(names)}", text=body), *inner]
    return [Line(f"comment{name}", text=body), *inner]


def opaque_lines(book: Book, entry: Entry, element: Element) -> list[Line]:
    """The bodies of an opaque element: documentation in natural language, else as they are."""
    bodies = element.attrs.get("bodies", element.attrs.get("body"))
    languages = element.attrs.get("languages", element.attrs.get("language", ""))
    texts = bodies if isinstance(bodies, tuple) else () if bodies is None else (bodies,)
    named = languages if isinstance(languages, tuple) else (languages,) * len(texts)
    pairs = zip(texts, (*named, *([""] * len(texts))), strict=False)
    return [representation(str(text), str(language)) for text, language in pairs if text]


def representation(text: str, language: str) -> Line:
    """A text in its language."""
    if language.lower() in _NATURAL:
        return Line("doc", text=comment_lines(text))
    return Line(f"language {string(language)}", text=comment_lines(text))
