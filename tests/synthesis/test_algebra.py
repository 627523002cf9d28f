"""Relations between contracts: refinement and compatibility, with counterexamples."""

import os
from pathlib import Path

import pytest
from contracts_in_lines import parse_contract
from listed_runs import ListedRuns
from small_games import random_contract

from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Class
from sysmlc.logic.evaluate import evaluate_on_lasso
from sysmlc.logic.formats import read
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis import Manager
from sysmlc.synthesis.algebra.fair_systems import (
    DomainError,
    Runs,
    Universe,
    build_lasso,
    pick_state,
)
from sysmlc.synthesis.algebra.refinement import (
    Entailment,
    find_refinement_failures,
    has_environment,
)

DOOR = """
    env open: bool
    sys at: 0..3
    assume recurs open
    promise at first at=0
    promise always open & at<3 -> at'=at+1
    promise always !open | at=3 -> at'=at
    promise recurs at=3
"""


def find_failures(concrete, abstract):
    failures = find_refinement_failures(parse_contract(concrete), parse_contract(abstract), Manager)
    return [("assumes" if failure.is_assumption else "promises", failure) for failure in failures]


def describe_failures(failures):
    return [f"{side}: {failure.conjunct.text}" for side, failure in failures]


def test_a_contract_refines_itself():
    assert find_failures(DOOR, DOOR) == []


def test_a_refinement_promises_more_and_assumes_less():
    weaker = DOOR.replace("promise at first at=0\n", "")
    assert find_failures(DOOR, weaker) == []
    assert describe_failures(find_failures(weaker, DOOR)) == ["promises: at=0"]


def test_an_additional_assumption_is_named():
    demanding = f"{DOOR}\n assume always open -> open'"
    assert describe_failures(find_failures(demanding, DOOR)) == ["assumes: open -> open'"]


def test_an_implied_guarantee_need_not_be_written():
    assert find_failures(DOOR, f"{DOOR}\n promise always at'<3 -> at<3") == []


def test_the_run_shows_where_a_promise_fails():
    ((_, failure),) = find_failures(DOOR, f"{DOOR}\n promise always at<2 -> at'=at+1")
    first, second = failure.trace.steps[:2]
    assert (first["open"], first["at"], second["at"]) == (False, 0, 0)


def test_a_recurring_promise_fails_in_a_loop():
    lazy = DOOR.replace("    promise recurs at=3\n", "").replace("    assume recurs open\n", "")
    ((_, failure),) = find_failures(lazy, f"{lazy}\n promise recurs at=3")
    loop = failure.trace.steps[failure.trace.loop :]
    assert all(step["at"] < 3 for step in loop)


def test_contradictory_assumptions_have_no_environment():
    assert has_environment(parse_contract(DOOR), Manager())
    assert not has_environment(parse_contract(f"{DOOR}\n assume always !open'"), Manager())


def test_variables_of_one_name_must_have_the_same_values():
    with pytest.raises(DomainError, match="'at'"):
        find_failures(DOOR, DOOR.replace("0..3", "0..4"))


def iter_entailments(seed):
    """Yield each conjunct of a random contract, the others, and their entailment."""
    contract = random_contract(seed)
    conjuncts = (*contract.assumptions, *contract.guarantees)
    for conclusion in conjuncts:
        premises = tuple(conjunct for conjunct in conjuncts if conjunct is not conclusion)
        universe = Universe((contract,), Manager())
        yield contract, premises, conclusion, Entailment(universe, universe.system(premises))


def evaluate_on_trace(conjunct, trace):
    column = evaluate_on_lasso(conjunct.formula, trace.steps, trace.loop)
    match conjunct.class_:
        case Class.INIT:
            return column[0]
        case Class.SAFETY:
            return all(column)
        case _:
            return any(column[trace.loop :])


@pytest.mark.parametrize("start", range(0, 200, 20))
def test_answers_and_runs_agree_with_listed_states(start):
    for seed in range(start, start + 20):
        for contract, premises, conclusion, entailment in iter_entailments(seed):
            runs = ListedRuns(contract.variables, premises)
            trace = entailment.find_violation(conclusion)
            assert (trace is not None) == runs.is_violated(conclusion), (seed, conclusion)
            assert entailment.is_possible == runs.is_possible(), (seed, conclusion)
            if trace is not None:
                assert all(evaluate_on_trace(premise, trace) for premise in premises), (
                    seed,
                    conclusion,
                )
                assert not evaluate_on_trace(conclusion, trace), (seed, conclusion)


def test_random_entailments_have_both_answers_for_each_class():
    answers = {
        (w.class_, a.find_violation(w) is None)
        for s in range(60)
        for _, _, w, a in iter_entailments(s)
    }
    assert answers == {(c, t) for c in (Class.INIT, Class.SAFETY, Class.LIVENESS) for t in (0, 1)}


def build_entailment(lines):
    """Build the entailment whose premises are all conjuncts of the contract in *lines*."""
    contract = parse_contract(lines)
    universe = Universe((contract,), Manager())
    return Entailment(universe, universe.system((*contract.assumptions, *contract.guarantees)))


def parse_guarantee(lines):
    (guarantee,) = parse_contract(lines).guarantees
    return guarantee


def test_an_initial_condition_is_checked_in_the_first_step_only():
    turns = build_entailment("sys x: 0..1\npromise at first x=0\npromise always x'=1-x")
    assert turns.find_violation(parse_guarantee("sys x: 0..1\npromise at first x=0")) is None
    assert turns.find_violation(parse_guarantee("sys x: 0..1\npromise at first x=1")) is not None


DEAD_END = "sys a: bool\nsys b: bool\npromise always a & a'"
"""No run begins without ``a``, although no conjunct restricts the start."""


def test_an_example_begins_in_a_state_with_a_successor():
    example = build_entailment(DEAD_END).find_example()
    assert all(step["a"] for step in example.steps)


def test_a_finite_path_that_no_run_continues_is_no_violation():
    never = build_entailment(DEAD_END)
    assert (
        never.find_violation(parse_guarantee("sys a: bool\nsys b: bool\npromise at first a"))
        is None
    )
    assert (
        never.find_violation(parse_guarantee("sys a: bool\nsys b: bool\npromise always a'")) is None
    )


def test_no_lasso_is_built_from_a_state_without_fair_run():
    runs = build_entailment(DEAD_END).runs
    with pytest.raises(ValueError, match="no fair run"):
        build_lasso(runs, [pick_state(runs, runs.system.init & ~runs.fair)], runs.fair)


PAIRS = {
    ("move_wall_assumed", "move"): ["xtarget'<2"],
    ("move", "move_wall_assumed"): [],
    ("coordinator", "coordinator_must_turn"): ["turn_executed"],
    ("coordinator_must_turn", "coordinator"): [],
    ("turn", "turn"): [],
    ("turn", "turn_only_up"): ["angle>desired -> angle'=angle"],
    ("place", "place_no_pos"): ["command=place & pos"],
    ("pick_no_pos", "pick"): [],
    ("compose", "compose_no_collision"): ["!(arm1'=2 & arm2'=2)"],
}


@pytest.mark.corpus
@pytest.mark.parametrize("pair", PAIRS, ids=" ".join)
def test_actions_of_din_8580_refine_their_variants_or_not(pair):
    corpus = os.environ["SYSMLC_CORPUS"]
    folder = Path(corpus) / "gr1" / "din8580"
    (concrete,), (abstract,) = (
        read((folder / f"{name}.json").read_text(), name, Sink()) for name in pair
    )
    failures = find_refinement_failures(concrete, abstract, Manager)
    assert [print_formula(failure.conjunct.formula) for failure in failures] == PAIRS[pair]


def test_ranges_are_premises():
    narrow = "sys n: 0..2\npromise always n'=n"
    assert find_failures(narrow, f"{narrow}\npromise always n<3") == []


def test_a_conjunct_outside_gr1_is_reduced_with_an_observer():
    short = "env go: bool\nsys on: bool\npromise always on' <-> go'"
    response = "promise G (go -> F on)"
    assert describe_failures(find_failures(short, f"{short}\n{response}")) == [
        "promises: G (go -> F on)"
    ]
    persistent = f"{short}\nassume always go -> go'"
    assert find_failures(persistent, f"{persistent}\n{response}") == []


def test_a_conjunct_outside_gr1_is_decided_by_a_tableau():
    persistent = "promise G (F G on -> F on)"
    assert find_failures("sys on: bool", f"sys on: bool\n{persistent}") == []
    stable = "promise F G on"
    ((_, failure),) = find_failures("sys on: bool", f"sys on: bool\n{stable}")
    assert not all(step["on"] for step in failure.trace.steps[failure.trace.loop :])


def test_predecessors_among_reachable_states_ignore_steps_from_other_states():
    """The parts of the relation are larger than the set of reachable states."""
    contract = parse_contract("""
        env go: bool
        sys a: 0..15
        sys b: 0..15
        promise at first a=0 & b=0
        promise always a'=(a*b+a+b) mod 16
        promise always b'=(a*a+b*b) mod 16
        promise always go -> b<9
    """)
    universe = Universe((contract,), Manager())
    runs = Runs(universe.system(contract.guarantees))
    reachable = runs.reachable
    assert max(map(len, runs.system.parts)) > len(reachable)
    for states in (reachable, runs.system.init, universe.symbols.encode({"go": True})):
        before = runs.predecessors_among_reachable(states)
        assert reachable & before == reachable & runs.predecessors(states) != runs.manager.false
    assert runs.predecessors_among_reachable(reachable) != runs.predecessors(reachable)
