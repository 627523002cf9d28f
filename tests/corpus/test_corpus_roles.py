"""Roles in real models are those that a script reads from the XML with lxml alone."""

import zipfile
from pathlib import Path

import pytest
from lxml import etree
from reading_corpus import load_files, lower

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Graph, Kind

pytestmark = pytest.mark.corpus

XMI = "{http://www.omg.org/spec/XMI/20131001}"
PORTS = {"FullPort": "full port", "ProxyPort": "proxy port"}
MODEL = "com.nomagic.magicdraw.uml_model.model"
SHARED_MODEL = "com.nomagic.magicdraw.uml_model.shared_model"
ARROWHEAD = "xmi/papyrus/Arrowhead-5.0.uml"
PROFILE = "xmi/papyrus/ArrowheadProfile_v5.0.profile.uml"
TANK = "xmi/magicdraw/Tank_control_2.mdzip"


# -- the independent script --------------------------------------------------------------------


def find_port_ids(root: etree._Element) -> set[str]:
    """Return the ids of the ports that the file declares, without references to ports."""
    xmi = f"{{{root.nsmap['xmi']}}}"
    return {
        element.get(f"{xmi}id")
        for element in root.iter("{*}ownedAttribute", "{*}ownedPort")
        if element.get(f"{xmi}type") == "uml:Port"
        and element.get("href") is None
        and element.get(f"{xmi}idref") is None
    }


def list_applications(root: etree._Element, base: str) -> list[tuple[str, str]]:
    """Return the local name and base id of every stereotype application."""
    return [
        (etree.QName(child).localname, child.get(base))
        for child in root
        if isinstance(child.tag, str) and child.get(base)
    ]


def find_stereotyped_ports(root: etree._Element) -> dict[str, str]:
    """Map declared ports to the role that FullPort or ProxyPort of any profile gives to them."""
    ports = find_port_ids(root)
    return {
        base: PORTS[name]
        for name, base in list_applications(root, "base_Port")
        if name in PORTS and base in ports
    }


def map_generals(profile: etree._Element) -> dict[str, set[str]]:
    """Map each stereotype of a profile to its own name and the names of its general stereotypes."""
    table = {}
    stereotypes = {
        element.get(f"{XMI}id"): element
        for element in profile.iter("{*}packagedElement")
        if element.get(f"{XMI}type") == "uml:Stereotype"
    }

    def collect_names(element: etree._Element) -> set[str]:
        names = {element.get("name")}
        for generalization in element.findall("generalization"):
            if generalization.get("general"):
                names |= collect_names(stereotypes[generalization.get("general")])
            for href in generalization.xpath("general/@href"):
                names.add(href.rpartition("_packagedElement_")[2])
        return names

    for element in stereotypes.values():
        table[element.get("name")] = collect_names(element)
    return table


def parse_entry(path: Path, entry: str = "") -> etree._Element:
    if not entry:
        return etree.parse(str(path)).getroot()
    with zipfile.ZipFile(path) as archive:
        return etree.fromstring(archive.read(entry))


# -- the compiler ------------------------------------------------------------------------------


def refine(*paths: Path) -> tuple[Graph, Sink]:
    passes = ("resolve", "inherit", "classify", "ports", "flows", "behaviours")
    return lower(load_files(*paths), passes, verify_each=True)


def find_roles(graph: Graph, kind: Kind, *roles: str) -> dict[str, str]:
    elements = (element for element in graph.of_kind(kind) if not element.attrs.get("external"))
    return {element.id: element.role for element in elements if element.role in roles}


# -- tests -------------------------------------------------------------------------------------


@pytest.mark.parametrize("files", [[ARROWHEAD], [ARROWHEAD, PROFILE]], ids=["alone", "profile"])
def test_arrowhead_ports_are_recognised_with_and_without_the_profile(corpus, files):
    expected = find_stereotyped_ports(parse_entry(corpus / ARROWHEAD))
    graph, _ = refine(*(corpus / name for name in files))
    assert len(expected) == 315
    assert find_roles(graph, Kind.PORT, *PORTS.values()) == expected
    plain = find_roles(graph, Kind.PORT, "port").keys()
    assert plain == find_port_ids(parse_entry(corpus / ARROWHEAD)) - expected.keys()


def test_arrowhead_blocks_are_recognised_through_the_generalizations_of_the_profile(corpus):
    names = map_generals(parse_entry(corpus / PROFILE))
    graph, _ = refine(corpus / ARROWHEAD, corpus / PROFILE)
    checked = 0
    for stereotype, base in list_applications(parse_entry(corpus / ARROWHEAD), "base_Class"):
        generals = names.get(stereotype, {stereotype})
        if "InterfaceBlock" in generals or "Block" in generals:
            role = "interface block" if "InterfaceBlock" in generals else "block"
            assert (stereotype, graph[base].role) == (stereotype, role)
            checked += 1
    assert checked > 150


def test_arrowhead_stereotypes_of_the_profile_are_found(corpus):
    graph, _ = refine(corpus / ARROWHEAD, corpus / PROFILE)
    stereotypes = map_generals(parse_entry(corpus / PROFILE)).keys()
    for application in graph.of_kind(Kind.APPLICATION):
        if application.attrs["namespace"] == "http://www.eclipse.org/papyrus/arrowhead":
            is_found = graph.target(application, Edge.INSTANCE_OF) is not None
            assert is_found is (application.attrs["stereotype"] in stereotypes), application


def test_tank_control_ports_are_recognised(corpus):
    root = parse_entry(corpus / TANK, MODEL)
    expected = find_stereotyped_ports(root)
    graph, _ = refine(corpus / TANK)
    assert expected.keys() == find_port_ids(root)
    assert len(expected) == 72
    assert find_roles(graph, Kind.PORT, *PORTS.values()) == expected


def test_tank_control_parts_and_values_are_recognised(corpus):
    root = parse_entry(corpus / TANK, MODEL)
    expected = {
        base: {"PartProperty": "part", "ValueProperty": "value"}[name]
        for name, base in list_applications(root, "base_Property")
        if name in ("PartProperty", "ValueProperty")
    }
    graph, _ = refine(corpus / TANK)
    assert len(expected) == 68
    assert {id: graph[id].role for id in expected} == expected


@pytest.mark.parametrize(
    ("name", "entry"),
    [
        ("xmi/papyrus/SmartCityDSL-2.uml", ""),
        ("xmi/magicdraw/Tank_control_2.xml", ""),
        ("xmi/magicdraw/Wired_Camera_Example.mdzip", MODEL),
        ("xmi/magicdraw/App_test_JD_v2.mdzip", SHARED_MODEL),
        ("xmi/magicdraw/Smart_street_light_2.mdzip", MODEL),
    ],
)
def test_stereotyped_ports_of_other_models_are_recognised(corpus, name, entry):
    root = parse_entry(corpus / name, entry)
    expected = find_stereotyped_ports(root)
    graph, _ = refine(corpus / name)
    roles = find_roles(graph, Kind.PORT, *PORTS.values())
    assert expected
    assert {id: roles.get(id) for id in expected} == expected


def test_item_flows_give_the_direction_that_the_diagram_shows(corpus):
    """Light enters the camera at "boundary" and its module at "light in" (MagicDraw 17)."""
    graph, _ = refine(corpus / "xmi/magicdraw/Wired_Camera_Example.mdzip")
    directions = {port.name: port.attrs.get("direction") for port in graph.of_kind(Kind.PORT)}
    assert (directions["boundary"], directions["light in"]) == ("in", "in")
    assert (directions["filter"], directions["mount"]) == ("inout", None)


def test_marte_ports_are_not_sysml_flow_ports(corpus):
    """ProducerConsumer applies MARTE's FlowPort, which has only its name in common with SysML's."""
    path = corpus / "xmi/papyrus/ProducerConsumer.uml"
    marte = [
        base
        for name, base in list_applications(parse_entry(path), "base_Port")
        if name == "FlowPort"
    ]
    graph, _ = refine(path)
    assert marte
    assert {graph[base].role for base in marte} == {"port"}
