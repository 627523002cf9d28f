"""Places of elements are converted to lines and columns, counted in characters."""

import pytest

from sysmlc.diagnostics import Place
from sysmlc.diagnostics.locations import Location, find_positions, find_start_tags, locate
from sysmlc.sources import Source
from sysmlc.sources.xml import make_parser, parse


def find_locations(text, *places, encoding="utf-8"):
    source = Source("f", text.encode(encoding))
    locations = locate([source], places)
    return [locations.get(place) for place in places]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "windows-1252"])
def test_columns_count_characters_in_every_encoding(encoding):
    declaration = "utf-8" if encoding.startswith("utf-8") else encoding
    text = f'<?xml version="1.0" encoding="{declaration}"?>\r\n<a>\n  <é/><b ä="ü"/> <c/>\n</a>'
    line = '  <é/><b ä="ü"/> <c/>'
    assert find_locations(text, Place("f", 3), Place("f", 0), encoding=encoding) == [
        Location(3, 18, line, end_line=3, end_column=22),
        Location(2, 1, "<a>", end_line=2, end_column=4),
    ]


def test_lines_after_65535_are_correct():
    text = "<a>" + "\n" * 70_000 + "  <b/></a>"
    assert find_locations(text, Place("f", 1)) == [
        Location(70_001, 3, "  <b/></a>", end_line=70_001, end_column=7)
    ]


def test_columns_in_files_of_one_line_are_correct():
    text = "<a>" + "<b/>" * 50_000 + "<c/></a>"
    (location,) = find_locations(text, Place("f", 50_001))
    assert (location.line, location.column) == (1, 4 + 4 * 50_000)


def test_places_in_text_are_byte_offsets():
    assert find_locations("part é;\r\nport p", Place("f", offset=15)) == [
        Location(2, 6, "port p", end_line=2, end_column=7)
    ]


def test_places_with_line_and_column_get_the_text_of_the_line():
    assert find_locations("one\ntwo", Place("f", line=2, column=3)) == [
        Location(2, 3, "two", end_line=2, end_column=4)
    ]


def test_unknown_ordinals_and_files_have_no_location():
    assert find_locations("<a/>", Place("f", 7), Place("g", 0), Place("f")) == [None, None, None]


def test_elements_before_a_syntax_error_are_located():
    assert find_locations("<a>\n<b></a>", Place("f", 1)) == [
        Location(2, 1, "<b></a>", end_line=2, end_column=4)
    ]


TEXTS_WITH_HIDDEN_TAGS = [
    "<a><b x='/>'/>\n<c>t</c><d\n/></a>",
    "<?xml version='1.0'?><!-- <b/> --><a><b/></a>",
    "<a><![CDATA[<b/>]]><b/></a>",
    "<a><?say <b/>?><b/></a>",
    "<?xml-stylesheet href='<b/>'?><a><b/></a>",
    "\ufeff<a><é/>\r<b/>\r\n<c/></a>",
    "<?xml version='1.0' encoding='windows-1252'?><a><é/><b/></a>",
]


@pytest.mark.parametrize("text", TEXTS_WITH_HIDDEN_TAGS)
def test_start_tags_are_found_where_a_parser_finds_them(text):
    encoding = "windows-1252" if "1252" in text else "utf-8"
    source = Source("f", text.encode(encoding))
    offsets, parser = [], make_parser()
    parser.StartElementHandler = lambda *_: offsets.append(parser.CurrentByteIndex)
    parse(source, parser)
    assert find_start_tags(source.data) in (offsets, None)
    places = [Place("f", ordinal) for ordinal in range(len(offsets))]
    locations = locate([source], places)
    assert {
        place.ordinal: (locations[place].line, locations[place].column) for place in places
    } == (find_positions([source], {"f": range(len(offsets))})["f"])


def test_the_fast_search_for_tags_needs_plain_utf_8():
    assert find_start_tags(b"<a><b/></a>") == [0, 3]
    assert find_start_tags("<?xml version='1.0' encoding='utf-16'?><a/>".encode("utf-16")) is None
    assert find_start_tags(b"<a><!-- <b/> --></a>") is None
    assert find_start_tags(b"<?xml version='1.0'") is None


def test_unknown_ordinals_and_files_have_no_position():
    source = Source("f", b"<a>\n<b/></a>")
    assert find_positions([source], {"f": [1, 2, -1, 1], "g": [0]}) == {"f": {1: (2, 1)}}


def test_the_excerpt_of_a_long_line_is_the_part_around_the_column():
    """Otherwise a file of one line with thousands of diagnostics would be copied as often."""
    text = "<a>" + "<b/>" * 50_000 + "</a>"
    first, distant = find_locations(text, Place("f", 1), Place("f", 25_000))
    assert (first.shift, first.text) == (0, text[:400])
    index = distant.column - 1 - distant.shift
    assert (len(distant.text), distant.text[index : index + 4]) == (400, "<b/>")


@pytest.mark.parametrize("name", ["base64", "idna", "rot13", "klingon", "unicode_escape"])
def test_an_unknown_encoding_does_not_prevent_locations(name):
    text = f'<?xml version="1.0" encoding="{name}"?>\n<a/>'
    assert find_locations(text, Place("f", offset=len(text) - 4)) == [
        Location(2, 1, "<a/>", end_line=2, end_column=5)
    ]
