"""Findings about names stand where the name stands, whatever the file is like."""

from resolving import library

from sysmlc.diagnostics import Place, Sink
from sysmlc.language.names import resolve
from sysmlc.language.text import parse
from sysmlc.language.tree import Document, Node, locate
from sysmlc.sources import Source


def stand_at(text, *, mark=b""):
    """What of the file begins where a name of it is said to lead nowhere."""
    data = mark + text.encode()
    sink, source = Sink({"SM207": None}), Source("plant.sysml", data)
    resolve([parse(text, "plant.sysml", "sysml", sink, source)], library(), sink)
    return [data[one.subject.place.offset :].decode() for one in sink]


def test_a_name_is_found_behind_a_byte_order_mark_and_wide_characters():
    assert stand_at("package 'Käse' { part cut : Knife; }") == ["Knife; }"]
    assert stand_at("package 'Käse' { part cut : Knife; }", mark=b"\xef\xbb\xbf") == ["Knife; }"]


def test_a_name_is_found_behind_names_with_quotes_in_them():
    robot = r"part def Robot { part 'robot\'s arm' : Robot; }"
    use = r"part robot : Robot; part tool = robot.'robot\'s arm'.tool;"
    assert stand_at(robot + use) == ["tool;"]


def test_what_stands_in_an_interchange_file_is_found_by_its_element():
    assert locate(Document("plant.sysmlx", "sysml", Node("Namespace")), 7) == Place(
        "plant.sysmlx", ordinal=7
    )
