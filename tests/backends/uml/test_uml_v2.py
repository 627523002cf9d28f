"""A model in SysML v2, saved as SysML 1.6 and read again: the same model in the words of v1.

What v2 says by metaclasses and features, v1 says by stereotypes and tagged values; item flows stand
in packages (UML 2.5.1 clause 20.2). Nothing else may differ.
"""

import pytest

from examples.compiling import TEXT, compile_example, compile_text, outputs
from sysmlc.ir import Edge, Kind, query
from sysmlc.ir.compare import compare

SAID_BY_STEREOTYPES = {"stereotype", "applies", "text", "req id", "direction"}


@pytest.fixture(scope="module")
def graphs(tmp_path_factory):
    """The graph of the text, and that of what it was saved as."""
    one = compile_example(TEXT, "uml")
    (saved,) = [text for path, text in outputs(one).items() if path.startswith("uml/")]
    two = compile_text(tmp_path_factory.mktemp("v2"), "model.uml", saved.encode(), "uml")
    return one.graph, two.graph


def is_in_other_words(change):
    """Whether a change is only one of notation."""
    is_stereotype = change.aspect in SAID_BY_STEREOTYPES or change.aspect.startswith("«")
    return is_stereotype or change.kind == "item flow"


def test_it_is_the_same_model_in_other_words(graphs):
    changes = compare(*graphs, ("id",))
    assert [str(one) for one in changes if not is_in_other_words(one)] == []
    assert len(graphs[0]) > 300


def test_requirements_have_their_id_and_text(graphs):
    old, new = graphs
    said = {one.name: (one.attrs["req_id"], one.attrs["text"]) for one in requirements(old)}
    read = {one.name: (tag(new, one, "id"), tag(new, one, "text")) for one in requirements(new)}
    assert said == read
    assert len(said) == 6


def requirements(graph):
    return [one for one in graph if query.is_requirement(one)]


def tag(graph, element, name):
    return query.tag(graph, element, name)


def test_item_flows_lead_from_and_to_the_same_and_carry_the_same(graphs):
    old, new = map(flows, graphs)
    assert old == new
    assert old


def flows(graph):
    """Each item flow by its name: its ends, what it conveys, the names of its connectors."""
    edges = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET, Edge.CONVEYS, Edge.REALIZING)
    return sorted(
        (one.name, *(tuple(graph.qualified_name(t) for t in graph.targets(one, e)) for e in edges))
        for one in graph.of_kind(Kind.ITEM_FLOW)
    )


def test_stereotypes_are_those_of_the_roles(graphs):
    """Every stereotype that came in is one of SysML, and on what has its role."""
    old, new = graphs
    for one in new:
        names = set(query.stereotypes(new, one)) & {"Block", "Requirement", "FlowProperty"}
        roles = {"Block": "block", "Requirement": "requirement", "FlowProperty": "flow property"}
        assert {roles[name] for name in names} <= {one.role}, one
    assert {one.role for one in old} <= {one.role for one in new}
