"""Counterstrategies: ranks, the environment's strategy, its machine, the game and the diagrams."""

import random
from itertools import pairwise

import pytest
from contracts_in_lines import parse_contract
from explicit import ExplicitGame, list_evaluations, list_valuations
from small_games import random_contract

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


def build_environment(text):
    return EnvironmentStrategy(find_ranks(make_game(reduce_contract(text).contract, Manager())))


def build_counter_machine(text):
    contract = parse_contract(text)
    return build_counterstrategy(build_environment(contract), contract)


def test_the_environment_prevents_a_goal_for_ever():
    machine = build_counter_machine(LAMP)
    assert [(state.inputs, len(state.moves)) for state in machine.states] == [
        ((False,), 1),
        ((True,), 1),
    ]
    assert list(describe_run(example_run(machine))) == [
        "step 1: go=false, at=0",
        "step 2: go=true",
        "then again from step 2",
    ]


def test_a_counterstrategy_answers_step_by_step():
    machine = build_counter_machine(LAMP)
    assert machine.inputs_in(0) == {"go": False}
    assert machine.step(0, {"at": 0}) == ({"go": True}, 1)
    with pytest.raises(LookupError):
        machine.step(0, {"at": 1})


def test_a_component_without_an_answer_ends_the_run():
    machine = build_counter_machine(STUCK)
    assert list(describe_run(example_run(machine)))[-1] == "then there is no answer"
    assert [state.inputs for state in machine.states if not state.moves] == [(True,)]


def test_the_environment_prevents_a_goal_without_waiting_for_others():
    busy = parse_contract(
        f"sys n: 0..1\nsys m: 0..1\n{LAMP}\npromise recurs n=1\npromise recurs m=1"
    )
    machine = build_counterstrategy(find_environment_strategy(busy, Options()), busy)
    assert len(machine.states) == 2
    assert "go=true" in list(describe_run(example_run(machine)))[1]


def test_a_realizable_contract_has_no_counterstrategy():
    with pytest.raises(NotLostError):
        build_counter_machine(f"{LAMP}\nassume recurs !go\npromise recurs go | !go")


def test_the_environment_satisfies_the_assumptions():
    polite = LAMP.replace("always go ->", "always ->").replace(
        "promise always ->", "promise always"
    )
    polite = f"{LAMP}\nassume recurs !go\npromise always !go' -> at'=0"
    machine = build_counter_machine(polite)
    trace = example_run(machine)
    assert any(not step["go"] for step in trace.steps[trace.loop :])


def play_and_lose(seed):
    """Play random answers against the environment's strategy.

    Return the contract and the play as steps and start of the loop, or None if it is realizable.
    """
    contract, die = random_contract(seed), random.Random(seed)
    try:
        strategy = build_environment(contract)
    except NotLostError:
        return contract, None
    state, fair, inputs, steps, visits = None, 0, strategy.first, [], {}
    decode = strategy.lost_game.arena.symbols.decode
    while True:
        answers = list(strategy.iter_answers(state, inputs))
        if not answers:
            return contract, ([*steps, decode(inputs)], None)
        state = {**inputs, **die.choice(answers)}
        steps.append(decode(state))
        key = tuple(state.values()), fair
        if key in visits and len(steps) > 60:
            return contract, (steps, visits[key])
        visits[key] = len(steps)
        inputs, fair = strategy.next_inputs(state, fair)


@pytest.mark.parametrize("start", range(0, 300, 50))
def test_random_contracts_lose_exactly_if_they_are_unrealizable(start):
    for seed in range(start, start + 50):
        contract, play = play_and_lose(seed)
        assert (play is None) == ExplicitGame(contract).is_realizable(), seed
        if play is not None:
            check_defeat(contract, *play, seed)


def check_defeat(contract, steps, loop, seed):
    """Check that the play satisfies the assumptions and, if it is finite, has no allowed answer."""
    inputs = {
        variable.name for variable in contract.variables if variable.owner is Owner.ENVIRONMENT
    }
    assumptions, initial_assumptions = (
        list_evaluations(contract.assumptions, Class.SAFETY),
        list_evaluations(contract.assumptions, Class.INIT),
    )
    assert all(rule(steps[0], None) for rule in initial_assumptions), seed
    for current, following in pairwise(steps):
        next_inputs = {name: value for name, value in following.items() if name in inputs}
        assert all(rule(current, next_inputs) for rule in assumptions), seed
    if loop is None:
        before = steps[-2] if len(steps) > 1 else None
        assert not list(iter_allowed_outputs(contract, before, steps[-1])), seed


def iter_allowed_outputs(contract, before, inputs):
    """Yield the outputs that the guarantees allow."""
    guarantees = list_evaluations(contract.guarantees, Class.SAFETY if before else Class.INIT)
    for outputs in list_valuations(contract, Owner.SYSTEM):
        step = {**inputs, **outputs}
        if all(rule(before, step) if before else rule(step, None) for rule in guarantees):
            yield outputs


@pytest.mark.parametrize("start", range(0, 300, 50))
def test_in_every_loop_of_the_machine_all_assumptions_recur_and_one_goal_does_not(start):
    for seed in range(start, start + 50):
        contract = random_contract(seed)
        try:
            machine = build_counterstrategy(build_environment(contract), contract)
        except NotLostError:
            continue
        trace = example_run(machine)
        loop = trace.steps[trace.loop :]
        if not loop:
            continue
        fair = [
            compile_evaluation(conjunct.formula)
            for conjunct in contract.assumptions
            if conjunct.class_ is Class.LIVENESS
        ]
        goals = [
            compile_evaluation(conjunct.formula)
            for conjunct in contract.guarantees
            if conjunct.class_ is Class.LIVENESS
        ]
        assert all(any(rule(step, None) for step in loop) for rule in fair), seed
        assert any(not any(rule(step, None) for step in loop) for rule in goals), seed


def test_a_machine_beyond_the_limit_raises():
    contract = parse_contract(LAMP)
    with pytest.raises(LimitError, match="answers of the system"):
        build_counterstrategy(build_environment(contract), contract, max_moves=0)


def play_lines(text, *answers):
    contract, output, remaining = parse_contract(text, "Lamp"), [], list(answers)

    def read(_):
        if not remaining:
            raise EOFError
        return remaining.pop(0)

    return Player(build_environment(contract), contract, read, output.append).play(), output


def test_the_game_reports_violated_guarantees_and_its_end():
    has_ended, output = play_lines(LAMP, "at=1", "at=0", "options", "at=5", "up=1", "at=1", "", "")
    assert has_ended
    assert output[1:] == [
        "step 1: go=false",
        "This answer violates 'at=0'.",
        "     at=0",
        "step 2: go=true",
        "     at=0",
        "'at' is one of 0, 1",
        "'up' is not an output; the outputs are at",
        "This answer violates 'go' -> at'=at'.",
        "     at=0",
        "step 3: nothing changes",
        "     at=0",
        "Step 3 equals step 2, and the environment can repeat this for ever:\n"
        "'at=1' never holds again. You have lost.",
    ]


def test_the_game_ends_without_answers_or_when_the_player_quits():
    has_ended, output = play_lines(STUCK, "", "", "", "")
    assert has_ended
    assert output[-1] == "No answer is allowed: each one violates a guarantee. You have lost."
    assert play_lines(STUCK)[0] is False
    assert play_lines(STUCK, "quit")[0] is False


def test_the_game_names_the_guarantee_that_the_last_answer_violates():
    text = "env go: bool\nsys at: 0..1\npromise always !go -> at=0\npromise recurs at=1"
    _, output = play_lines(text, "at=1", "", "")
    assert output[1:3] == ["step 1: go=false", "     at=1"]
    assert output[-1] == "Your last answer violates '!go -> at=0'. You have lost."


def test_the_game_shows_a_formula_as_it_was_written():
    _, output = play_lines(
        "env go: bool\nsys at: 0..1\npromise G (go -> F at=1)\n" + STAY, *[""] * 9
    )
    assert output[-1].endswith("'G (go -> F at=1)' is violated. You have lost.")


STAY = "promise at first at=0\npromise always at'=at"


def test_history_bits_are_no_outputs_of_the_machine():
    text = "env ask: bool\nsys done: bool\npromise always !done'\npromise G (ask -> F done)"
    machine = build_counter_machine(text)
    assert [variable.name for variable in machine.outputs] == ["done"]


def test_files_of_a_counter_strategy():
    contract = parse_contract(STUCK, "Plant::Lamp")
    files = dict(
        counterstrategy_files(
            [(build_counterstrategy(build_environment(contract), contract), contract)],
            lambda origin: origin,
        )
    )
    assert list(files) == [
        "Plant.Lamp.counter.puml",
        "Plant.Lamp.counter-run.puml",
        "Plant.Lamp.counter.sysml",
    ]
    assert "note over p1 : no answer is left" in files["Plant.Lamp.counter-run.puml"]
    assert "<b>no answer is left</b>" in files["Plant.Lamp.counter.puml"]


@pytest.mark.plantuml
def test_plantuml_draws_counterstrategies(plantuml):
    contract = parse_contract(STUCK, "Plant::Lamp")
    files = dict(
        counterstrategy_files(
            [(build_counterstrategy(build_environment(contract), contract), contract)],
            lambda origin: origin,
        )
    )
    texts = {name: text for name, text in files.items() if name.endswith(".puml")}
    drawings = plantuml.render(texts)
    assert all(
        b"no answer is left" in picture.replace(b"&#160;", b" ") for picture in drawings.values()
    )
