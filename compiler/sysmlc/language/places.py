"""Where something of a tree stands in its file."""

from codecs import BOM_UTF8

from sysmlc.diagnostics import Place
from sysmlc.language.tree import Document


def place(document: Document, start: int) -> Place:
    """The place of a character of a text, or of an XML element of an interchange file."""
    if not document.text:
        return Place(document.path, ordinal=start)
    return Place(document.path, offset=byte(document, start))


def byte(document: Document, start: int) -> int:
    """The byte of the file at which a character of the text starts; -1 stays -1."""
    if start < 0:
        return start
    text = document.text
    before = start if text.isascii() else len(text[:start].encode("utf-8", "replace"))
    return mark(document) + before


def mark(document: Document) -> int:
    """Bytes of the byte order mark before the text."""
    is_marked = document.source is not None and document.source.data.startswith(BOM_UTF8)
    return len(BOM_UTF8) if is_marked else 0
