"""The SPIN text against Spot: it can be read, and means what the formula of the graph means.

The independent route encodes every variable in bits and every formula by its truth table (now
and next), written here without the printer's code; Spot decides equivalence under the axioms
that tie the propositions ``x==3`` to the bits.
"""

from itertools import product

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from long_runs import examples
from sysmlc.logic import formula as f
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
from sysmlc.logic.formats.spin import SpinPrinter, print_spin
from sysmlc.logic.formula import Apply, Const, Op, Var

spot = pytest.importorskip("spot")

DOMAINS = {
    "p": BooleanDomain(),
    "Door": BooleanDomain(),
    "n": IntegerDomain(-1, 2),
    "m": IntegerDomain(0, 3),
    "mode": EnumerationDomain(("idle", "busy", "Off")),
}
VALUES = {
    "p": [False, True],
    "Door": [False, True],
    "n": [-1, 0, 1, 2],
    "m": [0, 1, 2, 3],
    "mode": ["idle", "busy", "Off"],
}


def print_conjunct(conjunct):
    return SpinPrinter(DOMAINS).print_conjunct(conjunct)


def read(text):
    """Parse with Spot, whose lenient mode reads braces as propositions."""
    parsed = spot.parse_infix_psl(text, spot.default_environment.instance(), False, True)
    assert not parsed.errors, text
    return parsed.f


# -- the independent route ---------------------------------------------------------------------


def bits(name, value):
    """Return the value as a conjunction of bits."""
    index = VALUES[name].index(value)
    return [f'{"" if index >> k & 1 else "!"}"{name}.{k}"' for k in range(2)]


def axioms(names):
    """Return that each proposition of the SPIN text is a bit pattern, and each pattern a value."""
    conditions = []
    for name in names:
        patterns = [" & ".join(bits(name, value)) for value in VALUES[name]]
        conditions.append("(" + " | ".join(f"({pattern})" for pattern in patterns) + ")")
        for value, pattern in zip(VALUES[name], patterns, strict=True):
            conditions.append(f"({proposition(name, value)} <-> ({pattern}))")
    return "G(" + " & ".join(conditions or ["1"]) + ")"


def proposition(name, value):
    if isinstance(value, bool):
        word = {"p": '"p"', "Door": '"Door==1"'}[name]
        return word if value else f"!{word}"
    return f'"{name}=={value}"'


def truth_table(formula):
    """Return a formula without temporal operators as a disjunction of valuations."""
    variables = sorted({(v.name, v.primed) for v in f.variables(formula)})
    rows = []
    for values in product(*(VALUES[name] for name, _ in variables)):
        world = dict(zip(variables, values, strict=True))
        if evaluate(formula, world):
            parts = [
                f"X({bit})" if primed else bit
                for (name, primed), value in world.items()
                for bit in bits(name, value)
            ]
            rows.append(" & ".join(parts) or "1")
    return " | ".join(f"({row})" for row in rows) or "0"


def evaluate(formula, world):
    if isinstance(formula, Const):
        return formula.value
    if isinstance(formula, Var):
        return world[formula.name, formula.primed]
    args = [evaluate(arg, world) for arg in formula.args]
    return {
        "!": lambda: not args[0],
        "&": lambda: all(args),
        "|": lambda: any(args),
        "->": lambda: args[1] if args[0] else True,
        "<->": lambda: args[0] is args[1],
        "=": lambda: args[0] == args[1],
        "!=": lambda: args[0] != args[1],
        "<": lambda: args[0] < args[1],
        "<=": lambda: args[0] <= args[1],
        ">": lambda: args[0] > args[1],
        ">=": lambda: args[0] >= args[1],
        "+": lambda: args[0] + args[1],
        "-": lambda: args[0] - args[1],
        "*": lambda: args[0] * args[1],
    }[formula.op]()


def assert_text_agrees_with_truth_table(conjunct):
    table = truth_table(conjunct.formula)
    wrap = {Class.SAFETY: "G({})", Class.LIVENESS: "G(F({}))", Class.INIT: "({})"}
    names = sorted({v.name for v in f.variables(conjunct.formula)})
    world = axioms(names)
    expected = spot.formula(f"{world} & {wrap[conjunct.class_].format(table)}")
    text = print_conjunct(conjunct)
    actual = spot.formula.And([spot.formula(world), read(text)])
    assert spot.are_equivalent(actual, expected), text


# -- random formulas ---------------------------------------------------------------------------

_numbers = st.sampled_from(
    [
        Var("n"),
        Var("m"),
        Var("m", True),
        Const(1),
        Const(9),
        Apply(Op.ADD, (Var("n"), Const(1))),
        Apply(Op.SUB, (Var("m"), Var("n"))),
        Apply(Op.MUL, (Var("m"), Const(2))),
    ]
)
_orders = st.sampled_from([Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE])
_modes = st.sampled_from([Var("mode"), Var("mode", True), Const("idle"), Const("Off")])
_atoms = st.one_of(
    st.sampled_from([Var("p"), Var("p", True), Var("Door"), Var("Door", True), f.TRUE]),
    st.builds(f.compare, _orders, _numbers, _numbers),
    st.builds(f.compare, st.sampled_from([Op.EQ, Op.NE]), _modes, _modes),
)
formulas = st.recursive(
    _atoms,
    lambda inner: st.one_of(
        st.builds(f.negate, inner),
        st.builds(f.both, inner, inner),
        st.builds(f.either, inner, inner),
        st.builds(f.implies, inner, inner),
        st.builds(f.iff, inner, inner),
    ),
    max_leaves=3,
)


@pytest.mark.parametrize("op", [Op.EQ, Op.NE, Op.LT, Op.GE])
def test_a_value_beyond_the_range_has_no_proposition(op):
    formula = Apply(op, (Var("n"), Const(9)))
    assert "9" not in print_conjunct(Conjunct(formula, Class.SAFETY, "x"))
    assert_text_agrees_with_truth_table(Conjunct(formula, Class.SAFETY, "x"))


@given(formulas, st.sampled_from([Class.SAFETY, Class.LIVENESS]))
@settings(max_examples=examples(60), deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_the_text_is_equivalent_to_the_truth_table(formula, class_):
    assert_text_agrees_with_truth_table(Conjunct(formula, class_, "x"))


def test_a_contract_is_one_formula():
    contract = Contract(
        "C",
        "c",
        (
            Variable("p", Owner.ENVIRONMENT, BooleanDomain()),
            Variable("mode", Owner.SYSTEM, DOMAINS["mode"]),
        ),
        (Conjunct(Var("p"), Class.LIVENESS, "a"),),
        (
            Conjunct(f.eq(Var("mode"), Const("idle")), Class.INIT, "b"),
            Conjunct(
                f.implies(Var("p"), f.eq(Var("mode", True), Const("busy"))), Class.SAFETY, "c"
            ),
        ),
    )
    text = print_spin(contract)
    assert text == ("([]<>(p)) -> (({mode==idle}) && [](p -> X {mode==busy}))\n")
    assert read(text) == spot.formula('GFp -> ("mode==idle" & G(p -> X"mode==busy"))')


def test_no_assumptions_are_written_as_true():
    contract = Contract("C", "c", (Variable("p", Owner.SYSTEM, BooleanDomain()),), (), ())
    assert print_spin(contract) == "(true) -> (true)\n"


def test_general_ltl_retains_its_operators():
    formula = Apply(Op.UNTIL, (f.negate(Var("p")), f.eventually(f.eq(Var("m"), Const(3)))))
    text = print_conjunct(Conjunct(formula, Class.OTHER, "x"))
    assert text == "(!p U <>{m==3})"
    assert spot.are_equivalent(read(text), spot.formula('!p U F"m==3"'))
