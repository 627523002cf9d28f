"""Robots, environment and mission together: what of C_S they keep, judged by listed states."""

from functools import partial

import pytest
from listed_floor import STAY, Listed
from msgspec.structs import replace
from small_floors import floor

from sysmlc.logic.formula import variables
from sysmlc.robots import contract_terms as terms
from sysmlc.robots.claims import decide_claims
from sysmlc.robots.environment_contract import environment_contract
from sysmlc.robots.joint_contracts import mission_guarantees
from sysmlc.robots.joint_proof import JointProof
from sysmlc.robots.mission_contract import mission_contract
from sysmlc.robots.run_extension import extend_to_all_robots, violated_conjuncts
from sysmlc.robots.schedule import shortest_travel_times
from sysmlc.robots.study import WAYS
from sysmlc.synthesis import Limits
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.decision import Options

FLOORS = {
    "one cell": floor(1, None),
    "two cells": floor(2, None, rows=1),
    "two cells, two robots": floor(2, None, None, rows=1),
    "corridor": floor(3, None, rows=1),
    "corridor, two robots": floor(3, None, None, rows=1),
    "corridor in two parts": floor(3, None, rows=1, blocked=(1,)),
    "corridor in two parts, two robots": floor(3, None, None, rows=1, blocked=(1,)),
    "square": floor(2, None),
    "square, two robots": floor(2, None, None),
    "angle, two robots": floor(2, None, None, blocked=(3,)),
    "angle": floor(2, None, blocked=(0,)),
    "two rows": floor(3, None, rows=2, blocked=(4,)),
}
new_manager = partial(Manager, "", Limits(), lambda *given: None)


def together(study):
    return JointProof(study, new_manager)


@pytest.mark.parametrize("name", FLOORS)
def test_what_is_decided_is_what_listed_states_say(name):
    study = FLOORS[name]
    asked, listed = together(study), Listed(study)
    assert (asked.find_safety_failure() is None) == listed.is_safe()
    assert (asked.find_offer_failure() is not None) == listed.is_ever_stuck()
    assert (asked.find_endless_travel() is not None) == listed.is_ever_away()


@pytest.mark.parametrize("name", FLOORS)
def test_a_run_that_fails_is_one_of_the_listed_states(name):
    study = FLOORS[name]
    found, listed = together(study).find_offer_failure(), Listed(study)
    if found is not None:
        steps = [state(study, one) for one in found.run.steps]
        onward = [*steps[1:], steps[found.run.loop]]
        assert all(then in listed.after[now] for now, then in zip(steps, onward, strict=True))
        loop = steps[found.run.loop :]
        assert not any(listed.is_near(one, 0) for one in loop)
        for robot in listed.robots:
            assert any(listed.is_served(one, robot) for one in loop)


def state(study, values):
    """The values of a step as a listed state."""
    return tuple(
        (
            values[terms.position(one)],
            values[terms.target(one)],
            frozenset(way for way in WAYS if values[terms.sensor(one, way)]),
            values[terms.command(one)],
        )
        for one in study.robots
    )


def test_floors_of_both_kinds_are_judged():
    answers = {together(study).find_offer_failure() is None for study in FLOORS.values()}
    assert answers == {True, False}
    assert {together(study).find_endless_travel() is None for study in FLOORS.values()} == {
        True,
        False,
    }


@pytest.mark.parametrize(("side", "robots"), [(3, 2), (4, 2), (5, 2), (4, 4), (5, 5)])
def test_floors_of_the_thesis_are_decided_one_robot_or_two_at_a_time(side, robots):
    study = floor(side, *(None,) * robots)
    asked = together(study)
    assert asked.find_safety_failure() is None
    assert asked.find_liveness_failure() is None
    found = asked.find_offer_failure()
    assert found.conjunct.text == "Again and again 'r0' is in its target, or may go nearer."
    assert list(violated_conjuncts(found.run, (found.conjunct,))) == [found.conjunct]
    promised = list(violated_conjuncts(found.run, asked.contracts.system.guarantees))
    assert [one.text for one in promised] == ["'r0' reaches its targets."]


def test_without_its_promise_to_go_on_free_ways_only_a_robot_breaks_what_is_assumed_of_it():
    asked = together(floor(3, None, None))
    first, *others = asked.contracts.robots
    kept = [one for one in first.guarantees if "only when the way is free" not in one.text]
    asked.contracts.robots = [replace(first, guarantees=tuple(kept)), *others]
    asked.contracts.parts = (asked.contracts.environment, *asked.contracts.robots)
    asked._step_conjuncts = {(one.class_, one.formula) for one in asked.contracts.steps()}
    broken = [one for one in asked.contracts.environment.assumptions if not asked._is_proven(one)]
    assert [one.text for one in broken] == [
        f"'r0' goes {way} only when the way is free." for way in WAYS
    ]


def test_nothing_says_how_soon_a_robot_comes_to_its_target():
    found = together(floor(3, None, None, within=4)).find_safety_failure()
    assert found.conjunct.text == "'r0' reaches a target within 4 steps."
    assert [one["r0_timer"] for one in found.run.steps][:8] == [0, 0, 0, 1, 2, 3, 4, 5]
    assert together(floor(1, None, within=4)).find_safety_failure() is None


def test_targets_of_a_mission_stay_and_can_be_reached():
    """What joins the contracts keeps what C_R and C_S assume of targets, on any floor."""
    for study in FLOORS.values():
        asked = together(study)
        goals = {terms.target(one) for one in study.robots}
        for part in asked.contracts.robots:
            of_targets = [one for one in part.assumptions if goals & names(one)]
            assert all(asked._is_proven(one) for one in of_targets if one.class_ != "liveness")


def names(conjunct):
    return {one.name for one in variables(conjunct.formula)}


def test_others_rest_in_nobodys_way():
    study = floor(3, None, None, None)
    found = together(study).find_offer_failure()
    contract = environment_contract(study)
    assert list(violated_conjuncts(found.run, (*contract.assumptions, *contract.guarantees))) == []
    assert list(violated_conjuncts(found.run, mission_guarantees(study))) == []
    assert {one["r2_command"] for one in found.run.steps} == {STAY}


def test_where_there_is_no_room_a_run_of_few_robots_is_none_of_all():
    study = floor(2, None, None, None, None)
    few = replace(study, robots=study.robots[:1])
    run = together(few).find_offer_failure().run
    contract = environment_contract(study)
    for one in extend_to_all_robots(study, few.robots, run):
        assert list(violated_conjuncts(one, contract.guarantees)) != []


def test_a_floor_that_is_full_is_not_decided_in_no_time():
    study = floor(2, *(None,) * 4)
    options = Options(limits=Limits(seconds=0.1))
    found = {one.claim: one for one in decide_claims(study, shortest_travel_times(study), options)}
    whole = found["C_R, C_E and C_M together refine C_S"]
    assert whole.holds is None
    assert "limit" in whole.reason


def test_the_mission_as_it_is_written_keeps_what_every_mission_does():
    """C_M of a study promises, of goals, what the study of all missions relies on."""
    study = floor(3, None, None, targets=(0, 4, 8), orders=((0, 1, True),))
    texts = {one.text for one in mission_contract(study, shortest_travel_times(study)).guarantees}
    assert {"At first 'r0' has no target.", "'r0' keeps a target until it has reached it."} <= texts
