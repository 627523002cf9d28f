"""XPaths of places: lxml finds exactly the element that they are about."""

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


def paths(data, *places):
    source = Source("f", data if isinstance(data, bytes) else data.encode())
    locations = locate([source], places, with_xpath=True)
    return [locations[place].xpath for place in places]


def list_prefixes(tree):
    """The meaning that each prefix has first."""
    namespaces = {}
    for element in tree.iter(etree.Element):
        for prefix, uri in element.nsmap.items():
            namespaces.setdefault(prefix, uri)
    return {prefix: uri for prefix, uri in namespaces.items() if prefix}


def check(data, ordinals=None):
    """Every XPath leads lxml to the element of that number, and to no other."""
    tree = etree.fromstring(data, etree.XMLParser(**_SAFE))
    every = list(tree.iter(etree.Element))
    numbers = range(len(every)) if ordinals is None else ordinals(len(every))
    places = [Place("f", ordinal=number) for number in numbers]
    namespaces = list_prefixes(tree)
    for place, path in zip(places, paths(data, *places), strict=True):
        assert tree.xpath(path, namespaces=namespaces) == [every[place.ordinal]], path


def test_a_path_has_the_prefixes_of_the_file_and_positions_among_equal_names():
    text = (
        '<xmi:XMI xmlns:xmi="x" xmlns:uml="u"><uml:Model><packagedElement/><ownedComment/>'
        "<packagedElement><ownedAttribute/></packagedElement></uml:Model></xmi:XMI>"
    )
    assert paths(text, *(Place("f", ordinal) for ordinal in range(6))) == [
        "/xmi:XMI",
        "/xmi:XMI/uml:Model[1]",
        "/xmi:XMI/uml:Model[1]/packagedElement[1]",
        "/xmi:XMI/uml:Model[1]/ownedComment[1]",
        "/xmi:XMI/uml:Model[1]/packagedElement[2]",
        "/xmi:XMI/uml:Model[1]/packagedElement[2]/ownedAttribute[1]",
    ]
    check(text.encode())


def test_a_default_namespace_is_named_in_full():
    (path,) = paths('<a xmlns="u"><b/><b/></a>', Place("f", 2))
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
def test_names_that_are_hard_to_tell_apart(text):
    check(text.encode())


_NAMES = st.sampled_from(["a", "b", "p:a", "p:b", "q:a"])
_SCOPES = st.dictionaries(st.sampled_from(["p", "q", ""]), st.sampled_from(["u", "v"]))
_TREES = st.recursive(
    st.tuples(_NAMES, _SCOPES, st.just([])),
    lambda inner: st.tuples(_NAMES, _SCOPES, st.lists(inner, max_size=4)),
    max_leaves=25,
)


def written(tree):
    name, scope, children = tree
    spaces = "".join(f' xmlns{":" if p else ""}{p}="{uri}"' for p, uri in scope.items())
    return f"<{name}{spaces}>{''.join(map(written, children))}</{name}>"


@given(_TREES)
@settings(max_examples=examples(200), deadline=None)
def test_any_document(tree):
    check(f'<root xmlns:p="u" xmlns:q="v">{written(tree)}</root>'.encode())


@pytest.mark.corpus
def test_real_models(corpus):
    draw = random.Random(3)
    files = sorted(p for p in (corpus / "xmi").rglob("*") if p.suffix in _MODELS)
    assert len(files) > 40
    for path in files:
        for source in load(path, path.name):
            check(source.data, lambda count: draw.sample(range(count), min(count, 12)))


_MODELS = {".uml", ".xml", ".xmi", ".mdxml", ".mdzip", ".ecore"}


# -- places that are no start tag --------------------------------------------------------------


def test_a_fault_has_the_path_of_the_element_that_is_open_there():
    text = "<a><b/> <b>\n  <c></d>\n</b></a>"
    assert paths(text, Place("f", offset=text.index("</d>"))) == ["/a/b[2]/c[1]"]
    inside, after = Place("f", offset=5), Place("f", offset=7)
    assert paths(text, inside, after) == ["/a/b[1]", "/a"]
    assert paths("<a><b>", Place("f", offset=6)) == ["/a/b[1]"]
    assert paths("<a></a><b/>", Place("f", offset=7)) == ["/"]


def test_text_has_no_path():
    assert paths("port p : Pallet", Place("f", offset=5)) == [""]


# -- lines and columns at the edges ------------------------------------------------------------


def where(data, *places):
    locations = locate([Source("f", data)], places, with_xpath=True)
    return [(locations[p].line, locations[p].column, locations[p].xpath) for p in places]


_ENCODINGS = ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "windows-1252", "ascii")


@pytest.mark.parametrize("encoding", _ENCODINGS)
@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_lines_and_columns_in_every_encoding_and_with_every_line_end(encoding, newline):
    sign, wide = ("e", "e") if encoding == "ascii" else ("é", "é")
    if encoding.startswith("utf"):
        wide = "𝄞"
    names = {"utf-8-sig": "utf-8", "utf-16-le": "utf-16", "utf-16-be": "utf-16"}
    mark = "\ufeff" if encoding in ("utf-16-le", "utf-16-be") else ""
    lines = [
        f'<?xml version="1.0" encoding="{names.get(encoding, encoding)}"?>',
        "<a>",
        f'  <b n="{sign}{wide}"/><c',
        f'     n="{wide}"',
        f'     m="{wide}"/> <d/>',
        "</a>",
    ]
    data = (mark + newline.join(lines)).encode(encoding)
    assert where(data, *(Place("f", ordinal) for ordinal in range(4))) == [
        (2, 1, "/a"),
        (3, 3, "/a/b[1]"),
        (3, 14, "/a/c[1]"),
        (5, 14, "/a/d[1]"),
    ]


def test_an_element_past_line_65535_and_one_in_a_file_of_one_line():
    tall = b"<a>" + b"\n<b/>" * 70_000 + b"</a>"
    assert where(tall, Place("f", 70_000)) == [(70_001, 1, "/a/b[70000]")]
    wide = b"<a>" + b"<b/>" * 70_000 + b"</a>"
    assert where(wide, Place("f", 70_000)) == [(1, 4 + 4 * 69_999, "/a/b[70000]")]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "windows-1252"])
def test_a_fault_is_counted_in_characters(encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?>\n<a>\n<b n="ééé"/></c>'
    data = text.encode(encoding)
    source = Source("f", data)
    with pytest.raises(SourceError) as problem:
        parse(source, make_parser())
    line = text.splitlines()[2]
    locations = where(data, Place("f", offset=problem.value.offset))
    assert locations == [(3, line.index("c>") + 1, "/a")]


def test_an_entry_of_an_archive(tmp_path):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("com.nomagic.magicdraw.uml_model.model", "<a>\n <é/></a>")
    (tmp_path / "p.mdzip").write_bytes(packed.getvalue())
    sources = load(tmp_path / "p.mdzip", "p.mdzip")
    place = Place(sources[0].name, 1)
    location = locate(sources, [place], with_xpath=True)[place]
    assert (place.file, location.line, location.column, location.xpath) == (
        "p.mdzip!com.nomagic.magicdraw.uml_model.model",
        2,
        2,
        "/a/é[1]",
    )
