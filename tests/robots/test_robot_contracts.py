"""Contracts of floors: those of corpus/gr1/robots, conjunct by conjunct, and what obstacles add."""

import json

import pytest
from small_floors import CORPUS, contract_like, floor, list_conjuncts, rename_variables

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic.formats import read
from sysmlc.robots.environment_contract import Sharing, environment_contract
from sysmlc.robots.mission_contract import mission_contract
from sysmlc.robots.robot_contract import robot_contract
from sysmlc.robots.schedule import shortest_travel_times
from sysmlc.robots.system_contract import Encoding, system_contract
from sysmlc.synthesis.decision import Options, decide

FILES = sorted(CORPUS.glob("*.json")) if CORPUS.parent.name else []
COSTLY = {"hol_16x4_move", "hol_16x3_thesis", "env_9x3_literal"}
"""Decided by the test of the corpus's verdicts: equal contracts are equal."""


def is_realizable(contract):
    return decide(contract, lambda origin: Subject(), Sink(), Options()).is_realizable


@pytest.mark.corpus
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_contract_of_the_corpus_is_ours_word_for_word(path):
    (theirs,) = read(path.read_text("utf-8"), path.as_posix(), Sink())
    ours = contract_like(path.stem)
    assert {
        (side, kind, rename_variables(text)) for side, kind, text in list_conjuncts(theirs)
    } == list_conjuncts(ours)
    assert {rename_variables(variable.name) for variable in theirs.variables} == {
        variable.name for variable in ours.variables
    }


@pytest.mark.corpus
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_verdicts_are_those_of_the_corpus(path):
    if path.stem not in COSTLY:
        expected = json.loads(path.read_text("utf-8"))["status"] == "realizable"
        assert is_realizable(contract_like(path.stem)) is expected


def test_two_robots_may_enter_one_cell_unless_it_is_offered_to_one_of_them():
    study = floor(3, None, None)
    verdicts = {sharing: is_realizable(environment_contract(study, sharing)) for sharing in Sharing}
    assert verdicts == {Sharing.LITERAL: False, Sharing.ASSUMED: True, Sharing.ARBITRATED: True}


def test_an_obstacle_bars_the_ways_into_it_and_no_target_is_there():
    study = floor(3, None, blocked=(4,))
    contract = robot_contract(study, study.robots[0])
    texts = {text for side, _, text in list_conjuncts(contract) if side == "assumed"}
    assert "r0_position=1 -> !r0_sensor_down" in texts
    assert "r0_position=1 -> r0_sensor_left" in texts
    assert "!r0_target=4" in texts
    assert is_realizable(contract)


def test_on_a_floor_in_two_parts_targets_are_in_the_part_of_the_robot():
    study = floor(3, None, blocked=(3, 4, 5))
    contract = robot_contract(study, study.robots[0])
    texts = {text for _, _, text in list_conjuncts(contract)}
    assert (
        "r0_position=0 | r0_position=1 | r0_position=2 -> r0_target=0 | r0_target=1 | r0_target=2"
    ) in texts
    assert is_realizable(contract)


def test_step_counters_count_changes_of_position_and_begin_again():
    study = floor(2, None, counter_size=3)
    contract = robot_contract(study, study.robots[0])
    texts = {text for _, _, text in list_conjuncts(contract)}
    assert "!r0_position'=r0_position & r0_steps=2 -> r0_steps'=0" in texts
    assert is_realizable(contract)


def test_among_others_a_robot_relies_on_a_way_that_leads_nearer():
    study = floor(2, None, None)
    alone, shared = (robot_contract(study, study.robots[0], is_alone) for is_alone in (True, False))
    assert is_realizable(shared)
    assert [
        conjunct.class_ for conjunct in shared.assumptions if conjunct.class_ == "liveness"
    ] == ["liveness"]
    assert shared.component == f"{alone.component}.shared"


@pytest.mark.parametrize(("within", "is_kept"), [(6, False), (7, True)])
def test_a_robot_on_16_cells_reaches_each_target_within_7_steps(within, is_kept):
    study = floor(4, None, within=within)
    contract = system_contract(study, Encoding.COMMANDS)
    extra = robot_contract(study, study.robots[0]).guarantees
    stays = next(conjunct for conjunct in extra if "stays for a step" in conjunct.text)
    assert is_realizable(contract.__class__(*_add_guarantee(contract, stays))) is is_kept


def _add_guarantee(contract, conjunct):
    guarantees = (*contract.guarantees, conjunct)
    return (
        contract.component,
        contract.origin,
        contract.variables,
        contract.assumptions,
        guarantees,
    )


@pytest.mark.parametrize(("within", "is_kept"), [(3, False), (4, True)])
def test_two_robots_on_9_cells_reach_each_target_within_4_steps(within, is_kept):
    contract = system_contract(floor(3, None, None, within=within), Encoding.MOVES)
    assert is_realizable(contract) is is_kept


@pytest.mark.parametrize(("deadline", "is_kept"), [(4, False), (5, True)])
def test_a_mission_is_kept_when_its_deadline_leaves_time_for_the_way(deadline, is_kept):
    study = floor(3, 0, targets=(4,), deadline=deadline)
    assert is_realizable(mission_contract(study, shortest_travel_times(study))) is is_kept


def test_the_order_of_targets_takes_time():
    free = floor(2, 0, 3, targets=(1, 2), deadline=5)
    ordered = floor(2, 0, 3, targets=(1, 2), orders=((0, 1),), deadline=5)
    assert is_realizable(mission_contract(free, shortest_travel_times(free)))
    assert not is_realizable(mission_contract(ordered, shortest_travel_times(ordered)))


def test_what_is_carried_is_carried_by_one_robot():
    free = floor(3, 0, 8, targets=(1, 7), orders=((0, 1),), deadline=9)
    carried = floor(3, 0, 8, targets=(1, 7), orders=((0, 1, True),), deadline=9)
    assert is_realizable(mission_contract(free, shortest_travel_times(free)))
    assert is_realizable(mission_contract(carried, shortest_travel_times(carried)))
    soon = floor(3, 0, 8, targets=(1, 7), orders=((0, 1, True),), deadline=7)
    assert not is_realizable(mission_contract(soon, shortest_travel_times(soon)))
