"""Directions and aggregations that UML does not have are reported and removed (SM220)."""

import pytest
from pass_runs import run_until


@pytest.mark.parametrize(
    ("element", "attribute"),
    [
        ('Parameter x "x" direction="Sideways"', "direction"),
        ('Port x "x" direction="sideways"', "direction"),
        ('Property x "x" aggregation="weird"', "aggregation"),
    ],
)
def test_an_unknown_literal_is_reported_and_removed(element, attribute):
    graph, (diagnostic,) = run_until(f"{element}\n", "classify")
    assert (diagnostic.rule.code, diagnostic.severity) == ("SM220", "warning")
    assert diagnostic.message.startswith(f"the {attribute} of 'x' is ")
    assert attribute not in graph["x"].attrs


def test_a_flow_property_with_an_unknown_direction_has_the_default():
    flow = (
        'Property x "x"\n  Application a stereotype="FlowProperty" tag.direction="sideways" '
        'namespace="http://www.omg.org/spec/SysML/20120401/SysML"\n    -> subject x\n'
    )
    graph, (diagnostic,) = run_until(flow, "classify")
    assert (diagnostic.rule.code, graph["x"].attrs["direction"]) == ("SM220", "inout")


@pytest.mark.parametrize("value", ["in", "inout", "out", "return"])
def test_valid_literals_are_preserved(value):
    graph, sink = run_until(f'Parameter x "x" direction="{value}"\n', "classify")
    assert (list(sink), graph["x"].attrs["direction"]) == ([], value)


FLOW_PORT = (
    'DataType t "T"\nPort x "x"\n  -> typed-by t\n'
    '  Application a stereotype="FlowPort" tag.direction="{}"'
    ' namespace="http://www.omg.org/spec/SysML/20120401/SysML"\n    -> subject x\n'
)


@pytest.mark.parametrize("value", ["sideways", "return", "In"])
def test_a_flow_port_with_an_unknown_direction_has_the_default(value):
    graph, (diagnostic,) = run_until(FLOW_PORT.format(value), "ports")
    assert (diagnostic.rule.code, diagnostic.subject.id) == ("SM220", "x")
    assert diagnostic.message.endswith(f"is '{value}', which is not one of in, out, inout")
    assert graph["x"].attrs["direction"] == "inout"


@pytest.mark.parametrize("value", ["in", "out", "inout"])
def test_a_flow_port_has_the_direction_of_its_stereotype(value):
    graph, sink = run_until(FLOW_PORT.format(value), "ports")
    assert (list(sink), graph["x"].attrs["direction"]) == ([], value)
