"""Constraint properties, parameters and bindings, in the forms of Papyrus and MagicDraw."""

import pytest
from pass_runs import list_codes, list_diagnostics, run_until

from sysmlc.ir import Edge

LAW = (
    'Class law "Law" role="constraint block"\n'
    '  {kind} law.f "f"\n'
    '  {kind} law.m "m"\n'
    'Class crane "Crane" role="block"\n'
    '  Property crane.mass "mass" role="value"\n'
    '  Property crane.law "law" aggregation="composite"\n'
    "    -> typed-by law\n"
    '  Connector k "k"\n'
    "    -> end k.1 k.2\n"
    "    ConnectorEnd k.1\n      -> role crane.mass\n"
    "    ConnectorEnd k.2\n      -> path crane.law\n      -> role law.m\n"
)


@pytest.mark.parametrize("kind", ["Property", "Port"])
def test_a_connector_at_a_parameter_binds_even_without_a_stereotype(kind):
    graph, sink = run_until(LAW.format(kind=kind), "flows")
    assert graph["law.m"].role == "constraint parameter"
    assert graph["crane.law"].role == "constraint property"
    assert graph["k"].role == "binding connector"
    assert graph.targets(graph["crane.mass"], Edge.BINDS) == [graph["law.m"]]
    assert list_diagnostics(sink) == [
        "SM218 info: parameters of constraint 'Crane::law' are not bound: 'f'"
    ]


def test_a_connector_between_parts_binds_nothing():
    text = (
        'Class a "A" role="block"\n'
        '  Property one "one" role="part"\n  Property two "two" role="part"\n'
        '  Connector k "k"\n    -> end k.1 k.2\n'
        "    ConnectorEnd k.1\n      -> role one\n    ConnectorEnd k.2\n      -> role two\n"
    )
    graph, _ = run_until(text, "classify")
    assert graph["k"].role == ""
    assert list(graph.edges(Edge.BINDS)) == []


def test_a_binding_binds_the_parameters_of_one_usage_only():
    text = LAW.format(kind="Property") + ('  Property crane.law2 "law2"\n    -> typed-by law\n')
    lines = [line for line in list_diagnostics(run_until(text, "classify")[1]) if "law2" in line]
    assert lines == ["SM218 info: parameters of constraint 'Crane::law2' are not bound: 'f', 'm'"]
    text = text.replace('"law2"', '"law2" default="law"')
    lines = [line for line in list_diagnostics(run_until(text, "classify")[1]) if "law2" in line]
    assert lines == []


def test_units_of_the_same_name_are_the_same_unit():
    text = (
        'DataType a "A" role="value type"\n  -> references a.u\n  Unit a.u "kg"\n'
        'DataType b "B" role="value type"\n  -> references b.u\n  Unit b.u "kg"\n'
        'Class c "C" role="block"\n'
        '  Property x "x" role="value"\n    -> typed-by a\n    -> binds y\n'
        '  Property y "y" role="value"\n    -> typed-by b\n'
    )
    assert "SM219" not in list_codes(run_until(text, "classify")[1])
    assert "SM219" in list_codes(run_until(text.replace('b.u "kg"', 'b.u "g"'), "classify")[1])
