"""Places become lines and columns, in characters, only when they are shown."""

import pytest

from sysmlc.diagnostics import Place
from sysmlc.diagnostics.locations import Location, find_positions, find_start_tags, locate
from sysmlc.sources import Source
from sysmlc.sources.xml import make_parser, parse


def where(text, *places, encoding="utf-8"):
    source = Source("f", text.encode(encoding))
    locations = locate([source], places)
    return [locations.get(place) for place in places]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "windows-1252"])
def test_columns_count_characters_in_every_encoding(encoding):
    declared = "utf-8" if encoding.startswith("utf-8") else encoding
    text = f'<?xml version="1.0" encoding="{declared}"?>\r\n<a>\n  <é/><b ä="ü"/> <c/>\n</a>'
    line = '  <é/><b ä="ü"/> <c/>'
    assert where(text, Place("f", 3), Place("f", 0), encoding=encoding) == [
        Location(3, 18, line),
        Location(2, 1, "<a>"),
    ]


def test_lines_are_right_past_65535():
    text = "<a>" + "\n" * 70_000 + "  <b/></a>"
    assert where(text, Place("f", 1)) == [Location(70_001, 3, "  <b/></a>")]


def test_columns_are_right_in_files_of_one_line():
    text = "<a>" + "<b/>" * 50_000 + "<c/></a>"
    (location,) = where(text, Place("f", 50_001))
    assert (location.line, location.column) == (1, 4 + 4 * 50_000)


def test_text_places_are_offsets_in_bytes():
    assert where("part é;\r\nport p", Place("f", offset=15)) == [Location(2, 6, "port p")]


def test_places_that_are_located_already_get_their_line():
    assert where("one\ntwo", Place("f", line=2, column=3)) == [Location(2, 3, "two")]


def test_unknown_ordinals_and_files_have_no_location():
    assert where("<a/>", Place("f", 7), Place("g", 0), Place("f")) == [None, None, None]


def test_elements_before_damage_are_still_found():
    assert where("<a>\n<b></a>", Place("f", 1)) == [Location(2, 1, "<b></a>")]


HIDDEN = [
    "<a><b x='/>'/>\n<c>t</c><d\n/></a>",
    "<?xml version='1.0'?><!-- <b/> --><a><b/></a>",
    "<a><![CDATA[<b/>]]><b/></a>",
    "<a><?say <b/>?><b/></a>",
    "<?xml-stylesheet href='<b/>'?><a><b/></a>",
    "\ufeff<a><é/>\r<b/>\r\n<c/></a>",
    "<?xml version='1.0' encoding='windows-1252'?><a><é/><b/></a>",
]


@pytest.mark.parametrize("text", HIDDEN)
def test_start_tags_are_where_a_parser_sees_them(text):
    encoding = "windows-1252" if "1252" in text else "utf-8"
    source = Source("f", text.encode(encoding))
    offsets, parser = [], make_parser()
    parser.StartElementHandler = lambda *_: offsets.append(parser.CurrentByteIndex)
    parse(source, parser)
    assert find_start_tags(source.data) in (offsets, None)
    places = [Place("f", ordinal) for ordinal in range(len(offsets))]
    located = locate([source], places)
    assert {p.ordinal: (located[p].line, located[p].column) for p in places} == (
        find_positions([source], {"f": range(len(offsets))})["f"]
    )


def test_only_plain_text_is_searched_for_tags():
    assert find_start_tags(b"<a><b/></a>") == [0, 3]
    assert find_start_tags("<?xml version='1.0' encoding='utf-16'?><a/>".encode("utf-16")) is None
    assert find_start_tags(b"<a><!-- <b/> --></a>") is None
    assert find_start_tags(b"<?xml version='1.0'") is None


def test_unknown_ordinals_and_files_have_no_position():
    source = Source("f", b"<a>\n<b/></a>")
    assert find_positions([source], {"f": [1, 2, -1, 1], "g": [0]}) == {"f": {1: (2, 1)}}


def test_the_excerpt_of_a_long_line_is_the_part_around_the_column():
    """A file of one line with thousands of findings held that line thousands of times."""
    text = "<a>" + "<b/>" * 50_000 + "</a>"
    first, far = where(text, Place("f", 1), Place("f", 25_000))
    assert (first.shift, first.text) == (0, text[:400])
    index = far.column - 1 - far.shift
    assert (len(far.text), far.text[index : index + 4]) == (400, "<b/>")


@pytest.mark.parametrize("name", ["base64", "idna", "rot13", "klingon", "unicode_escape"])
def test_an_encoding_that_is_none_of_texts_does_not_stop_us(name):
    text = f'<?xml version="1.0" encoding="{name}"?>\n<a/>'
    assert where(text, Place("f", offset=len(text) - 4)) == [Location(2, 1, "<a/>")]
