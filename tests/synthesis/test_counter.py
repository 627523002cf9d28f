"""How the environment wins: ranks, its strategy, the machine, the game, the drawings."""

import random
from itertools import pairwise

import pytest
from contracts_in_lines import contract
from explicit import Explicit, rules, valuations
from small_games import contract as random_contract

from sysmlc.logic.contract import Class, Owner
from sysmlc.logic.evaluate import compile_evaluation
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.synthesis import LimitError, Manager, make_game
from sysmlc.synthesis.counterstrategy.counter_files import counterstrategy_files
from sysmlc.synthesis.counterstrategy.counter_machine import (
    build_counterstrategy,
    example_run,
    find_environment_strategy,
)
from sysmlc.synthesis.counterstrategy.environment_strategy import (
    EnvironmentStrategy,
    NotLostError,
    find_ranks,
)
from sysmlc.synthesis.counterstrategy.play import Player
from sysmlc.synthesis.decision import Options
from sysmlc.synthesis.witnesses import describe_run

LAMP = """
    env go: bool
    sys at: 0..1
    promise at first at=0
    promise always at'=at+1 | at'=at
    promise always go' -> at'=at
    promise recurs at=1
"""
STUCK = """
    env go: bool
    sys on: bool
    promise always go' -> on'
    promise always on -> !on'
"""


def environment(text):
    return EnvironmentStrategy(find_ranks(make_game(reduce_contract(text).contract, Manager())))


def defeated(text):
    made = contract(text)
    return build_counterstrategy(environment(made), made)


def test_what_never_comes_is_prevented_for_ever():
    found = defeated(LAMP)
    assert [(one.inputs, len(one.moves)) for one in found.states] == [((False,), 1), ((True,), 1)]
    assert list(describe_run(example_run(found))) == [
        "step 1: go=false, at=0",
        "step 2: go=true",
        "then again from step 2",
    ]


def test_a_component_without_an_answer_ends_the_run():
    found = defeated(STUCK)
    assert list(describe_run(example_run(found)))[-1] == "then there is no answer"
    assert [one.inputs for one in found.states if not one.moves] == [(True,)]


def test_the_environment_prevents_what_it_can_and_does_not_wait_for_other_goals():
    busy = contract(f"sys n: 0..1\nsys m: 0..1\n{LAMP}\npromise recurs n=1\npromise recurs m=1")
    found = build_counterstrategy(find_environment_strategy(busy, Options()), busy)
    assert len(found.states) == 2
    assert "go=true" in list(describe_run(example_run(found)))[1]


def test_a_contract_that_can_be_kept_is_not_defeated():
    with pytest.raises(NotLostError):
        defeated(f"{LAMP}\nassume recurs !go\npromise recurs go | !go")


def test_what_is_assumed_is_kept_by_the_environment():
    polite = LAMP.replace("always go ->", "always ->").replace(
        "promise always ->", "promise always"
    )
    polite = f"{LAMP}\nassume recurs !go\npromise always !go' -> at'=0"
    found = defeated(polite)
    trace = example_run(found)
    assert any(not one["go"] for one in trace.steps[trace.loop :])


def losing(seed):
    """A random play in which a random component is defeated by the environment's strategy."""
    made, die = random_contract(seed), random.Random(seed)
    try:
        playing = environment(made)
    except NotLostError:
        return made, None
    state, fair, given, steps, marks = None, 0, playing.first, [], {}
    decode = playing.lost_game.arena.symbols.decode
    while True:
        answers = list(playing.iter_answers(state, given))
        if not answers:
            return made, ([*steps, decode(given)], None)
        state = {**given, **die.choice(answers)}
        steps.append(decode(state))
        key = tuple(state.values()), fair
        if key in marks and len(steps) > 60:
            return made, (steps, marks[key])
        marks[key] = len(steps)
        given, fair = playing.next_inputs(state, fair)


@pytest.mark.parametrize("start", range(0, 300, 50))
def test_random_contracts_are_defeated_exactly_when_they_cannot_be_kept(start):
    for seed in range(start, start + 50):
        made, play = losing(seed)
        assert (play is None) == Explicit(made).is_realizable(), seed
        if play is not None:
            check_defeat(made, *play, seed)


def check_defeat(made, steps, loop, seed):
    """The environment keeps what is assumed; the component is stuck, or a goal does not recur."""
    inputs = {one.name for one in made.variables if one.owner is Owner.ENVIRONMENT}
    assumed, first = rules(made.assumptions, Class.SAFETY), rules(made.assumptions, Class.INIT)
    assert all(rule(steps[0], None) for rule in first), seed
    for now, then in pairwise(steps):
        given = {name: value for name, value in then.items() if name in inputs}
        assert all(rule(now, given) for rule in assumed), seed
    if loop is None:
        before = steps[-2] if len(steps) > 1 else None
        assert not list(allowed(made, before, steps[-1])), seed


def allowed(made, before, given):
    """The answers that what is promised allows."""
    promised = rules(made.guarantees, Class.SAFETY if before else Class.INIT)
    for out in valuations(made, Owner.SYSTEM):
        now = {**given, **out}
        if all(rule(before, now) if before else rule(now, None) for rule in promised):
            yield out


@pytest.mark.parametrize("start", range(0, 300, 50))
def test_in_every_loop_of_the_machine_all_assumptions_recur_and_one_goal_does_not(start):
    for seed in range(start, start + 50):
        made = random_contract(seed)
        try:
            found = build_counterstrategy(environment(made), made)
        except NotLostError:
            continue
        trace = example_run(found)
        loop = trace.steps[trace.loop :]
        if not loop:
            continue
        fair = [
            compile_evaluation(one.formula)
            for one in made.assumptions
            if one.class_ is Class.LIVENESS
        ]
        goals = [
            compile_evaluation(one.formula)
            for one in made.guarantees
            if one.class_ is Class.LIVENESS
        ]
        assert all(any(rule(step, None) for step in loop) for rule in fair), seed
        assert any(not any(rule(step, None) for step in loop) for rule in goals), seed


def test_a_machine_beyond_the_limit_is_none():
    made = contract(LAMP)
    with pytest.raises(LimitError, match="answers of the system"):
        build_counterstrategy(environment(made), made, max_moves=0)


def played(text, *answers):
    made, said, left = contract(text, "Lamp"), [], list(answers)

    def read(_):
        if not left:
            raise EOFError
        return left.pop(0)

    return Player(environment(made), made, read, said.append).play(), said


def test_the_game_says_what_an_answer_breaks_and_how_it_ends():
    has_ended, said = played(LAMP, "at=1", "at=0", "options", "at=5", "up=1", "at=1", "", "")
    assert has_ended
    assert said[1:] == [
        "step 1: go=false",
        "That breaks 'at=0'.",
        "     at=0",
        "step 2: go=true",
        "     at=0",
        "'at' is one of 0, 1",
        "'up' is not yours; yours are at",
        "That breaks 'go' -> at'=at'.",
        "     at=0",
        "step 3: nothing changes",
        "     at=0",
        "Step 3 is step 2 again, and the environment can go on so for ever:\n"
        "'at=1' does not come about again. You have lost.",
    ]


def test_the_game_ends_where_there_is_no_answer_or_the_reader_gives_up():
    has_ended, said = played(STUCK, "", "", "", "")
    assert has_ended
    assert said[-1] == "You have no answer: each one breaks what you promise. You have lost."
    assert played(STUCK)[0] is False
    assert played(STUCK, "quit")[0] is False


def test_the_game_names_what_an_answer_has_broken_at_once():
    text = "env go: bool\nsys at: 0..1\npromise always !go -> at=0\npromise recurs at=1"
    _, said = played(text, "at=1", "", "")
    assert said[1:3] == ["step 1: go=false", "     at=1"]
    assert said[-1] == "Your last answer breaks '!go -> at=0'. You have lost."


def test_the_game_shows_a_formula_as_it_was_written():
    _, said = played("env go: bool\nsys at: 0..1\npromise G (go -> F at=1)\n" + STAY, *[""] * 9)
    assert said[-1].endswith("'G (go -> F at=1)' is not kept. You have lost.")


STAY = "promise at first at=0\npromise always at'=at"


def test_history_bits_are_nobodys_business():
    made = "env ask: bool\nsys done: bool\npromise always !done'\npromise G (ask -> F done)"
    found = defeated(made)
    assert [one.name for one in found.outputs] == ["done"]


def test_files_of_a_counter_strategy():
    made = contract(STUCK, "Plant::Lamp")
    found = dict(
        counterstrategy_files(
            [(build_counterstrategy(environment(made), made), made)], lambda origin: origin
        )
    )
    assert list(found) == [
        "Plant.Lamp.counter.puml",
        "Plant.Lamp.counter-run.puml",
        "Plant.Lamp.counter.sysml",
    ]
    assert "note over p1 : no answer is left" in found["Plant.Lamp.counter-run.puml"]
    assert "<b>no answer is left</b>" in found["Plant.Lamp.counter.puml"]


@pytest.mark.plantuml
def test_plantuml_draws_them(plantuml):
    made = contract(STUCK, "Plant::Lamp")
    found = dict(
        counterstrategy_files(
            [(build_counterstrategy(environment(made), made), made)], lambda origin: origin
        )
    )
    texts = {name: text for name, text in found.items() if name.endswith(".puml")}
    drawn = plantuml.render(texts)
    assert all(
        b"no answer is left" in picture.replace(b"&#160;", b" ") for picture in drawn.values()
    )
