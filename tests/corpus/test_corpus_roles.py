"""Roles in real models, against what an independent script reads in the XML with lxml alone."""

import zipfile
from pathlib import Path

import pytest
from lxml import etree

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.passes import pipeline
from sysmlc.sources.files import load

pytestmark = pytest.mark.corpus

XMI = "{http://www.omg.org/spec/XMI/20131001}"
PORTS = {"FullPort": "full port", "ProxyPort": "proxy port"}
MODEL = "com.nomagic.magicdraw.uml_model.model"
SHARED_MODEL = "com.nomagic.magicdraw.uml_model.shared_model"
ARROWHEAD = "xmi/papyrus/Arrowhead-5.0.uml"
PROFILE = "xmi/papyrus/ArrowheadProfile_v5.0.profile.uml"
TANK = "xmi/magicdraw/Tank_control_2.mdzip"


# -- the independent script --------------------------------------------------------------------


def ports_in(root: etree._Element) -> set[str]:
    """Ids of the ports that the file declares: references (href, idref) have no id of a port."""
    xmi = f"{{{root.nsmap['xmi']}}}"
    return {
        element.get(f"{xmi}id")
        for element in root.iter("{*}ownedAttribute", "{*}ownedPort")
        if element.get(f"{xmi}type") == "uml:Port"
        and element.get("href") is None
        and element.get(f"{xmi}idref") is None
    }


def applied(root: etree._Element, base: str) -> list[tuple[str, str]]:
    """Local name and base id of every stereotype application beside the model."""
    return [
        (etree.QName(child).localname, child.get(base))
        for child in root
        if isinstance(child.tag, str) and child.get(base)
    ]


def stereotyped_ports(root: etree._Element) -> dict[str, str]:
    """Role that FullPort or ProxyPort, of whatever profile, gives to a declared port."""
    declared = ports_in(root)
    return {
        base: PORTS[name]
        for name, base in applied(root, "base_Port")
        if name in PORTS and base in declared
    }


def general_names(profile: etree._Element) -> dict[str, set[str]]:
    """For each stereotype of a profile its name and those of all that it specialises."""
    found = {}
    stereotypes = {
        element.get(f"{XMI}id"): element
        for element in profile.iter("{*}packagedElement")
        if element.get(f"{XMI}type") == "uml:Stereotype"
    }

    def names(element: etree._Element) -> set[str]:
        own = {element.get("name")}
        for up in element.findall("generalization"):
            if up.get("general"):
                own |= names(stereotypes[up.get("general")])
            for href in up.xpath("general/@href"):
                own.add(href.rpartition("_packagedElement_")[2])
        return own

    for element in stereotypes.values():
        found[element.get("name")] = names(element)
    return found


def tree(path: Path, entry: str = "") -> etree._Element:
    if not entry:
        return etree.parse(str(path)).getroot()
    with zipfile.ZipFile(path) as archive:
        return etree.fromstring(archive.read(entry))


# -- the compiler ------------------------------------------------------------------------------


def compiled(*paths: Path) -> tuple[Graph, Sink]:
    graph, sink = Graph(), Sink()
    sources = [source for path in paths for source in load(path, path.name)]
    FRONTEND.read(sources, graph, sink, Coverage())
    names = ("resolve", "inherit", "classify", "ports", "flows", "behaviours")
    pipeline.build_pipeline(names).run(graph, sink, verify_each=True)
    return graph, sink


def roles(graph: Graph, kind: Kind, *wanted: str) -> dict[str, str]:
    found = (one for one in graph.of_kind(kind) if not one.attrs.get("external"))
    return {one.id: one.role for one in found if one.role in wanted}


# -- what must hold ----------------------------------------------------------------------------


@pytest.mark.parametrize("files", [[ARROWHEAD], [ARROWHEAD, PROFILE]], ids=["alone", "profile"])
def test_arrowhead_ports_are_recognised_with_and_without_the_profile(corpus, files):
    expected = stereotyped_ports(tree(corpus / ARROWHEAD))
    graph, _ = compiled(*(corpus / name for name in files))
    assert len(expected) == 315
    assert roles(graph, Kind.PORT, *PORTS.values()) == expected
    plain = roles(graph, Kind.PORT, "port").keys()
    assert plain == ports_in(tree(corpus / ARROWHEAD)) - expected.keys()


def test_arrowhead_blocks_are_recognised_through_the_generalizations_of_the_profile(corpus):
    names = general_names(tree(corpus / PROFILE))
    graph, _ = compiled(corpus / ARROWHEAD, corpus / PROFILE)
    checked = 0
    for stereotype, base in applied(tree(corpus / ARROWHEAD), "base_Class"):
        above = names.get(stereotype, {stereotype})
        if "InterfaceBlock" in above or "Block" in above:
            role = "interface block" if "InterfaceBlock" in above else "block"
            assert (stereotype, graph[base].role) == (stereotype, role)
            checked += 1
    assert checked > 150


def test_arrowhead_stereotypes_of_the_profile_are_found(corpus):
    graph, _ = compiled(corpus / ARROWHEAD, corpus / PROFILE)
    defined = general_names(tree(corpus / PROFILE)).keys()
    for application in graph.of_kind(Kind.APPLICATION):
        if application.attrs["namespace"] == "http://www.eclipse.org/papyrus/arrowhead":
            known = graph.target(application, Edge.INSTANCE_OF) is not None
            assert known is (application.attrs["stereotype"] in defined), application


def test_tank_control_ports_are_recognised(corpus):
    root = tree(corpus / TANK, MODEL)
    expected = stereotyped_ports(root)
    graph, _ = compiled(corpus / TANK)
    assert expected.keys() == ports_in(root)
    assert len(expected) == 72
    assert roles(graph, Kind.PORT, *PORTS.values()) == expected


def test_tank_control_parts_and_values_are_recognised(corpus):
    root = tree(corpus / TANK, MODEL)
    expected = {
        base: {"PartProperty": "part", "ValueProperty": "value"}[name]
        for name, base in applied(root, "base_Property")
        if name in ("PartProperty", "ValueProperty")
    }
    graph, _ = compiled(corpus / TANK)
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
def test_ports_of_other_models_are_recognised(corpus, name, entry):
    root = tree(corpus / name, entry)
    expected = stereotyped_ports(root)
    graph, _ = compiled(corpus / name)
    found = roles(graph, Kind.PORT, *PORTS.values())
    assert expected
    assert {id: found.get(id) for id in expected} == expected


def test_item_flows_give_the_direction_that_the_diagram_shows(corpus):
    """Light enters the camera at its boundary and its module at "light in"; MagicDraw 17."""
    graph, _ = compiled(corpus / "xmi/magicdraw/Wired_Camera_Example.mdzip")
    directions = {one.name: one.attrs.get("direction") for one in graph.of_kind(Kind.PORT)}
    assert (directions["boundary"], directions["light in"]) == ("in", "in")
    assert (directions["filter"], directions["mount"]) == ("inout", None)


def test_marte_ports_are_no_sysml_ports(corpus):
    """ProducerConsumer applies MARTE's FlowPort, which only shares the name with SysML's."""
    path = corpus / "xmi/papyrus/ProducerConsumer.uml"
    marte = [base for name, base in applied(tree(path), "base_Port") if name == "FlowPort"]
    graph, _ = compiled(path)
    assert marte
    assert {graph[base].role for base in marte} == {"port"}
