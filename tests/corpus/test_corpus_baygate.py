"""BayGate is compiled as its description states, from each of its four files."""

from collections import Counter

import pytest
from reading_corpus import BAYGATE_FILES

from graph_differences import diff
from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.ir import Edge, Kind

pytestmark = pytest.mark.corpus


@pytest.fixture(scope="module")
def compilations(corpus):
    backends = tuple(select_backends(("plantuml",)))
    folder = corpus / "aml" / "baygate"
    requests = {name: Request(inputs=(folder / name,), backends=backends) for name in BAYGATE_FILES}
    return {name: compile_model(request) for name, request in requests.items()}


def is_of_user(graph, element):
    return not element.attrs.get("external")


@pytest.mark.parametrize("name", BAYGATE_FILES)
def test_baygate_has_the_totals_of_its_description(name, compilations):
    """Section 11 of baygate/expected.md."""
    graph = compilations[name].graph
    elements = [element for element in graph if is_of_user(graph, element)]
    kinds = Counter((e.kind, e.role, e.subkind) for e in elements)
    libraries = {"system-unit-class-lib", "role-class-lib", "interface-class-lib"}
    blocks = [element for element in elements if element.kind is Kind.CLASS]
    generals = [t for e in blocks for t in graph.targets(e, Edge.SPECIALIZES)]
    assert {
        "bdd": sum(e.kind is Kind.PACKAGE and e.subkind in libraries for e in elements),
        "ibd": sum(e.kind is Kind.INSTANCE and e.subkind == "" for e in elements),
        "blocks": kinds[Kind.CLASS, "block", ""],
        "roles": kinds[Kind.CLASS, "block", "role-class"],
        "interface blocks": kinds[Kind.CLASS, "interface block", ""],
        "ports": sum(e.kind is Kind.PORT for e in elements),
        "parts": kinds[Kind.PROPERTY, "part", ""],
        "values": kinds[Kind.PROPERTY, "value", ""],
        "generalizations": len(generals),
        "of them to user classes": sum(is_of_user(graph, t) for t in generals),
        "realizations": sum(len(graph.targets(e, Edge.REALIZES)) for e in elements),
        "connectors": sum(e.kind is Kind.CONNECTOR for e in elements),
        "slots": {e.name: e.attrs["value"] for e in elements if e.kind is Kind.SLOT},
        "unresolved": sum("unresolved" in e.attrs for e in graph),
        "diagnostics": list(compilations[name].diagnostics),
    } == {
        "bdd": 3,
        "ibd": 1,
        "blocks": 5,
        "roles": 3,
        "interface blocks": 1,
        "ports": 10,
        "parts": 3,
        "values": 2,
        "generalizations": 5,
        "of them to user classes": 1,
        "realizations": 6,
        "connectors": 5,
        "slots": {"length": 1.2, "velocity": 0.3},
        "unresolved": 0,
        "diagnostics": [],
    }


@pytest.mark.parametrize("name", BAYGATE_FILES)
def test_the_diagrams_of_baygate_are_those_of_the_thesis(name, compilations):
    """Table 3.1; the value types of CAEX 3.0 (section 6) have a diagram of their own."""
    diagrams = {artefact.path.removesuffix(".puml") for artefact in compilations[name].artefacts}
    assert diagrams - {"diagrams/Quantities.bdd"} == {
        "diagrams/BayGate_Breakdown.bdd",
        "diagrams/SysML-RCL.bdd",
        "diagrams/Interface_Lib.bdd",
        "diagrams/BayGate_System.BayGate.ibd",
    }


def test_the_links_of_baygate_are_connectors_between_its_ports(compilations):
    for compilation in compilations.values():
        graph = compilation.graph
        ends = {
            connector.name: [
                ".".join(
                    step.name for e in (Edge.PATH, Edge.ROLE) for step in graph.targets(end, e)
                )
                for end in graph.targets(connector, Edge.END)
            ]
            for connector in graph.of_kind(Kind.CONNECTOR)
        }
        assert ends == {
            "l_bgIn_sIn": ["p_bgIn", "st.p_sIn"],
            "l_stRf_rfIn": ["st.p_stRf", "rf.p_rfIn"],
            "l_sOut_swIn": ["st.p_sOut", "sw.p_swIn"],
            "l_swOut_bgOut": ["sw.p_swOut", "p_bgOut"],
            "l_swCb_bgCb": ["sw.p_swCb", "p_bgCb"],
        }


HEADER_KINDS = {"Document", "Import", "Metadata"}
"""Kinds of elements that describe the files, which differ between the four forms."""


def read_graph(corpus, name):
    return compile_model(Request(inputs=(corpus / "aml" / "baygate" / name,))).graph


@pytest.mark.parametrize("name", BAYGATE_FILES[1:])
def test_the_four_files_give_one_graph(name, corpus):
    first, second = (remove_header(read_graph(corpus, file)) for file in (BAYGATE_FILES[0], name))
    if name == "BayGate_caex215.aml":
        first, second = remove_types(first), remove_types(second)
    assert diff(first, second, ignore=("id", "source", "trace", "interface_ids")) == []


def remove_header(graph):
    for element in [e for e in graph.roots() if e.kind.value in HEADER_KINDS]:
        graph.remove(element)
    return graph


def remove_types(graph):
    """Remove the types of values, which a file of CAEX 2.15 derives from units."""
    for package in [e for e in graph.roots() if e.subkind == "attribute-type-lib"]:
        graph.remove(package)
    for type_ in graph.of_kind(Kind.DATA_TYPE):
        if type_.id in graph:
            graph.remove(type_)
    return graph
