"""Real models of every tool are read completely: verdicts, elements and references."""

import re
import zipfile
from collections import Counter

import pytest
from lxml import etree
from reading_corpus import XMI_FOLDERS, find_typed, parse_data

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph, Kind
from sysmlc.ir.verify import verify
from sysmlc.sources import load

pytestmark = pytest.mark.corpus


def read_files(corpus, *names):
    sources = [s for name in names for s in load(corpus / "xmi" / name, name)]
    graph, sink, coverage = Graph(), Sink(), Coverage()
    assert all(FRONTEND.detect(source) == 1.0 for source in sources)
    FRONTEND.read(sources, graph, sink, coverage)
    assert verify(graph) == []
    return graph, sink, coverage, sources


def parse_sources(sources):
    return [parse_data(source.data) for source in sources]


def list_elements(tree):
    return [element for element in tree.iter() if isinstance(element.tag, str)]


def list_files(folder):
    paths = sorted(path for path in folder.iterdir() if path.suffix != ".ecore")
    assert paths
    return paths


@pytest.mark.parametrize("folder", XMI_FOLDERS)
def test_every_element_of_every_file_has_one_verdict(corpus, folder):
    for path in list_files(corpus / "xmi" / folder):
        _, sink, coverage, sources = read_files(corpus, f"{folder}/{path.name}")
        counts = {file["file"]: file["elements"] for file in coverage.as_json()["files"]}
        expected = {
            s.name: len(list_elements(t))
            for s, t in zip(sources, parse_sources(sources), strict=True)
        }
        assert counts == expected
        assert not sink.has_errors(), [str(finding.message) for finding in sink]


@pytest.mark.parametrize("folder", XMI_FOLDERS)
def test_every_local_reference_is_resolved(corpus, folder):
    for path in list_files(corpus / "xmi" / folder):
        graph, *_ = read_files(corpus, f"{folder}/{path.name}")
        unresolved = [
            reference
            for reference in graph.pending
            if reference.target not in graph and "#" not in reference.target
        ]
        assert unresolved == [], path.name


def test_arrowhead_has_all_ports_connectors_and_classes(corpus):
    graph, _, _, sources = read_files(corpus, "papyrus/Arrowhead-5.0.uml")
    for kind, name in (
        (Kind.PORT, "Port"),
        (Kind.CONNECTOR, "Connector"),
        (Kind.CLASS, "Class"),
        (Kind.ACTIVITY, "Activity"),
    ):
        elements_of_kind = [
            e for e in graph.of_kind(kind) if not (e.subkind or e.attrs.get("library"))
        ]
        assert len(elements_of_kind) == len(find_typed(parse_sources(sources), name)), name
    assert len(graph.of_kind(Kind.PORT)) == 327
    conjugated = [
        e for e in find_typed(parse_sources(sources), "Port") if e.get("isConjugated") == "true"
    ]
    assert sum(1 for p in graph.of_kind(Kind.PORT) if "conjugated" in p.attrs) == len(conjugated)


def test_arrowhead_stereotypes_are_connected_to_their_profile(corpus):
    graph, *_ = read_files(
        corpus, "papyrus/Arrowhead-5.0.uml", "papyrus/ArrowheadProfile_v5.0.profile.uml"
    )
    applications = [
        e
        for e in graph.of_kind(Kind.APPLICATION)
        if e.attrs["namespace"] == "http://www.eclipse.org/papyrus/arrowhead"
    ]
    stereotypes = {stereotype.name for stereotype in graph.of_kind(Kind.STEREOTYPE)}
    connected = [e for e in applications if graph.target(e, "instance-of") is not None]
    assert connected == [e for e in applications if e.name in stereotypes]
    assert len(connected) > 480


def test_tank_control_has_all_ports_connectors_and_classes(corpus):
    graph, _, _, sources = read_files(corpus, "magicdraw/Tank_control_2.mdzip")
    sources = [source for source in sources if not source.name.endswith("snapshot")]
    model_elements = [e for e in graph if not e.attrs.get("library")]
    for kind, name in ((Kind.PORT, "Port"), (Kind.CONNECTOR, "Connector"), (Kind.CLASS, "Class")):
        elements_of_kind = [e for e in model_elements if e.kind is kind and not e.subkind]
        assert len(elements_of_kind) == len(find_typed(parse_sources(sources), name)), name
    assert len([e for e in model_elements if e.kind is Kind.CONNECTOR]) == 38
    ends = {end.id for end in graph.of_kind(Kind.CONNECTOR_END)}
    paths = Counter(r.source for r in graph.pending if r.edge == "path")
    nested = [
        element
        for tree in parse_sources(sources)
        for element in tree
        if etree.QName(element).localname == "NestedConnectorEnd"
    ]
    assert {e.get("base_ConnectorEnd") for e in nested} <= ends
    for element in nested:
        length = len(element.get("propertyPath", "").split()) + len(list(element))
        assert paths[element.get("base_ConnectorEnd")] >= length


RESOLVED = {
    "Tank_control_2": (1183, 524, 649),
    "Smart_street_light_2": (1334, 918, 395),
    "Wired_Camera_Example": (136, 127, 6),
    "App_test_JD_v2": (274, 129, 123),
}
"""Hrefs of each archive: all, those into its models, those into its snapshots."""


@pytest.mark.parametrize("name", RESOLVED)
def test_references_within_an_archive_are_resolved(corpus, name):
    path = corpus / f"xmi/magicdraw/{name}.mdzip"
    models, snapshots, hrefs = {}, {}, []
    with zipfile.ZipFile(path) as archive:
        for entry in archive.namelist():
            if entry.endswith("snapshot"):
                snapshots |= {e.get("ID"): e for e in etree.fromstring(archive.read(entry)).iter()}
            elif re.fullmatch(r"com\.nomagic\.magicdraw\.uml_model\.(shared_)?model", entry):
                tree = etree.fromstring(archive.read(entry))
                models |= {find_attribute(e, "id"): e for e in list_elements(tree)}
                hrefs += [e.get("href") for e in list_elements(tree) if e.get("href")]
    fragments = [href.rpartition("#")[2] for href in hrefs]
    into_models = [id for id in fragments if id in models]
    into_snapshots = [id for id in fragments if id not in models and id in snapshots]
    assert (len(hrefs), len(into_models), len(into_snapshots)) == RESOLVED[name]
    graph, *_ = read_files(corpus, f"magicdraw/{name}.mdzip")
    missing_types = {find_attribute(models[id], "type") for id in into_models if id not in graph}
    assert missing_types <= {"uml:Generalization", "uml:Diagram"}
    primitives = {id for id in into_snapshots if id not in graph}
    assert {snapshots[id].get("name") for id in primitives} <= {"Real"}
    for id in set(into_snapshots) - primitives:
        owner = snapshots[id].getparent()
        assert graph[id].attrs["library"]
        assert graph[id].name == snapshots[id].get("name", "")
        if owner.get("ID") and etree.QName(owner).localname != "Model":
            assert graph[id].owner == owner.get("ID")


def find_attribute(element, name):
    return next((v for k, v in element.attrib.items() if k.endswith("}" + name)), None)
