"""The columns of a file that is written plainly: its text is cut at the signs that start tags.

Most tags of a plant say word for word what others say, but for an ID: each is read once, and its
rows share the attributes. That the file is well-formed is seen on the way (``wellformed``), or left
to expat where something is unusual. Comments, line ends and references to characters are
dealt with; a file with more than that (other encodings than UTF-8, CDATA, processing instructions,
single quotes, attributes with prefixes) goes the general way (``columns``), which gives the same
columns for every file.
"""

import re
from collections.abc import Iterator
from itertools import chain
from typing import Any

from sysmlc.frontends.caex import wellformed
from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.tags import (
    UNLIKE,
    NotPlainError,
    Reader,
    Tag,
    is_plain,
    text_in,
    without_references,
)
from sysmlc.frontends.caex.vocabulary import FOLDED
from sysmlc.sources import DEFAULT_LIMITS, Source
from sysmlc.sources.encoding import codec

_CHUNK = 1 << 16
"""Bytes that are cut at once: what comes of them stays near the processor."""

_DECLARATION = re.compile(rb"<\?xml\s.*?\?>", re.DOTALL)
_COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)
_ROOT = re.compile(r"""(?:[^"'>]|"[^"]*"|'[^']*')*(?<!/)>(.*)""", re.DOTALL)

_FOLDED_STARTS = tuple({name[0]: None for name in FOLDED})
"""What the names of folded elements start with: no others that are frequent do."""

_SILENT, _LISTENING, _FOLDED = range(3)
"""Whether text is listened to for the row's own; or it was taken for a column of its parent."""


def fill(document: Document, source: Source) -> bool:
    """Fill the columns of a document without rows; False when the file is not plain."""
    start = _start_of(source.data)
    if start is None:
        return False
    data = _without_comments(source.data)
    if _begins_too_deep(data, start):
        return False
    is_checked = data is not source.data or not wellformed.is_sound(data)
    root = wellformed.root(source) if is_checked else wellformed.root_alone(source)
    if root is None or root[0] != "CAEXFile":
        return False
    try:
        is_sound = _cut(document, _chunks(data, start), root[1])
    except (NotPlainError, UnicodeDecodeError, IndexError, StopIteration):
        # The last two: more ends than starts, or fewer; it is not well-formed.
        document.clear()
        return False
    if is_sound or is_checked or wellformed.root(source) is not None:
        return True
    document.clear()
    return False


def _start_of(data: bytes) -> int | None:
    """Where the declaration is over; None when there is more to it than tags and comments."""
    mark, name = codec(data)
    if name != "utf-8":
        return None
    declared = _DECLARATION.match(data, mark)
    start = declared.end() if declared else mark
    # Single characters first: to look for two takes ten times as long.
    at = data.find(b"?", start)
    if at >= 0 and data.find(b"<?", start) >= 0:
        return None
    return None if b"!" in data and b"<![" in data else start


def _without_comments(data: bytes) -> bytes:
    """The bytes without comments; the same object when there is none."""
    return _COMMENT.sub(b"", data) if b"!" in data and b"<!--" in data else data


def _begins_too_deep(data: bytes, start: int) -> bool:
    """Whether more elements are open at the first end than may be: the rest need not be checked."""
    ends = [at for at in (data.find(b"</", start), data.find(b"/>", start)) if at >= 0]
    return data.count(b"<", start, min(ends, default=len(data))) > DEFAULT_LIMITS.depth


def _start(document: Document, piece: str, values: dict[str, str]) -> None:
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


def _cut(document: Document, chunks: Iterator[list[str]], root: dict[str, str]) -> bool:
    """Fill the columns with the rows of a text; False when it has to be checked by a parser."""
    reader, ends = Reader(), wellformed.Ends()
    pieces = chain.from_iterable(chunks)
    _start(document, next(pieces), root)
    last = _fill(document, pieces, reader, ends)
    if 0 in document.ends or not is_plain("".join(document.ids)):
        raise NotPlainError
    document.has_changes = reader.has_changes
    document.has_stray = reader.has_stray or ends.has_stray
    document.shapes = {("CAEXFile", tuple(root)), *reader.shapes}
    return reader.is_sound and ends.is_sound and wellformed.is_end(last)


def _fill(document: Document, pieces: Iterator[str], reader: Reader, ended: wellformed.Ends) -> str:
    """Fill the columns with the rows behind the root; the last piece.

    Text is listened to as in ``columns``: from a start tag that may have some to the next tag.
    The numbers of rows above are objects, so that rows share them: compiled, each
    row would have a number of its own otherwise.
    """
    tags, ends, texts = document.tags, document.ends, document.texts
    known, read = reader.known.get, reader.read
    add_tag, add_attributes, add_id = tags.append, document.attributes.append, document.ids.append
    add_parent, add_ordinal = document.parents.append, document.ordinals.append
    add_end, add_alike = ends.append, document.alike.append
    stack: list[Any] = [0]
    deepest = DEFAULT_LIMITS.depth
    push, pop = stack.append, stack.pop
    ordinal, row, state, piece = 0, 1, _LISTENING, ""
    for piece in pieces:
        first = piece[0]
        if first == "/":
            above = pop()
            if tags[above] != ended[piece]:
                raise NotPlainError
            ends[above] = row
            state = _SILENT
            continue
        ordinal += 1
        above = stack[-1]
        if first in _FOLDED_STARTS and not state:
            name, sign, said = piece.partition(">")
            column = texts.get(name)
            if column is not None and sign and above not in column:
                column[above] = without_references(said) if "&" in said else said
                if ended[next(pieces)] != name:
                    raise NotPlainError
                continue
        found = None if first == UNLIKE else known(piece)
        tag, id = read(piece, row) if found is None else (found, "")
        name, values, is_empty, has_text, alike = tag
        if has_text or state:
            state = _listen(texts, tag, piece, above, row)
            if state == _FOLDED:
                _pass_end(tag, pieces, ended)
                state = _SILENT
                continue
        add_tag(name)
        add_attributes(values)
        add_id(id)
        add_alike(alike)
        add_parent(above)
        add_ordinal(ordinal)
        row += 1
        if is_empty:
            add_end(row)
        else:
            push(row - 1)
            add_end(0)
            if len(stack) > deepest:
                raise NotPlainError
    return piece


def _pass_end(tag: Tag, pieces: Iterator[str], ended: wellformed.Ends) -> None:
    """Pass over the end tag of an element that is folded."""
    if not tag[2] and ended[next(pieces)] != tag[0]:
        raise NotPlainError


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


def _chunks(data: bytes, start: int) -> Iterator[list[str]]:
    """What stands between the signs that start tags, in lists.

    Bytes become text here: new memory is what takes longest in that, and so it is used again.
    """
    start, end = data.index(b"<", start) + 1, len(data)
    while start < end:
        stop = data.find(b"<", start + _CHUNK)
        stop = end if stop < 0 else stop
        text = data[start:stop].decode()
        if "\r" in text:
            text = text.replace("\r\n", "\n").replace("\r", "\n")
        yield text.split("<")
        start = stop + 1
