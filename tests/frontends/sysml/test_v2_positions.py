"""Positions in a file: the byte of a character of the document, and the character at a byte."""

from codecs import BOM_UTF8

import pytest

from sysmlc.language.tree import Document, Node, locate
from sysmlc.sources import Source

LONG = f"{'a' * 300}\u00e9{'b' * 255}\u2013\U0001f600{'c' * 300}"
"""A text with characters of two, three and four bytes."""


def read(text, prefix=b""):
    source = Source("m.sysml", prefix + text.encode())
    return Document("m.sysml", "sysml", Node("Namespace"), text, source)


@pytest.mark.parametrize("prefix", [b"", BOM_UTF8])
@pytest.mark.parametrize("text", ["", "part a;", "\u00e9\u00e9", LONG])
def test_bytes_of_characters_are_those_of_the_file(text, prefix):
    mark = prefix if text else b""
    document = read(text, mark)
    characters = range(len(text))
    starts = [len(mark) + len(text[:index].encode()) for index in characters]
    assert [document.byte_offsets.byte_of(index) for index in characters] == starts
    nodes = [Node("Feature", start=index) for index in characters]
    assert [document.ordinal_of(node) for node in nodes] == starts
    assert [document.byte_offsets.character_at(start) for start in starts] == list(characters)


def test_each_byte_belongs_to_a_character():
    offsets = read("a\u2013b").byte_offsets
    assert [offsets.character_at(byte) for byte in range(5)] == [0, 1, 1, 1, 2]
    assert read("ab", BOM_UTF8).byte_offsets.character_at(1) == -1


def test_a_node_without_a_position_has_no_byte():
    assert read(LONG).byte_offsets.byte_of(-1) == -1
    assert read("").ordinal_of(Node("Feature")) == -1


def test_a_document_indexes_its_characters_once_for_all_diagnostics():
    document = read(LONG)
    assert [locate(document, start).offset for start in (300, 301, 557)] == [300, 302, 560]
    assert document.byte_offsets is document.byte_offsets
