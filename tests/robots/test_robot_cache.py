"""What is known of a floor's robots is kept: new targets ask for another allocation only."""

import pytest
from small_floors import floor

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.robots import claims
from sysmlc.robots import outcome as flow
from sysmlc.robots.answers import Answers
from sysmlc.robots.crew_cache import CrewCache, decode_controller, encode_controller
from sysmlc.robots.outcome import run_study
from sysmlc.robots.report import study_files
from sysmlc.robots.robot_controller import ANY, controller_contract, measure_travel_times
from sysmlc.support.cache import Cache
from sysmlc.synthesis import Limits
from sysmlc.synthesis.controller_synthesis import Form, synthesise_controller
from sysmlc.synthesis.controllers.forms import Table
from sysmlc.synthesis.decision import Options

FIRST = floor(3, None, None, targets=(0, 8), deadline=40)
OTHER = floor(3, 4, None, targets=(2, 6, 1), orders=((0, 1, True),), deadline=60)
"""The same floor and robots; another mission, and one of them starts in a cell."""


def nowhere(origin):
    return Subject()


@pytest.fixture
def keeper(tmp_path):
    return CrewCache(Cache(tmp_path), "this version")


def made(study, keeper, has_relations=True, options=None):
    sink = Sink()
    found = run_study(study, nowhere, sink, options or Options(), has_relations, keeper)
    return found, [(one.rule.code, one.message, one.notes) for one in sink]


def forbid(monkeypatch):
    """Nothing may be synthesised, measured or decided from here on."""

    def fail(*given, **named):
        raise AssertionError("done again")

    for module, name in (
        (flow, "synthesise_robot"),
        (flow, "measure_travel_times"),
        (flow, "decide"),
        (claims, "find_refinement_failures"),
        (claims, "Entailment"),
        (claims, "JointProof"),
    ):
        monkeypatch.setattr(module, name, fail)


def test_new_targets_ask_for_another_allocation_and_for_nothing_else(keeper, monkeypatch):
    first, told = made(FIRST, keeper)
    forbid(monkeypatch)
    second, told_again = made(OTHER, keeper)
    assert second.is_good
    assert second.study is OTHER
    assert second.controller.machine == first.controller.machine
    assert second.travel != first.travel
    assert told_again == told
    assert [one.holds for one in second.relations] == [one.holds for one in first.relations]


def test_what_is_kept_comes_to_the_same_as_what_is_made(keeper):
    made(FIRST, keeper)
    kept, told = made(OTHER, keeper)
    fresh, told_fresh = made(OTHER, None)
    assert dict(study_files(kept)) == dict(study_files(fresh))
    assert told == told_fresh


@pytest.mark.parametrize(
    "other",
    [
        floor(3, None, None, None, targets=(0, 8)),
        floor(4, None, None, targets=(0, 8), rows=3),
        floor(3, None, None, targets=(0, 8), blocked=(4,)),
        floor(3, None, None, targets=(0, 8), within=9),
        floor(3, None, None, targets=(0, 8), counter_size=4),
    ],
)
def test_another_floor_or_other_robots_are_made_anew(other, keeper, monkeypatch):
    made(FIRST, keeper, has_relations=False)
    forbid(monkeypatch)
    with pytest.raises(AssertionError, match="done again"):
        made(other, keeper, has_relations=False)


def test_another_version_of_the_tool_makes_all_anew(keeper, monkeypatch):
    made(FIRST, keeper, has_relations=False)
    forbid(monkeypatch)
    with pytest.raises(AssertionError, match="done again"):
        made(FIRST, CrewCache(keeper.cache, "the next version"), has_relations=False)


def test_claims_that_were_not_asked_for_are_decided_later(keeper):
    made(FIRST, keeper, has_relations=False)
    found, _ = made(FIRST, keeper)
    assert len(found.relations) == 11


def test_what_was_not_decided_is_tried_again(keeper):
    short = Options(limits=Limits(nodes=10))
    assert keeper.get(FIRST) is None
    made(FIRST, keeper, has_relations=False)
    crew = keeper.get(FIRST)
    undecided = {
        one.claim: one
        for one in claims.decide_claims(FIRST, flow.travel_times_of(FIRST, {}), short)
    }
    assert None in {one.holds for one in undecided.values()}
    keeper.put(FIRST, flow.replace(crew, claims=undecided))
    assert None not in {one.holds for one in keeper.get(FIRST).claims.values()}
    found, _ = made(FIRST, keeper)
    assert None not in {one.holds for one in found.relations}


def test_a_damaged_entry_costs_time_only(keeper):
    made(FIRST, keeper, has_relations=False)
    key = keeper._key(FIRST)
    for data in (
        b"no JSON",
        b"{}",
        b"[{},[],[]]",
        b'[{"inputs":[],"outputs":["nobody"]},[],[]]',
    ):
        keeper.cache.put(key, data)
        assert keeper.get(FIRST) is None
    assert made(FIRST, keeper, has_relations=False)[0].is_good


def test_a_table_is_kept_as_well():
    study = floor(2, None, targets=(3,))
    contract = controller_contract(study)
    found = synthesise_controller(contract, nowhere, Sink(), Options(), Form.TABLE)
    assert isinstance(found.machine, Table)
    again = decode_controller(
        encode_controller(found.machine), reduce_contract(contract).contract.variables
    )
    assert again == found.machine
    answers = Answers(again, ANY, study.grid)
    assert measure_travel_times(study, (answers,))[3] == {0: 4, 1: 3, 2: 3, 3: 1}
