"""Rows of a file that is written plainly, from what stands between the signs that start its tags.

Every tag of a plant passes here. Text is listened to as in ``columns``: from a start tag that may
have some to the next tag.
"""

from collections.abc import Iterator
from typing import Any

from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.sections import WITHOUT_VALUE
from sysmlc.frontends.caex.tags import (
    UNLIKE,
    WITH_ID,
    NotPlainError,
    Reader,
    Tag,
    text_in,
    without_references,
)
from sysmlc.frontends.caex.vocabulary import FOLDED
from sysmlc.frontends.caex.wellformed import Ends
from sysmlc.sources import DEFAULT_LIMITS

_FOLDED_STARTS = "".join({name[0]: None for name in FOLDED})
"""What the names of folded elements start with: no others that are frequent do."""

_DEEPEST = DEFAULT_LIMITS.depth

_SILENT, _LISTENING, _FOLDED = range(3)
"""Whether text is listened to for the row's own; or it was taken for a column of its parent."""


class Rows:
    """Adds rows behind that of the root to a document; ``last`` is the piece that came last.

    The numbers of rows above are objects, so that rows share them: compiled, each row would have
    a number of its own otherwise.
    """

    __slots__ = ("_adding", "_document", "_ended", "_reader", "_reading", "_stack", "last")

    def __init__(self, document: Document, reader: Reader, ended: Ends) -> None:
        self._document, self._reader, self._ended = document, reader, ended
        self._adding = (
            *(document.tags.append, document.attributes.append, document.ids.append),
            *(document.alike.append, document.parents.append),
            *(document.ordinals.append, document.ends.append),
        )
        known, with_id = reader.known.get, reader.with_id.get
        self._reading = (known, with_id, reader.read, reader.parsed)
        self._stack: list[Any] = [0]
        self.last = ""

    def add(self, sections: Iterator[str]) -> None:
        """Add the rows of all sections.

        Behind most values an attribute ends and one beside it starts, which has a value, too: what
        stands between both is known as a whole.

        Raises NotPlainError, IndexError, StopIteration.
        """
        document, ended, stack = self._document, self._ended, self._stack
        tags, ends, values_of = document.tags, document.ends, document.texts["Value"]
        known = self._reader.beside.get
        add_tag, add_attributes, add_id, add_alike, add_parent, add_ordinal, add_end = self._adding
        row, ordinal, state = 1, 0, _LISTENING
        for section in sections:
            above = stack[-1]
            if section is WITHOUT_VALUE:
                pieces = iter(next(sections).split("<"))
            elif above in values_of:
                pieces = iter(f"Value>{section}".split("<"))
            else:
                said, _, between = section.partition("<")
                values_of[above] = without_references(said) if "&" in said else said
                ordinal += 1
                state = _SILENT
                beside = known(between)
                if beside is not None and tags[above] == beside[0]:
                    name, values, _, _, alike = beside
                    ends[above] = stack[-1] = row
                    add_tag(name)
                    add_attributes(values)
                    add_id("")
                    add_alike(alike)
                    add_parent(stack[-2])
                    ordinal += 1
                    add_ordinal(ordinal)
                    add_end(0)
                    row += 1
                    continue
                behind = between.split("<")
                pieces = iter(behind)
                if ended[next(pieces)] != "Value":
                    raise NotPlainError
                if len(behind) == 3:
                    self._reader.learn(between, behind, ended)
            row, ordinal, state = self._add_each(pieces, row, ordinal, state)

    def _add_each(
        self, pieces: Iterator[str], row: int, ordinal: int, state: int
    ) -> tuple[int, int, int]:
        """Add the rows of what stands between signs that start tags; where it has got to."""
        document, ended, stack = self._document, self._ended, self._stack
        tags, ends, texts = document.tags, document.ends, document.texts
        known, with_id, read, parsed = self._reading
        add_tag, add_attributes, add_id, add_alike, add_parent, add_ordinal, add_end = self._adding
        piece = ""
        for piece in pieces:
            first = piece[0]
            if first == "/":
                above = stack.pop()
                if tags[above] != ended[piece]:
                    raise NotPlainError
                ends[above] = row
                state = _SILENT
                continue
            ordinal += 1
            above = stack[-1]
            if first in _FOLDED_STARTS and not state and _is_folded(texts, piece, above):
                _pass_end(piece.partition(">")[0], pieces, ended)
                continue
            if first == UNLIKE:
                tag = parsed(piece, row)
                id = tag[1].get("ID", "")
            elif first == WITH_ID:
                head, _, rest = piece.partition(' ID="')
                id, _, tail = rest.partition('"')
                found = with_id((head, tail))
                tag, id = read(piece, row) if found is None else (found, id)
            else:
                found = known(piece)
                tag, id = read(piece, row) if found is None else (found, "")
            name, values, is_empty, has_text, alike = tag
            if has_text or state:
                state = _listen(texts, tag, piece, above, row)
                if state == _FOLDED:
                    _pass_end("" if is_empty else name, pieces, ended)
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
                stack.append(row - 1)
                add_end(0)
                if len(stack) > _DEEPEST:
                    raise NotPlainError
        self.last = piece
        return row, ordinal, state


def _is_folded(texts: dict[str, dict[int, str]], piece: str, above: int) -> bool:
    """Take the text of an element that is folded; False when it has to be a row."""
    name, sign, said = piece.partition(">")
    column = texts.get(name)
    if column is None or not sign or above in column:
        return False
    column[above] = without_references(said)
    return True


def _pass_end(name: str, pieces: Iterator[str], ended: Ends) -> None:
    """Pass over the end tag of an element that is folded; without a name there is none."""
    if name and ended[next(pieces)] != name:
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
