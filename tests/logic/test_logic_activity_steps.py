"""The contract of an activity with nodes of all kinds allows exactly the interpreter's steps."""

import random
from itertools import pairwise

from hypothesis import given, note, settings
from hypothesis import strategies as st
from random_block_activities import (
    WAYS,
    Valuation,
    draw_activity,
    list_successors,
    perform,
    play,
    play_trace,
    rich_blocks,
)

from long_runs import examples
from sysmlc.analyses.activities import Activities
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import print_text
from sysmlc.logic import domains, evaluate
from sysmlc.logic.activities import interpreter, reachability
from sysmlc.logic.activities.derivation import derive_contract
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_step import TokenStep
from sysmlc.logic.contract import Class, Contract, Owner


def build_tokens_if_safe(block, **options) -> TokenGraph | None:
    """Return the token graph; None when the activity is not 1-safe, which is reported."""
    graph, sink = draw_activity(block), Sink()
    note(print_text(graph))
    Activities(max_markings=4000, **options).run(graph, sink)
    graphs = graph.derived(TokenGraph)
    assert graphs or {diagnostic.rule.code for diagnostic in sink} & {"SM454", "SM455"}
    return perform(graphs[0], "repeated") if graphs else None


def is_allowed(contract: Contract, before: Valuation, after: Valuation) -> bool:
    """Whether the safety guarantees allow a step."""
    return all(
        evaluate.find_violation(conjunct, [before, after]) is None
        for conjunct in contract.guarantees
        if conjunct.class_ is Class.SAFETY
    )


@settings(max_examples=examples(60), deadline=None)
@given(rich_blocks(), st.sampled_from(WAYS), st.integers(0, 2**16))
def test_the_contract_allows_each_step_and_none_that_differs_in_one_variable(block, way, seed):
    tokens = build_tokens_if_safe(block)
    if tokens is None:
        return
    tokens = perform(tokens, way)
    contract = derive_contract(tokens)
    outputs = [variable.name for variable in contract.variables if variable.owner is Owner.SYSTEM]
    for before, after in pairwise(play_trace(tokens, seed, 10)):
        successors = list_successors(tokens, before, after)
        assert is_allowed(contract, before, after)
        for name in outputs:
            changed = {**after, name: not after[name]}
            is_step = {variable: changed[variable] for variable in successors[0]} in successors
            assert is_allowed(contract, before, changed) == is_step, name


@settings(max_examples=examples(120), deadline=None)
@given(rich_blocks(), st.sampled_from(WAYS), st.integers(0, 2**16))
def test_the_contract_allows_every_choice_of_the_interpreter(block, way, seed):
    tokens = build_tokens_if_safe(block)
    if tokens is None:
        return
    tokens = perform(tokens, way)
    contract = derive_contract(tokens)
    for before, after in pairwise(play_trace(tokens, seed, 26)):
        for successor in list_successors(tokens, before, after):
            assert is_allowed(contract, before, {**after, **successor})


@settings(max_examples=examples(40), deadline=None)
@given(rich_blocks(4))
def test_the_search_covers_all_states_that_the_interpreter_reaches(block):
    tokens = build_tokens_if_safe(block)
    if tokens is None:
        return
    input_domains = {variable.name: variable.domain for variable in tokens.inputs}
    if domains.count(input_domains) > 32:
        return
    search = reachability.explore_states(tokens, 3000)
    if not search.is_complete:
        return
    states, steps = list_reachable_states(tokens, input_domains)
    # Events and guards that depend on one another make the search see more, never less.
    assert len({(state.tokens, state.running) for state in states}) <= search.states
    assert tokens.finishes or not any(step.is_finished() for step in steps)
    for region in tokens.regions():
        assert tokens.can_rest(region) or not is_resting_reachable(region, steps)


def list_reachable_states(tokens: TokenGraph, input_domains):
    """Return the states that the interpreter reaches with any inputs and choices, and the steps."""
    worklist, steps = [interpreter.initial_state(tokens)], []
    states = {*worklist}
    for state in worklist:
        for inputs in domains.valuations(input_domains):
            steps.append(TokenStep(tokens, state, inputs, evaluate.is_true))
            valuation = {**inputs, **interpreter.values_of(tokens, state, inputs)}
            for successor in list_successors(tokens, valuation, inputs):
                next_state = interpreter.state_of(tokens, successor)
                if next_state not in states:
                    states.add(next_state)
                    worklist.append(next_state)
    return states, steps


def is_resting_reachable(region: str, steps: list[TokenStep]) -> bool:
    """Whether a region can be complete without a token at one of its ends."""
    return any(
        step.is_complete(region)
        and not step.reaches_final(region)
        and (not region or region in step.old.running)
        for step in steps
    )


@settings(max_examples=examples(60), deadline=None)
@given(rich_blocks(8), st.integers(0, 2**16))
def test_activities_with_collapsed_steps_satisfy_their_contracts(block, seed):
    tokens = build_tokens_if_safe(block, collapse_over=0)
    if tokens is None:
        return
    contract = derive_contract(tokens)
    for before, after in pairwise(play_trace(tokens, seed, 61)):
        assert is_allowed(contract, before, after)


@settings(max_examples=examples(60), deadline=None)
@given(rich_blocks(), st.integers(0, 2**16))
def test_a_rich_activity_finishes_when_the_environment_is_fair(block, seed):
    """Accept actions without incoming flows are excluded: in UML they wait for ever again."""
    tokens = build_tokens_if_safe(block)
    if tokens is None or not {"accept", "change"}.isdisjoint(list_words(block)):
        return
    assert tokens.finishes
    (finish,) = [
        conjunct
        for conjunct in derive_contract(tokens).guarantees
        if conjunct.class_ is Class.LIVENESS
    ]
    run = play(tokens, random.Random(seed), 1500)
    assert any(evaluate.is_true(finish.formula, valuation) for _, valuation in run)


def list_words(block) -> set[str]:
    return {block[0]}.union(*map(list_words, block[1:]))
