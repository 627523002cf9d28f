"""The study of a floor: controller, travel times, claims, further allocations, new targets."""

from pathlib import Path

import pytest
from greedy_machine import greedy_answers
from msgspec.structs import replace
from small_floors import floor

from sysmlc.diagnostics import Sink, Subject
from sysmlc.robots import outcome as outcome_module
from sysmlc.robots.claims import Claim, decide_claims
from sysmlc.robots.mission_contract import mission_contract
from sysmlc.robots.mission_run import sequence_diagram
from sysmlc.robots.outcome import allocate_mission, run_study
from sysmlc.robots.report import study_files, study_markdown
from sysmlc.robots.robot_controller import (
    build_answers,
    measure_travel_times,
    synthesise_robot,
    travel_times_of,
)
from sysmlc.robots.schedule import START, build_schedule, shortest_travel_times
from sysmlc.robots.validation import validate_allocation
from sysmlc.synthesis import Limits
from sysmlc.synthesis.decision import Options, decide

DOCS = Path(__file__).parents[2] / "docs"


def locate_nowhere(origin):
    return Subject()


def study_floor(study, has_relations=False):
    sink = Sink()
    outcome = run_study(study, locate_nowhere, sink, Options(), has_relations)
    return outcome, [(diagnostic.rule.code, diagnostic.message) for diagnostic in sink]


@pytest.fixture(scope="module")
def nine():
    """The outcome on a floor of nine cells with two robots that start anywhere."""
    return study_floor(
        floor(3, None, None, targets=(0, 8, 4), orders=((0, 1, True),), deadline=40)
    )[0]


def test_the_machine_of_a_robot_on_nine_cells_has_at_most_four_states(nine):
    assert nine.controller.machine.size <= 4


def test_simulated_travel_times_are_those_of_shortest_paths(nine):
    assert nine.travel.is_simulated
    assert nine.travel.steps == shortest_travel_times(nine.study).steps


def test_the_mission_succeeds_from_every_start(nine):
    assert nine.is_good
    assert nine.chosen.validation.starts == 9 * 8
    assert nine.chosen.validation.steps <= 40
    assert decide(
        mission_contract(nine.study, nine.travel), locate_nowhere, Sink(), Options()
    ).is_realizable


def test_the_synthesised_machine_is_as_fast_as_one_written_by_hand():
    study = floor(4, None, None, None, targets=(0, 5, 10), rows=3)
    lists = ((0,), (1,), (2,))
    machine = build_answers(study, synthesise_robot(study, locate_nowhere, Sink(), Options()))
    assert validate_allocation(study, lists, machine) == validate_allocation(
        study, lists, greedy_answers(study)
    )


def test_new_targets_reuse_the_controllers(nine, monkeypatch):
    def refuse_synthesis(*arguments):
        raise AssertionError("synthesised again")

    monkeypatch.setattr(outcome_module, "synthesise_robot", refuse_synthesis)
    new_targets = floor(3, None, None, targets=(2, 6, 1, 3), deadline=60)
    reallocated = allocate_mission(nine, locate_nowhere, Sink(), new_targets)
    assert reallocated.is_good
    assert reallocated.study is new_targets
    assert reallocated.controller is nine.controller


def test_another_allocation_is_tried_after_one_fails(monkeypatch):
    """The test makes the simulation of the best allocation fail."""
    study = floor(3, 0, 8, targets=(2, 6), deadline=40)
    best = study_floor(study)[0].chosen.schedule.allocation

    def fail_best_allocation(study, allocation, answers):
        validation = validate_allocation(study, allocation, answers)
        return replace(validation, failed=(0, 8), late=0) if allocation == best else validation

    monkeypatch.setattr(outcome_module, "validate_allocation", fail_best_allocation)
    outcome, messages = study_floor(study)
    assert outcome.is_good
    assert [attempt.validation.is_good for attempt in outcome.tried] == [False, True]
    assert outcome.chosen.schedule.allocation != best
    assert messages == []


def test_a_failing_run_is_reported_if_no_allocation_succeeds():
    outcome, messages = study_floor(
        floor(3, 0, 2, rows=1, targets=(0, 2), orders=((1, 0, True),), deadline=9)
    )
    assert not outcome.is_good
    assert messages == [
        ("SM571", "the mission of 'Hall' fails: 't0' is not reached within 9 steps")
    ]
    assert [attempt.schedule.allocation for attempt in outcome.tried] == [
        ((), (1, 0)),
        ((1, 0), ()),
    ]
    assert "reached" not in sequence_diagram(outcome.study, outcome.run, "x")


def test_a_deadline_that_is_too_short_is_reported():
    outcome, messages = study_floor(floor(3, 0, targets=(8,), deadline=5))
    assert outcome.tried == ()
    assert [code for code, _ in messages] == ["SM572"]
    assert "takes 6 steps" in messages[0][1]


def test_which_claims_of_the_thesis_hold_on_nine_cells(nine):
    decisions = {
        decision.claim: decision for decision in decide_claims(nine.study, nine.travel, Options())
    }
    assert {claim: decision.holds for claim, decision in decisions.items()} == {
        "C_S refines C_R": False,
        "C_S refines C_R among others": False,
        "C_S refines C_E": False,
        "C_S refines C_M": False,
        "C_E as the thesis defines it discharges what C_R assumes of it": False,
        "C_E discharges what C_R assumes of it": False,
        "C_E discharges what C_R among others assumes of it": False,
        "C_R, C_E and C_M together keep what C_S promises of each step": True,
        "C_R, C_E and C_M together refine C_S": False,
        "C_R, C_E and C_M together keep C_S where ways that lead nearer are offered": True,
        "C_R and C_E bring robots to their targets in a known time, as C_M assumes": False,
    }
    assert "is free" in decisions["C_E discharges what C_R assumes of it"].reason
    among_robots = decisions["C_E discharges what C_R among others assumes of it"]
    assert "Again and again" in among_robots.reason
    assert among_robots.run[-1].startswith("then again from step")


def test_the_environment_of_a_single_robot_discharges_its_assumptions():
    study = floor(2, None)
    holds = {
        decision.claim: decision.holds
        for decision in decide_claims(study, shortest_travel_times(study), Options())
    }
    assert holds["C_S refines C_R"] is False
    assert holds["C_E as the thesis defines it discharges what C_R assumes of it"] is True
    assert holds["C_E discharges what C_R assumes of it"] is False


def test_a_claim_beyond_the_limit_is_undecided(nine):
    options = Options(limits=Limits(nodes=10))
    decisions = decide_claims(nine.study, nine.travel, options)
    assert {decision.holds for decision in decisions if "refines C_M" not in decision.claim} == {
        None
    }


def test_an_undecided_claim_is_reported(monkeypatch):
    monkeypatch.setattr(
        outcome_module, "decide_claims", lambda *arguments: [Claim("x", None, "10 s")]
    )
    _, messages = study_floor(floor(2, None), has_relations=True)
    assert messages == [("SM574", "on 'Hall' it is not decided whether x: 10 s")]


def test_reports_are_reproducible(nine):
    assert dict(study_files(nine)) == dict(study_files(nine))
    text = study_markdown(nine)
    assert text.startswith("# Hall\n\nHall: 9 cells, 2 robots, 3 targets: done in ")
    assert "A machine of 2 states" in text


def test_a_schedule_has_the_times_of_a_simulation_of_one_robot():
    study = floor(3, 0, targets=(8, 2, 6), deadline=60)
    answers = build_answers(study, synthesise_robot(study, locate_nowhere, Sink(), Options()))
    travel_times = travel_times_of(study, measure_travel_times(study, answers))
    schedule = build_schedule(study, travel_times, ((0, 1, 2),))
    validation = validate_allocation(study, ((0, 1, 2),), answers)
    assert validation.reached == schedule.reached


def test_a_robot_has_no_travel_time_from_a_place_without_way_to_the_target():
    """Robot r1 may start in cell 1 or 2, so that each of them needs a way."""
    study = floor(3, 0, None, rows=1, targets=(2,))
    reachable = travel_times_of(study, {2: {0: 3, 1: 2, 2: 0}})
    assert reachable.steps == {(0, START, 0): 3, (1, START, 0): 2}
    assert travel_times_of(study, {2: {0: 3, 1: 2}}).steps == {(0, START, 0): 3}
    assert travel_times_of(study, {}).steps == {}


DOCUMENTED_CLAIMS = (
    "C_E discharges what C_R assumes of it",
    "C_E discharges what C_R among others assumes of it",
    "C_R, C_E and C_M together refine C_S",
)


@pytest.mark.parametrize("claim", DOCUMENTED_CLAIMS)
def test_the_documentation_shows_the_runs_that_refute_claims(claim):
    text = (DOCS / "robots.md").read_text(encoding="utf-8")
    study = floor(3, None, None)
    (decision,) = (
        decision
        for decision in decide_claims(study, shortest_travel_times(study), Options())
        if decision.claim == claim
    )
    assert decision.reason.partition(": ")[2] in " ".join(text.split())
    assert "".join(f"    {line}\n" for line in decision.run) in text


@pytest.mark.parametrize(("within", "is_good"), [(4, False), (5, True)])
def test_the_bound_of_the_system_contract_is_part_of_the_mission(within, is_good):
    """The path has four cells, so that the target is reached after five steps."""
    outcome, messages = study_floor(floor(3, 0, targets=(8,), within=within))
    assert outcome.is_good is is_good
    reason = "the mission of 'Hall' fails: a robot that is sent to 't0' takes more than 4 steps"
    assert messages == ([] if is_good else [("SM571", reason)])


def test_another_allocation_is_tried_after_a_path_was_too_long():
    """One target for each robot is faster, but only one robot for both has short paths."""
    outcome, messages = study_floor(floor(5, 0, 4, targets=(1, 2), within=2, rows=1))
    assert [attempt.validation.is_slow for attempt in outcome.tried] == [True, False]
    assert outcome.is_good
    assert messages == []
