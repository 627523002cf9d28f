"""Scenarios of blocks with everything that they perform, call and contain."""

from itertools import product
from random import Random

import pytest

from contract_oracle import list_models
from sysmlc import compile_model
from sysmlc.diagnostics import Sink
from sysmlc.logic import evaluate
from sysmlc.logic.contract import Class, Owner
from sysmlc.logic.domains import values
from sysmlc.simulation import run_scenarios
from sysmlc.simulation.components import open_component
from sysmlc.sources import Source

CELL = """package P {
private import ScalarValues::*;
item def Go; item def Halt;
part def Cell {
    attribute gripped : Boolean := false;
    attribute held : Boolean := false;
    action pick {
        first start then close;
        action close;
        then grip;
        action grip assign gripped := true;
        then done;
    }
    exhibit state M {
        entry; then Idle;
        state Idle;
        transition first Idle accept Go then Busy;
        state Busy { do pick; }
        transition first Busy accept Halt then Idle;
        transition first Busy if gripped do assign held := gripped then Full;
        transition first Busy then Idle;
        state Full;
    }
}
}
"""


@pytest.fixture
def play(tmp_path):
    """Return a function that plays a scenario of a model and returns the result."""

    def run(model, scenario):
        path = tmp_path / "model.sysml"
        path.write_text(model, "utf-8")
        sink = Sink()
        source = Source("s.yaml", scenario.encode())
        report = run_scenarios(compile_model(path).graph, source, sink)
        assert list(sink) == []
        return report

    return run


def test_a_state_waits_for_the_end_of_the_activity_that_it_performs(play):
    scenario = """component: P::Cell
steps:
  - inputs: {event: Go}
    expect: {state: Idle, run_pick: false}
  - expect: {state: Busy, run_pick: true, pick_run_close: true}
  - inputs: {pick_done_close: true}
    expect: {pick_run_close: true, pick_run_grip: false, gripped: false}
  - expect: {pick_run_close: false, pick_run_grip: true, run_pick: true, state: Busy}
  - expect: {state: Full, gripped: true, held: true, run_pick: false}
"""
    # The guard reads the last assignment, so that both completion transitions are enabled.
    assert play(CELL, scenario).passed
    assert not play(CELL.replace("if gripped", "if not gripped"), scenario).passed
    idle = scenario.replace("state: Full, gripped: true, held: true", "state: Idle, gripped: true")
    assert play(CELL, idle).passed


def test_an_effect_reads_what_the_do_behaviour_assigns_in_its_last_step(play):
    model = CELL.replace("if gripped do", "do").replace("transition first Busy then Idle;", "")
    scenario = """component: Cell
steps:
  - inputs: {event: Go}
  - inputs: {pick_done_close: true}
  - expect: {pick_run_grip: true, held: false}
  - expect: {state: Full, gripped: true, held: true}
"""
    assert play(model, scenario).passed


def test_leaving_a_state_stops_what_it_performs(play):
    scenario = """component: Cell
steps:
  - inputs: {event: Go}
  - expect: {run_pick: true}
  - inputs: {event: Halt}
    expect: {pick_run_close: true}
  - inputs: {pick_done_close: true}
    expect: {state: Idle, run_pick: false, pick_run_close: false}
  - repeat: 3
    expect: {pick_run_grip: false, gripped: false}
"""
    assert play(CELL, scenario).passed


def test_what_a_part_performs_runs_once(play):
    model = """package P {
private import ScalarValues::*;
part def Line {
    attribute x : Boolean := false;
    perform action one { first start; then action set assign x := true; then done; }
    perform action two { first start; then action wait; then done; }
}
}
"""
    scenario = """component: Line
steps:
  - inputs: {two_done_wait: true}
    expect: {run_one: true, run_set: true, run_two: true, two_run_wait: true}
  - repeat: 4
    expect: {x: true, run_one: false, run_two: false}
"""
    assert play(model, scenario).passed


LIFT = """package P {
private import ScalarValues::*;
part def Lift {
    attribute goal : Boolean := true;
    attribute height : Boolean := false;
    action move {
        in attribute target : Boolean;
        out attribute reached : Boolean := false;
        first start then drive;
        action drive;
        then arrive;
        action arrive assign reached := target;
        then done;
    }
    perform action job {
        first start then both;
        fork both;
        first both then up;
        first both then change;
        perform action up references move {
            in attribute :>> target := goal;
            out attribute :>> reached = height;
        }
        first up then sync;
        action change assign goal := false;
        first change then sync;
        join sync;
        first sync then done;
    }
}
}
"""


def test_an_argument_is_taken_at_the_start_and_an_output_written_at_the_end(play):
    scenario = """component: P::Lift
steps:
  - expect: {run_job: true, run_up: true, run_change: true, goal: true, up_target: true}
  - inputs: {up_done_drive: true}
    expect: {up_run_drive: true, goal: false, up_target: true}
  - expect: {up_run_arrive: true, height: false, run_up: true}
  - expect: {run_up: false, height: true}
"""
    assert play(LIFT, scenario).passed


def test_a_bound_argument_follows_the_feature(play):
    scenario = """component: P::Lift
steps:
  - expect: {run_change: true, up_target: true}
  - inputs: {up_done_drive: true}
    expect: {up_target: false}
  - expect: {up_run_arrive: true}
  - expect: {run_up: false, height: false}
"""
    assert play(LIFT.replace("target := goal", "target = goal"), scenario).passed


def test_an_output_without_value_may_have_any_value(play):
    model = LIFT.replace("reached : Boolean := false", "reached : Boolean")
    model = model.replace("assign reached := target", "")
    steps = "steps:\n  - repeat: 3\n  - inputs: {up_done_drive: true}\n  - {}\n"
    steps += "  - inputs: {up_done_arrive: true}\n  - expect: {run_up: false, height: %s}\n"
    for height in ("true", "false"):
        assert play(model, f"component: Lift\n{steps % height}").passed


SORTER = """package P {
item def Go; item def Piece; item def Scrap;
port def Chute { out item piece : Piece; }
port def Bin { out item scrap : Scrap; }
part def Line {
    part a {
        port outlet : Chute;
        exhibit state M {
            entry; then Ready;
            state Ready;
            transition first Ready accept Go do send new Piece() via outlet then Sent;
            state Sent;
        }
    }
    part b {
        port outlet : Bin;
        exhibit state M {
            entry; then Ready;
            state Ready;
            transition first Ready accept Go do send new Scrap() via outlet then Sent;
            state Sent;
        }
    }
    part c {
        port inlet : ~Chute;
        port bin : ~Bin;
        exhibit state M {
            entry; then Empty;
            state Empty;
            transition first Empty accept Piece via inlet then Full;
            transition first Empty accept Scrap via bin then Dirty;
            state Full;
            state Dirty;
        }
    }
    connect a.outlet to c.inlet;
    connect b.outlet to c.bin;
}
}
"""


def test_a_signal_is_the_event_of_the_receiver_in_the_step_after_the_reaction(play):
    scenario = """component: P::Line
steps:
  - inputs: {a_event: Go}
    expect: {c_event: none}
  - expect: {a_state: Sent, c_event: Piece, c_state: Empty}
  - expect: {c_event: none, c_state: Full}
"""
    assert play(SORTER, scenario).passed


def test_an_event_that_only_parts_send_is_no_input(tmp_path):
    path = tmp_path / "model.sysml"
    path.write_text(SORTER, "utf-8")
    scenario = b"""component: P::Line
steps:
  - inputs: {c_event: Piece}
"""
    sink = Sink()
    run_scenarios(compile_model(path).graph, Source("s.yaml", scenario), sink)
    (diagnostic,) = sink
    assert diagnostic.rule.code == "SM555"
    assert diagnostic.message.startswith("'c_event' is decided by 'P::Line'")


@pytest.mark.parametrize(("event", "state"), [("Piece", "Full"), ("Scrap", "Dirty")])
def test_one_of_two_signals_for_one_receiver_occurs(play, event, state):
    scenario = f"""component: P::Line
steps:
  - inputs: {{a_event: Go, b_event: Go}}
  - expect: {{c_event: {event}}}
  - expect: {{c_event: none, c_state: {state}}}
"""
    assert play(SORTER, scenario).passed


# -- against the derivation ------------------------------------------------------------------------

MODELS = list_models()


@pytest.mark.corpus
@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.path.stem)
def test_every_step_of_the_player_is_a_step_of_the_derived_relation(model):
    assert_steps_agree(model.path, model.component)


WITHIN_STEP = """package P {
private import ScalarValues::*;
item def Go;
part def Cell {
    attribute a : Boolean := false;
    attribute b : Boolean := false;
    action init { first start; then action one assign a := not b; then action two assign b := a; }
    exhibit state M {
        entry; then Clear;
        state Clear { entry action { first start; then assign a := false; then assign b := a; } }
        state Entry { entry init; exit init; }
        state Do { do init; }
        transition first Clear accept Go then Entry;
        transition first Entry accept Go do init then Do;
        transition first Do accept Go then Clear;
    }
}
}
"""


def test_the_player_and_the_relation_agree_about_activities_within_a_step(tmp_path):
    path = tmp_path / "model.sysml"
    path.write_text(WITHIN_STEP, "utf-8")
    assert_steps_agree(path, "P::Cell", rounds=40)


def test_an_entry_performs_an_activity_within_the_step(play):
    scenario = """component: P::Cell
steps:
  - inputs: {event: Go}
    expect: {state: Clear, a: false, run_init: false}
  - expect: {state: Entry, a: true, b: true, run_init: false}
  - inputs: {event: Go}
    expect: {state: Entry, a: true, b: true}
  - expect: {state: Do, a: true, b: true, run_init: true}
  - expect: {state: Do, a: false, b: true, run_init: true}
  - expect: {state: Do, a: false, b: false, run_init: false}
"""
    assert play(WITHIN_STEP, scenario).passed
    assert not play(WITHIN_STEP.replace("entry init", "entry"), scenario).passed


def assert_steps_agree(path, component, rounds=5):
    """Play a component at random; its steps have to satisfy the formulas of its behaviour."""
    graph = compile_model(path).graph
    block = next(element for element in graph if graph.qualified_name(element) == component)
    player = open_component(graph, block)
    assert player is not None
    random = Random(0)
    inputs = [variable for variable in player.variables if variable.owner is Owner.ENVIRONMENT]
    guarantees = player.behaviour.contract.guarantees
    starts = [item.formula for item in guarantees if item.class_ is Class.INIT]
    steps = [item.formula for item in guarantees if item.class_ is Class.SAFETY]
    # What a machine reads after its do behaviours is a variable of the relation only.
    played = {variable.name for variable in player.variables}
    late = {
        variable.name: values(variable.domain)
        for variable in player.behaviour.contract.variables
        if variable.name not in played
    }

    def draw():
        return {variable.name: random.choice(values(variable.domain)) for variable in inputs}

    def is_step(now, following):
        rows = (dict(zip(late, row, strict=True)) for row in product(*late.values()))
        return any(
            all(evaluate.is_true(formula, {**now, **row}, following) for formula in steps)
            for row in rows
        )

    for _ in range(rounds):
        now = random.choice(player.initial(draw()))
        assert all(evaluate.is_true(formula, now) for formula in starts)
        for _ in range(12):
            following = random.choice(player.successors(now, draw()))
            assert is_step(now, following)
            now = following


def test_an_expectation_is_undecided_if_not_all_runs_are_followed(tmp_path):
    names = [f"x{number}" for number in range(14)]
    features = " ".join(f"attribute {name} : Boolean;" for name in names)
    model = CELL.replace("action pick {", f"{features} action pick {{")
    path = tmp_path / "model.sysml"
    path.write_text(model.replace("if gripped do", f"if {' and '.join(names)} do"), "utf-8")
    sink = Sink()
    scenario = "component: P::Cell\nsteps:\n  - expect: {held: true}\n"
    report = run_scenarios(compile_model(path).graph, Source("s.yaml", scenario.encode()), sink)
    assert [diagnostic.rule.code for diagnostic in sink] == ["SM578"]
    assert report.as_text() == "not decided P::Cell: scenario 1\n0 of 1 scenario passed\n"
    assert "the scenario is not decided" in report.as_junit()


def test_an_expectation_is_met_if_one_of_the_runs_that_are_followed_meets_it(play):
    model = CELL.replace("action pick {", "attribute x : Boolean; action pick {")
    report = play(
        model.replace("if gripped do", "if x do"),
        "component: P::Cell\nsteps:\n  - expect: {x: true}\n",
    )
    assert report.passed
