"""The columns of a file that is written plainly: its text is cut at the signs that start tags.

Most tags of a plant say word for word what others say, but for an ID: each is read once, and its
rows share the attributes. Expat only checks the file then, which takes a third of what it takes
with a call into Python for every element. Comments, line ends and references to characters are
dealt with; a file with more than that (other encodings than UTF-8, CDATA, processing instructions,
single quotes, attributes with prefixes) goes the general way (``columns``), which gives the same
columns for every file.
"""

import re
from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING

from sysmlc.frontends.caex.columns import FOLDED
from sysmlc.frontends.caex.tags import (
    NotPlainError,
    Reader,
    Tag,
    is_plain,
    text_in,
    without_references,
)
from sysmlc.sources import DEFAULT_LIMITS, Source, SourceError
from sysmlc.sources.encoding import codec
from sysmlc.sources.xml import SEPARATOR, parse, parser

if TYPE_CHECKING:
    from sysmlc.frontends.caex.document import Document

_CHUNK = 1 << 16
"""Characters that are cut at once: what comes of them stays near the processor."""

_DECLARATION = re.compile(r"<\?xml\s.*?\?>", re.DOTALL)
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_ROOT = re.compile(r"""(?:[^"'>]|"[^"]*"|'[^']*')*(?<!/)>(.*)""", re.DOTALL)

_FOLDED_STARTS = "".join({name[0] for name in FOLDED})
"""What the names of folded elements start with: no others that are frequent do."""

_SILENT, _LISTENING, _FOLDED = range(3)
"""Whether text is listened to for the row's own; or it was taken for a column of its parent."""

_Root = tuple[str, dict[str, str]]
"""Tag and attributes."""


def fill(document: "Document", source: Source) -> bool:
    """Fill the columns of a document without rows; False when the file is not plain."""
    text = _text_of(source)
    root = None if text is None or _begins_too_deep(text) else _checked(source)
    if text is None or root is None or root[0] != "CAEXFile":
        return False
    try:
        _cut(document, text, root[1])
    except NotPlainError:
        document.clear()
        return False
    return True


def _text_of(source: Source) -> str | None:
    """The text without declaration and comments; None when there is more to it than tags."""
    mark, name = codec(source.data)
    if name != "utf-8":
        return None
    try:
        text = source.data[mark:].decode()
    except UnicodeDecodeError:
        return None
    declared = _DECLARATION.match(text)
    text = text[declared.end() :] if declared else text
    # Single characters first: to look for two takes ten times as long.
    if ("?" in text and "<?" in text) or ("!" in text and "<![" in text):
        return None
    if "!" in text and "<!--" in text:
        text = _COMMENT.sub("", text)
    return text.replace("\r\n", "\n").replace("\r", "\n") if "\r" in text else text


def _begins_too_deep(text: str) -> bool:
    """Whether more elements are open at the first end than may be: the rest need not be checked."""
    ends = [at for at in (text.find("</"), text.find("/>")) if at >= 0]
    return text.count("<", 0, min(ends, default=len(text))) > DEFAULT_LIMITS.depth


def _checked(source: Source) -> _Root | None:
    """The root; None when the file is not well-formed, which the general way tells."""
    made, found = parser(), []

    def start(tag: str, values: dict[str, str]) -> None:
        found.append((tag.rpartition(SEPARATOR)[2], values))
        made.StartElementHandler = None

    made.StartElementHandler = start
    try:
        parse(source, made)
    except SourceError:
        return None
    finally:
        made.StartElementHandler = None
    return found[0]


def _start(document: "Document", piece: str, values: dict[str, str]) -> None:
    """Fill the row of the root."""
    found = _ROOT.fullmatch(piece)
    if found is None:
        raise NotPlainError
    document.tags.append("CAEXFile")
    document.attributes.append(values)
    document.ids.append(values.get("ID", ""))
    document.alike.append(0)
    document.parents.append(-1)
    document.ordinals.append(0)
    document.ends.append(0)
    if found[1]:
        document.texts[""][0] = without_references(found[1])


def _cut(document: "Document", text: str, root: dict[str, str]) -> None:
    """Fill the columns with the rows of a text that is well-formed.

    Text is listened to as in ``columns``: from a start tag that may have some to the next tag.
    """
    tags, ends, texts, reader = document.tags, document.ends, document.texts, Reader()
    known, read = reader.known.get, reader.read
    stack, deepest = [-1, 0], DEFAULT_LIMITS.depth
    add_tag, add_attributes, add_id = tags.append, document.attributes.append, document.ids.append
    add_parent, add_ordinal = document.parents.append, document.ordinals.append
    add_end, add_alike, push, pop = ends.append, document.alike.append, stack.append, stack.pop
    pieces = chain.from_iterable(_chunks(text))
    _start(document, next(pieces), root)
    ended: set[str] = set()
    end = ended.add
    ordinal, row, state = 0, 1, _LISTENING
    for piece in pieces:
        if piece[0] == "/":
            end(piece)
            ends[pop()] = row
            state = _SILENT
            continue
        ordinal += 1
        above = stack[-1]
        tag, id = known(piece), ""
        if tag is None:
            if piece[0] in _FOLDED_STARTS and not state:
                name, _, said = piece.partition(">")
                column = texts.get(name)
                if column is not None and above not in column:
                    column[above] = without_references(said) if "&" in said else said
                    end(_ended(pieces))
                    continue
            tag, id = read(piece, row)
        name, values, is_empty, has_text, alike = tag
        if has_text or state:
            state = _listen(texts, tag, piece, above, row)
            if state == _FOLDED:
                state = _SILENT
                if not is_empty:
                    end(_ended(pieces))
                continue
        add_tag(name)
        add_attributes(values)
        add_id(id)
        add_alike(alike)
        add_parent(above)
        add_ordinal(ordinal)
        if is_empty:
            row += 1
            add_end(row)
        else:
            push(row)
            row += 1
            add_end(0)
            if len(stack) > deepest:
                raise NotPlainError
    if not is_plain("".join(document.ids)):
        raise NotPlainError
    document.has_changes = reader.has_changes
    document.has_stray = reader.has_stray or _has_stray(ended)
    document.shapes = {("CAEXFile", tuple(root)), *reader.shapes}


def _has_stray(ended: set[str]) -> bool:
    """Whether text stands behind an end tag."""
    return any(piece.partition(">")[2].strip() for piece in ended)


def _ended(pieces: Iterator[str]) -> str:
    """The end tag of an element that is folded."""
    piece = next(pieces)
    if piece[0] != "/":
        raise NotPlainError
    return piece


def _listen(texts: dict[str, dict[int, str]], tag: Tag, piece: str, above: int, row: int) -> int:
    """Take the text of a start tag; what is listened to then."""
    name, values, is_empty, _, _ = tag
    said = "" if is_empty else text_in(piece)
    column = None if values else texts.get(name)
    if column is not None and above not in column:
        column[above] = said
        return _FOLDED
    if said:
        texts[""][row] = said
    return _SILENT if is_empty else _LISTENING


def _chunks(text: str) -> Iterator[list[str]]:
    """What stands between the signs that start tags, in lists."""
    start, end = text.index("<") + 1, len(text)
    while start < end:
        stop = text.find("<", start + _CHUNK)
        stop = end if stop < 0 else stop
        yield text[start:stop].split("<")
        start = stop + 1
