"""The analyses of tokens at the same time and of values there cover all runs of an activity."""

import random

from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace
from random_block_activities import build_tokens, draw_activity, play, rich_blocks

from long_runs import examples
from sysmlc.logic import evaluate
from sysmlc.logic import formula as f
from sysmlc.logic.activities.concurrency import ConcurrencyRelation
from sysmlc.logic.activities.saturation import ValueAnalysis
from sysmlc.logic.activities.step_formulas import StepFormulas
from sysmlc.logic.activities.token_nodes import NodeKind, Store, Write
from sysmlc.logic.contract import IntegerDomain, Owner, Variable
from sysmlc.logic.formula import Const, Op

RANGE = IntegerDomain(0, 3)
X = f.var("x")
FULL, ROOM = f.compare(Op.GT, X, Const(2)), f.compare(Op.LE, X, Const(2))
SET = ((f.TRUE, Const(0)),)
COUNT = ((FULL, Const(3)), (ROOM, f.compare(Op.ADD, X, Const(1))))


def build_tokens_if_safe(block, has_final):
    """Return the token graph; None when the activity is not 1-safe."""
    try:
        return build_tokens(draw_activity(block, has_final))
    except ValueError:
        return None


def add_counter(tokens, dice):
    """Return the token graph with a counter that each action resets or increments."""
    writes = []
    for node in tokens.workers():
        if node.kind is NodeKind.ACTION:
            is_counting = dice.random() < 0.6
            stops = (FULL,) if is_counting else ()
            writes.append(Write(node.id, "", COUNT if is_counting else SET, stops))
    variable = Variable("x", Owner.SYSTEM, RANGE, "a")
    initial_value, is_local = dice.choice([0, 2]), dice.random() < 0.5
    store = Store(variable, tuple(writes), initial_value, is_local)
    return replace(tokens, stores=(store, *tokens.stores))


@settings(max_examples=examples(200), deadline=None)
@given(rich_blocks(7), st.booleans(), st.integers(0, 2**16))
def test_places_with_tokens_at_the_same_time_are_in_the_concurrency_relation(
    block, has_final, seed
):
    tokens = build_tokens_if_safe(block, has_final)
    if tokens is None:
        return
    relation = ConcurrencyRelation(tokens)
    for state, _ in play(tokens, random.Random(seed), 80):
        places = state.tokens | state.running
        for place in sorted(places):
            concurrent = {*relation.list_concurrent_places(place)}
            assert places - {place} <= concurrent
            assert all(relation.are_concurrent(place, other) for other in concurrent)


@settings(max_examples=examples(300), deadline=None)
@given(rich_blocks(7), st.booleans(), st.integers(0, 2**16))
def test_a_write_that_stops_in_a_run_may_stop_by_the_value_analysis(block, has_final, seed):
    tokens, dice = build_tokens_if_safe(block, has_final), random.Random(seed)
    if tokens is None:
        return
    tokens = add_counter(tokens, dice)
    store, formulas = tokens.stores[0], StepFormulas(tokens)
    analysis = ValueAnalysis(tokens, ConcurrencyRelation(tokens), store)
    for _, valuation in play(tokens, dice, 80):
        for write in store.writes:
            stops = f.both(formulas.finish_formula(tokens.node(write.node)), *write.stops)
            if write.stops and evaluate.is_true(stops, valuation):
                assert analysis.may_stop(write)
