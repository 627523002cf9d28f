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

from sysmlc.frontends.caex import wellformed
from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.rows import Rows
from sysmlc.frontends.caex.sections import in_lists
from sysmlc.frontends.caex.tags import NotPlainError, Reader, is_plain, without_references
from sysmlc.sources import DEFAULT_LIMITS, Source
from sysmlc.sources.encoding import codec

_DECLARATION = re.compile(rb"<\?xml\s.*?\?>", re.DOTALL)
_COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)
_ROOT = re.compile(r"""(?:[^"'>]|"[^"]*"|'[^']*')*(?<!/)>(.*)""", re.DOTALL)


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
        is_sound = _cut(document, in_lists(data, start), root[1])
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


def _cut(document: Document, lists: Iterator[list[str]], root: dict[str, str]) -> bool:
    """Fill the columns with the rows of a text; False when it has to be checked by a parser."""
    reader, ends = Reader(), wellformed.Ends()
    sections = chain.from_iterable(lists)
    mark, first = next(sections), next(sections)
    piece, _, behind = first.partition("<")
    _start(document, piece, root)
    rows = Rows(document, reader, ends)
    rows.add(chain((mark, behind), sections))
    if 0 in document.ends or not is_plain("".join(document.ids)):
        raise NotPlainError
    document.has_changes = reader.has_changes
    document.has_stray = reader.has_stray or ends.has_stray
    document.shapes = {("CAEXFile", tuple(root)), *reader.shapes}
    return reader.is_sound and ends.is_sound and wellformed.is_end(rows.last)
