"""Random formulas and contracts over Booleans, ranges and enumerations."""

from hypothesis import strategies as st

from spot_formulas import conjoin
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


def apply_unary(operators, operand):
    """Draw applications of one of the operators to an operand."""
    return st.builds(lambda op, inner: Apply(op, (inner,)), st.sampled_from(operators), operand)


def apply_binary(operators, left, right):
    """Draw applications of one of the operators to two operands."""
    return st.builds(lambda op, a, b: Apply(op, (a, b)), st.sampled_from(operators), left, right)


def connect(operand):
    """Draw negations, conjunctions, disjunctions, implications and equivalences."""
    return st.one_of(
        st.builds(f.negate, operand),
        st.builds(f.both, operand, operand),
        st.builds(f.either, operand, operand),
        st.builds(f.implies, operand, operand),
        st.builds(f.iff, operand, operand),
    )


def numbers(primes):
    variables = st.builds(Var, st.sampled_from(["n", "low", "m"]), primes)
    constants = st.integers(-3, 5).map(Const)
    sums = apply_binary([Op.ADD, Op.SUB], variables, constants)
    products = apply_binary([Op.MUL], variables, st.just(Const(2)))
    return st.one_of(variables, constants, sums, products)


def atoms(primes):
    orders = [Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE]
    modes = st.sampled_from(["idle", "busy", "stop"]).map(Const)
    return st.one_of(
        st.builds(Var, st.sampled_from(["go", "done"]), primes),
        apply_binary(orders, numbers(primes), numbers(primes)),
        apply_binary([Op.EQ, Op.NE], st.builds(Var, st.just("mode"), primes), modes),
    )


def conditions(primes):
    return st.recursive(atoms(primes), connect, max_leaves=5)


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


def canonicalise(contract):
    """Return variables and conjuncts, split and sorted by class, without origins and texts."""

    def split(conjuncts):
        parts = {Conjunct(part, class_, ""): None for class_, part in classify(conjoin(conjuncts))}
        return sort_by_class(part for part in parts if part.formula != f.TRUE)

    return (
        sorted(contract.variables, key=lambda variable: (variable.owner, variable.name)),
        split(contract.assumptions),
        split(contract.guarantees),
    )
