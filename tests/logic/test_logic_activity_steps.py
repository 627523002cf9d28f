"""The formulas of rich activities admit exactly the steps that the reference interpreter plays."""

import random
from collections.abc import Iterator

from activity_models import activity, rich
from hypothesis import given, note, settings
from hypothesis import strategies as st

from long_runs import examples
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import print_text
from sysmlc.logic import domains, evaluate
from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities import reachability as token_search
from sysmlc.logic.activities.derivation import derive_contract
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.contract import Class, Contract, Owner
from sysmlc.logic.domains import values
from sysmlc.logic.formula import Literal
from sysmlc.passes.activities import Activities

Valuation = dict[str, Literal]


def tokens_of(block, **options) -> TokenGraph | None:
    """The token graph, or nothing when the activity is not 1-safe, which is reported."""
    graph, sink = activity(block), Sink()
    note(print_text(graph))
    Activities(max_markings=4000, **options).run(graph, sink)
    made = graph.derived(TokenGraph)
    assert made or {found.rule.code for found in sink} & {"SM454", "SM455"}
    return made[0] if made else None


def steps(tokens: TokenGraph, seed: int, length: int) -> Iterator[tuple[Valuation, Valuation]]:
    """A random run as steps, each with the inputs that follow."""
    dice = random.Random(seed)
    state, inputs = token_game.initial_state(tokens), drawn(tokens, dice)
    for _ in range(length):
        now = {**inputs, **token_game.values_of(tokens, state)}
        state = token_game.next_state(
            tokens, state, inputs, evaluate.is_true, lambda _, open_: dice.choice(open_)
        )
        inputs = drawn(tokens, dice)
        yield now, {**inputs, **token_game.values_of(tokens, state)}


def drawn(tokens: TokenGraph, dice: random.Random) -> Valuation:
    return {v.name: dice.choice(values(v.domain)) for v in tokens.inputs}


def is_allowed(contract: Contract, now: Valuation, then: Valuation) -> bool:
    """Whether the guarantees about steps allow this one."""
    return all(
        evaluate.find_violation(part, [now, then]) is None
        for part in contract.guarantees
        if part.class_ is Class.SAFETY
    )


def following(tokens: TokenGraph, now: Valuation) -> list[Valuation]:
    """All states that the interpreter lets follow, whatever is chosen."""
    state, found, waiting = token_game.state_of(tokens, now), [], [[]]
    while waiting:
        plan = waiting.pop()
        counts: list[int] = []

        def choose(_, open_, plan=plan, counts=counts):
            counts.append(len(open_))
            return open_[plan[len(counts) - 1] if len(counts) <= len(plan) else 0]

        after = token_game.next_state(tokens, state, now, evaluate.is_true, choose)
        found.append(token_game.values_of(tokens, after))
        for place in range(len(plan), len(counts)):
            head = plan + [0] * (place - len(plan))
            waiting += [[*head, other] for other in range(1, counts[place])]
    return found


@settings(max_examples=examples(60), deadline=None)
@given(rich(), st.integers(0, 2**16))
def test_each_step_is_allowed_and_no_step_that_differs_in_one_variable(block, seed):
    tokens = tokens_of(block)
    if tokens is None:
        return
    contract = derive_contract(tokens)
    system = [v.name for v in contract.variables if v.owner is Owner.SYSTEM]
    for now, then in steps(tokens, seed, 9):
        allowed = following(tokens, now)
        assert is_allowed(contract, now, then)
        for name in system:
            changed = {**then, name: not then[name]}
            is_step = {v: changed[v] for v in allowed[0]} in allowed
            assert is_allowed(contract, now, changed) == is_step, name


@settings(max_examples=examples(120), deadline=None)
@given(rich(), st.integers(0, 2**16))
def test_every_choice_that_the_interpreter_has_is_allowed(block, seed):
    tokens = tokens_of(block)
    if tokens is None:
        return
    contract = derive_contract(tokens)
    for now, then in steps(tokens, seed, 25):
        assert all(is_allowed(contract, now, {**then, **after}) for after in following(tokens, now))


@settings(max_examples=examples(40), deadline=None)
@given(rich(4))
def test_the_search_finds_the_states_that_the_interpreter_reaches(block):
    tokens = tokens_of(block)
    if tokens is None or domains.count({v.name: v.domain for v in tokens.inputs}) > 32:
        return
    reached = token_search.explore_states(tokens, 3000)
    if not reached.is_complete:
        return
    first = token_game.initial_state(tokens)
    seen, waiting = {first}, [first]
    for state in waiting:
        for inputs in domains.valuations({v.name: v.domain for v in tokens.inputs}):
            now = {**inputs, **token_game.values_of(tokens, state)}
            for after in following(tokens, now):
                found = token_game.state_of(tokens, after)
                if found not in seen:
                    seen.add(found)
                    waiting.append(found)
    # Events and guards that depend on one another make the search see more, never less.
    assert len(seen) <= reached.states
    assert tokens.finishes or not any(token_game.is_finished(tokens, state) for state in seen)
    resting = {r for r in tokens.regions() if tokens.can_rest(r)}
    assert resting >= {r for r in tokens.regions() if _rests(tokens, r, seen)}


def _rests(tokens: TokenGraph, region: str, states) -> bool:
    return any(
        token_game.is_complete(tokens, state, region)
        and not any(edge.id in state.tokens for edge in tokens.ends(region))
        and (not region or region in state.running)
        and (not region or not token_game.is_finished(tokens, state))
        for state in states
    )


@settings(max_examples=examples(60), deadline=None)
@given(rich(8), st.integers(0, 2**16))
def test_collapsed_rich_activities_keep_their_contracts(block, seed):
    tokens = tokens_of(block, collapse_over=0)
    if tokens is None:
        return
    contract = derive_contract(tokens)
    assert all(is_allowed(contract, now, then) for now, then in steps(tokens, seed, 60))


@settings(max_examples=examples(60), deadline=None)
@given(rich(), st.integers(0, 2**16))
def test_a_rich_activity_finishes_when_the_environment_is_fair(block, seed):
    """But for accept actions that nothing starts: by UML they listen again for ever."""
    tokens = tokens_of(block)
    if tokens is None or "accept" in words(block):
        return
    assert tokens.finishes
    (finish,) = [p for p in derive_contract(tokens).guarantees if p.class_ is Class.LIVENESS]
    assert any(evaluate.is_true(finish.formula, now) for now, _ in steps(tokens, seed, 1500))


def words(block) -> set[str]:
    return {block[0]}.union(*map(words, block[1:]))
