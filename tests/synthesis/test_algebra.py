"""What contracts say of one another: refinement, compatibility, consistency, with runs."""

import os
from pathlib import Path

import pytest
from contracts_in_lines import contract
from listed_runs import Listed
from small_games import contract as random_contract

from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Class
from sysmlc.logic.evaluate import evaluate_on_lasso
from sysmlc.logic.formats import read
from sysmlc.logic.printing import print_formula
from sysmlc.synthesis import Manager, OutsideGr1Error
from sysmlc.synthesis.algebra.fair_systems import DomainError, Universe, build_lasso, pick_state
from sysmlc.synthesis.algebra.refinement import (
    Entailment,
    find_contract_run,
    find_environment_run,
    find_refinement_failures,
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


def failures(concrete, abstract):
    found = find_refinement_failures(contract(concrete), contract(abstract), Manager())
    return [("assumes" if one.is_assumption else "promises", one) for one in found]


def said(found):
    return [f"{side}: {one.conjunct.text}" for side, one in found]


def test_a_contract_refines_itself():
    assert failures(DOOR, DOOR) == []


def test_more_is_promised_and_less_is_assumed():
    weaker = DOOR.replace("promise at first at=0\n", "")
    assert failures(DOOR, weaker) == []
    assert said(failures(weaker, DOOR)) == ["promises: at=0"]


def test_what_is_assumed_in_addition_is_named():
    demanding = f"{DOOR}\n assume always open -> open'"
    assert said(failures(demanding, DOOR)) == ["assumes: open -> open'"]


def test_what_follows_need_not_be_written():
    assert failures(DOOR, f"{DOOR}\n promise always at'<3 -> at<3") == []


def test_the_run_shows_where_a_promise_fails():
    ((_, failure),) = failures(DOOR, f"{DOOR}\n promise always at<2 -> at'=at+1")
    now, then = failure.trace.steps[:2]
    assert (now["open"], now["at"], then["at"]) == (False, 0, 0)


def test_a_recurring_promise_fails_in_a_loop():
    lazy = DOOR.replace("    promise recurs at=3\n", "").replace("    assume recurs open\n", "")
    ((_, failure),) = failures(lazy, f"{lazy}\n promise recurs at=3")
    loop = failure.trace.steps[failure.trace.loop :]
    assert all(one["at"] < 3 for one in loop)


def test_a_contract_without_runs_is_not_consistent():
    assert find_contract_run(contract(DOOR), Manager()) is not None
    assert find_contract_run(contract(f"{DOOR}\n promise always at'=0"), Manager()) is None


def test_an_environment_that_cannot_exist():
    assert find_environment_run(contract(DOOR), Manager()) is not None
    assert find_environment_run(contract(f"{DOOR}\n assume always !open'"), Manager()) is None


def test_variables_of_one_name_must_have_the_same_values():
    with pytest.raises(DomainError, match="'at'"):
        failures(DOOR, DOOR.replace("0..3", "0..4"))


def entailments(seed):
    """A random contract's conjuncts, each asked of all the others."""
    made = random_contract(seed)
    every = (*made.assumptions, *made.guarantees)
    for wanted in every:
        given = tuple(one for one in every if one is not wanted)
        universe = Universe((made,), Manager())
        yield made, given, wanted, Entailment(universe, universe.system(given))


def holds(conjunct, trace):
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
        for made, given, wanted, asked in entailments(seed):
            listed = Listed(made.variables, given)
            trace = asked.find_violation(wanted)
            assert (trace is not None) == listed.is_violated(wanted), (seed, wanted)
            assert asked.is_possible == listed.is_possible(), (seed, wanted)
            if trace is not None:
                assert all(holds(one, trace) for one in given), (seed, wanted)
                assert not holds(wanted, trace), (seed, wanted)


def test_the_random_questions_have_both_answers():
    answers = {
        (w.class_, a.find_violation(w) is None) for s in range(60) for _, _, w, a in entailments(s)
    }
    assert answers == {(c, t) for c in (Class.INIT, Class.SAFETY, Class.LIVENESS) for t in (0, 1)}


def asked(lines):
    """What is asked of all runs in which the conjuncts of a contract in lines hold."""
    made = contract(lines)
    universe = Universe((made,), Manager())
    return Entailment(universe, universe.system((*made.assumptions, *made.guarantees)))


def wanted(lines):
    (found,) = contract(lines).guarantees
    return found


def test_what_is_wanted_at_first_is_looked_for_at_first_only():
    turns = asked("sys x: 0..1\npromise at first x=0\npromise always x'=1-x")
    assert turns.find_violation(wanted("sys x: 0..1\npromise at first x=0")) is None
    assert turns.find_violation(wanted("sys x: 0..1\npromise at first x=1")) is not None


DEAD_END = "sys a: bool\nsys b: bool\npromise always a & a'"
"""Without ``a`` no run begins, though nothing is said about the start."""


def test_an_example_begins_where_a_run_goes_on():
    found = asked(DEAD_END).find_example()
    assert all(one["a"] for one in found.steps)


def test_a_way_that_no_run_goes_on_from_is_no_violation():
    never = asked(DEAD_END)
    assert never.find_violation(wanted("sys a: bool\nsys b: bool\npromise at first a")) is None
    assert never.find_violation(wanted("sys a: bool\nsys b: bool\npromise always a'")) is None


def test_from_what_has_no_run_none_is_shown():
    runs = asked(DEAD_END).runs
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
    corpus = os.environ.get("SYSMLC_CORPUS")
    if not corpus:
        pytest.skip("SYSMLC_CORPUS is not set")
    folder = Path(corpus) / "gr1" / "din8580"
    (concrete,), (abstract,) = (
        read((folder / f"{name}.json").read_text(), name, Sink()) for name in pair
    )
    found = find_refinement_failures(concrete, abstract, Manager())
    assert [print_formula(one.conjunct.formula) for one in found] == PAIRS[pair]


def test_ranges_are_given():
    narrow = "sys n: 0..2\npromise always n'=n"
    assert failures(narrow, f"{narrow}\npromise always n<3") == []


def test_what_is_outside_gr1_is_observed():
    short = "env go: bool\nsys on: bool\npromise always on' <-> go'"
    asked = "promise G (go -> F on)"
    assert said(failures(short, f"{short}\n{asked}")) == ["promises: G (go -> F on)"]
    held = f"{short}\nassume always go -> go'"
    assert failures(held, f"{held}\n{asked}") == []


def test_what_no_reduction_is_known_for_is_named():
    with pytest.raises(OutsideGr1Error) as caught:
        failures("sys on: bool", "sys on: bool\npromise G (F G on -> F on)")
    assert caught.value.conjunct.text == "G (F G on -> F on)"
