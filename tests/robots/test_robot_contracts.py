"""Contracts of floors: the same conjuncts as in corpus/gr1/robots, and those for obstacles."""

import json

import pytest
from compact_contracts import assume_no_meeting, compact_contract
from small_floors import CORPUS, build_contract, floor, list_conjuncts, rename_variables

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic.formats import read
from sysmlc.robots.environment_contract import environment_contract
from sysmlc.robots.mission_contract import mission_contract
from sysmlc.robots.robot_contract import robot_contract
from sysmlc.robots.schedule import shortest_travel_times
from sysmlc.synthesis.decision import Options, decide

FILES = sorted(CORPUS.glob("*.json")) if CORPUS.parent.name else []
COSTLY = {"hol_16x4_move", "hol_16x3_thesis", "env_9x3_literal"}
"""Slow contracts. The tests of the corpus decide them, and they are equal to ours."""


def is_realizable(contract):
    return decide(contract, lambda origin: Subject(), Sink(), Options()).is_realizable


@pytest.mark.corpus
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_contract_of_the_corpus_has_the_same_conjuncts_as_ours(path):
    (theirs,) = read(path.read_text("utf-8"), path.as_posix(), Sink())
    ours = build_contract(path.stem)
    assert {
        (side, kind, rename_variables(text)) for side, kind, text in list_conjuncts(theirs)
    } == list_conjuncts(ours)
    assert {rename_variables(variable.name) for variable in theirs.variables} == {
        variable.name for variable in ours.variables
    }


@pytest.mark.corpus
@pytest.mark.parametrize(
    "path", [path for path in FILES if path.stem not in COSTLY], ids=lambda path: path.stem
)
def test_verdicts_are_those_of_the_corpus(path):
    expected = json.loads(path.read_text("utf-8"))["status"] == "realizable"
    assert is_realizable(build_contract(path.stem)) is expected


def test_collisions_are_avoided_only_if_a_cell_is_offered_to_one_robot():
    study = floor(3, None, None)
    assert not is_realizable(environment_contract(study, is_literal=True))
    assert is_realizable(assume_no_meeting(study))
    assert is_realizable(environment_contract(study))


def test_an_obstacle_blocks_ways_and_targets():
    study = floor(3, None, blocked=(4,))
    contract = robot_contract(study, study.robots[0])
    texts = {text for side, _, text in list_conjuncts(contract) if side == "assumption"}
    assert "r0_position=1 -> !r0_sensor_down" in texts
    assert "r0_position=1 -> r0_sensor_left" in texts
    assert "!r0_target=4" in texts
    assert is_realizable(contract)


def test_targets_are_in_the_part_of_the_floor_where_the_robot_is():
    study = floor(3, None, blocked=(3, 4, 5))
    contract = robot_contract(study, study.robots[0])
    texts = {text for _, _, text in list_conjuncts(contract)}
    assert (
        "r0_position=0 | r0_position=1 | r0_position=2 -> r0_target=0 | r0_target=1 | r0_target=2"
    ) in texts
    assert is_realizable(contract)


def test_step_counters_count_moves_modulo_their_size():
    study = floor(2, None, counter_size=3)
    contract = robot_contract(study, study.robots[0])
    texts = {text for _, _, text in list_conjuncts(contract)}
    assert "!r0_position'=r0_position & r0_steps=2 -> r0_steps'=0" in texts
    assert is_realizable(contract)


def test_the_shared_contract_assumes_a_way_that_leads_nearer():
    study = floor(2, None, None)
    alone, shared = (robot_contract(study, study.robots[0], is_alone) for is_alone in (True, False))
    assert is_realizable(shared)
    assert [
        conjunct.class_ for conjunct in shared.assumptions if conjunct.class_ == "liveness"
    ] == ["liveness"]
    assert shared.component == f"{alone.component}.shared"


@pytest.mark.parametrize(("within", "expected"), [(6, False), (7, True)])
def test_a_robot_on_16_cells_reaches_each_target_within_7_steps(within, expected):
    study = floor(4, None, within=within)
    contract = compact_contract(study, "commands")
    guarantees = robot_contract(study, study.robots[0]).guarantees
    stays = next(conjunct for conjunct in guarantees if "stays for a step" in conjunct.text)
    assert is_realizable(contract.__class__(*_add_guarantee(contract, stays))) is expected


def _add_guarantee(contract, conjunct):
    guarantees = (*contract.guarantees, conjunct)
    return (
        contract.component,
        contract.origin,
        contract.variables,
        contract.assumptions,
        guarantees,
    )


@pytest.mark.parametrize(("within", "expected"), [(3, False), (4, True)])
def test_two_robots_on_9_cells_reach_each_target_within_4_steps(within, expected):
    contract = compact_contract(floor(3, None, None, within=within), "moves")
    assert is_realizable(contract) is expected


@pytest.mark.parametrize(("deadline", "expected"), [(4, False), (5, True)])
def test_a_mission_is_realizable_if_its_deadline_covers_the_path(deadline, expected):
    study = floor(3, 0, targets=(4,), deadline=deadline)
    assert is_realizable(mission_contract(study, shortest_travel_times(study))) is expected


def test_an_order_of_targets_needs_more_time():
    free = floor(2, 0, 3, targets=(1, 2), deadline=5)
    ordered = floor(2, 0, 3, targets=(1, 2), orders=((0, 1),), deadline=5)
    assert is_realizable(mission_contract(free, shortest_travel_times(free)))
    assert not is_realizable(mission_contract(ordered, shortest_travel_times(ordered)))


def test_a_carried_item_needs_the_time_of_one_robot():
    free = floor(3, 0, 8, targets=(1, 7), orders=((0, 1),), deadline=9)
    carried = floor(3, 0, 8, targets=(1, 7), orders=((0, 1, True),), deadline=9)
    assert is_realizable(mission_contract(free, shortest_travel_times(free)))
    assert is_realizable(mission_contract(carried, shortest_travel_times(carried)))
    early = floor(3, 0, 8, targets=(1, 7), orders=((0, 1, True),), deadline=7)
    assert not is_realizable(mission_contract(early, shortest_travel_times(early)))
