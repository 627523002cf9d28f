"""A feature with several writers, wherever they are, is an input of every contract."""

import pytest
from reading_v2 import read

from refinement import run_all
from sysmlc.analyses import analysis
from sysmlc.diagnostics import Sink, catalogue
from sysmlc.ir import Graph
from sysmlc.logic.contract import Contract, Owner

analysis.load("contracts")

PLANT = """
package Plant {{
    private import ScalarValues::*;
    part def Base {{ attribute full : Boolean; {base} }}
    part def Cell :> Base {{
        {own}
        action work {{
            first start; then again; merge again;
            then action fill {{ assign full := true; }}
            {step}
            then enough; decide enough; if full then done; else again;
        }}
        {beside}
    }}
    {elsewhere}
}}
"""
CLEAR = "first start; then action clear {{ assign {} := false; }} then done;"


def write_plant(base="", actions="", step="", beside="", elsewhere="") -> tuple[Graph, Sink]:
    text = PLANT.format(base=base, own=actions, step=step, beside=beside, elsewhere=elsewhere)
    reading = read(text)
    run_all(reading.graph, reading.sink, verify_each=True)
    return reading.graph, reading.sink


def list_messages(sink: Sink, *codes: str) -> list[str]:
    return [
        diagnostic.message
        for diagnostic in sink
        if diagnostic.rule.code in (codes or ("SM544", "SM545", "SM546"))
    ]


def list_owners(graph: Graph, name: str) -> set[Owner]:
    variables = (
        variable for contract in graph.derived(Contract) for variable in contract.variables
    )
    return {variable.owner for variable in variables if variable.name == name}


def without_text(name: str) -> str:
    return "action reset { " + CLEAR.format(name) + " }"


@pytest.mark.parametrize(
    "model",
    [
        {"elsewhere": f"part def Boss {{ part cell : Cell; {without_text('cell.full')} }}"},
        {"elsewhere": f"part cell : Cell {{ attribute :>> full := true; {without_text('full')} }}"},
        {"base": without_text("full"), "actions": "attribute :>> full := false;"},
        {"beside": f"part def Arm {{ {without_text('full')} }} part arm : Arm;"},
        {"beside": without_text("full")},
    ],
    ids=["through a part", "a redefinition", "a general", "a part inside", "beside it"],
)
def test_what_another_behaviour_writes_is_nobodys_own(model):
    graph, sink = write_plant(**model)
    assert any(
        diagnostic.startswith("the contract of 'work' treats 'full' as an input")
        and diagnostic.endswith("'clear' assigns it too")
        for diagnostic in list_messages(sink)
    )
    assert list_owners(graph, "full") == {Owner.ENVIRONMENT}


def test_what_is_alone_in_writing_owns_it():
    graph, sink = write_plant()
    assert (list_messages(sink), list_owners(graph, "full")) == ([], {Owner.SYSTEM})


def test_an_output_that_is_bound_to_a_feature_writes_it():
    reset = "action def Reset { inout x : Boolean; " + CLEAR.format("x") + " }"
    step = "then action reset : Reset { inout x = full; }"
    graph, sink = write_plant(step=step, elsewhere=reset)
    assert set(list_messages(sink)) == {
        "the contract of 'work' treats 'full' as an input although action 'fill' and action "
        "'reset' assign it: the contract does not follow the assigned value"
    }
    assert list_owners(graph, "full") == {Owner.ENVIRONMENT}


MACHINE = """state {name} {{
    entry; then a; state a; state b;
    transition first a accept when full then b;
    transition first b do action {{ assign full := {value}; }} then a;
}}"""


def test_machines_that_write_the_same_promise_nothing_of_it():
    other_machine = "attribute other : Boolean; " + MACHINE.format(name="mode", value="false")
    graph, sink = write_plant(beside=other_machine)
    assert list_messages(sink) == [
        "the contract of 'work' treats 'full' as an input although action 'fill' assigns it: "
        "'mode' assigns it too",
        "'full' is also assigned by 'fill', so the contract of 'mode' treats it as an input "
        "and shows 'full := false' as output 'full_false'",
    ]
    assert list_owners(graph, "full") == {Owner.ENVIRONMENT}


def test_machines_of_one_name_are_told_apart():
    machine = MACHINE.format(name="mode", value="true")
    text = (
        "part def P {{ attribute full : ScalarValues::Boolean; part a {{ {0} }} part b {{ {0} }} }}"
    )
    reading = read(text.format(machine))
    run_all(reading.graph, reading.sink, verify_each=True)
    assert list_messages(reading.sink) == [
        f"'full' is also assigned by 'P::{other}::mode', so the contract of 'mode' treats it as an "
        "input and shows 'full := true' as output 'full_true'"
        for other in ("b", "a")
    ]


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("full : Boolean", "full : Integer", "Plant::Base::full"),
        ("full : Boolean", "full : Boolean[0..4]", "Plant::Base::full"),
        ("{ assign full := true; }", "{ assign full := measure(); }", "Plant::Cell::work::fill"),
        ("{ assign full := true; }", "{ assign full := true; }", "Plant::Cell::work::fill"),
    ],
)
def test_the_finding_is_where_the_reason_is(old, new, place):
    text = PLANT.format(base="", own="", step="", beside=without_text("full"), elsewhere="")
    reading = read(text.replace(old, new))
    run_all(reading.graph, reading.sink, verify_each=True)
    names = [d.subject.name for d in reading.sink if d.rule.code == "SM544"]
    assert place in names


def test_the_rule_of_machines_reports_its_wrong_model_and_not_its_right_one():
    rule = catalogue()["SM546"]
    for text, expected in ((rule.read_page().wrong, True), (rule.read_page().right, False)):
        reading = read(text)
        run_all(reading.graph, reading.sink, verify_each=True)
        assert ("SM546" in [diagnostic.rule.code for diagnostic in reading.sink]) is expected


@pytest.mark.parametrize(
    ("action", "reason"),
    [
        ("part def Boss { part cell : Cell; ACTION }", "cell.full"),
        ("part robot { attribute full : Boolean; part def Arm { ACTION } }", "full"),
    ],
)
def test_a_feature_of_another_object_is_reported_but_not_as_an_unknown_name(action, reason):
    _, sink = write_plant(elsewhere=action.replace("ACTION", without_text(reason)))
    assert (
        "the contract of 'reset' treats 'full' as an input although action 'clear' assigns it: "
        "it belongs to another object"
    ) in list_messages(sink)
    assert list_messages(sink, "SM545") == []


def test_a_feature_by_the_name_of_its_owner_is_the_same_feature():
    robot = "part robot { attribute busy : Boolean := false; ACTION }"
    graph, sink = write_plant(elsewhere=robot.replace("ACTION", without_text("robot.busy")))
    assert (list_messages(sink), list_owners(graph, "busy")) == ([], {Owner.SYSTEM})


def test_what_an_activity_inherits_is_known():
    inherited = "action def Counting { attribute count : Boolean := false; }"
    work = "part def Other { action add : Counting { ACTION } }".replace(
        "ACTION", CLEAR.format("count")
    )
    _, sink = write_plant(elsewhere=f"{inherited} {work}")
    assert list_messages(sink) == []


def test_help_fits_the_reason():
    _, sink = write_plant(beside=without_text("full"))
    helps = {diagnostic.help for diagnostic in sink if diagnostic.rule.code == "SM544"}
    assert helps == {"let only one behaviour assign it, or specify its value in a requirement"}
