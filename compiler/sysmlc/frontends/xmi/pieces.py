"""The columns of a file that is written plainly: its text is cut at the signs that start tags.

Tags of a model differ in the values of their attributes; what they have in common is read once.
That the file is well-formed is seen on the way. Whatever is unusual (another encoding than UTF-8,
comments, CDATA, single quotes, namespaces declared below the root, drawings) is left to the parser
(``columns``), which gives the same columns for every file.
"""

import re
from collections.abc import Iterator
from itertools import chain

from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.indexing import XSI
from sysmlc.frontends.xmi.prefixes import IrregularError, Prefixes
from sysmlc.frontends.xmi.tags import NotPlainError, Tags, signs_in
from sysmlc.sources import DEFAULT_LIMITS, Source, SourceError, plain
from sysmlc.sources.xml import parse, plain_parser

_DRAWING = b"<diagramRepresentation"
"""Files with drawings inside are left to the parser without another look."""
_END = re.compile(r"/([A-Za-z_][A-Za-z0-9_.:-]*)[ \t\n]*>(.*)", re.DOTALL)


def fill(document: Document, source: Source, prefixes: Prefixes) -> Tags | None:
    """Fill the columns, with numbers of kinds of rows instead of shapes; None if it is not plain.

    The tags that are returned have the kinds; the prefixes learn from the root.
    """
    data = source.data
    start = None if _DRAWING in data else plain.start_of(data)
    if start is None or not plain.is_sound(data, start):
        return None
    try:
        root, values = _root(Source(source.name, plain.alone(data, start)))
        tags = Tags(prefixes, prefixes.begin(root, values), values)
        _add_root(document, values)
        _fill(document, _Cut(plain.texts(data, start)), tags, root)
        _check(document, tags, prefixes)
    except (NotPlainError, IrregularError, SourceError, UnicodeDecodeError, IndexError):
        # The last one: more ends than starts; it is not well-formed.
        return None
    return tags


def _root(source: Source) -> tuple[str, dict[str, str]]:
    """Name and attributes of the root as written. Raises SourceError."""
    made, found = plain_parser(), list[tuple[str, dict[str, str]]]()
    made.StartElementHandler = lambda tag, values: found.append((tag, values))
    try:
        parse(source, made)
    finally:
        made.StartElementHandler = None
    return found[0]


def _add_root(document: Document, values: dict[str, str]) -> None:
    document.attributes.append(values)
    document.parents.append(-1)
    document.ordinals.append(0)
    document.ends.append(0)
    document.shape_numbers.append(0)


def _check(document: Document, tags: Tags, prefixes: Prefixes) -> None:
    """Raises NotPlainError for no end of the root, or two roots, or types of another namespace."""
    has_xsi = XSI in prefixes.declared.values()
    is_typed = any(written for _, written, _ in tags.kinds)
    if document.ends[0] != len(document.ends) or (has_xsi and not is_typed):
        raise NotPlainError


class _Cut:
    """What stands between the signs that start tags, behind the text that the root starts with."""

    def __init__(self, texts: Iterator[str]) -> None:
        first = next(texts, "")
        self.first = first.partition("<")[0]
        self.signs = 0
        """Line ends, tabs and quotes in all that was cut so far."""
        self._texts = chain([first], texts)

    def __iter__(self) -> Iterator[str]:
        return chain.from_iterable(map(self._cut, self._texts))

    def _cut(self, text: str) -> list[str]:
        self.signs += signs_in(text)
        return text.split("<")[1:]


def _fill(document: Document, cut: _Cut, tags: Tags, root: str) -> None:
    """Fill the columns with the rows behind the root. Raises NotPlainError.

    Everything is in one frame: a call for each row would cost as much as the row.
    """
    ends, texts = document.ends, document.texts
    known, read, ended = tags.known.get, tags.read, _Ends()
    add_attributes, add_number = document.attributes.append, document.shape_numbers.append
    add_parent, add_ordinal = document.parents.append, document.ordinals.append
    add_end = ends.append
    stack, open_names, deepest = [-1, 0], [root], DEFAULT_LIMITS.depth
    push, pop, push_name, pop_name = stack.append, stack.pop, open_names.append, open_names.pop
    following, signs = 1, signs_in(cut.first)
    _hear(texts, 0, cut.first)
    for piece in cut:
        if piece[0] == "/":
            name, text, outside = ended[piece]
            if pop_name() != name:
                raise NotPlainError
            ends[pop()] = following
            signs += outside
            if text:
                _hear(texts, stack[-1], text)
            continue
        parts = piece.split('"')
        tag, text = known(tuple(parts[::2])), ""
        if tag is None:
            tag, text = read(piece, parts)
        name, is_empty, attributes, type_at, kinds, outside = tag
        signs += outside
        if "&" in piece:
            parts = [plain.said(part) if "&" in part else part for part in parts]
        # Columns share their numbers: a number of its own is four times its place in a list.
        row = following
        following = row + 1
        add_number(kinds[parts[type_at]] if type_at else kinds[""])
        add_attributes(attributes(parts))
        add_parent(stack[-1])
        add_ordinal(row)
        if is_empty:
            add_end(following)
        else:
            add_end(row)
            push(row)
            push_name(name)
            if len(stack) >= deepest:
                raise NotPlainError
        if text:
            signs += signs_in(text)
            _hear(texts, stack[-1], text)
    if signs != cut.signs:
        # Line ends in values are blanks, and quotes behind tags are text.
        raise NotPlainError


def _hear(texts: dict[int, str], row: int, text: str) -> None:
    """Note the text of a row. Raises NotPlainError for text behind the root."""
    said = plain.said(text)
    if said and not said.isspace():
        if row < 0:
            raise NotPlainError
        texts[row] = texts[row] + said if row in texts else said


class _Ends(dict[str, tuple[str, str, int]]):
    """Names of elements that end, texts behind, and signs as in ``Tag``, by what is written."""

    def __missing__(self, piece: str) -> tuple[str, str, int]:
        found = _END.fullmatch(piece)
        if found is None:
            raise NotPlainError
        name, text = found.groups()
        if text and not text.isspace():
            return name, text, signs_in(piece)
        self[piece] = ended = name, "", signs_in(piece)
        return ended
