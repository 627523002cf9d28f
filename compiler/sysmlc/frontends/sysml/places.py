"""Places of nodes in their files: bytes of a text, ordinals of an interchange file."""

import re
from bisect import bisect_left

from sysmlc.language.places import mark
from sysmlc.language.tree import Document, Node

_WIDE = re.compile(r"[^\x00-\x7f]")


class Places:
    """Turns offsets of characters into bytes, for the documents of a unit."""

    def __init__(self) -> None:
        self._wide: dict[int, tuple[list[int], list[int], int]] = {}

    def ordinal(self, document: Document, node: Node) -> int:
        """The byte at which the name of a node starts; the element's ordinal in an XMI file."""
        offset = node.name_start if node.name_start >= 0 else node.start
        return self.byte(document, offset)

    def byte(self, document: Document, offset: int) -> int:
        """The byte of a character of the document; -1 stays -1."""
        if offset < 0 or not document.text:
            return offset
        positions, extra, mark = self._wide.get(id(document)) or self._table(document)
        if not positions:
            return offset + mark
        number = bisect_left(positions, offset)
        return offset + (extra[number - 1] if number else 0) + mark

    def _table(self, document: Document) -> tuple[list[int], list[int], int]:
        found = self._wide[id(document)] = _table(document)
        return found


def _table(document: Document) -> tuple[list[int], list[int], int]:
    """Characters that take several bytes, the bytes more up to each, and those of a mark."""
    positions, extra, sum_ = [], [], 0
    if not document.text.isascii():
        for found in _WIDE.finditer(document.text):
            sum_ += len(found[0].encode("utf-8", "replace")) - 1
            positions.append(found.start())
            extra.append(sum_)
    return positions, extra, mark(document)
