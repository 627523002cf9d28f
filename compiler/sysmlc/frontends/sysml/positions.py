"""Positions of nodes in their files: bytes of a text, ordinals of an interchange file."""

import re
from bisect import bisect_left, bisect_right

from sysmlc.language.tree import Document, Node, byte_order_mark_length

_WIDE_CHARACTER = re.compile(r"[^\x00-\x7f]")


class DocumentPositions:
    """A document of the unit, with the byte offsets of its characters.

    ``language.tree.byte_offset`` encodes the text before one character, which is right for a single
    diagnostic. The lowering asks for each element, so this class indexes the characters that take
    several bytes once.
    """

    def __init__(self, document: Document) -> None:
        self.document = document
        self.path = document.path
        surplus = byte_order_mark_length(document.source) if document.text else 0
        self._wide_characters: list[int] = []
        self._surplus_bytes = [surplus]
        """Bytes beyond one for each character, before the first and after each wide character."""
        for match in _WIDE_CHARACTER.finditer(document.text):
            # A lone surrogate, which UTF-8 cannot encode, counts as the one byte of '?'.
            surplus += len(match[0].encode("utf-8", "replace")) - 1
            self._wide_characters.append(match.start())
            self._surplus_bytes.append(surplus)

    def ordinal_of(self, node: Node) -> int:
        """Return the byte at which the name of a node starts, or its ordinal in an XMI file."""
        return self.byte_of(node.name_start if node.name_start >= 0 else node.start)

    def byte_of(self, offset: int) -> int:
        """Return the byte of a character of the document; -1 stays -1."""
        if offset < 0:
            return offset
        return offset + self._surplus_bytes[bisect_left(self._wide_characters, offset)]

    def character_at(self, byte: int) -> int:
        """Return the character of the document that contains a byte; -1 before the first."""
        return bisect_right(range(byte + 1), byte, key=self.byte_of) - 1
