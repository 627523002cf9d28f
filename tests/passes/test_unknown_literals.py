"""Directions and aggregations that UML does not have: reported, and not in the graph any more."""

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
def test_what_is_no_literal_counts_as_none(element, attribute):
    graph, (found,) = run_until(f"{element}\n", "classify")
    assert (found.rule.code, found.severity) == ("SM220", "warning")
    assert found.message.startswith(f"the {attribute} of 'x' is ")
    assert attribute not in graph["x"].attrs


def test_a_flow_property_has_its_default_instead():
    flow = (
        'Property x "x"\n  Application a stereotype="FlowProperty" tag.direction="sideways" '
        'namespace="http://www.omg.org/spec/SysML/20120401/SysML"\n    -> subject x\n'
    )
    graph, (found,) = run_until(flow, "classify")
    assert (found.rule.code, graph["x"].attrs["direction"]) == ("SM220", "inout")


@pytest.mark.parametrize("value", ["in", "inout", "out", "return"])
def test_literals_stay(value):
    graph, sink = run_until(f'Parameter x "x" direction="{value}"\n', "classify")
    assert (list(sink), graph["x"].attrs["direction"]) == ([], value)


FLOW_PORT = (
    'DataType t "T"\nPort x "x"\n  -> typed-by t\n'
    '  Application a stereotype="FlowPort" tag.direction="{}"'
    ' namespace="http://www.omg.org/spec/SysML/20120401/SysML"\n    -> subject x\n'
)


@pytest.mark.parametrize("value", ["sideways", "return", "In"])
def test_a_flow_port_with_a_direction_that_does_not_exist_has_the_default(value):
    graph, (found,) = run_until(FLOW_PORT.format(value), "ports")
    assert (found.rule.code, found.subject.id) == ("SM220", "x")
    assert found.message.endswith(f"is '{value}', which is not one of in, out, inout")
    assert graph["x"].attrs["direction"] == "inout"


@pytest.mark.parametrize("value", ["in", "out", "inout"])
def test_a_flow_port_has_the_direction_that_its_stereotype_gives(value):
    graph, sink = run_until(FLOW_PORT.format(value), "ports")
    assert (list(sink), graph["x"].attrs["direction"]) == ([], value)
