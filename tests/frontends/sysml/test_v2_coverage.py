"""Losses are reported and listed; consequences of an unknown name are not reported."""

import pytest
from reading_v2 import PASSES, read

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Edge, Graph
from sysmlc.sources import Source

ENGINE = """
    part def Engine { attribute mass : ScalarValues::Integer; }
    part engine : Engine;
    requirement def Mass { subject e : Engine; }
"""


def list_lost(text):
    """Return the messages about losses, without the number."""
    sink = read(f"package P {{ {text} }}").sink
    return [
        diagnostic.message.partition(" (")[0]
        for diagnostic in sink
        if diagnostic.rule.code in ("SM480", "SM481")
    ]


def list_reported_losses(text):
    """Return the losses of the detailed report: type, verdict, elements, reason."""
    coverage = Coverage(is_detailed=True)
    FRONTEND.read([Source("m.sysml", text.encode())], Graph(), Sink(), coverage)
    (file,) = coverage.files()
    lost = [(loss.type, str(loss.verdict), loss.elements, loss.reason) for loss in file.losses]
    unmapped = file.elements - file.totals()["mapped"]
    assert sum(loss.elements for loss in file.losses) == unmapped
    return lost


@pytest.mark.parametrize(
    ("text", "beginning"),
    [
        (
            "requirement r : Mass { subject = engine; }",
            "the value of a subject is read as its type",
        ),
        ("use case u { subject e : Engine = engine; }", "the value of a subject is read as its"),
        (
            "analysis a { subject e : Engine; objective : Mass; }",
            "the type of an objective is not read",
        ),
        (
            "use case u; part t { perform u; }",
            "the performance of an element that is not an action",
        ),
        ("flow def F { end a; end b; }", "flow definition is not read"),
        ("part def Q { constraint { 1 < 2 } }", "a constraint that nothing asserts is read as"),
    ],
)
def test_losses_are_reported(text, beginning):
    (message,) = list_lost(ENGINE + text)
    assert message.startswith(beginning)


@pytest.mark.parametrize(
    "text",
    [
        "requirement r : Mass { subject e; }",
        "analysis a { subject e : Engine; objective { doc /* why */ } }",
        "part def Q { assert constraint { 1 < 2 } }",
        "requirement def R { subject e : Engine; require constraint { e.mass < 3 } }",
        "package A; private import A::*;",
    ],
)
def test_nothing_is_reported_if_nothing_is_lost(text):
    assert list_lost(ENGINE + text) == []


def test_a_loss_is_listed_with_the_number_of_its_members():
    text = f"package P {{ {ENGINE} analysis a {{ subject e : Engine;"
    text += " objective { assume constraint { e.mass > 2 } verify engine2; } }"
    text += " requirement engine2 : Mass; private import ScalarValues::*; }"
    assert list_reported_losses(text) == [
        ("ConstraintUsage", "approximated", 5, "a part of an objective is not read"),
        ("NamespaceImport", "external", 1, "stands for an element of a library"),
    ]


def test_an_import_with_a_filter_is_in_the_graph():
    reading = read("package P { package A; private import A::*[@SysML::PartDefinition]; }")
    (import_,) = [element for element in reading.graph if str(element.kind) == "Import"]
    assert reading.list_targets(reading.graph.qualified_name(import_), "references") == ["P::A"]


@pytest.mark.parametrize(
    "text",
    [
        "state def S { entry; then x; state x; transition first gone then x; }",
        "state def S { entry; then x; state x; transition first x accept Gone then x; }",
        "state def S { entry; then x; state x; transition first x then gone; }",
        "action def A { accept Gone; }",
        "action def A { send new Gone() to self; }",
        "action def A { first start; then gone; action b; first b then gone; }",
        "part def B { port p; port q; connect p to gone; bind q = gone; }",
    ],
)
def test_consequences_of_an_unknown_name_are_not_reported(text):
    passes = (*PASSES, "behaviours", "activities", "contracts")
    reading = read(f"package P {{ {text} }}", passes=passes)
    errors = [
        diagnostic.rule.code
        for diagnostic in reading.sink
        if str(diagnostic.rule.severity) != "info"
    ]
    assert set(errors) == {"SM205"}


@pytest.mark.parametrize(
    "ends",
    ["end a ::> x; end b ::> y; end c ::> z;", "end :>> a ::> x; end b :> y; end part c ::> z;"],
)
def test_ends_in_the_body_of_a_connection_are_its_ends(ends):
    reading = read(f"""
package P {{
    part def A;
    connection def C {{ end a : A; end b : A; end c : A; }}
    part def Cell {{ part x : A; part y : A; part z : A; connection k : C {{ {ends} }} }}
}}""")
    assert reading.list_codes() == []
    connector_ends = reading.graph.targets(
        reading.find_element("P::Cell::k", "Connector"), Edge.END
    )
    roles = [reading.graph.target(end, Edge.ROLE).name for end in connector_ends]
    assert roles == ["x", "y", "z"]


def test_a_flow_definition_with_types_of_its_ends_is_an_item_flow():
    flow = (
        "flow def Feed { ref item :>> payload : Fuel; end part tank : Tank; end part e : Engine; }"
    )
    text = f"{ENGINE} part def Tank; item def Fuel; {flow}"
    reading = read(f"package P {{ {text} }}")
    assert reading.find_element("P::Feed").kind == "ItemFlow"
    assert [
        reading.list_targets("P::Feed", edge) for edge in ("flow-source", "flow-target", "conveys")
    ] == [["P::Tank"], ["P::Engine"], ["P::Fuel"]]
    assert "flow definition is not read" not in list_lost(text)
