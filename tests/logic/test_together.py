"""What may have tokens at the same time, and which values a variable may have there."""

import random

from activity_models import activity, rich, tokens_of
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from long_runs import examples
from sysmlc.logic import evaluate
from sysmlc.logic import formula as f
from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities.concurrency import ConcurrencyRelation
from sysmlc.logic.activities.step_formulas import StepFormulas
from sysmlc.logic.activities.token_graph import NodeKind, Store, Write
from sysmlc.logic.activities.value_analysis import ValueAnalysis
from sysmlc.logic.contract import IntegerDomain, Owner, Variable
from sysmlc.logic.domains import values
from sysmlc.logic.formula import Const, Op

RANGE = IntegerDomain(0, 3)
X = f.var("x")
FULL, ROOM = f.compare(Op.GT, X, Const(2)), f.compare(Op.LE, X, Const(2))
SET = ((f.TRUE, Const(0)),)
COUNT = ((FULL, Const(3)), (ROOM, f.compare(Op.ADD, X, Const(1))))


def drawn(block, has_final):
    """The token graph; None for what is not 1-safe."""
    try:
        return tokens_of(activity(block, has_final))
    except ValueError:
        return None


def written(tokens, dice):
    """The graph with a counter that its actions set and count."""
    writes = []
    for node in (one for one in tokens.workers() if one.kind is NodeKind.ACTION):
        is_counting = dice.random() < 0.6
        stops = (FULL,) if is_counting else ()
        writes.append(Write(node.id, "", COUNT if is_counting else SET, stops))
    variable = Variable("x", Owner.SYSTEM, RANGE, "a")
    first, is_local = dice.choice([0, 2]), dice.random() < 0.5
    return replace(tokens, stores=(Store(variable, tuple(writes), first, is_local),))


def played(tokens, dice, steps=80):
    """States of a run with the inputs that they are met with."""
    state = token_game.initial_state(tokens)
    for _ in range(steps):
        inputs = {one.name: dice.choice(values(one.domain)) for one in tokens.inputs}
        yield state, {**inputs, **token_game.values_of(tokens, state)}
        state = token_game.next_state(
            tokens, state, inputs, evaluate.is_true, lambda _, open_: dice.choice(open_)
        )


@settings(max_examples=examples(200), deadline=None)
@given(rich(7), st.booleans(), st.integers(0, 2**16))
def test_what_has_tokens_together_in_a_run_is_known_to(block, has_final, seed):
    tokens = drawn(block, has_final)
    if tokens is None:
        return
    together = ConcurrencyRelation(tokens)
    for state, _ in played(tokens, random.Random(seed)):
        places = sorted(state.tokens | state.running)
        for one in places:
            beside = {*together.list_concurrent_places(one)}
            assert {*places} - {one} <= beside
            assert all(together.are_concurrent(one, other) for other in beside)


@settings(max_examples=examples(300), deadline=None)
@given(rich(7), st.booleans(), st.integers(0, 2**16))
def test_a_value_that_stops_in_a_run_is_one_that_may(block, has_final, seed):
    tokens, dice = drawn(block, has_final), random.Random(seed)
    if tokens is None:
        return
    tokens = written(tokens, dice)
    (store,), game = tokens.stores, StepFormulas(tokens)
    spread = ValueAnalysis(tokens, ConcurrencyRelation(tokens), store)
    for state, now in played(tokens, dice):
        for write in store.writes if not token_game.is_finished(tokens, state) else ():
            ends = f.both(game.finish_formula(tokens.node(write.node)), *write.stops)
            if write.stops and evaluate.is_true(ends, now):
                assert spread.may_stop(write)
