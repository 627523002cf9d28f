"""Random contracts over Booleans, ranges and enumerations."""

from hypothesis import strategies as st

from sysmlc.logic import formula as f
from sysmlc.logic.classification import classify
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formats.encodings import sort_by_class
from sysmlc.logic.formula import Apply, Const, Op, Var

VARIABLES = (
    Variable("go", Owner.ENVIRONMENT, BooleanDomain()),
    Variable("n", Owner.ENVIRONMENT, IntegerDomain(0, 3)),
    Variable("low", Owner.ENVIRONMENT, IntegerDomain(-2, 1)),
    Variable("done", Owner.SYSTEM, BooleanDomain()),
    Variable("m", Owner.SYSTEM, IntegerDomain(2, 4)),
    Variable("mode", Owner.SYSTEM, EnumerationDomain(("idle", "busy", "stop"))),
)


def numbers(primes):
    names = st.sampled_from(["n", "low", "m"])
    variables = st.builds(Var, names, primes)
    constants = st.integers(-3, 5).map(Const)
    sums = st.builds(
        lambda op, a, b: Apply(op, (a, b)), st.sampled_from([Op.ADD, Op.SUB]), variables, constants
    )
    products = st.builds(lambda a: Apply(Op.MUL, (a, Const(2))), variables)
    return st.one_of(variables, constants, sums, products)


def atoms(primes):
    orders = st.sampled_from([Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE])
    return st.one_of(
        st.builds(Var, st.sampled_from(["go", "done"]), primes),
        st.builds(lambda op, a, b: Apply(op, (a, b)), orders, numbers(primes), numbers(primes)),
        st.builds(
            lambda op, primed, value: Apply(op, (Var("mode", primed), Const(value))),
            st.sampled_from([Op.EQ, Op.NE]),
            primes,
            st.sampled_from(["idle", "busy", "stop"]),
        ),
    )


def conditions(primes):
    return st.recursive(
        atoms(primes),
        lambda inner: st.one_of(
            st.builds(f.negate, inner),
            st.builds(f.both, inner, inner),
            st.builds(f.either, inner, inner, inner),
            st.builds(f.implies, inner, inner),
            st.builds(f.iff, inner, inner),
        ),
        max_leaves=5,
    )


def conjuncts(class_, primes):
    return st.builds(lambda formula: Conjunct(formula, class_, ""), conditions(primes))


unprimed, primed_or_not = st.just(False), st.booleans()
guarantees = st.lists(
    st.one_of(
        conjuncts(Class.INIT, unprimed),
        conjuncts(Class.SAFETY, primed_or_not),
        conjuncts(Class.LIVENESS, unprimed),
    ),
    max_size=4,
)
assumptions = st.lists(
    st.one_of(conjuncts(Class.INIT, unprimed), conjuncts(Class.LIVENESS, unprimed)), max_size=2
)
contracts = st.builds(
    lambda assumptions, guarantees: Contract(
        "Gate", "", VARIABLES, tuple(assumptions), tuple(guarantees)
    ),
    assumptions,
    guarantees,
)


def canonical(contract):
    """Return variables and conjuncts, split and sorted by class, without origins and texts."""

    def split(conjuncts):
        whole = f.both(*map(add_temporal_operators, conjuncts))
        parts = {Conjunct(part, class_, ""): None for class_, part in classify(whole)}
        return sort_by_class(part for part in parts if part.formula != f.TRUE)

    return (
        sorted(contract.variables, key=lambda variable: (variable.owner, variable.name)),
        split(contract.assumptions),
        split(contract.guarantees),
    )


def add_temporal_operators(conjunct):
    """Return the conjunct's formula in LTL, with the operators that its class implies."""
    formula = conjunct.formula
    if conjunct.class_ is Class.LIVENESS:
        formula = f.eventually(formula)
    return f.always(formula) if conjunct.class_ in (Class.SAFETY, Class.LIVENESS) else formula
