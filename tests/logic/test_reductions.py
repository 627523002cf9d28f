"""Reductions to GR(1); Spot judges that every one is an equivalence."""

import pytest
import spot
from hypothesis import given, settings
from hypothesis import strategies as st
from random_contracts import apply_binary, apply_unary

from long_runs import examples
from spot_formulas import conjoin, conjoin_parts, print_for_spot
from sysmlc.logic import formula as f
from sysmlc.logic.classification import classify
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner, Variable
from sysmlc.logic.formal_texts import read_temporal_logic
from sysmlc.logic.formula import Op, Var
from sysmlc.logic.infix import parse_formula
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.logic.reduction.formula_reduction import NotReducibleError, reduce_formula
from sysmlc.logic.reduction.history import History

DOMAINS = {name: BooleanDomain() for name in "abcd"}
SAFE, LIVE, INIT = "safety", "liveness", "init"


def parse(text):
    return parse_formula(text, DOMAINS)


def are_equivalent(formula, parts, history):
    """Whether the parts equal the formula in all traces in which the bits follow their rules."""
    claim = f.implies(conjoin(history.conjuncts), f.iff(formula, conjoin_parts(parts)))
    return spot.translate(spot.formula(print_for_spot(f.negate(claim)))).is_empty()


@pytest.mark.parametrize(
    ("text", "parts", "bits"),
    [
        ("G (a -> F b)", [(LIVE, "!(a & !b | !b & since_1)")], 1),
        ("G F (a -> X b)", [(LIVE, "did_1")], 1),
        ("G (a -> X X b)", [(SAFE, "was_1 -> b'")], 1),
        # A bit for each step stores that b is still due.
        ("G (a -> b | X (b | X (b | X b)))", None, 2),
        ("G (a -> b & X (b & X b))", None, 1),
        ("G (a -> b | X b | X X b)", None, None),
        ("a W b", None, None),
        ("a U b", None, None),
        ("F a", None, None),
        ("G (a -> b W c)", None, None),
        ("G (a -> b U c)", None, None),
        ("G (a -> b R c)", None, None),
        ("G (a -> X (b U c))", None, None),
        ("G (a -> G b)", None, None),
        ("G (a & X b -> X X c)", None, None),
        ("!F (a & X b)", None, None),
        ("!(a U b)", None, None),
        ("!(a W b)", None, None),
        ("a & G (b -> F c) & G F d", None, None),
        ("G (b | F c)", None, None),
        ("G F (a & X X b)", None, None),
        ("!F G a", [(LIVE, "!a")], 0),
        ("X X X a", None, None),
        ("a -> F b", None, None),
        ("G (a -> F (b & F c))", None, None),
        ("G (a -> F (b & F (c & F d)))", None, None),
        ("G (a -> F (b & X c))", None, None),
        ("G (a -> F F b)", None, None),
        ("G F (a & F b)", None, None),
        ("F (a & X X b)", None, None),
        ("X (a U X !b)", None, None),
        ("a W X b", None, None),
        ("X a R b", None, None),
        ("G (c -> a U X X b)", None, None),
    ],
)
def test_formulas_with_a_known_reduction_become_gr1(text, parts, bits):
    history = History(DOMAINS)
    reduced = reduce_formula(parse(text), history)
    assert are_equivalent(parse(text), reduced, history)
    if parts is not None:
        assert [(str(class_), print_formula(part)) for class_, part in reduced] == parts
        assert len(history.variables) == bits


@pytest.mark.parametrize(
    ("text", "future"),
    [
        ("G (Y a -> b)", "G (a -> X b)"),
        ("G (b -> Y a)", "!b & G (X b -> a)"),
        ("G (O a -> b)", "G (a -> G b)"),
        ("G (H a -> b)", "b W !a"),
        ("G (a S b -> c)", "G (b -> c & X (c W !a))"),
        ("G (Y (a S b) -> c) & G (Y Y a -> b)", "G (b -> X (c W (c & !a))) & G (a -> X X b)"),
        ("G F (a & Y b)", "G F (b & X a)"),
        ("G (a S false -> c) & G (Y a -> b)", "G (a -> X b)"),
    ],
)
def test_history_bits_replace_the_past(text, future):
    history = History(DOMAINS)
    parts = reduce_formula(read_temporal_logic(text, DOMAINS), history)
    assert are_equivalent(parse(future), parts, history)


def test_equal_facts_about_the_past_share_one_bit():
    history, a, b = History(DOMAINS), Var("a"), Var("b")
    shared = [history.previous(a), history.historically(a), history.since(a, b)]
    shared.append(history.last_step(a))
    # A goal that never holds, and a variable with the name of a kind of bits.
    different = [history.since(a, f.FALSE), history.since(a, Var("since")), history.once(a)]
    different += [history.since(b, a), history.since(a, f.TRUE)]
    assert len(history.variables) == len(shared) + len(different)
    repeated = [history.previous(a), history.historically(a), history.since(a, b)]
    repeated.append(history.last_step(a))
    assert repeated == shared
    assert len(history.variables) == len(shared) + len(different)


@pytest.mark.parametrize(
    "text", ["F G a", "G F a -> G F b", "G (a -> F (b & G c))", "G (F a | F b)"]
)
def test_a_formula_without_a_known_reduction_adds_no_bits(text):
    history = History(DOMAINS)
    with pytest.raises(NotReducibleError):
        reduce_formula(parse(text), history)
    assert history.variables == []


STATES = st.recursive(
    st.sampled_from([Var(name) for name in "abc"]),
    lambda inner: st.one_of(st.builds(f.negate, inner), st.builds(f.either, inner, inner)),
    max_leaves=2,
)
STEPS = STATES | apply_unary([Op.NEXT], STATES)
BODIES = st.recursive(
    STATES,
    lambda inner: st.one_of(
        st.builds(f.implies, STATES, inner),
        st.builds(f.both, inner, inner),
        st.builds(f.negate, inner),
        apply_unary([Op.NEXT, Op.ALWAYS, Op.EVENTUALLY], inner),
        apply_binary([Op.UNTIL, Op.WEAK_UNTIL, Op.RELEASE], STEPS, STEPS),
    ),
    max_leaves=3,
)


@given(BODIES.map(f.always) | BODIES)
@settings(max_examples=examples(250), deadline=None)
def test_every_reduction_is_an_equivalence(formula):
    history = History(DOMAINS)
    try:
        parts = reduce_formula(formula, history)
    except NotReducibleError:
        return
    if len(history.variables) <= 5:
        assert are_equivalent(formula, parts, history)


def test_a_reduced_contract_has_its_bits_after_its_own_variables_and_guarantees():
    variables = tuple(
        Variable(name, Owner.ENVIRONMENT if name in "ab" else Owner.SYSTEM, BooleanDomain())
        for name in "abcd"
    )
    response = Conjunct(parse("G (a -> F c)"), Class.OTHER, "model::Req1", "Answer.")
    stable = Conjunct(parse("F G c"), Class.OTHER, "model::Req2")
    plain = Conjunct(parse("d"), Class.INIT, "model::Req3")
    reduced = reduce_contract(Contract("C", "", variables, (), (response, stable, plain)))
    assert reduced.irreducible == (stable,)
    assert reduced.contract.variables[:4] == variables
    guarantees = reduced.contract.guarantees
    assert [(conjunct.class_, conjunct.origin) for conjunct in guarantees] == [
        (Class.LIVENESS, "model::Req1"),
        (Class.OTHER, "model::Req2"),
        (Class.INIT, "model::Req3"),
        (Class.INIT, "model::Req1"),
        (Class.SAFETY, "model::Req1"),
    ]
    assert reduce_contract(reduced.contract).contract == reduced.contract


def test_an_assumption_is_about_the_inputs_that_the_environment_chooses():
    """Games evaluate a condition on the present inputs a step late."""
    variables = tuple(Variable(name, Owner.ENVIRONMENT, BooleanDomain()) for name in "ab")
    late = Conjunct(parse("G (a -> X (!b & X !b))"), Class.OTHER, "")
    reduced = reduce_contract(Contract("C", "", variables, (late,), ())).contract
    assumptions = [(item.class_, print_formula(item.formula)) for item in reduced.assumptions]
    assert assumptions == [(Class.SAFETY, "a -> !b'"), (Class.SAFETY, "was_1 -> !b'")]


@pytest.mark.parametrize("text", ["a", "a | b", "a U b", "F a"])
def test_what_holds_now_and_from_the_next_step_on_holds_always(text):
    spelt, plain = parse(f"({text}) & X G ({text})"), parse(f"G ({text})")
    assert list(classify(spelt)) == list(classify(plain))
