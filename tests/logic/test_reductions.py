"""Reductions to GR(1): Spot finds every one of them to be an equivalence."""

import pytest
import spot
from hypothesis import given, settings
from hypothesis import strategies as st
from test_formats_spot import for_spot

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner, Variable
from sysmlc.logic.formula import Apply, Op, Var
from sysmlc.logic.ltl import parse_formula
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.logic.reduction.formula_reduction import NotReducibleError, reduce_formula
from sysmlc.logic.reduction.history import History
from sysmlc.logic.texts.formal import read_temporal_logic

DOMAINS = {name: BooleanDomain() for name in "abcd"}
SAFE, LIVE, INIT = "safety", "liveness", "init"


def parse(text):
    return parse_formula(text, DOMAINS)


def ltl(parts):
    made = []
    for class_, part in parts:
        inner = f.eventually(part) if class_ is Class.LIVENESS else part
        made.append(f.always(inner) if class_ in (Class.SAFETY, Class.LIVENESS) else inner)
    return f.both(*made)


def same(formula, parts, history):
    """Whether the parts say what the formula says, wherever the bits follow their rules."""
    ruled = ltl([(one.class_, one.formula) for one in history.conjuncts])
    claim = f.implies(ruled, f.iff(formula, ltl(parts)))
    return spot.translate(spot.formula(for_spot(f.negate(claim)))).is_empty()


@pytest.mark.parametrize(
    ("text", "parts", "bits"),
    [
        ("G (a -> F b)", [(LIVE, "!(a & !b | !b & since_1)")], 1),
        ("G F (a -> X b)", [(LIVE, "did_1")], 1),
        ("G (a -> X X b)", [(SAFE, "was_1 -> was_2 -> b'")], 2),
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
    ],
)
def test_what_is_known_to_be_in_gr1_is_brought_there(text, parts, bits):
    history = History(DOMAINS)
    found = reduce_formula(parse(text), history)
    assert same(parse(text), found, history)
    if parts is not None:
        assert [(str(class_), print_formula(part)) for class_, part in found] == parts
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
def test_the_past_is_remembered(text, future):
    history = History(DOMAINS)
    assert same(parse(future), reduce_formula(read_temporal_logic(text, DOMAINS), history), history)


def test_the_same_past_has_one_bit_and_another_past_another_one():
    history, a, b = History(DOMAINS), Var("a"), Var("b")
    once = [history.previous(a), history.historically(a), history.since(a, b), history.since(b, a)]
    # What can never begin, and what follows from a variable with a name of a bit's kind.
    once += [history.since(a, f.FALSE), history.since(a, Var("since")), history.since(a, f.TRUE)]
    once += [history.once(a), history.last_step(a)]
    assert len(history.variables) == len(once)
    again = [
        history.previous(a),
        history.historically(a),
        history.since(a, b),
        history.last_step(a),
    ]
    assert again == [*once[:3], once[-1]]
    assert len(history.variables) == len(once)


@pytest.mark.parametrize(
    "text", ["F G a", "G F a -> G F b", "G (a -> F (b & G c))", "G (F a | F b)"]
)
def test_what_no_reduction_is_known_for_is_told(text):
    history = History(DOMAINS)
    with pytest.raises(NotReducibleError):
        reduce_formula(parse(text), history)
    assert history.variables == []


STATES = st.recursive(
    st.sampled_from([Var(name) for name in "abc"]),
    lambda inner: st.one_of(st.builds(f.negate, inner), st.builds(f.either, inner, inner)),
    max_leaves=2,
)
BODIES = st.recursive(
    STATES,
    lambda inner: st.one_of(
        st.builds(f.implies, STATES, inner),
        st.builds(f.both, inner, inner),
        st.builds(f.negate, inner),
        st.builds(
            lambda op, one: Apply(op, (one,)),
            st.sampled_from([Op.NEXT, Op.ALWAYS, Op.EVENTUALLY]),
            inner,
        ),
        st.builds(
            lambda op, one, other: Apply(op, (one, other)),
            st.sampled_from([Op.UNTIL, Op.WEAK_UNTIL, Op.RELEASE]),
            STATES,
            STATES,
        ),
    ),
    max_leaves=3,
)


@given(BODIES.map(f.always) | BODIES)
@settings(max_examples=250, deadline=None)
def test_every_reduction_is_an_equivalence(formula):
    history = History(DOMAINS)
    try:
        parts = reduce_formula(formula, history)
    except NotReducibleError:
        return
    if len(history.variables) <= 5:
        assert same(formula, parts, history)


def test_a_contract_keeps_what_it_was_and_gets_bits_behind():
    variables = tuple(
        Variable(name, Owner.ENVIRONMENT if name in "ab" else Owner.SYSTEM, BooleanDomain())
        for name in "abcd"
    )
    response = Conjunct(parse("G (a -> F c)"), Class.OTHER, "model::Req1", "Answer.")
    stable = Conjunct(parse("F G c"), Class.OTHER, "model::Req2")
    plain = Conjunct(parse("d"), Class.INIT, "model::Req3")
    made = reduce_contract(Contract("C", "", variables, (), (response, stable, plain)))
    assert made.irreducible == (stable,)
    assert made.contract.variables[:4] == variables
    assert [(one.class_, one.origin) for one in made.contract.guarantees] == [
        (Class.LIVENESS, "model::Req1"),
        (Class.OTHER, "model::Req2"),
        (Class.INIT, "model::Req3"),
        (Class.INIT, "model::Req1"),
        (Class.SAFETY, "model::Req1"),
    ]
    assert reduce_contract(made.contract).contract == made.contract
