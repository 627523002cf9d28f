"""Who else writes a feature is found wherever it stands: then no contract says that it keeps."""

import pytest
from reading_v2 import read

from sysmlc.diagnostics import Sink, catalogue
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text
from sysmlc.logic.contract import Contract, Owner
from sysmlc.passes import pipeline

pipeline.load("contracts")

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


def plant(base="", own="", step="", beside="", elsewhere="") -> tuple[Graph, Sink]:
    text = PLANT.format(base=base, own=own, step=step, beside=beside, elsewhere=elsewhere)
    reading = read(text)
    pipeline.run(reading.graph, reading.sink, verify_each=True)
    return reading.graph, reading.sink


def told(sink: Sink, *codes: str) -> list[str]:
    return [one.message for one in sink if one.rule.code in (codes or ("SM544", "SM545", "SM546"))]


def owners(graph: Graph, name: str) -> set[Owner]:
    variables = (one for made in graph.derived(Contract) for one in made.variables)
    return {one.owner for one in variables if one.name == name}


def clear(name: str) -> str:
    return "action reset { " + CLEAR.format(name) + " }"


@pytest.mark.parametrize(
    "model",
    [
        {"elsewhere": f"part def Boss {{ part cell : Cell; {clear('cell.full')} }}"},
        {"elsewhere": f"part cell : Cell {{ attribute :>> full := true; {clear('full')} }}"},
        {"base": clear("full"), "own": "attribute :>> full := false;"},
        {"beside": f"part def Arm {{ {clear('full')} }} part arm : Arm;"},
        {"beside": clear("full")},
    ],
    ids=["through a part", "a redefinition", "a general", "a part inside", "beside it"],
)
def test_what_another_behaviour_writes_is_nobodys_own(model):
    graph, sink = plant(**model)
    assert any(
        one.startswith("the contract of 'work' treats 'full' as an input")
        and one.endswith("'clear' assigns it too")
        for one in told(sink)
    )
    assert owners(graph, "full") == {Owner.ENVIRONMENT}


def test_what_is_alone_in_writing_owns_it():
    graph, sink = plant()
    assert (told(sink), owners(graph, "full")) == ([], {Owner.SYSTEM})


def test_an_output_that_is_bound_to_a_feature_writes_it():
    reset = "action def Reset { inout x : Boolean; " + CLEAR.format("x") + " }"
    step = "then action reset : Reset { inout x = full; }"
    graph, sink = plant(step=step, elsewhere=reset)
    assert told(sink) == [
        "the contract of 'work' treats 'full' as an input although action 'fill' and action "
        "'reset' assign it: the value that it gets is not known"
    ]
    assert owners(graph, "full") == {Owner.ENVIRONMENT}


MACHINE = """state {name} {{
    entry; then a; state a; state b;
    transition first a accept when full then b;
    transition first b do action {{ assign full := {value}; }} then a;
}}"""


def test_machines_that_write_the_same_promise_nothing_of_it():
    other = "attribute other : Boolean; " + MACHINE.format(name="mode", value="false")
    graph, sink = plant(beside=other)
    assert told(sink) == [
        "the contract of 'work' treats 'full' as an input although action 'fill' assigns it: "
        "'mode' assigns it too",
        "'full' is also assigned by 'fill', so the contract of 'mode' treats it as an input "
        "and shows 'full := false' as output 'full_false'",
    ]
    assert owners(graph, "full") == {Owner.ENVIRONMENT}


def test_the_rule_of_machines_reports_its_wrong_model_and_not_its_right_one():
    rule = catalogue()["SM546"]
    for text, expected in ((rule.read_page().wrong, True), (rule.read_page().right, False)):
        graph, sink = parse_text(text), Sink()
        pipeline.run(graph, sink, verify_each=True)
        assert ("SM546" in [one.rule.code for one in sink]) is expected


@pytest.mark.parametrize(
    ("action", "reason"),
    [
        ("part def Boss { part cell : Cell; ACTION }", "cell.full"),
        ("part robot { attribute full : Boolean; part def Arm { ACTION } }", "full"),
    ],
)
def test_what_belongs_to_another_object_is_told_and_is_no_unknown_name(action, reason):
    _, sink = plant(elsewhere=action.replace("ACTION", clear(reason)))
    assert (
        "the contract of 'reset' treats 'full' as an input although action 'clear' assigns it: "
        "it belongs to another object"
    ) in told(sink)
    assert told(sink, "SM545") == []


def test_a_feature_by_the_name_of_its_owner_is_the_same_feature():
    robot = "part robot { attribute busy : Boolean := false; ACTION }"
    graph, sink = plant(elsewhere=robot.replace("ACTION", clear("robot.busy")))
    assert (told(sink), owners(graph, "busy")) == ([], {Owner.SYSTEM})


def test_what_an_activity_inherits_is_known():
    inherited = "action def Counting { attribute count : Boolean := false; }"
    work = "part def Other { action add : Counting { ACTION } }".replace(
        "ACTION", CLEAR.format("count")
    )
    _, sink = plant(elsewhere=f"{inherited} {work}")
    assert told(sink) == []


def test_help_fits_the_reason():
    _, sink = plant(beside=clear("full"))
    helps = {one.help for one in sink if one.rule.code == "SM544"}
    assert helps == {"let only one behaviour assign it, or specify its value in a requirement"}
