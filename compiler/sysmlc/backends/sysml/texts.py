"""Comments, documentation, and bodies in other languages."""

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.words import comment_lines, quoted, string
from sysmlc.ir import Edge, Element


def comment(book: Book, entry: Entry) -> list[Line]:
    """Documentation of its owner, or a comment about what it annotates."""
    element = entry.element
    assert element is not None
    about = book.graph.targets(element, Edge.REFERENCES)
    owner = book.graph.owner(element)
    body = comment_lines(str(element.attrs.get("body", "")))
    name = f" {quoted(entry.name)}" if entry.name else ""
    inner = [line for one in entry.members for line in book.member(one)]
    if body != comment_lines(_spelt(element)) or _spelt(element) != element.attrs.get("body", ""):
        book.approximated(element, "white space around a text", "none")
    if not about and owner is not None:
        book.approximated(element, "a comment about nothing", "documentation of its owner")
    if about == [owner] or (not about and entry.parent is not None and element.role == ""):
        return [Line(f"doc{name}", text=body), *inner]
    names = book.names(entry.parent, element, Edge.REFERENCES)
    if names:
        return [Line(f"comment{name} about {', '.join(names)}", text=body), *inner]
    return [Line(f"comment{name}", text=body), *inner]


def _spelt(element: Element) -> str:
    """The text as it is read again: without what surrounds its lines."""
    return _plain(str(element.attrs.get("body", "")))


def _plain(text: str) -> str:
    lines = text.replace("\r\n", "\n").strip().splitlines()
    return "\n".join(one.rstrip() for one in lines)


def opaque_lines(book: Book, entry: Entry, element: Element) -> list[Line]:
    """The bodies of an opaque element: documentation in natural language, else as they are."""
    bodies = element.attrs.get("bodies", element.attrs.get("body"))
    languages = element.attrs.get("languages", element.attrs.get("language", ""))
    texts = bodies if isinstance(bodies, tuple) else () if bodies is None else (bodies,)
    named = languages if isinstance(languages, tuple) else (languages,) * len(texts)
    if any(str(one) != _plain(str(one)) for one in texts):
        book.approximated(element, "white space around a text", "none")
    pairs = zip(texts, (*named, *([""] * len(texts))), strict=False)
    return [representation(str(text), str(language)) for text, language in pairs if text]


def representation(text: str, language: str) -> Line:
    """A text in its language."""
    return Line(f"language {string(language)}", text=comment_lines(text))
