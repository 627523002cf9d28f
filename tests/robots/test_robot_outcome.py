"""The flow as a whole: controller, travel times, claims, other allocations, new targets."""

from pathlib import Path

import pytest
from greedy_machine import greedy_answers
from msgspec.structs import replace
from small_floors import floor

from sysmlc.diagnostics import Sink, Subject
from sysmlc.robots import outcome as module
from sysmlc.robots.claims import Claim, decide_claims
from sysmlc.robots.mission_contract import mission_contract
from sysmlc.robots.mission_run import sequence_diagram
from sysmlc.robots.outcome import allocate_mission, run_study
from sysmlc.robots.report import study_files, study_markdown
from sysmlc.robots.robot_controller import build_answers, simulate_travel_times, synthesise_robot
from sysmlc.robots.schedule import build_schedule, shortest_travel_times
from sysmlc.robots.validation import validate_allocation
from sysmlc.synthesis import Limits
from sysmlc.synthesis.decision import Options, decide

DOCS = Path(__file__).parents[2] / "docs"


def nowhere(origin):
    return Subject()


def made(study, has_relations=False):
    sink = Sink()
    found = run_study(study, nowhere, sink, Options(), has_relations)
    return found, [(diagnostic.rule.code, diagnostic.message) for diagnostic in sink]


@pytest.fixture(scope="module")
def nine():
    """A floor of nine cells with two robots that start anywhere."""
    return made(floor(3, None, None, targets=(0, 8, 4), orders=((0, 1, True),), deadline=40))[0]


def test_the_machine_of_a_robot_on_nine_cells_has_four_states_at_most(nine):
    assert nine.controller.machine.size <= 4


def test_travel_times_are_measured_and_are_those_of_shortest_ways(nine):
    assert nine.travel.is_simulated
    assert nine.travel.steps == shortest_travel_times(nine.study).steps


def test_the_mission_is_done_from_every_start(nine):
    assert nine.is_good
    assert nine.chosen.validation.starts == 9 * 8
    assert nine.chosen.validation.steps <= 40
    assert decide(
        mission_contract(nine.study, nine.travel), nowhere, Sink(), Options()
    ).is_realizable


def test_the_synthesised_machine_and_one_written_by_hand_reach_the_same():
    study = floor(4, None, None, None, targets=(0, 5, 10), rows=3)
    lists = ((0,), (1,), (2,))
    machine = build_answers(study, synthesise_robot(study, nowhere, Sink(), Options()))
    assert validate_allocation(study, lists, machine) == validate_allocation(
        study, lists, greedy_answers(study)
    )


def test_new_targets_are_given_to_the_robots_that_there_are(nine, monkeypatch):
    def fail(*given):
        raise AssertionError("synthesised again")

    monkeypatch.setattr(module, "synthesise_robot", fail)
    other = floor(3, None, None, targets=(2, 6, 1, 3), deadline=60)
    again = allocate_mission(nine, nowhere, Sink(), other)
    assert again.is_good
    assert again.study is other
    assert again.controller is nine.controller


def test_another_allocation_is_tried_when_one_fails(monkeypatch):
    """The best one does not do when its simulation is made to fail."""
    study = floor(3, 0, 8, targets=(2, 6), deadline=40)
    best = made(study)[0].chosen.schedule.allocation

    def but_for_the_best(study, allocation, answers):
        found = validate_allocation(study, allocation, answers)
        return replace(found, failed=(0, 8), late=0) if allocation == best else found

    monkeypatch.setattr(module, "validate_allocation", but_for_the_best)
    found, told = made(study)
    assert found.is_good
    assert [one.validation.is_good for one in found.tried] == [False, True]
    assert found.chosen.schedule.allocation != best
    assert told == []


def test_when_no_allocation_does_the_run_is_told():
    found, told = made(floor(3, 0, 2, rows=1, targets=(0, 2), orders=((1, 0, True),), deadline=9))
    assert not found.is_good
    assert told == [("SM571", "the mission of 'Hall' fails: 't0' is not reached within 9 steps")]
    assert [one.schedule.allocation for one in found.tried] == [((), (1, 0)), ((1, 0), ())]
    assert "reached" not in sequence_diagram(found.study, found.run, "x")


def test_a_deadline_that_leaves_no_time_is_told():
    found, told = made(floor(3, 0, targets=(8,), deadline=5))
    assert found.tried == ()
    assert [code for code, _ in told] == ["SM572"]
    assert "takes 6 steps" in told[0][1]


def test_what_the_thesis_claims_on_nine_cells(nine):
    found = {one.claim: one for one in decide_claims(nine.study, nine.travel, Options())}
    assert {claim: one.holds for claim, one in found.items()} == {
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
    assert "is free" in found["C_E discharges what C_R assumes of it"].reason
    among = found["C_E discharges what C_R among others assumes of it"]
    assert "Again and again" in among.reason
    assert among.run[-1].startswith("then again from step")


def test_one_robot_alone_gets_what_its_contract_assumes_of_the_environment():
    study = floor(2, None)
    found = {
        one.claim: one.holds
        for one in decide_claims(study, shortest_travel_times(study), Options())
    }
    assert found["C_S refines C_R"] is False
    assert found["C_E as the thesis defines it discharges what C_R assumes of it"] is True
    assert found["C_E discharges what C_R assumes of it"] is False


def test_what_is_not_decided_is_no_answer(nine):
    options = Options(limits=Limits(nodes=10))
    found = list(decide_claims(nine.study, nine.travel, options))
    assert {one.holds for one in found if "refines C_M" not in one.claim} == {None}


def test_what_is_not_decided_is_told(monkeypatch):
    monkeypatch.setattr(module, "decide_claims", lambda *given: [Claim("x", None, "10 s")])
    _, told = made(floor(2, None), has_relations=True)
    assert told == [("SM574", "on 'Hall' it is not decided whether x: 10 s")]


def test_a_report_is_the_same_each_time(nine):
    assert dict(study_files(nine)) == dict(study_files(nine))
    text = study_markdown(nine)
    assert text.startswith("# Hall\n\nHall: 9 cells, 2 robots, 3 targets: done in ")
    assert "A machine of 2 states" in text


def test_a_schedule_is_what_a_robot_alone_does():
    study = floor(3, 0, targets=(8, 2, 6), deadline=60)
    answers = build_answers(study, synthesise_robot(study, nowhere, Sink(), Options()))
    schedule = build_schedule(study, simulate_travel_times(study, answers), ((0, 1, 2),))
    found = validate_allocation(study, ((0, 1, 2),), answers)
    assert found.reached == schedule.reached


PAGE = (
    "C_E discharges what C_R assumes of it",
    "C_E discharges what C_R among others assumes of it",
    "C_R, C_E and C_M together refine C_S",
)


@pytest.mark.parametrize("claim", PAGE)
def test_the_page_about_robots_shows_the_runs_in_which_claims_do_not_hold(claim):
    text = (DOCS / "robots.md").read_text(encoding="utf-8")
    study = floor(3, None, None)
    found = {
        one.claim: one for one in decide_claims(study, shortest_travel_times(study), Options())
    }
    shown = found[claim]
    assert shown.reason.partition(": ")[2] in " ".join(text.split())
    assert "".join(f"    {line}\n" for line in shown.run) in text


@pytest.mark.parametrize(("within", "is_kept"), [(4, False), (5, True)])
def test_what_c_s_promises_of_each_target_is_part_of_the_mission(within, is_kept):
    """Four cells to go: five steps from when the robot has its target."""
    found, told = made(floor(3, 0, targets=(8,), within=within))
    assert found.is_good is is_kept
    reason = "the mission of 'Hall' fails: a robot that is sent to 't0' takes more than 4 steps"
    assert told == ([] if is_kept else [("SM571", reason)])


def test_another_allocation_is_tried_when_ways_are_too_long():
    """Each robot to one target is done first; one robot to both has short ways only."""
    found, told = made(floor(5, 0, 4, targets=(1, 2), within=2, rows=1))
    assert [one.validation.is_slow for one in found.tried] == [True, False]
    assert found.is_good
    assert told == []
