"""Real models of every tool: read without a traceback, every element counted, numbers right."""

import re
import zipfile
from collections import Counter

import pytest
from lxml import etree

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph, Kind
from sysmlc.ir.verify import verify
from sysmlc.sources import load

pytestmark = pytest.mark.corpus

FOLDERS = ("papyrus", "magicdraw", "md-eclipse-export", "omg", "profile", "ea")


def read(corpus, *names):
    sources = [s for name in names for s in load(corpus / "xmi" / name, name)]
    graph, sink, coverage = Graph(), Sink(), Coverage()
    assert all(FRONTEND.detect(source) == 1.0 for source in sources)
    FRONTEND.read(sources, graph, sink, coverage)
    assert verify(graph) == []
    return graph, sink, coverage, sources


def trees(sources):
    parser = etree.XMLParser(huge_tree=True, resolve_entities=False, no_network=True)
    return [etree.fromstring(source.data, parser) for source in sources]


def elements(tree):
    return [element for element in tree.iter() if isinstance(element.tag, str)]


def typed(sources, name):
    """Elements whose ``xmi:type`` is ``uml:<name>`` and that are not references."""
    return [
        element
        for tree in trees(sources)
        for element in elements(tree)
        if "href" not in element.attrib
        and any(k.endswith("}type") and v == f"uml:{name}" for k, v in element.attrib.items())
    ]


def names(folder):
    found = sorted(path for path in folder.iterdir() if path.suffix != ".ecore")
    assert found
    return found


@pytest.mark.parametrize("folder", FOLDERS)
def test_every_file_reads_and_every_element_has_one_verdict(corpus, folder):
    for path in names(corpus / "xmi" / folder):
        _, sink, coverage, sources = read(corpus, f"{folder}/{path.name}")
        counted = {file["file"]: file["elements"] for file in coverage.as_json()["files"]}
        expected = {s.name: len(elements(t)) for s, t in zip(sources, trees(sources), strict=True)}
        assert counted == expected
        assert not sink.has_errors(), [str(finding.message) for finding in sink]


@pytest.mark.parametrize("folder", FOLDERS)
def test_no_local_reference_is_left_unresolved(corpus, folder):
    for path in names(corpus / "xmi" / folder):
        graph, *_ = read(corpus, f"{folder}/{path.name}")
        lost = [r for r in graph.pending if r.target not in graph and "#" not in r.target]
        assert lost == [], path.name


def test_arrowhead_has_all_ports_connectors_and_classes(corpus):
    graph, _, _, sources = read(corpus, "papyrus/Arrowhead-5.0.uml")
    for kind, name in (
        (Kind.PORT, "Port"),
        (Kind.CONNECTOR, "Connector"),
        (Kind.CLASS, "Class"),
        (Kind.ACTIVITY, "Activity"),
    ):
        ours = [e for e in graph.of_kind(kind) if not (e.subkind or e.attrs.get("library"))]
        assert len(ours) == len(typed(sources, name)), name
    assert len(graph.of_kind(Kind.PORT)) == 327
    conjugated = [e for e in typed(sources, "Port") if e.get("isConjugated") == "true"]
    assert sum(1 for p in graph.of_kind(Kind.PORT) if "conjugated" in p.attrs) == len(conjugated)


def test_arrowhead_stereotypes_are_tied_to_their_profile(corpus):
    graph, *_ = read(
        corpus, "papyrus/Arrowhead-5.0.uml", "papyrus/ArrowheadProfile_v5.0.profile.uml"
    )
    applications = [
        e
        for e in graph.of_kind(Kind.APPLICATION)
        if e.attrs["namespace"] == "http://www.eclipse.org/papyrus/arrowhead"
    ]
    defined = {stereotype.name for stereotype in graph.of_kind(Kind.STEREOTYPE)}
    tied = [e for e in applications if graph.target(e, "instance-of") is not None]
    assert tied == [e for e in applications if e.name in defined]
    assert len(tied) > 480


def test_tank_control_has_all_ports_connectors_and_classes(corpus):
    graph, _, _, sources = read(corpus, "magicdraw/Tank_control_2.mdzip")
    sources = [source for source in sources if not source.name.endswith("snapshot")]
    ours = [e for e in graph if not e.attrs.get("library")]
    for kind, name in ((Kind.PORT, "Port"), (Kind.CONNECTOR, "Connector"), (Kind.CLASS, "Class")):
        found = [e for e in ours if e.kind is kind and not e.subkind]
        assert len(found) == len(typed(sources, name)), name
    assert len([e for e in ours if e.kind is Kind.CONNECTOR]) == 38
    ends = {end.id for end in graph.of_kind(Kind.CONNECTOR_END)}
    paths = Counter(r.source for r in graph.pending if r.edge == "path")
    nested = [
        element
        for tree in trees(sources)
        for element in tree
        if etree.QName(element).localname == "NestedConnectorEnd"
    ]
    assert {e.get("base_ConnectorEnd") for e in nested} <= ends
    for element in nested:
        length = len(element.get("propertyPath", "").split()) + len(list(element))
        assert paths[element.get("base_ConnectorEnd")] >= length


def test_the_two_dialects_of_ballot_definition_agree(corpus):
    """The same model with and without MagicDraw's extensions, and as Eclipse exports it."""
    with_drawings, *_ = read(corpus, "magicdraw/BallotDefinition.xml")
    without, *_ = read(corpus, "magicdraw/BallotDefinition-noext.xml")
    assert shape(with_drawings) == shape(without)
    eclipse, *_ = read(corpus, "md-eclipse-export/BallotDefinition.uml")
    for kind in (Kind.CLASS, Kind.ENUMERATION, Kind.ENUMERATION_LITERAL, Kind.ASSOCIATION):
        missing = graph_names(without, kind) - graph_names(eclipse, kind)
        assert missing == Counter(), kind


def shape(graph):
    """What the model itself holds; snapshots of libraries are in MagicDraw's extensions."""
    return [(e.id, e.kind, e.name, e.owner, e.attrs) for e in graph if not e.attrs.get("library")]


def graph_names(graph, kind):
    return Counter(element.name for element in graph.of_kind(kind))


def test_activities_of_both_dialects_of_fuml_tests_agree(corpus):
    """The activities that both files have own as many nodes, pins and flows in both."""
    magicdraw, *_ = read(corpus, "magicdraw/fUML-Tests.mdxml")
    eclipse, *_ = read(corpus, "papyrus/fUML-Tests.uml")
    ours, theirs = activities(magicdraw), activities(eclipse)
    common = ours.keys() & theirs.keys()
    assert len(common) >= 30
    different = {name for name in common if ours[name] != theirs[name]}
    assert len(different) <= len(common) // 5, sorted(different)


def activities(graph):
    return {
        graph.qualified_name(e).partition("::")[2]: Counter(c.kind for c in graph.subtree(e))
        for e in graph.of_kind(Kind.ACTIVITY)
    }


RESOLVED = {
    "Tank_control_2": (1183, 524, 649),
    "Smart_street_light_2": (1334, 918, 395),
    "Wired_Camera_Example": (136, 127, 6),
    "App_test_JD_v2": (274, 129, 123),
}
"""Hrefs of each archive: all, those into its models, those into its snapshots."""


@pytest.mark.parametrize("name", RESOLVED)
def test_what_an_archive_refers_to_is_found_in_it(corpus, name):
    path = corpus / f"xmi/magicdraw/{name}.mdzip"
    models, snapshots, hrefs = {}, {}, []
    with zipfile.ZipFile(path) as opened:
        for entry in opened.namelist():
            if entry.endswith("snapshot"):
                snapshots |= {e.get("ID"): e for e in etree.fromstring(opened.read(entry)).iter()}
            elif re.fullmatch(r"com\.nomagic\.magicdraw\.uml_model\.(shared_)?model", entry):
                tree = etree.fromstring(opened.read(entry))
                models |= {attribute(e, "id"): e for e in elements(tree)}
                hrefs += [e.get("href") for e in elements(tree) if e.get("href")]
    inside = [href.rpartition("#")[2] for href in hrefs]
    into_models = [id for id in inside if id in models]
    into_snapshots = [id for id in inside if id not in models and id in snapshots]
    assert (len(hrefs), len(into_models), len(into_snapshots)) == RESOLVED[name]
    graph, *_ = read(corpus, f"magicdraw/{name}.mdzip")
    folded = {attribute(models[id], "type") for id in into_models if id not in graph}
    assert folded <= {"uml:Generalization", "uml:Diagram"}
    primitives = {id for id in into_snapshots if id not in graph}
    assert {snapshots[id].get("name") for id in primitives} <= {"Real"}
    for id in set(into_snapshots) - primitives:
        above = snapshots[id].getparent()
        assert graph[id].attrs["library"]
        assert graph[id].name == snapshots[id].get("name", "")
        if above.get("ID") and etree.QName(above).localname != "Model":
            assert graph[id].owner == above.get("ID")


def attribute(element, name):
    return next((v for k, v in element.attrib.items() if k.endswith("}" + name)), None)
