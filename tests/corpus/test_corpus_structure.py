"""Conjugation, nested ends, requirements in real models, against a script with lxml alone."""

import zipfile
from pathlib import Path

import pytest
from lxml import etree

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.ir.query import flow_properties, opposite, type_of
from sysmlc.passes import pipeline
from sysmlc.sources.files import load

pytestmark = pytest.mark.corpus

FILES = {
    "papyrus/Arrowhead-5.0.uml": (127, 32, {}),
    "papyrus/CraneModel.uml": (8, 40, {1: 22}),
    "papyrus/RoboCab.uml": (0, 78, {}),
    "papyrus/SmartCityDSL-2.uml": (56, 18, {}),
    "papyrus/Studio4EducationAHTModel.uml": (7, 14, {1: 14}),
    "magicdraw/App_test_JD_v2.mdzip": (25, 6, {1: 2, 2: 4}),
    "magicdraw/Smart_street_light_2.mdzip": (64, 118, {1: 89, 3: 22}),
    "magicdraw/SUV_Example.mdzip": (0, 16, {}),
    "magicdraw/Tank_control_2.mdzip": (47, 76, {1: 17, 2: 42, 3: 16}),
    "magicdraw/Tank_control_2.xml": (47, 76, {1: 17, 2: 42, 3: 16}),
    "magicdraw/TestProject2.mdzip": (0, 24, {1: 18}),
    "magicdraw/Wired_Camera_Example.mdzip": (0, 32, {1: 6, 2: 2}),
}
"""Every file with connectors or conjugated ports: how many conjugated ports, ends, and property
paths by length the file has."""


# -- the independent script --------------------------------------------------------------------


def roots(path: Path) -> list[etree._Element]:
    if path.suffix != ".mdzip":
        return [etree.parse(str(path)).getroot()]
    with zipfile.ZipFile(path) as archive:
        names = [name for name in archive.namelist() if name.endswith("model")]
        return [etree.fromstring(archive.read(name)) for name in names]


def written(element: etree._Element, feature: str) -> list[str]:
    """Ids that a feature refers to, as attribute or as children, without their files."""
    found = (element.get(feature) or "").split()
    for child in element.findall(feature):
        values = [v for k, v in child.attrib.items() if k.endswith("}idref") or k == "href"]
        found += values
    return [one.rpartition("#")[2] for one in found]


def id_of(element: etree._Element) -> str:
    return next(v for k, v in element.attrib.items() if k.endswith("}id"))


def conjugated(path: Path) -> set[str]:
    found = (one for root in roots(path) for one in root.iter("{*}ownedAttribute"))
    return {id_of(one) for one in found if one.get("isConjugated") == "true"}


def nested(path: Path) -> dict[str, list[str]]:
    """Property path by connector end."""
    return {
        base: steps
        for root in roots(path)
        for one in root.iter("{*}NestedConnectorEnd")
        for base in written(one, "base_ConnectorEnd")
        if (steps := written(one, "propertyPath"))
    }


def connector_ends(path: Path) -> dict[str, etree._Element]:
    """Ends by id; what MagicDraw draws in its diagrams has no type."""
    return {
        id_of(end): end
        for root in roots(path)
        for connector in root.iter("{*}ownedConnector")
        for end in connector.findall("{*}end")
        if "uml:ConnectorEnd" in end.attrib.values()
    }


# -- the compiler ------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def compiled(corpus):
    known: dict[str, Graph] = {}

    def compile_(name: str) -> Graph:
        if name not in known:
            graph, sink = Graph(), Sink()
            path = corpus / "xmi" / name
            FRONTEND.read(load(path, path.name), graph, sink, Coverage())
            pipeline.build_pipeline(("resolve", "inherit", "classify", "ports", "flows")).run(
                graph, sink
            )
            known[name] = graph
        return known[name]

    return compile_


def plain(id: str) -> str:
    return id.rpartition("#")[2]


def own(graph: Graph, kind: Kind) -> list:
    return [one for one in graph.of_kind(kind) if not one.attrs.get("external")]


# -- what must hold ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", FILES)
def test_the_files_are_what_the_numbers_say(corpus, name):
    path = corpus / "xmi" / name
    lengths: dict[int, int] = {}
    for steps in nested(path).values():
        lengths[len(steps)] = lengths.get(len(steps), 0) + 1
    assert (len(conjugated(path)), len(connector_ends(path)), lengths) == FILES[name]


@pytest.mark.parametrize("name", FILES)
def test_every_conjugated_port_is_conjugated_and_no_other(corpus, compiled, name):
    graph = compiled(name)
    found = {plain(one.id) for one in own(graph, Kind.PORT) if one.attrs.get("conjugated")}
    assert found == conjugated(corpus / "xmi" / name)


@pytest.mark.parametrize("name", FILES)
def test_every_connector_end_has_the_path_that_is_written(corpus, compiled, name):
    path = corpus / "xmi" / name
    graph, deep, ends = compiled(name), nested(path), connector_ends(path)
    found = {plain(one.id): one for one in own(graph, Kind.CONNECTOR_END)}
    assert found.keys() == ends.keys()
    for id, end in ends.items():
        steps = deep.get(id, [])
        expected = steps + [one for one in written(end, "partWithPort") if one not in steps]
        shown = [_reference(one) for one in graph.targets(found[id], Edge.PATH)]
        assert shown == expected, id
        roles = [_reference(one) for one in graph.targets(found[id], Edge.ROLE)]
        assert roles == written(end, "role"), id


def _reference(element) -> str:
    return plain(str(element.attrs.get("href") or element.id))


@pytest.mark.parametrize("name", FILES)
def test_conjugation_turns_round_what_the_type_says(compiled, name):
    graph = compiled(name)
    for port in own(graph, Kind.PORT):
        type_ = type_of(graph, port)
        given = {str(p.attrs["direction"]) for p in flow_properties(graph, type_)} if type_ else ()
        if len(given) == 1 and port.role != "flow port":
            (direction,) = given
            expected = opposite(direction) if port.attrs.get("conjugated") else direction
            assert port.attrs["direction"] == expected, port


def test_requirements_have_the_id_and_text_of_the_file(corpus, compiled):
    path = corpus / "xmi/magicdraw/SUV_Example.mdzip"
    graph = compiled("magicdraw/SUV_Example.mdzip")
    expected = {
        one.get("base_Class"): (one.get("Id"), one.get("Text") or one.findtext("Text") or "")
        for root in roots(path)
        for one in root.iter("{http://www.omg.org/spec/SysML/20120401/SysML}Requirement")
    }
    assert len(expected) == 12
    shown = {
        plain(one.id): (one.attrs.get("req_id"), one.attrs.get("text", ""))
        for one in graph
        if one.role == "requirement"
    }
    assert shown == expected


def test_connectors_of_old_papyrus_stand_where_their_paths_lead(compiled):
    from sysmlc.backends.plantuml.parametric import find_bindings

    graph = compiled("papyrus/INCOSE.uml")
    (block,) = find_bindings(graph)
    assert graph[block].name == "Straight Line Vehicle Dynamics"
    shown = {
        graph[one.shows[0]].name: [".".join(graph[id].name for id in end.ids()) for end in one.ends]
        for one in find_bindings(graph)[block]
    }
    assert shown["c5"] == ["e1.bf", "v.b.r.braking force"]
    assert shown["c6"] == ["v.b.duty cycle", "e1.tl"]
    assert shown["c7"] == ["e1.f", "e2.f"]
    assert shown["c3"] == ["v.position", "e4.x"]
