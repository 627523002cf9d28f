"""Conjugation through nested ports, flow ports of SysML 1.1, ends of any depth."""

import pytest
from pass_runs import list_codes, run_until

from sysmlc.ir.query import end_direction, flow_directions, is_boundary

SYSML = "http://www.omg.org/spec/SysML/20120401/SysML"


def applied(stereotype: str, id: str, given: str = "", indent: int = 4) -> str:
    space = " " * indent
    return (
        f'{space}Application {id}.a stereotype="{stereotype}" namespace="{SYSML}" {given}\n'
        f"{space}  -> subject {id}\n"
    )


# -- flow ports of SysML 1.1 -------------------------------------------------------------------


SPECIFICATION = (
    'Interface spec "Spec"\n'
    + applied("FlowSpecification", "spec", indent=2)
    + '  Property spec.in "order"\n'
    + applied("FlowProperty", "spec.in", 'tag.direction="in"')
    + 'DataType pallet "Pallet"\n'
)


@pytest.mark.parametrize(
    ("type_", "given", "expected"),
    [
        ("pallet", 'tag.direction="out"', "out"),
        ("pallet", 'tag.direction="out" tag.isAtomic="true"', "out"),
        ("pallet", "", "inout"),
        ("pallet", 'tag.isConjugated="true" tag.direction="in"', "in"),
        ("spec", 'tag.isAtomic="false"', "in"),
        ("spec", 'tag.isConjugated="true"', "out"),
        ("spec", 'tag.IsConjugated="true"', "out"),
        ("spec", 'tag.isConjugated="false"', "in"),
    ],
)
def test_the_direction_of_a_flow_port(type_, given, expected):
    port = f'Class gate "Gate"\n  Port port "port"\n    -> typed-by {type_}\n'
    graph, _ = run_until(SPECIFICATION + port + applied("FlowPort", "port", given), "ports")
    assert graph["port"].role == "flow port"
    assert graph["port"].attrs["direction"] == expected


# -- conjugation -------------------------------------------------------------------------------


TYPES = (
    'Class data "Data"\n'
    '  FlowProperty data.id "id" direction="in"\n'
    '  FlowProperty data.ok "ok" direction="out"\n'
    'Class door "Door"\n'
    '  Port door.data "data"\n    -> typed-by one\n'
    'Class one "One"\n  FlowProperty one.x "x" direction="in"\n'
)


@pytest.mark.parametrize("conjugated", [False, True])
def test_each_flow_property_is_turned_round_at_a_conjugated_port(conjugated):
    attribute = " conjugated=true" * conjugated
    port = f'Class gate "Gate"\n  Port port "port"{attribute}\n    -> typed-by data\n'
    graph, _ = run_until(TYPES + port, "ports")
    shown = {one.name: direction for one, direction in flow_directions(graph, graph["port"])}
    expected = {"id": "out", "ok": "in"} if conjugated else {"id": "in", "ok": "out"}
    assert shown == expected


@pytest.mark.parametrize(
    ("outer", "inner", "expected"),
    [
        ("", "", "in"),
        (" conjugated=true", "", "out"),
        ("", " conjugated=true", "out"),
        (" conjugated=true", " conjugated=true", "in"),
    ],
)
def test_a_conjugated_port_turns_round_what_is_nested_in_it(outer, inner, expected):
    model = TYPES.replace('"data"\n    -> typed-by one', f'"data"{inner}\n    -> typed-by one')
    model += (
        f'Class gate "Gate"\n  Port port "port"{outer}\n    -> typed-by door\n'
        '  Connector k "k"\n    -> end k.1\n    ConnectorEnd k.1\n'
        "      -> path port\n      -> role door.data\n"
    )
    graph, _ = run_until(model, "ports")
    assert end_direction(graph, graph["k.1"]) == expected
    assert is_boundary(graph, graph["k.1"])


def connected(outer: str) -> str:
    """Two equal parts; the nested port of one is turned round by ``outer`` on its port."""
    return TYPES + (
        'Class left "Left" role="block"\n  Port left.p "p"\n    -> typed-by door\n'
        f'Class right "Right" role="block"\n  Port right.p "p"{outer}\n    -> typed-by door\n'
        'Class line "Line" role="block"\n'
        '  Property l "l" aggregation="composite"\n    -> typed-by left\n'
        '  Property r "r" aggregation="composite"\n    -> typed-by right\n'
        '  Connector k "k"\n    -> end k.1 k.2\n'
        "    ConnectorEnd k.1\n      -> path l left.p\n      -> role door.data\n"
        "    ConnectorEnd k.2\n      -> path r right.p\n      -> role door.data\n"
    )


def test_nested_ports_connect_when_conjugation_makes_them_fit():
    assert "SM315" not in list_codes(run_until(connected(" conjugated=true"), "flows")[1])
    assert "SM315" in list_codes(run_until(connected(""), "flows")[1])


def test_a_part_on_the_way_makes_an_end_inner():
    graph, _ = run_until(connected(""), "flows")
    assert not is_boundary(graph, graph["k.1"])
    assert graph.targets(graph["k.1"], "path") == [graph["l"], graph["left.p"]]


# -- the type of a conjugated port ---------------------------------------------------------------


@pytest.mark.parametrize("name", ["~InterfaceBlock", "ConjugatedInterfaceBlock"])
def test_an_empty_conjugated_interface_block_has_the_directions_of_its_original(name):
    model = (
        'Class one "One"\n  FlowProperty one.x "x" direction="in"\n'
        'Class two "~One"\n'
        + applied(name, "two", 'tag.original="one"', indent=2)
        + 'Class gate "Gate"\n  Port port "port"\n    -> typed-by two\n'
    )
    graph, _ = run_until(model, "ports")
    assert graph["port"].attrs["direction"] == "out"
    assert graph["two"].role == "interface block"
