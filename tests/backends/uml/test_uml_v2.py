"""A model in SysML v2 that is saved as SysML 1.6 and read back is the same model.

SysML v1 expresses metaclasses and features of v2 by stereotypes and tagged values, and its item
flows are in packages (UML 2.5.1 clause 20.2). Nothing else may differ.
"""

import pytest

from examples.compiling import TEXT, compile_example, compile_text, outputs
from sysmlc.ir import Edge, Kind, query
from sysmlc.ir.compare import compare

FROM_STEREOTYPES = {"stereotype", "applies", "text", "req id", "direction"}


@pytest.fixture(scope="module")
def graphs(tmp_path_factory):
    """Return the graph of the text, and that of the saved file."""
    original = compile_example(TEXT, "uml")
    (saved,) = [text for path, text in outputs(original).items() if path.startswith("uml/")]
    copy = compile_text(tmp_path_factory.mktemp("v2"), "model.uml", saved.encode(), "uml")
    return original.graph, copy.graph


def is_notation_only(change):
    """Return whether a change is only one of notation."""
    is_stereotype = change.aspect in FROM_STEREOTYPES or change.aspect.startswith("«")
    # UML evaluates the value of a pin at the start; SM722 reports the values that are bound to it.
    is_pin_value = change.kind == "pin" and change.aspect == "value kind"
    return is_stereotype or is_pin_value or change.kind == "item flow"


def test_only_the_notation_differs(graphs):
    changes = compare(*graphs, ("id",))
    assert [str(change) for change in changes if not is_notation_only(change)] == []
    assert len(graphs[0]) > 300


def test_requirements_have_their_id_and_text(graphs):
    old, new = graphs
    texts = {r.name: (r.attrs["req_id"], r.attrs["text"]) for r in list_requirements(old)}
    tags = {
        requirement.name: tuple(query.tag(new, requirement, name) for name in ("id", "text"))
        for requirement in list_requirements(new)
    }
    assert texts == tags
    assert len(texts) == 6


def list_requirements(graph):
    return [element for element in graph if query.is_requirement(element)]


def test_item_flows_have_the_same_ends_and_items(graphs):
    old, new = map(list_item_flows, graphs)
    assert old == new
    assert old


def list_item_flows(graph):
    """Return name, ends, conveyed items and connectors of each item flow."""
    edges = (Edge.FLOW_SOURCE, Edge.FLOW_TARGET, Edge.CONVEYS, Edge.REALIZING)
    return sorted(
        (flow.name, *(tuple(map(graph.qualified_name, graph.targets(flow, e))) for e in edges))
        for flow in graph.of_kind(Kind.ITEM_FLOW)
    )


def test_stereotypes_are_those_of_the_roles(graphs):
    """Every stereotype of SysML is applied to an element with its role."""
    old, new = graphs
    for element in new:
        names = set(query.stereotypes(new, element)) & {"Block", "Requirement", "FlowProperty"}
        roles = {"Block": "block", "Requirement": "requirement", "FlowProperty": "flow property"}
        assert {roles[name] for name in names} <= {element.role}, element
    assert {element.role for element in old} <= {element.role for element in new}


HALL = """package Hall {
    private import Floors::*;
    part def Hall :> Floor {
        constant attribute :>> columns = 2;
        constant attribute :>> rows = 1;
        part robot : Robot { :>> row = 0; :>> column = 0; }
        part mission : Mission { part dock : Target { :>> row = 0; :>> column = 1; } }
    }
}
"""
LOADER = """package Cells {
    private import DIN8580::*;
    part def Loader :> Picking { action pick : Pick; bind pick.command = command; }
}
"""


@pytest.mark.parametrize(
    ("library", "text"), [("Floors", HALL), ("DIN8580", LOADER)], ids=["floors", "actions"]
)
def test_a_model_is_saved_with_the_shipped_libraries_that_it_uses(library, text, tmp_path):
    original = compile_text(tmp_path, "model.sysml", text.encode(), "uml", "contracts")
    saved = {path: text for path, text in outputs(original).items() if path.startswith("uml/")}
    assert sorted(saved) == [f"uml/libraries/{library}.uml", "uml/model.uml"]
    for path, content in saved.items():
        file = tmp_path / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(content, encoding="utf-8")
    copy = compile_example(tmp_path / "uml", "contracts")
    formulas = list_formulas(original)
    assert formulas
    assert formulas.items() <= list_formulas(copy).items()


def list_formulas(outcome):
    """Return the formulas of each contract by its file."""
    return {path: text for path, text in outputs(outcome).items() if path.endswith(".spin.ltl")}


PAYLOADS = """package Cells {
    private import ScalarValues::*;
    item def Order { attribute urgent : Boolean; }
    item def Rush :> Order;
    part def Gate {
        in attribute limit : Boolean;
        out attribute open : Boolean := false;
        exhibit state Run {
            entry; then Idle;
            state Idle;
            transition first Idle accept o : Order if o.urgent then Busy;
            state Busy;
            transition first Busy accept r : Rush if not r.urgent or limit
                do assign open := r.urgent then Idle;
        }
    }
}
"""


def test_guards_and_effects_read_the_payload_of_an_event_by_the_name_of_its_trigger(tmp_path):
    original = compile_text(tmp_path, "model.sysml", PAYLOADS.encode(), "uml", "contracts")
    formulas = list_formulas(original)
    assert "o_urgent" in next(iter(formulas.values()))
    (saved,) = [text for path, text in outputs(original).items() if path.startswith("uml/")]
    copy = compile_text(tmp_path, "model.uml", saved.encode(), "contracts")
    assert list_formulas(copy) == formulas
