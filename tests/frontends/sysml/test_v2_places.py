"""Bytes of characters, and back: what a place in a file is in the text of its document."""

from codecs import BOM_UTF8

import pytest

from sysmlc.frontends.sysml.places import Home
from sysmlc.language.tree import Document, Node
from sysmlc.sources import Source

LONG = f"{'a' * 300}\u00e9{'b' * 255}\u2013\U0001f600{'c' * 300}"
"""Longer than the pieces that are looked through, with characters of two to four bytes."""


def home(text, before=b""):
    data = before + text.encode()
    return Home(Document("m.sysml", "sysml", Node("Namespace"), text, Source("m.sysml", data)))


@pytest.mark.parametrize("before", [b"", BOM_UTF8])
@pytest.mark.parametrize("text", ["", "part a;", "\u00e9\u00e9", LONG])
def test_bytes_of_characters_are_those_of_the_file(text, before):
    place = home(text, before if text else b"")
    starts = [len(before if text else b"") + len(text[:at].encode()) for at in range(len(text))]
    assert [place.byte(at) for at in range(len(text))] == starts
    assert [place.ordinal(Node("Feature", start=at)) for at in range(len(text))] == starts
    assert [place.character(at) for at in starts] == list(range(len(text)))


def test_each_byte_belongs_to_a_character():
    assert [home("a\u2013b").character(at) for at in range(5)] == [0, 1, 1, 1, 2]
    assert home("ab", BOM_UTF8).character(1) == -1


def test_a_node_without_a_place_stays_without():
    assert home(LONG).byte(-1) == home("").ordinal(Node("Feature")) == -1
