"""The pass ``overlay``: operations, behaviours, calls, values and allocations of blocks."""

import pytest
from overlay_samples import GATE, GETS_IN, HANDLED, PLANT, apply_overlays, find_element
from pass_runs import list_codes

from sysmlc.ir import Edge, Kind
from sysmlc.ir.query import component_name


def test_an_operation_has_its_parameters_in_order():
    text = GATE + (
        "    operations:\n      readId:\n        description: Reads.\n        parameters:\n"
        "        - {name: tag, type: Plant/Tag}\n"
        "        - {name: id, type: String, direction: return}\n"
    )
    graph, sink = apply_overlays(text)
    assert list_codes(sink) == []
    operation = find_element(graph, "readId")
    assert graph.owner(operation) is graph["gate"]
    owned = graph.owned(operation)
    assert [(element.name, element.attrs.get("direction")) for element in owned] == [
        ("", None),
        ("tag", None),
        ("id", "return"),
    ]
    types = [graph.target(parameter, Edge.TYPED_BY) for parameter in owned[1:]]
    assert types == [graph["tag"], find_element(graph, "String")]


def test_an_operation_without_parameters_takes_those_of_its_method():
    text = GATE + "    operations:\n      handle: {method: gate.uml#Gate::Handle}\n"
    text += GETS_IN
    graph, sink = apply_overlays(text, until="behaviours")
    assert "SM404" not in list_codes(sink)
    operation = find_element(graph, "handle", Kind.OPERATION)
    assert graph.targets(operation, Edge.METHOD) == [graph["handle"]]
    assert [parameter.name for parameter in graph.owned(operation)] == ["pallet"]
    assert graph.owner(graph["handle"]) is graph["gate"]


def test_a_behaviour_becomes_the_classifier_behaviour_of_the_block():
    graph, sink = apply_overlays(HANDLED + GETS_IN)
    assert list_codes(sink) == []
    assert graph.targets(graph["gate"], Edge.CLASSIFIER_BEHAVIOR) == [graph["handle"]]
    assert component_name(graph, graph["handle"]) == "Plant::Gate"


def test_a_state_machine_may_be_the_classifier_behaviour():
    machine = 'Package m "M" @gate.uml:9\n  StateMachine states "States" @gate.uml:10\n'
    text = GATE + "    behavior: gate.uml#M::States\n"
    graph, sink = apply_overlays(text, model=PLANT + machine)
    assert list_codes(sink) == []
    assert graph.targets(graph["gate"], Edge.CLASSIFIER_BEHAVIOR) == [graph["states"]]


def test_a_value_that_the_block_inherits_is_reported():
    model = PLANT + 'Class base "Base" role="block"\n  Property base.v "v" role="value"\n'
    text = "overlay: 1\nblocks:\n  Plant/Switch: {specializes: [Base], values: {v: }}\n"
    (diagnostic,) = apply_overlays(text, model=model)[1]
    assert diagnostic.rule.code == "SM334"
    assert diagnostic.message == "block 'Plant::Switch' has 'v' already, inherited from 'Base'"


ENUMERATION = 'Enumeration e "Bay"\n  EnumerationLiteral e.f "free"\n'


@pytest.mark.parametrize(
    ("type_", "valid", "invalid"),
    [
        ("Boolean", "true", "1"),
        ("Integer", "7", "7.5"),
        ("Integer", "0", "true"),
        ("Real", "7", '"7"'),
        ("String", '"7"', "7"),
        ("Bay", "free", "fre"),
    ],
)
def test_a_default_that_is_no_value_of_its_type_is_reported(type_, valid, invalid):
    for default, expected in ((valid, []), (invalid, ["SM637"])):
        value = f"{{type: {type_}, default: {default}}}"
        text = f"overlay: 1\nblocks:\n  Plant/Switch: {{values: {{v: {value}}}}}\n"
        assert list_codes(apply_overlays(text, model=PLANT + ENUMERATION)[1]) == expected


def test_a_call_may_call_an_operation_of_a_part():
    graph, sink = apply_overlays(
        HANDLED + "  Plant/Switch: {operations: {getIn: }}\n", until="behaviours"
    )
    assert "SM400" not in list_codes(sink)
    assert graph.targets(graph["call"], Edge.CALLS) == [
        find_element(graph, "getIn", Kind.OPERATION)
    ]


def test_a_call_may_call_an_operation_that_a_part_inherits():
    text = (
        HANDLED
        + GETS_IN.replace("Switch", "Stopper")
        + "  Plant/Switch: {specializes: [Plant/Stopper]}\n"
    )
    graph, sink = apply_overlays(text)
    assert list_codes(sink) == []
    assert graph.targets(graph["call"], Edge.CALLS) == [
        find_element(graph, "getIn", Kind.OPERATION)
    ]


def test_a_call_without_an_operation_is_reported_once_with_the_nearest_name():
    _, sink = apply_overlays(
        HANDLED + "  Plant/Switch: {operations: {getInn: }}\n", until="behaviours"
    )
    (error,) = [diagnostic for diagnostic in sink if diagnostic.severity == "error"]
    assert error.message == (
        "action 'getIn' calls no operation: neither 'Plant::Gate' nor a part of it has one of "
        "this name"
    )
    assert error.help.endswith("did you mean 'getInn'?")
    assert "SM400" not in list_codes(sink)


def test_a_call_in_the_overlay_takes_precedence_over_equal_names():
    text = HANDLED + (
        "    calls: {getIn: sw/open}\n  Plant/Switch: {operations: {open: , getIn: }}\n"
    )
    graph, sink = apply_overlays(text)
    assert list_codes(sink) == []
    (operation,) = graph.targets(graph["call"], Edge.CALLS)
    assert graph.qualified_name(operation) == "Plant::Switch::open"


def test_a_value_becomes_a_property_of_the_block():
    text = GATE + "    values: {bayIsFree: {type: Boolean, default: true}}\n"
    graph, sink = apply_overlays(text)
    assert list_codes(sink) == []
    value = find_element(graph, "bayIsFree")
    assert (value.role, value.attrs["default"]) == ("value", True)
    assert graph.owner(value) is graph["gate"]


def test_an_allocation_becomes_an_edge():
    text = "overlay: 1\nallocations:\n- {from: Gate/Handle, to: Plant/Gate/sw}\n"
    graph, sink = apply_overlays(text, until="classify")
    assert list_codes(sink) == []
    assert graph.targets(graph["handle"], Edge.ALLOCATED_TO) == [graph["sw"]]
