"""Formulas as decision diagrams: they agree with evaluation on all values."""

from itertools import product

import pytest
from contracts_in_lines import parse_contract
from hypothesis import given, settings
from hypothesis import strategies as st

from long_runs import examples
from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import IntegerDomain, Owner, Variable
from sysmlc.logic.evaluate import is_true
from sysmlc.logic.formula import Apply, Const, Op, Var
from sysmlc.logic.infix import parse_formula
from sysmlc.synthesis import Manager, SymbolError, Symbols

VARIABLES = parse_contract("""
    env go: bool
    sys n: -2..4
    sys m: 3..6
    env lamp: red amber green
""").variables
DOMAINS = {variable.name: variable.domain for variable in VARIABLES}


def make_symbols(engine: str = "") -> Symbols:
    return Symbols(Manager(engine), VARIABLES)


def assert_agreement(symbols: Symbols, formula) -> None:
    """Assert that the diagram and the evaluation of a formula agree on all values."""
    node = symbols.bdd(formula)
    for values in domains.valuations(DOMAINS):
        assert (symbols.encode(values) <= node) == is_true(formula, values), values


ATOMS = st.sampled_from([Var("n"), Var("m"), *(Const(value) for value in range(-3, 6))])
NUMBERS = st.recursive(
    ATOMS,
    lambda inner: st.builds(
        lambda op, left, right: Apply(op, (left, right)),
        st.sampled_from([Op.ADD, Op.SUB, Op.MUL, Op.DIV, Op.MOD]),
        inner,
        inner,
    ),
    max_leaves=4,
)
COMPARISONS = st.sampled_from([Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE])


@settings(max_examples=examples(60))
@given(COMPARISONS, NUMBERS, NUMBERS)
def test_arithmetic_is_that_of_whole_numbers(op, left, right):
    assert_agreement(make_symbols(), f.compare(op, left, right))


@pytest.mark.parametrize(
    "text",
    ["lamp=red", "lamp!=amber & go", "go <-> n>1", "!go | lamp=green", "n=m", "n + 1 > m -> go"],
)
@pytest.mark.parametrize("engine", ["cudd", "autoref"])
def test_literals_booleans_and_numbers(engine, text):
    assert_agreement(make_symbols(engine), parse_formula(text, DOMAINS))


def test_a_prime_is_the_next_value():
    symbols = make_symbols()
    assert symbols.bdd(parse_formula("n'=m'", DOMAINS)) == symbols.prime(
        symbols.bdd(parse_formula("n=m", DOMAINS))
    )
    assert symbols.unprime(symbols.bdd(parse_formula("go'", DOMAINS))) == symbols.bdd(Var("go"))


def test_values_are_coded_and_decoded():
    symbols = make_symbols()
    for values in domains.valuations(DOMAINS):
        code = {bit: on for name in values for bit, on in symbols.code(name, values[name]).items()}
        assert symbols.decode(code) == values
    with pytest.raises(SymbolError, match="no value with the code 7"):
        symbols.decode({"n.0": True, "n.1": True, "n.2": True})
    with pytest.raises(SymbolError, match="n cannot be 5"):
        symbols.encode({"n": 5})


def test_the_domain_consists_of_the_codes_of_values():
    symbols = make_symbols()
    for name, domain in DOMAINS.items():
        codes = symbols.manager.count(symbols.domain(name), symbols.bits(name))
        assert codes == domains.size(domain), name
    assert symbols.domain("m") == symbols.manager.true


def test_bits_are_next_to_their_primed_copies():
    assert make_symbols().manager.bits[:6] == ("go.0", "go.0'", "n.0", "n.0'", "n.1", "n.1'")


@pytest.mark.parametrize(
    ("formula", "why"),
    [
        (Var("n"), "n is not Boolean"),
        (Var("gone"), "gone is not a variable of the contract"),
        (f.eq(Var("go"), Const(1)), "1 is not Boolean"),
        (f.compare(Op.LT, Var("lamp"), Const("red")), "< compares numbers"),
        (f.eq(Var("lamp"), Var("n")), "compared with a value that is not a literal"),
        (f.always(Var("go")), "G gives no Boolean of one step"),
    ],
)
def test_a_formula_without_value_raises(formula, why):
    with pytest.raises(SymbolError, match=why):
        make_symbols().bdd(formula)


def test_numbers_may_be_large():
    wide = Variable("w", Owner.SYSTEM, IntegerDomain(-5_000, 60_000))
    symbols = Symbols(Manager(), [wide])
    node = symbols.bdd(parse_formula("w * 3 = 29997", {"w": wide.domain}))
    assert symbols.encode({"w": 9_999}) == node


def test_a_variable_with_one_value_has_a_bit():
    constant = Variable("one", Owner.SYSTEM, IntegerDomain(7, 7))
    symbols = Symbols(Manager(), [constant])
    assert [len(symbols.bits("one")), symbols.decode({"one.0": False})] == [1, {"one": 7}]


def test_names_of_a_diagram_are_its_variables():
    symbols = make_symbols()
    node = symbols.bdd(parse_formula("go -> n'=1", DOMAINS))
    assert [symbols.names(node), symbols.names(node, primed=True)] == [("go",), ("n",)]


def test_every_pair_of_small_numbers_is_divided_towards_zero():
    symbols = make_symbols()
    for left, right in product(range(-4, 5), repeat=2):
        for op in (Op.DIV, Op.MOD):
            apply = Apply(op, (Const(left), Const(right)))
            expected = [n for n in range(-9, 10) if is_true(f.eq(apply, Const(n)), {})]
            truths = [
                n
                for n in range(-9, 10)
                if symbols.bdd(f.eq(apply, Const(n))) == symbols.manager.true
            ]
            assert truths == expected, (op, left, right)


@pytest.mark.parametrize("engine", ["cudd", "autoref"])
def test_picked_values_do_not_depend_on_the_order_of_the_diagrams(engine):
    manager = Manager(engine)
    manager.declare(["a", "b", "c", "d"])
    a, b, c = map(manager.var, "abc")
    assert manager.pick(manager.false, ["a"]) is None
    for order in ("abcd", "dcba"):
        manager._bdd.reorder({bit: level for level, bit in enumerate(order)})
        assert manager.bits == tuple(order)
        values = manager.pick((a & ~b) | (b & c) | (a & b & ~c), ["a", "b", "c", "d"])
        assert values == {"a": False, "b": True, "c": True, "d": False}
