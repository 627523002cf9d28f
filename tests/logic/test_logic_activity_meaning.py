"""The contract of an activity says what the reference interpreter does: no more and no less."""

import random

from activity_models import activity, blocks, tokens_of
from hypothesis import given, settings
from hypothesis import strategies as st

from long_runs import examples
from sysmlc.logic import evaluate
from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities.derivation import derive_contract
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.contract import Class, Contract, Owner
from sysmlc.logic.domains import values
from sysmlc.logic.formula import Literal
from sysmlc.passes.activities import Activities

Trace = list[dict[str, Literal]]


def play(graph: TokenGraph, seed: int, steps: int) -> Trace:
    """A run with random inputs, and random choices where the diagram leaves one."""
    dice = random.Random(seed)
    state, trace = token_game.initial_state(graph), []
    for _ in range(steps):
        inputs = {v.name: dice.choice(values(v.domain)) for v in graph.inputs}
        trace.append({**inputs, **token_game.values_of(graph, state)})
        state = token_game.next_state(
            graph, state, inputs, evaluate.is_true, lambda _, open_: dice.choice(open_)
        )
    return trace


def violated(contract: Contract, trace: Trace) -> list[str]:
    return [
        part.text
        for part in contract.guarantees
        if evaluate.find_violation(part, trace) is not None
    ]


@settings(max_examples=examples(150), deadline=None)
@given(blocks(), st.booleans(), st.integers(0, 2**16))
def test_every_run_of_the_diagram_satisfies_the_guarantees(block, has_final, seed):
    tokens = tokens_of(activity(block, has_final))
    assert violated(derive_contract(tokens), play(tokens, seed, 60)) == []


@settings(max_examples=examples(100), deadline=None)
@given(blocks(), st.integers(0, 2**16), st.data())
def test_a_run_with_one_changed_system_value_is_detected(block, seed, data):
    """Any token put somewhere or taken away, any action run or stopped, at any step."""
    tokens = tokens_of(activity(block))
    contract, trace = derive_contract(tokens), play(tokens, seed, 30)
    system = [v.name for v in contract.variables if v.owner is Owner.SYSTEM]
    name = data.draw(st.sampled_from(system))
    at = data.draw(st.integers(0, len(trace) - 1))
    trace[at] = {**trace[at], name: not trace[at][name]}
    assert violated(contract, trace)


@settings(max_examples=examples(100), deadline=None)
@given(blocks(), st.integers(0, 2**16), st.data())
def test_a_changed_input_is_detected_when_it_matters(block, seed, data):
    """A run that goes on as if an action had ended, or a guard had held, that did not."""
    tokens = tokens_of(activity(block))
    contract, trace = derive_contract(tokens), play(tokens, seed, 30)
    if not tokens.inputs:
        return
    at = data.draw(st.integers(0, len(trace) - 2))
    name = data.draw(st.sampled_from([v.name for v in tokens.inputs]))
    trace[at] = {**trace[at], name: not trace[at][name]}
    allowed = successors(tokens, trace[at])
    system = {v: value for v, value in trace[at + 1].items() if v in allowed[0]}
    assert bool(violated(contract, trace[: at + 2])) == (system not in allowed)


def successors(tokens: TokenGraph, step: dict[str, Literal]) -> list[dict[str, Literal]]:
    """All next states of a step, whatever is chosen."""
    state = token_game.state_of(tokens, step)
    found = []
    for seed in range(64):
        dice = random.Random(seed)
        after = token_game.next_state(
            tokens, state, step, evaluate.is_true, lambda _, o, dice=dice: dice.choice(o)
        )
        found.append(token_game.values_of(tokens, after))
    return found


@settings(max_examples=examples(100), deadline=None)
@given(blocks(), st.booleans(), st.integers(0, 2**16))
def test_a_well_formed_activity_finishes_when_the_environment_is_fair(block, has_final, seed):
    tokens = tokens_of(activity(block, has_final))
    assert tokens.finishes
    (finish,) = [p for p in derive_contract(tokens).guarantees if p.class_ is Class.LIVENESS]
    trace = play(tokens, seed, 1500)
    assert any(evaluate.is_true(finish.formula, step) for step in trace)


@settings(max_examples=examples(100), deadline=None)
@given(blocks(8), st.booleans(), st.integers(0, 2**16))
def test_collapsed_activities_satisfy_their_contracts_with_fewer_edges(block, has_final, seed):
    whole = tokens_of(activity(block, has_final))
    small = tokens_of(activity(block, has_final), lambda: Activities(collapse_over=0))
    assert len(small.edges) <= len(whole.edges)
    assert [n.run for n in small.workers()] == [n.run for n in whole.workers()]
    assert violated(derive_contract(small), play(small, seed, 60)) == []
