"""Joint proofs about robots, environment and mission, compared with enumerated states."""

from functools import partial

import pytest
from listed_floor import STAY, ListedFloor
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
NEVER_STUCK = {
    "one cell",
    "two cells",
    "corridor in two parts",
    "corridor in two parts, two robots",
}
"""Floors on which each robot is offered a way to its target again and again."""
new_manager = partial(Manager, "", Limits(), lambda *given: None)


def make_proof(study):
    return JointProof(study, new_manager)


@pytest.mark.parametrize("name", FLOORS)
def test_proofs_agree_with_enumerated_states(name):
    study = FLOORS[name]
    proof, listed = make_proof(study), ListedFloor(study)
    assert (proof.find_safety_failure() is None) == listed.is_safe()
    assert (proof.find_offer_failure() is not None) == listed.is_ever_stuck()
    assert (proof.find_endless_travel() is not None) == listed.is_ever_away()


@pytest.mark.parametrize("name", [name for name in FLOORS if name not in NEVER_STUCK])
def test_a_failing_run_is_possible_in_the_enumerated_states(name):
    study = FLOORS[name]
    failure, listed = make_proof(study).find_offer_failure(), ListedFloor(study)
    assert failure is not None
    steps = [read_listed_state(study, step) for step in failure.run.steps]
    onward = [*steps[1:], steps[failure.run.loop]]
    assert all(
        following in listed.successors[current]
        for current, following in zip(steps, onward, strict=True)
    )
    loop = steps[failure.run.loop :]
    assert not any(listed.is_near(step, 0) for step in loop)
    for robot in listed.robots:
        assert any(listed.is_served(step, robot) for step in loop)


def read_listed_state(study, values):
    """Convert the values of a step to a listed state."""
    return tuple(
        (
            values[terms.position(robot)],
            values[terms.target(robot)],
            frozenset(way for way in WAYS if values[terms.sensor(robot, way)]),
            values[terms.command(robot)],
        )
        for robot in study.robots
    )


def test_floors_have_proofs_and_failures():
    have_proof = {make_proof(study).find_offer_failure() is None for study in FLOORS.values()}
    assert have_proof == {True, False}
    assert {make_proof(study).find_endless_travel() is None for study in FLOORS.values()} == {
        True,
        False,
    }


@pytest.mark.parametrize(("side", "robots"), [(3, 2), (4, 2), (5, 2), (4, 4), (5, 5)])
def test_floors_of_the_thesis_are_decided(side, robots):
    study = floor(side, *(None,) * robots)
    proof = make_proof(study)
    assert proof.find_safety_failure() is None
    assert proof.find_liveness_failure() is None
    failure = proof.find_offer_failure()
    assert failure.conjunct.text == "Again and again 'r0' is in its target, or may go nearer."
    assert list(violated_conjuncts(failure.run, (failure.conjunct,))) == [failure.conjunct]
    violated = list(violated_conjuncts(failure.run, proof.contracts.system.guarantees))
    assert [conjunct.text for conjunct in violated] == ["'r0' reaches its targets."]


def test_a_robot_without_its_guarantee_about_free_ways_violates_assumptions():
    proof = make_proof(floor(3, None, None))
    first, *other_robots = proof.contracts.robots
    guarantees = [
        conjunct
        for conjunct in first.guarantees
        if "only when the way is free" not in conjunct.text
    ]
    proof.contracts.robots = [replace(first, guarantees=tuple(guarantees)), *other_robots]
    proof.contracts.parts = (proof.contracts.environment, *proof.contracts.robots)
    proof._step_conjuncts = {
        (conjunct.class_, conjunct.formula) for conjunct in proof.contracts.steps()
    }
    unproven = [
        conjunct
        for conjunct in proof.contracts.environment.assumptions
        if not proof._is_proven(conjunct)
    ]
    assert [conjunct.text for conjunct in unproven] == [
        f"'r0' goes {way} only when the way is free." for way in WAYS
    ]


def test_no_contract_bounds_the_time_to_a_target():
    failure = make_proof(floor(3, None, None, within=4)).find_safety_failure()
    assert failure.conjunct.text == "'r0' reaches a target within 4 steps."
    assert [step["r0_timer"] for step in failure.run.steps][:8] == [0, 0, 0, 1, 2, 3, 4, 5]
    assert make_proof(floor(1, None, within=4)).find_safety_failure() is None


def test_missions_satisfy_the_assumptions_about_targets():
    """The joint contracts imply what C_R and C_S assume about targets, on every floor."""
    for study in FLOORS.values():
        proof = make_proof(study)
        goals = {terms.target(robot) for robot in study.robots}
        for part in proof.contracts.robots:
            target_assumptions = [
                conjunct for conjunct in part.assumptions if goals & list_names(conjunct)
            ]
            assert all(
                proof._is_proven(conjunct)
                for conjunct in target_assumptions
                if conjunct.class_ != "liveness"
            )


def list_names(conjunct):
    return {variable.name for variable in variables(conjunct.formula)}


def test_robots_outside_the_proof_rest_without_violations():
    study = floor(3, None, None, None)
    failure = make_proof(study).find_offer_failure()
    contract = environment_contract(study)
    conjuncts = (*contract.assumptions, *contract.guarantees)
    assert list(violated_conjuncts(failure.run, conjuncts)) == []
    assert list(violated_conjuncts(failure.run, mission_guarantees(study))) == []
    assert {step["r2_command"] for step in failure.run.steps} == {STAY}


def test_a_run_of_few_robots_cannot_be_extended_on_a_full_floor():
    study = floor(2, None, None, None, None)
    two_robots = replace(study, robots=study.robots[:1])
    run = make_proof(two_robots).find_offer_failure().run
    contract = environment_contract(study)
    for extended_run in extend_to_all_robots(study, two_robots.robots, run):
        assert list(violated_conjuncts(extended_run, contract.guarantees)) != []


def test_a_claim_beyond_the_time_limit_stays_undecided():
    study = floor(2, *(None,) * 4)
    options = Options(limits=Limits(seconds=0.1))
    claims = {
        claim.claim: claim for claim in decide_claims(study, shortest_travel_times(study), options)
    }
    refinement = claims["C_R, C_E and C_M together refine C_S"]
    assert refinement.holds is None
    assert "limit" in refinement.reason


def test_a_mission_contract_has_the_guarantees_of_every_mission():
    """The joint proof for all missions relies on these guarantees of C_M about targets."""
    study = floor(3, None, None, targets=(0, 4, 8), orders=((0, 1, True),))
    texts = {
        conjunct.text
        for conjunct in mission_contract(study, shortest_travel_times(study)).guarantees
    }
    assert {"At first 'r0' has no target.", "'r0' keeps a target until it has reached it."} <= texts
