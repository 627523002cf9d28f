"""Conjugation, nested ends and requirements in real models are those that lxml finds."""

from pathlib import Path

import pytest
from lxml import etree
from reading_corpus import load_files, lower, parse_models, xmi_id

from sysmlc.ir import Edge, Graph, Kind
from sysmlc.ir.query import flow_properties, opposite, type_of

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
"""Files with connectors or conjugated ports: the number of conjugated ports, the number of
connector ends, and the number of property paths by length."""


# -- the independent script --------------------------------------------------------------------


def read_references(element: etree._Element, feature: str) -> list[str]:
    """Return the ids in a feature, in its attribute and its children, without their files."""
    references = (element.get(feature) or "").split()
    for child in element.findall(feature):
        values = [
            value for key, value in child.attrib.items() if key.endswith("}idref") or key == "href"
        ]
        references += values
    return [reference.rpartition("#")[2] for reference in references]


def find_conjugated(path: Path) -> set[str]:
    attributes = (
        attribute for root in parse_models(path) for attribute in root.iter("{*}ownedAttribute")
    )
    return {
        xmi_id(attribute) for attribute in attributes if attribute.get("isConjugated") == "true"
    }


def find_paths(path: Path) -> dict[str, list[str]]:
    """Map connector ends to their property paths."""
    return {
        base: steps
        for root in parse_models(path)
        for application in root.iter("{*}NestedConnectorEnd")
        for base in read_references(application, "base_ConnectorEnd")
        if (steps := read_references(application, "propertyPath"))
    }


def find_connector_ends(path: Path) -> dict[str, etree._Element]:
    """Map ids to connector ends; ends in MagicDraw's diagrams have no type."""
    return {
        xmi_id(end): end
        for root in parse_models(path)
        for connector in root.iter("{*}ownedConnector")
        for end in connector.findall("{*}end")
        if "uml:ConnectorEnd" in end.attrib.values()
    }


# -- the compiler ------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def refine_model(corpus):
    graphs: dict[str, Graph] = {}

    def refine_once(name: str) -> Graph:
        if name not in graphs:
            passes = ("resolve", "inherit", "classify", "ports", "flows")
            graphs[name], _ = lower(load_files(corpus / "xmi" / name), passes)
        return graphs[name]

    return refine_once


def strip_file(id: str) -> str:
    return id.rpartition("#")[2]


def list_internal(graph: Graph, kind: Kind) -> list:
    return [element for element in graph.of_kind(kind) if not element.attrs.get("external")]


# -- tests -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", FILES)
def test_the_files_have_the_numbers_of_the_table(corpus, name):
    path = corpus / "xmi" / name
    lengths: dict[int, int] = {}
    for steps in find_paths(path).values():
        lengths[len(steps)] = lengths.get(len(steps), 0) + 1
    assert (len(find_conjugated(path)), len(find_connector_ends(path)), lengths) == FILES[name]


@pytest.mark.parametrize("name", FILES)
def test_exactly_the_conjugated_ports_are_conjugated(corpus, refine_model, name):
    graph = refine_model(name)
    ports = {
        strip_file(port.id)
        for port in list_internal(graph, Kind.PORT)
        if port.attrs.get("conjugated")
    }
    assert ports == find_conjugated(corpus / "xmi" / name)


@pytest.mark.parametrize("name", FILES)
def test_every_connector_end_has_the_path_in_the_file(corpus, refine_model, name):
    path = corpus / "xmi" / name
    graph, paths, ends = refine_model(name), find_paths(path), find_connector_ends(path)
    elements = {
        strip_file(element.id): element for element in list_internal(graph, Kind.CONNECTOR_END)
    }
    assert elements.keys() == ends.keys()
    for id, end in ends.items():
        steps = paths.get(id, [])
        expected = steps + [
            element for element in read_references(end, "partWithPort") if element not in steps
        ]
        steps_of_graph = [
            _reference_id(element) for element in graph.targets(elements[id], Edge.PATH)
        ]
        assert steps_of_graph == expected, id
        roles = [_reference_id(element) for element in graph.targets(elements[id], Edge.ROLE)]
        assert roles == read_references(end, "role"), id


def _reference_id(element) -> str:
    return strip_file(str(element.attrs.get("href") or element.id))


@pytest.mark.parametrize(
    ("name", "count", "conjugated"),
    [
        ("papyrus/Arrowhead-5.0.uml", 2, 0),
        ("magicdraw/App_test_JD_v2.mdzip", 6, 3),
        ("magicdraw/Smart_street_light_2.mdzip", 21, 9),
        ("magicdraw/Tank_control_2.mdzip", 8, 4),
        ("magicdraw/Tank_control_2.xml", 8, 4),
        ("magicdraw/TestProject2.mdzip", 17, 0),
    ],
)
def test_conjugation_reverses_the_direction_of_the_type(refine_model, name, count, conjugated):
    """In the files with ports whose type has flow properties of one direction."""
    graph = refine_model(name)
    reversals = []
    for port in list_internal(graph, Kind.PORT):
        type_ = type_of(graph, port)
        properties = flow_properties(graph, type_) if type_ else ()
        directions = {str(flow_property.attrs["direction"]) for flow_property in properties}
        if len(directions) == 1 and port.role != "flow port":
            (direction,) = directions
            reversals.append(bool(port.attrs.get("conjugated")))
            expected = opposite(direction) if reversals[-1] else direction
            assert port.attrs["direction"] == expected, port
    assert (len(reversals), sum(reversals)) == (count, conjugated)


def test_requirements_have_the_id_and_text_of_the_file(corpus, refine_model):
    path = corpus / "xmi/magicdraw/SUV_Example.mdzip"
    graph = refine_model("magicdraw/SUV_Example.mdzip")
    expected = {
        element.get("base_Class"): (
            element.get("Id"),
            element.get("Text") or element.findtext("Text") or "",
        )
        for root in parse_models(path)
        for element in root.iter("{http://www.omg.org/spec/SysML/20120401/SysML}Requirement")
    }
    assert len(expected) == 12
    requirements = {
        strip_file(element.id): (element.attrs.get("req_id"), element.attrs.get("text", ""))
        for element in graph
        if element.role == "requirement"
    }
    assert requirements == expected


def test_connectors_of_old_papyrus_belong_to_the_block_of_their_paths(refine_model):
    from sysmlc.backends.plantuml.parametric import find_bindings

    graph = refine_model("papyrus/INCOSE.uml")
    (block,) = find_bindings(graph)
    assert graph[block].name == "Straight Line Vehicle Dynamics"
    ends_by_name = {
        graph[binding.shows[0]].name: [
            ".".join(graph[id].name for id in end.ids()) for end in binding.ends
        ]
        for binding in find_bindings(graph)[block]
    }
    assert ends_by_name["c5"] == ["e1.bf", "v.b.r.braking force"]
    assert ends_by_name["c6"] == ["v.b.duty cycle", "e1.tl"]
    assert ends_by_name["c7"] == ["e1.f", "e2.f"]
    assert ends_by_name["c3"] == ["v.position", "e4.x"]
