"""Positions in a file: the byte of a character of the document, and the character at a byte."""

from codecs import BOM_UTF8

import pytest

from sysmlc.language.tree import Document, DocumentPositions, Node
from sysmlc.sources import Source

LONG = f"{'a' * 300}\u00e9{'b' * 255}\u2013\U0001f600{'c' * 300}"
"""A text with characters of two, three and four bytes."""


def positions_of(text, prefix=b""):
    source = Source("m.sysml", prefix + text.encode())
    return DocumentPositions(Document("m.sysml", "sysml", Node("Namespace"), text, source))


@pytest.mark.parametrize("prefix", [b"", BOM_UTF8])
@pytest.mark.parametrize("text", ["", "part a;", "\u00e9\u00e9", LONG])
def test_bytes_of_characters_are_those_of_the_file(text, prefix):
    mark = prefix if text else b""
    positions = positions_of(text, mark)
    characters = range(len(text))
    starts = [len(mark) + len(text[:index].encode()) for index in characters]
    assert [positions.byte_of(index) for index in characters] == starts
    nodes = [Node("Feature", start=index) for index in characters]
    assert [positions.ordinal_of(node) for node in nodes] == starts
    assert [positions.character_at(start) for start in starts] == list(characters)


def test_each_byte_belongs_to_a_character():
    assert [positions_of("a\u2013b").character_at(byte) for byte in range(5)] == [0, 1, 1, 1, 2]
    assert positions_of("ab", BOM_UTF8).character_at(1) == -1


def test_a_node_without_a_position_has_no_byte():
    assert positions_of(LONG).byte_of(-1) == -1
    assert positions_of("").ordinal_of(Node("Feature")) == -1
