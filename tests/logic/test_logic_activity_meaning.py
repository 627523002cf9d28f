"""The contract of an activity allows exactly the runs of the reference interpreter."""

from hypothesis import given, settings
from hypothesis import strategies as st
from random_block_activities import (
    WAYS,
    blocks,
    build_tokens,
    draw_activity,
    list_successors,
    perform,
    play_trace,
)

from long_runs import examples
from sysmlc.analyses.activities import Activities
from sysmlc.logic import evaluate
from sysmlc.logic.activities import interpreter
from sysmlc.logic.activities.derivation import derive_contract
from sysmlc.logic.contract import Class, Owner


def list_violated(contract, trace):
    """Return the texts of the guarantees that a trace violates."""
    return [
        conjunct.text
        for conjunct in contract.guarantees
        if evaluate.find_violation(conjunct, trace) is not None
    ]


@settings(max_examples=examples(150), deadline=None)
@given(blocks(), st.booleans(), st.sampled_from(WAYS), st.integers(0, 2**16))
def test_every_run_of_an_activity_satisfies_the_guarantees(block, has_final, way, seed):
    tokens = perform(build_tokens(draw_activity(block, has_final)), way)
    assert list_violated(derive_contract(tokens), play_trace(tokens, seed, 60)) == []


@settings(max_examples=examples(100), deadline=None)
@given(blocks(), st.sampled_from(WAYS), st.integers(0, 2**16), st.data())
def test_a_run_with_one_changed_output_violates_a_guarantee(block, way, seed, data):
    """Any token is put somewhere or removed, any action starts or stops, at any step."""
    tokens = perform(build_tokens(draw_activity(block)), way)
    contract, trace = derive_contract(tokens), play_trace(tokens, seed, 30)
    outputs = [variable.name for variable in contract.variables if variable.owner is Owner.SYSTEM]
    name = data.draw(st.sampled_from(outputs))
    step = data.draw(st.integers(0, len(trace) - 1))
    trace[step] = {**trace[step], name: not trace[step][name]}
    assert list_violated(contract, trace)


@settings(max_examples=examples(100), deadline=None)
@given(blocks(), st.sampled_from(WAYS), st.integers(0, 2**16), st.data())
def test_a_changed_input_violates_a_guarantee_unless_the_next_step_is_still_possible(
    block, way, seed, data
):
    """The run continues as if an action had ended, or a guard had held, that did not."""
    tokens = perform(build_tokens(draw_activity(block)), way)
    contract, trace = derive_contract(tokens), play_trace(tokens, seed, 30)
    inputs = [variable.name for variable in contract.variables if variable.owner == "env"]
    if not inputs:
        return
    step = data.draw(st.integers(0, len(trace) - 2))
    name = data.draw(st.sampled_from(inputs))
    state = interpreter.state_of(tokens, trace[step])
    changed = {**{input: trace[step][input] for input in inputs}, name: not trace[step][name]}
    trace[step] = {**changed, **interpreter.values_of(tokens, state, changed)}
    successors = list_successors(tokens, trace[step], trace[step + 1])
    state = {variable: trace[step + 1][variable] for variable in successors[0]}
    assert bool(list_violated(contract, trace[: step + 2])) == (state not in successors)


@settings(max_examples=examples(100), deadline=None)
@given(blocks(), st.booleans(), st.integers(0, 2**16))
def test_a_well_formed_activity_finishes_when_the_environment_is_fair(block, has_final, seed):
    tokens = build_tokens(draw_activity(block, has_final))
    assert tokens.finishes
    ends = [
        conjunct.formula
        for conjunct in derive_contract(tokens).guarantees
        if conjunct.class_ is Class.LIVENESS
    ]
    # An activity of sends that ends in each step has no such guarantee: it would be "true".
    assert len(ends) == 1 or (not ends and not tokens.takes_time)
    trace = play_trace(tokens, seed, 1500)
    assert all(any(evaluate.is_true(end, valuation) for valuation in trace) for end in ends)


@settings(max_examples=examples(100), deadline=None)
@given(blocks(8), st.booleans(), st.integers(0, 2**16))
def test_collapsed_activities_satisfy_their_contracts_with_fewer_edges(block, has_final, seed):
    whole = build_tokens(draw_activity(block, has_final))
    collapsed = build_tokens(draw_activity(block, has_final), lambda: Activities(collapse_over=0))
    assert len(collapsed.edges) <= len(whole.edges)
    assert [node.run for node in collapsed.workers()] == [node.run for node in whole.workers()]
    assert list_violated(derive_contract(collapsed), play_trace(collapsed, seed, 60)) == []
