"""Handshakes of activities: who starts and abandons them, and what their contracts guarantee."""

import pytest
from reading_v2 import read

from refinement import run_all
from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis.decision import Options, decide

PICK = """
        action pick {
            first start then reach;
            action reach;
            then done;
        }"""


def compile_robot(members: str) -> Graph:
    """Return the graph of a part with some members."""
    items = "item def Go; item def Stop;"
    reading = read(f"package P {{ {items} part def Robot {{ {members} }} }}")
    run_all(reading.graph, reading.sink)
    return reading.graph


def describe(members: str) -> dict[str, str]:
    """Return the inputs of the handshake of each activity of a part with some members."""
    graph = compile_robot(members)
    handshakes = {game.component: game.handshake for game in graph.derived(TokenGraph)}
    return {
        name.removeprefix("P::Robot").lstrip("."): " ".join(
            filter(None, (h.start, h.stop, "first step" * h.is_started))
        )
        for name, h in handshakes.items()
    }


def in_busy(transition: str) -> str:
    """Return a state machine whose state Busy performs pick and is left by a transition."""
    return f"""{PICK}
        exhibit state Ctl {{
            entry; then Idle;
            state Idle;
            transition first Idle accept Go then Busy;
            state Busy {{ do pick; }}
            {transition}
        }}"""


def test_what_a_part_performs_starts_once():
    assert describe("perform " + PICK.strip()) == {"": "first step"}


def test_an_action_that_nothing_performs_is_a_service():
    assert describe(PICK) == {"pick": "start_pick"}


def test_a_state_that_waits_for_its_do_behaviour_never_stops_it():
    assert describe(in_busy("transition first Busy then Idle;")) == {"pick": "start_pick"}


def test_a_trigger_out_of_the_state_may_stop_its_do_behaviour():
    assert describe(in_busy("transition first Busy accept Stop then Idle;")) == {
        "pick": "start_pick stop_pick"
    }


@pytest.mark.parametrize("trigger", ["", "accept Stop "])
def test_the_contract_of_a_do_behaviour_can_be_satisfied(trigger):
    """Who abandons and starts it in each step does not let it end; the contract allows that."""
    graph = compile_robot(in_busy(f"transition first Busy {trigger}then Idle;"))
    (contract,) = (c for c in graph.derived(Contract) if c.component.endswith(".pick"))
    place = Place("model.sysml")
    assert decide(contract, lambda _: Subject("pick", place=place), Sink(), Options()).is_realizable


CALLER = """
        perform action cycle {
            first start;
            then perform pick;
            then done;
        }"""


def test_a_call_in_a_sequence_runs_to_its_end():
    assert describe(PICK + CALLER) == {"pick": "start_pick", "": "first step"}


FORKED = """
Activity pick "pick"
  Action work "work" subkind="opaque"
Activity a "a"
  Control start "" subkind="initial"
  Control split "" subkind="fork"
  Action call "call" subkind="call-behavior"
    -> calls pick
  Action wait "wait" subkind="opaque"
  Control last "" subkind="END"
  ControlFlow f1
    -> flow-source start
    -> flow-target split
  ControlFlow f2
    -> flow-source split
    -> flow-target call
  ControlFlow f3
    -> flow-source split
    -> flow-target wait
  ControlFlow f4
    -> flow-source wait
    -> flow-target last
"""


@pytest.mark.parametrize(("end", "stop"), [("final", "stop_pick"), ("flow-final", "")])
def test_only_an_activity_final_stops_the_call_in_another_branch(end, stop):
    graph = parse_text(FORKED.replace("END", end))
    run_all(graph, Sink())
    handshakes = {game.component: game.handshake for game in graph.derived(TokenGraph)}
    assert handshakes["pick"].stop == stop


def test_a_call_is_stopped_with_its_caller():
    load = "action load { first start; then perform pick; then done; }"
    machine = in_busy("transition first Busy accept Stop then Idle;").replace("do pick", "do load")
    assert describe(load + machine) == {
        "pick": "start_pick stop_pick",
        "load": "start_load stop_load",
    }


CALLS_ITSELF = "action pick { first start; then perform pick; then done; }"


def test_a_recursive_call_has_a_handshake():
    assert describe(CALLS_ITSELF) == {"pick": "start_pick"}


@pytest.mark.parametrize(
    ("members", "lines"),
    [
        (
            PICK,
            [
                "!running_pick",
                "running_pick' <-> start_pick & (!running_pick | finished_pick)"
                " | running_pick & !finished_pick",
                "finished_pick <-> running_pick & run_reach & done_reach",
                "!running_pick | finished_pick",
            ],
        ),
        (
            "perform " + PICK.strip(),
            [
                "running_pick",
                "running_pick' <-> running_pick & !finished_pick",
                "finished_pick <-> running_pick & run_reach & done_reach",
                "!running_pick | finished_pick",
            ],
        ),
    ],
)
def test_guarantees_about_start_and_end(members, lines):
    graph = compile_robot(members)
    (contract,) = graph.derived(Contract)
    origin = graph.derived(TokenGraph)[0].activity
    assert [
        print_formula(conjunct.formula)
        for conjunct in contract.guarantees
        if conjunct.origin == origin
    ] == lines


def list_running(members: str) -> list[str]:
    """Return the steps of the performed action of a part, by the outputs ``run_<step>``."""
    (contract,) = compile_robot(members).derived(Contract)
    names = (variable.name for variable in contract.variables)
    return [name for name in names if name.startswith("run_")]


def test_a_referential_action_without_order_is_not_performed():
    steps = (
        "ref action seen; ref accept Go; action a; action b; first start then a; first a then b;"
    )
    assert list_running(f"perform action work {{ {steps} }}") == ["run_a", "run_b"]


@pytest.mark.parametrize(
    "member",
    [
        "ref action seen;",
        "attribute force;",
        "item seam;",
        "part tool;",
        "port plug;",
        "assert constraint { true }",
        "requirement quality;",
        "connection cable;",
        "flow seams;",
        "attribute y : Boolean; bind y = y;",
        "action def Tack;",
        "alias other for weld;",
    ],
)
def test_an_action_without_steps_ends_when_the_environment_ends_it(member):
    graph = compile_robot(f"perform action work {{ action weld {{ {member} }} }}")
    (contract,) = graph.derived(Contract)
    assert "done_weld" in [variable.name for variable in contract.variables]
