"""Real models of several files: one unit, whatever the order, the dialect and the archive."""

import re
from collections import Counter

import pytest
from lxml import etree

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.driver import Request, compile_model
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Edge, Graph, Kind
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


def unit(corpus, *names):
    return compile_model(Request(tuple(corpus / "xmi" / name for name in names)))


def missing(compilation):
    return [f.message.split("'")[1] for f in compilation.diagnostics if f.rule.code == "SM152"]


def test_a_use_case_finds_its_library_and_profile(corpus):
    """Hrefs into the other two files, counted by lxml: all lead to elements with a place."""
    made = unit(corpus, *ARROWHEAD)
    assert not [file for file in missing(made) if "Arrowhead-5.0" in file or "Profile_v5" in file]
    tree = etree.parse(corpus / "xmi" / ARROWHEAD[2])
    hrefs = [e.get("href") for e in tree.iter(etree.Element) if e.get("href")]
    ids = {h.rpartition("#")[2] for h in hrefs if "Arrowhead-5.0.uml#" in h}
    assert len(ids) == 24
    assert {made.graph[id].source for id in ids} == {"Arrowhead-5.0.uml"}
    applied = [e for e in made.graph.of_kind(Kind.APPLICATION) if e.name == "SysD"]
    assert len(applied) > 20
    assert {e.attrs["lineage"] for e in applied} == {("SysD", "Block")}


def test_two_dialects_are_one_unit(corpus):
    """MagicDraw's tests of fUML call behaviours of OMG's library, as an independent count says."""
    made = unit(corpus, "magicdraw/fUML-Tests.mdxml", "omg/fUML_Library.xmi")
    assert missing(made) == []
    assert "SM150" not in {found.rule.code for found in made.diagnostics}
    calls = Counter(
        target
        for _, source, target in made.graph.edges(Edge.CALLS)
        if made.graph[source].source == "magicdraw/fUML-Tests.mdxml"
        and made.graph[target].source == "omg/fUML_Library.xmi"
    )
    tree = etree.parse(corpus / "xmi/magicdraw/fUML-Tests.mdxml")
    written = Counter(
        e.get("href").rpartition("#")[2]
        for e in tree.iter("behavior")
        if "fUML_Library.xmi#" in (e.get("href") or "")
    )
    assert calls == written
    assert calls.total() > 50


def test_archives_that_share_libraries_are_one_unit_in_any_order(corpus):
    texts = set()
    for names in (ARCHIVES, ARCHIVES[::-1]):
        sources = [s for name in names for s in load(corpus / "xmi" / name, name)]
        graph, sink = Graph(), Sink()
        FRONTEND.read(sources, graph, sink, Coverage())
        assert not list(sink)
        texts.add(print_text(graph))
    assert len(texts) == 1


def test_nearly_all_references_to_standard_libraries_have_a_stand_in(corpus):
    """Independent of any reader: every href in the text of every XML file."""
    counts = Counter()
    for path in sorted((corpus / "xmi").glob("*/*")):
        if path.suffix in (".uml", ".xmi", ".xml", ".mdxml"):
            for href in re.findall(rb'\shref\s*=\s*["\']([^"\'#]+#[^"\']+)', path.read_bytes()):
                counts[verdict(href.decode("utf-8", "replace"))] += 1
    assert counts["known"] > 5_000
    assert counts["new"] <= 120


def verdict(href):
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
def test_stand_ins_say_of_sysml_what_its_profiles_say(corpus, name):
    """Stereotypes of three dialects: found by their own ids, with the generals that they have."""
    graph = unit(corpus, name).graph
    stereotypes = [
        e
        for e in graph.of_kind(Kind.STEREOTYPE)
        if e.source and "Diagrams" not in graph.qualified_name(e) and not e.name.startswith("Magic")
    ]
    assert len(stereotypes) > 50
    for stereotype in stereotypes:
        found = load_libraries().find(
            "pathmap://SysML16_PROFILES/SysML.profile.uml", stereotype.id, "", ()
        )
        assert found is not None, stereotype.id
        assert found.kind is Kind.STEREOTYPE
        told = {up.name for up in graph.targets(stereotype, Edge.SPECIALIZES)}
        known = {up.rpartition("::")[2] for up in found.generals}
        assert known >= told - {"MagicDrawProfile_InvisibleStereotype", "InvisibleStereotype"}, (
            stereotype.name
        )
