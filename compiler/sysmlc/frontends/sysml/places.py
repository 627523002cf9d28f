"""Places of nodes in their files: bytes of a text, ordinals of an interchange file."""

import re
from bisect import bisect_left, bisect_right

from sysmlc.language.tree import Document, Node, byte_order_mark_length

_WIDE = re.compile(r"[^\x00-\x7f]")
_PIECE = 256


class Home:
    """A document of the unit, and where in the bytes of its file its nodes stand."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.path = document.path
        self._wide, self._behind = _wide(
            document.text, byte_order_mark_length(document) if document.text else 0
        )

    def ordinal(self, node: Node) -> int:
        """The byte at which the name of a node starts; the element's ordinal in an XMI file."""
        offset = node.name_start if node.name_start >= 0 else node.start
        return offset if offset < 0 else offset + self._behind[bisect_left(self._wide, offset)]

    def byte(self, offset: int) -> int:
        """The byte of a character of the document; -1 stays -1."""
        return offset if offset < 0 else offset + self._behind[bisect_left(self._wide, offset)]

    def character(self, byte: int) -> int:
        """The character of the document that a byte belongs to; -1 before the first."""
        return bisect_right(range(byte + 1), byte, key=self.byte) - 1


def _wide(text: str, more: int) -> tuple[list[int], list[int]]:
    """Characters that take several bytes, and how many bytes more there are before and behind each.

    ``more`` are those before the text.
    """
    positions, behind = [], [more]
    for start in range(0, 0 if text.isascii() else len(text), _PIECE):
        # Most pieces of a text have none; to ask a piece costs a tenth of looking through it.
        if text[start : start + _PIECE].isascii():
            continue
        for found in _WIDE.finditer(text, start, start + _PIECE):
            more += len(found[0].encode("utf-8", "replace")) - 1
            positions.append(found.start())
            behind.append(more)
    return positions, behind
