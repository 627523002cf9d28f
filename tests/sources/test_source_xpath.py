"""XPaths of places: each selects exactly the element at its place."""

import io
import random
import zipfile

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

from long_runs import examples
from sysmlc.diagnostics import Place
from sysmlc.diagnostics.locations import locate
from sysmlc.sources import Source, SourceError, load
from sysmlc.sources.xml import make_parser, parse

_SAFE = {"huge_tree": True, "resolve_entities": False, "no_network": True}


def find_xpaths(data, *places):
    source = Source("f", data if isinstance(data, bytes) else data.encode())
    locations = locate([source], places, with_xpath=True)
    return [locations[place].xpath for place in places]


def list_prefixes(tree):
    """Return the first namespace of each prefix."""
    namespaces = {}
    for element in tree.iter(etree.Element):
        for prefix, uri in element.nsmap.items():
            namespaces.setdefault(prefix, uri)
    return {prefix: uri for prefix, uri in namespaces.items() if prefix}


def check_xpaths(data, ordinals=None):
    """Assert that lxml selects the element of each ordinal by its XPath, and no other element."""
    tree = etree.fromstring(data, etree.XMLParser(**_SAFE))
    elements = list(tree.iter(etree.Element))
    numbers = range(len(elements)) if ordinals is None else ordinals(len(elements))
    places = [Place("f", ordinal=number) for number in numbers]
    namespaces = list_prefixes(tree)
    for place, path in zip(places, find_xpaths(data, *places), strict=True):
        assert tree.xpath(path, namespaces=namespaces) == [elements[place.ordinal]], path


def test_an_xpath_has_the_prefixes_of_the_file_and_positions_among_equal_names():
    text = (
        '<xmi:XMI xmlns:xmi="x" xmlns:uml="u"><uml:Model><packagedElement/><ownedComment/>'
        "<packagedElement><ownedAttribute/></packagedElement></uml:Model></xmi:XMI>"
    )
    assert find_xpaths(text, *(Place("f", ordinal) for ordinal in range(6))) == [
        "/xmi:XMI",
        "/xmi:XMI/uml:Model[1]",
        "/xmi:XMI/uml:Model[1]/packagedElement[1]",
        "/xmi:XMI/uml:Model[1]/ownedComment[1]",
        "/xmi:XMI/uml:Model[1]/packagedElement[2]",
        "/xmi:XMI/uml:Model[1]/packagedElement[2]/ownedAttribute[1]",
    ]
    check_xpaths(text.encode())


def test_a_default_namespace_is_written_in_full():
    (path,) = find_xpaths('<a xmlns="u"><b/><b/></a>', Place("f", 2))
    root = "*[local-name()='a' and namespace-uri()='u']"
    assert path == f"/{root}/*[local-name()='b' and namespace-uri()='u'][2]"


@pytest.mark.parametrize(
    "text",
    [
        '<p:a xmlns:p="1"><p:b xmlns:p="2"/><p:b/><p:b xmlns:p="2"><p:c/></p:b></p:a>',
        '<a><p:b xmlns:p="1"/><q:b xmlns:q="1"/><b/><b xmlns="1"/></a>',
        '<a xmlns="it\'s"><b/></a>',
        '<a><xml:b/><xml:b/><b xml:lang="en"/></a>',
        "<ä><ö/><ö><ü/></ö></ä>",
        "<a xmlns:p=\"1\"><p:b/><p:c xmlns:p='2'><p:b/></p:c><p:b/></a>",
        "<a><!-- b --><?b b?><b><![CDATA[<b/>]]></b><b/></a>",
    ],
)
def test_similar_names_are_distinguished(text):
    check_xpaths(text.encode())


_NAMES = st.sampled_from(["a", "b", "p:a", "p:b", "q:a"])
_SCOPES = st.dictionaries(st.sampled_from(["p", "q", ""]), st.sampled_from(["u", "v"]))
_TREES = st.recursive(
    st.tuples(_NAMES, _SCOPES, st.just([])),
    lambda inner: st.tuples(_NAMES, _SCOPES, st.lists(inner, max_size=4)),
    max_leaves=25,
)


def format_tree(tree):
    name, scope, children = tree
    spaces = "".join(
        f' xmlns{":" if prefix else ""}{prefix}="{uri}"' for prefix, uri in scope.items()
    )
    return f"<{name}{spaces}>{''.join(map(format_tree, children))}</{name}>"


@given(_TREES)
@settings(max_examples=examples(200), deadline=None)
def test_xpaths_of_any_document_select_their_elements(tree):
    check_xpaths(f'<root xmlns:p="u" xmlns:q="v">{format_tree(tree)}</root>'.encode())


@pytest.mark.corpus
def test_xpaths_of_real_models_select_their_elements(corpus):
    generator = random.Random(3)
    files = sorted(path for path in (corpus / "xmi").rglob("*") if path.suffix in _MODEL_SUFFIXES)
    assert len(files) > 40
    for path in files:
        for source in load(path, path.name):
            check_xpaths(source.data, lambda count: generator.sample(range(count), min(count, 12)))


_MODEL_SUFFIXES = {".uml", ".xml", ".xmi", ".mdxml", ".mdzip", ".ecore"}


# -- places other than start tags --------------------------------------------------------------


def test_a_syntax_error_has_the_xpath_of_the_open_element():
    text = "<a><b/> <b>\n  <c></d>\n</b></a>"
    assert find_xpaths(text, Place("f", offset=text.index("</d>"))) == ["/a/b[2]/c[1]"]
    inside, after = Place("f", offset=5), Place("f", offset=7)
    assert find_xpaths(text, inside, after) == ["/a/b[1]", "/a"]
    assert find_xpaths("<a><b>", Place("f", offset=6)) == ["/a/b[1]"]
    assert find_xpaths("<a></a><b/>", Place("f", offset=7)) == ["/"]


def test_a_place_in_text_has_no_xpath():
    assert find_xpaths("port p : Pallet", Place("f", offset=5)) == [""]


# -- lines and columns of XPaths ------------------------------------------------------------


def find_locations(data, *places):
    locations = locate([Source("f", data)], places, with_xpath=True)
    return [
        (locations[place].line, locations[place].column, locations[place].xpath) for place in places
    ]


_ENCODINGS = ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "windows-1252", "ascii")


@pytest.mark.parametrize("encoding", _ENCODINGS)
@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_lines_and_columns_are_correct_in_every_encoding_and_with_every_line_end(encoding, newline):
    letter, wide_letter = ("e", "e") if encoding == "ascii" else ("é", "é")
    if encoding.startswith("utf"):
        wide_letter = "𝄞"
    declared_names = {"utf-8-sig": "utf-8", "utf-16-le": "utf-16", "utf-16-be": "utf-16"}
    byte_order_mark = "\ufeff" if encoding in ("utf-16-le", "utf-16-be") else ""
    lines = [
        f'<?xml version="1.0" encoding="{declared_names.get(encoding, encoding)}"?>',
        "<a>",
        f'  <b n="{letter}{wide_letter}"/><c',
        f'     n="{wide_letter}"',
        f'     m="{wide_letter}"/> <d/>',
        "</a>",
    ]
    data = (byte_order_mark + newline.join(lines)).encode(encoding)
    assert find_locations(data, *(Place("f", ordinal) for ordinal in range(4))) == [
        (2, 1, "/a"),
        (3, 3, "/a/b[1]"),
        (3, 14, "/a/c[1]"),
        (5, 14, "/a/d[1]"),
    ]


def test_elements_after_line_65535_and_in_a_file_of_one_line_are_located():
    many_lines = b"<a>" + b"\n<b/>" * 70_000 + b"</a>"
    assert find_locations(many_lines, Place("f", 70_000)) == [(70_001, 1, "/a/b[70000]")]
    wide_letter = b"<a>" + b"<b/>" * 70_000 + b"</a>"
    assert find_locations(wide_letter, Place("f", 70_000)) == [(1, 4 + 4 * 69_999, "/a/b[70000]")]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "windows-1252"])
def test_the_column_of_a_syntax_error_is_counted_in_characters(encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?>\n<a>\n<b n="ééé"/></c>'
    data = text.encode(encoding)
    source = Source("f", data)
    with pytest.raises(SourceError) as raised:
        parse(source, make_parser())
    line = text.splitlines()[2]
    locations = find_locations(data, Place("f", offset=raised.value.offset))
    assert locations == [(3, line.index("c>") + 1, "/a")]


def test_a_place_in_an_archive_is_located_in_its_entry(tmp_path):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        archive.writestr("com.nomagic.magicdraw.uml_model.model", "<a>\n <é/></a>")
    (tmp_path / "p.mdzip").write_bytes(data.getvalue())
    sources = load(tmp_path / "p.mdzip", "p.mdzip")
    place = Place(sources[0].name, 1)
    location = locate(sources, [place], with_xpath=True)[place]
    assert (place.file, location.line, location.column, location.xpath) == (
        "p.mdzip!com.nomagic.magicdraw.uml_model.model",
        2,
        2,
        "/a/é[1]",
    )
