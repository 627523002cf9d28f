"""Several real files form one unit, whatever their order, dialect and archive."""

import re
from collections import Counter

import pytest
from lxml import etree
from reading_corpus import lower

from sysmlc.driver import Request, compile_model
from sysmlc.ir import Edge, Kind
from sysmlc.ir.text import print_text
from sysmlc.passes.resolve.libraries import find_primitive, is_standard, load_libraries
from sysmlc.sources import load

pytestmark = pytest.mark.corpus

ARROWHEAD = (
    "papyrus/Arrowhead-5.0.uml",
    "papyrus/ArrowheadProfile_v5.0.profile.uml",
    "papyrus/SmartCityDSL-2.uml",
)
ARCHIVES = (
    "magicdraw/Tank_control_2.mdzip",
    "magicdraw/Smart_street_light_2.mdzip",
    "magicdraw/App_test_JD_v2.mdzip",
)


def compile_unit(corpus, *names):
    return compile_model(Request(tuple(corpus / "xmi" / name for name in names)))


def list_missing_files(compilation):
    return [
        diagnostic.message.split("'")[1]
        for diagnostic in compilation.diagnostics
        if diagnostic.rule.code == "SM152"
    ]


def test_a_model_finds_its_library_and_profile(corpus):
    """All hrefs into the other two files, as counted by lxml, name elements of these files."""
    compilation = compile_unit(corpus, *ARROWHEAD)
    missing = " ".join(list_missing_files(compilation))
    assert "Arrowhead-5.0" not in missing
    assert "Profile_v5" not in missing
    tree = etree.parse(corpus / "xmi" / ARROWHEAD[2])
    hrefs = [e.get("href") for e in tree.iter(etree.Element) if e.get("href")]
    ids = {h.rpartition("#")[2] for h in hrefs if "Arrowhead-5.0.uml#" in h}
    assert len(ids) == 24
    assert {compilation.graph[id].source for id in ids} == {"Arrowhead-5.0.uml"}
    applications = [e for e in compilation.graph.of_kind(Kind.APPLICATION) if e.name == "SysD"]
    assert len(applications) > 20
    assert {e.attrs["lineage"] for e in applications} == {("SysD", "Block")}


def test_files_in_two_dialects_form_one_unit(corpus):
    """MagicDraw's tests of fUML call behaviours of OMG's library as often as lxml counts."""
    compilation = compile_unit(corpus, "magicdraw/fUML-Tests.mdxml", "omg/fUML_Library.xmi")
    assert list_missing_files(compilation) == []
    assert "SM150" not in {diagnostic.rule.code for diagnostic in compilation.diagnostics}
    calls = Counter(
        target
        for _, source, target in compilation.graph.edges(Edge.CALLS)
        if compilation.graph[source].source == "magicdraw/fUML-Tests.mdxml"
        and compilation.graph[target].source == "omg/fUML_Library.xmi"
    )
    tree = etree.parse(corpus / "xmi/magicdraw/fUML-Tests.mdxml")
    calls_in_file = Counter(
        e.get("href").rpartition("#")[2]
        for e in tree.iter("behavior")
        if "fUML_Library.xmi#" in (e.get("href") or "")
    )
    assert calls == calls_in_file
    assert calls.total() > 50


def test_archives_that_share_libraries_form_one_unit_in_any_order(corpus):
    texts = set()
    for names in (ARCHIVES, ARCHIVES[::-1]):
        sources = [s for name in names for s in load(corpus / "xmi" / name, name)]
        graph, sink = lower(sources)
        assert not list(sink)
        texts.add(print_text(graph))
    assert len(texts) == 1


def test_nearly_all_references_to_standard_libraries_have_an_external_stub(corpus):
    """The hrefs are found in the text of every XML file, independently of any reader."""
    counts = Counter()
    for path in sorted((corpus / "xmi").glob("*/*")):
        if path.suffix in (".uml", ".xmi", ".xml", ".mdxml"):
            for href in re.findall(rb'\shref\s*=\s*["\']([^"\'#]+#[^"\']+)', path.read_bytes()):
                counts[classify_href(href.decode("utf-8", "replace"))] += 1
    assert counts["known"] > 5_000
    assert counts["new"] <= 120


def classify_href(href):
    file, _, fragment = href.partition("#")
    if load_libraries().find(file, fragment, "", ()) or find_primitive(href, "", Kind.DATA_TYPE):
        return "known"
    return "new" if is_standard(file) else "other"


@pytest.mark.parametrize(
    "name",
    [
        "profile/papyrus-SysML-1.6.profile.uml",
        "md-eclipse-export/SysML.profile.uml",
        "omg/SysML-1.7-ptc-24-01-02.xmi",
    ],
)
def test_external_stubs_of_sysml_have_the_generals_of_the_profiles(corpus, name):
    """Stereotypes of three dialects are found by their own ids, with their general stereotypes."""
    graph = compile_unit(corpus, name).graph
    stereotypes = [
        e
        for e in graph.of_kind(Kind.STEREOTYPE)
        if e.source and "Diagrams" not in graph.qualified_name(e) and not e.name.startswith("Magic")
    ]
    assert len(stereotypes) > 50
    for stereotype in stereotypes:
        stub = load_libraries().find(
            "pathmap://SysML16_PROFILES/SysML.profile.uml", stereotype.id, "", ()
        )
        assert stub is not None, stereotype.id
        assert stub.kind is Kind.STEREOTYPE
        generals = {general.name for general in graph.targets(stereotype, Edge.SPECIALIZES)}
        stub_generals = {general.rpartition("::")[2] for general in stub.generals}
        assert stub_generals >= generals - {
            "MagicDrawProfile_InvisibleStereotype",
            "InvisibleStereotype",
        }, stereotype.name
