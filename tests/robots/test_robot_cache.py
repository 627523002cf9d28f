"""The cache of controllers, travel times and claims, which do not depend on the targets."""

import pytest
from small_floors import floor

from sysmlc.controllers.table import Table
from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.robots import claims
from sysmlc.robots import outcome as outcome_module
from sysmlc.robots.answers import Answers
from sysmlc.robots.crew_cache import CrewCache, decode_controller, encode_controller
from sysmlc.robots.outcome import run_study
from sysmlc.robots.report import study_files
from sysmlc.robots.robot_controller import ANY, controller_contract, measure_travel_times
from sysmlc.support.cache import Cache
from sysmlc.synthesis import Limits
from sysmlc.synthesis.controller_synthesis import Form, synthesise_controller
from sysmlc.synthesis.decision import Options

FIRST = floor(3, None, None, targets=(0, 8), deadline=40)
CHANGED = floor(3, 4, None, targets=(2, 6, 1), orders=((0, 1, True),), deadline=60)
"""The same floor and robots with another mission; one of the robots starts in a cell."""


def locate_nowhere(origin):
    return Subject()


@pytest.fixture
def crew_cache(tmp_path):
    return CrewCache(Cache(tmp_path), "this version")


def run_mission(study, crew_cache, has_relations=True, options=None):
    sink = Sink()
    outcome = run_study(
        study, locate_nowhere, sink, options or Options(), has_relations, crew_cache
    )
    return outcome, [
        (diagnostic.rule.code, diagnostic.message, diagnostic.notes) for diagnostic in sink
    ]


def forbid_computation(monkeypatch):
    """Let every further synthesis, measurement and decision fail."""

    def refuse_computation(*arguments, **options):
        raise AssertionError("computed again")

    for module, name in (
        (outcome_module, "synthesise_robot"),
        (outcome_module, "measure_travel_times"),
        (outcome_module, "decide"),
        (claims, "find_refinement_failures"),
        (claims, "Entailment"),
        (claims, "JointProof"),
    ):
        monkeypatch.setattr(module, name, refuse_computation)


def test_new_targets_need_only_a_new_allocation(crew_cache, monkeypatch):
    first, diagnostics = run_mission(FIRST, crew_cache)
    forbid_computation(monkeypatch)
    second, diagnostics_again = run_mission(CHANGED, crew_cache)
    assert second.is_good
    assert second.study is CHANGED
    assert second.controller.machine == first.controller.machine
    assert second.travel != first.travel
    assert diagnostics_again == diagnostics
    assert [claim.holds for claim in second.relations] == [claim.holds for claim in first.relations]


def test_cached_and_fresh_outcomes_are_equal(crew_cache):
    run_mission(FIRST, crew_cache)
    cached, diagnostics = run_mission(CHANGED, crew_cache)
    fresh, fresh_diagnostics = run_mission(CHANGED, None)
    assert dict(study_files(cached)) == dict(study_files(fresh))
    assert diagnostics == fresh_diagnostics


@pytest.mark.parametrize(
    "changed",
    [
        floor(3, None, None, None, targets=(0, 8)),
        floor(4, None, None, targets=(0, 8), rows=3),
        floor(3, None, None, targets=(0, 8), blocked=(4,)),
        floor(3, None, None, targets=(0, 8), within=9),
        floor(3, None, None, targets=(0, 8), counter_size=4),
    ],
)
def test_a_changed_floor_or_number_of_robots_misses_the_cache(changed, crew_cache, monkeypatch):
    run_mission(FIRST, crew_cache, has_relations=False)
    forbid_computation(monkeypatch)
    with pytest.raises(AssertionError, match="computed again"):
        run_mission(changed, crew_cache, has_relations=False)


def test_a_new_version_of_the_compiler_misses_the_cache(crew_cache, monkeypatch):
    run_mission(FIRST, crew_cache, has_relations=False)
    forbid_computation(monkeypatch)
    with pytest.raises(AssertionError, match="computed again"):
        run_mission(FIRST, CrewCache(crew_cache.cache, "the next version"), has_relations=False)


def test_claims_that_were_not_requested_are_decided_later(crew_cache):
    run_mission(FIRST, crew_cache, has_relations=False)
    outcome, _ = run_mission(FIRST, crew_cache)
    assert len(outcome.relations) == 11


def test_undecided_claims_are_decided_again(crew_cache):
    short = Options(limits=Limits(nodes=10))
    assert crew_cache.get(FIRST) is None
    run_mission(FIRST, crew_cache, has_relations=False)
    crew = crew_cache.get(FIRST)
    undecided = {
        claim.claim: claim
        for claim in claims.decide_claims(FIRST, outcome_module.travel_times_of(FIRST, {}), short)
    }
    assert None in {claim.holds for claim in undecided.values()}
    crew_cache.put(FIRST, outcome_module.replace(crew, claims=undecided))
    assert None not in {claim.holds for claim in crew_cache.get(FIRST).claims.values()}
    outcome, _ = run_mission(FIRST, crew_cache)
    assert None not in {claim.holds for claim in outcome.relations}


def test_a_damaged_entry_is_ignored(crew_cache):
    run_mission(FIRST, crew_cache, has_relations=False)
    key = crew_cache._key(FIRST)
    for data in (
        b"no JSON",
        b"{}",
        b"[{},[],[]]",
        b'[{"inputs":[],"outputs":["nobody"]},[],[]]',
    ):
        crew_cache.cache.put(key, data)
        assert crew_cache.get(FIRST) is None
    assert run_mission(FIRST, crew_cache, has_relations=False)[0].is_good


def test_a_table_is_cached_too():
    study = floor(2, None, targets=(3,))
    contract = controller_contract(study)
    result = synthesise_controller(contract, locate_nowhere, Sink(), Options(), Form.TABLE)
    assert isinstance(result.machine, Table)
    decoded = decode_controller(
        encode_controller(result.machine), reduce_contract(contract).contract.variables
    )
    assert decoded == result.machine
    answers = Answers(decoded, ANY, study.grid)
    assert measure_travel_times(study, (answers,))[3] == {0: 4, 1: 3, 2: 3, 3: 1}
