"""Overlaps and gaps of the guards of a decision are reported with example values."""

import pytest

from sysmlc.analyses.recipe.expressions import read_expression
from sysmlc.diagnostics import Sink, Subject
from sysmlc.recipe import validate
from sysmlc.recipe.model import EnumType, FlowEdge, FlowGraph, Model, Node, Parameter, Recipe

COLOUR = EnumType("Colour", ("red", "green"))
VARIABLES = (
    Parameter("ok", "boolean", value=False),
    Parameter("n", "integer", value=0),
    Parameter("m", "integer", value=0),
    Parameter("x", "real", value=0.5),
    Parameter("colour", COLOUR, value="red"),
    Parameter("tool", "string", value="drill"),
)


def check_guards(*guards: str) -> list[str]:
    """Return the diagnostics of a decision with these guards."""
    nodes = [Node("i", "initial"), Node("d", "decision"), Node("f", "final")]
    edges = [FlowEdge("i", "d")]
    for number, text in enumerate(guards):
        nodes.append(Node(f"s{number}", "action"))
        is_else = text == "else"
        guard = None if is_else or not text else read_expression(text)
        edges.append(FlowEdge("d", f"s{number}", guard, text, is_else))
        edges.append(FlowEdge(f"s{number}", "f"))
    graph = FlowGraph("g", variables=VARIABLES, nodes=tuple(nodes), edges=tuple(edges))
    sink = Sink()
    validate(Model(Recipe("r", ()), service_graphs=(graph,)), sink, Subject)
    return [f"{diagnostic.rule.code}: {diagnostic.message}" for diagnostic in sink]


@pytest.mark.parametrize(
    "guards",
    [
        ("ok", "not ok"),
        ("ok", "else"),
        ("n < 3", "n >= 3"),
        ("n < 3", "n == 3", "n > 3"),
        ("n < m", "n == m", "n > m"),
        ("x <= 0.5", "x > 0.5"),
        ("colour == Colour::red", "colour == green"),
        ("ok and n > 2", "ok and n <= 2", "not ok"),
    ],
)
def test_guards_of_which_exactly_one_is_true_are_valid(guards):
    assert check_guards(*guards) == []


@pytest.mark.parametrize(
    ("guards", "problem"),
    [
        (("ok", "ok or n > 1", "else"), "overlap: 'ok' and 'ok or n > 1' are both true for n = "),
        (("n < 3", "n > 3"), "leave a gap: none is true for n = 3"),
        (("n <= 3", "n >= 3"), "overlap: 'n <= 3' and 'n >= 3' are both true for n = 3"),
        (("x < 0.5", "x > 0.5"), "leave a gap: none is true for x = 0.5"),
        (("colour == Colour::red",), "leave a gap: none is true for colour = green"),
        (('tool == "drill"',), "leave a gap: none is true for tool = another"),
        (("else", "else"), "contain 'else' 2 times"),
        (("ok", ""), "leave an edge without a guard"),
        (("n + 1", "else"), "are not all Boolean: 'n + 1'"),
        (("n", "else"), "are not all Boolean: 'n'"),
    ],
)
def test_faulty_guards_are_reported_with_example_values(guards, problem):
    assert any(problem in message for message in check_guards(*guards))


def test_an_undeclared_name_is_reported():
    assert "SM606: in 'g', 'speed' is not declared" in check_guards("speed > 3", "else")


def test_a_guard_that_is_no_expression_is_reported():
    (message,) = check_guards("when it is ready", "else")
    assert message.startswith("SM616: 'when it is ready' at 'd'")
