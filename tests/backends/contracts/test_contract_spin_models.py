"""Every conjunct of derived contracts: Spot reads its SPIN text and finds it equivalent.

The independent route turns comparisons into truth tables over bits and keeps the connectives;
Spot compares what stands below the temporal operators, under the axioms that tie the
propositions of the text to the bits, now and in the next step.
"""

import re
from itertools import product
from pathlib import Path

import pytest

from long_runs import quick_first
from machine_samples import arrow, choice, machine, machine_of, region, state
from sysmlc.diagnostics import Sink
from sysmlc.driver import Request, compile_model
from sysmlc.ir.text import parse_text
from sysmlc.logic.contract import Class, Contract
from sysmlc.logic.domains import values
from sysmlc.logic.formats.spin import SpinPrinter, print_spin
from sysmlc.logic.formula import Apply, Const, Op, Var, variables
from sysmlc.passes import pipeline

spot = pytest.importorskip("spot")
buddy = pytest.importorskip("buddy")
EXAMPLES = Path(__file__).parents[3] / "examples"
COMPARISONS = {
    Op.EQ: lambda a, b: a == b,
    Op.NE: lambda a, b: a != b,
    Op.LT: lambda a, b: a < b,
    Op.LE: lambda a, b: a <= b,
    Op.GT: lambda a, b: a > b,
    Op.GE: lambda a, b: a >= b,
}
CONNECTIVES = {Op.NOT: "!", Op.AND: " & ", Op.OR: " | ", Op.IMPLIES: " -> ", Op.IFF: " <-> "}
INNER = (
    region("s", state("d"), state("e"), arrow("si", "d"), arrow("d", "e", "start")),
    region("q", state("f"), "FinalState g\n", arrow("qi", "f"), arrow("f", "g", after="after 2")),
)
MODELS = {
    "gate": machine(
        arrow("a", "b", "start", "level < 9", "level := level + 1; send opened"),
        arrow("b", "a", after="after 3 s"),
    ),
    "choice": machine(
        choice(),
        arrow("a", "x", "start", "ready", "level := level + size"),
        arrow("x", "b", guard="level > size"),
        arrow("x", "a", guard="else"),
        arrow("b", "a", "stop"),
        arrow("b", "b", "stop", effect="beep"),
    ).replace("Constraint k2", 'Constraint k3 body="0 <= size <= 3"\n    Constraint k2'),
    "orthogonal": machine_of(
        region("r", state("a", *INNER), state("b"), arrow("i", "a"), arrow("a", "b", "stop"))
    ),
}


def read(text):
    """Parse with Spot, whose lenient mode reads braces as propositions."""
    parsed = spot.parse_infix_psl(text, spot.default_environment.instance(), False, True)
    assert not parsed.errors, text
    return parsed.f


def derive_contracts(text):
    graph = parse_text(text)
    pipeline.run(graph, Sink())
    return list(graph.derived(Contract))


def bits(domains, name, value):
    index = values(domains[name]).index(value)
    count = max(1, (len(values(domains[name])) - 1).bit_length())
    return " & ".join(f'{"" if index >> k & 1 else "!"}"{name}.{k}"' for k in range(count))


def axioms(domains, names):
    conditions = []
    for name in sorted(names):
        patterns = [f"({bits(domains, name, value)})" for value in values(domains[name])]
        conditions.append(f"({' | '.join(patterns)})")
        for value, pattern in zip(values(domains[name]), patterns, strict=True):
            if value is False:
                continue
            proposition = f"{name}=={value}"
            if value is True:
                proposition = name if re.match("[a-z_]", name) else f"{name}==1"
            conditions.append(f'("{proposition}" <-> {pattern})')
    condition = " & ".join(conditions) or "1"
    return f"({condition}) & X({condition})"


def translate(domains, formula):
    if isinstance(formula, Const):
        return "1" if formula.value else "0"
    if isinstance(formula, Var):
        text = f"({bits(domains, formula.name, True)})"
        return f"X{text}" if formula.primed else text
    if formula.op in COMPARISONS:
        return f"({truth_table(domains, formula)})"
    args = [translate(domains, arg) for arg in formula.args]
    if formula.op is Op.NOT:
        return f"!({args[0]})"
    return CONNECTIVES[formula.op].join(f"({arg})" for arg in args)


def truth_table(domains, formula):
    names = sorted({(v.name, v.primed) for v in variables(formula)})
    rows = []
    for row in product(*(values(domains[name]) for name, _ in names)):
        world = dict(zip(names, row, strict=True))
        if evaluate(formula, world):
            parts = [(bits(domains, n, v), primed) for (n, primed), v in world.items()]
            rows.append(" & ".join(f"X({b})" if primed else f"({b})" for b, primed in parts))
    return " | ".join(f"({row})" for row in rows) or "0"


def evaluate(formula, world):
    if isinstance(formula, Const):
        return formula.value
    if isinstance(formula, Var):
        return world[formula.name, formula.primed]
    left, right = (evaluate(arg, world) for arg in formula.args)
    if formula.op in COMPARISONS:
        return COMPARISONS[formula.op](left, right)
    return {Op.ADD: left + right, Op.SUB: left - right}[formula.op]


def read_body(conjunct, domains):
    """Parse the conjunct's text without the temporal operators of its class."""
    formula = read(SpinPrinter(domains).print_conjunct(conjunct))
    operators = {Class.SAFETY: [spot.op_G], Class.LIVENESS: [spot.op_G, spot.op_F]}
    for operator in operators.get(conjunct.class_, []):
        if formula.is_constant():
            break
        assert formula.kind() == operator
        formula = formula[0]
    return formula


def assert_texts_are_equivalent(contract):
    domains = {v.name: v.domain for v in contract.variables}
    for conjunct in (*contract.assumptions, *contract.guarantees):
        names = {v.name for v in variables(conjunct.formula)}
        world = spot.formula(axioms(domains, names))
        expected = spot.formula(translate(domains, conjunct.formula))
        actual = read_body(conjunct, domains)
        is_equivalent = spot.are_equivalent(
            spot.formula.And([world, actual]), spot.formula.And([world, expected])
        )
        assert is_equivalent, SpinPrinter(domains).print_conjunct(conjunct)


@pytest.mark.parametrize("name", MODELS)
def test_conjuncts_of_small_machines_are_equivalent(name):
    (contract,) = derive_contracts(MODELS[name])
    assert_texts_are_equivalent(contract)


@pytest.mark.parametrize("name", MODELS)
def test_the_whole_text_is_the_implication_of_its_conjuncts(name):
    (contract,) = derive_contracts(MODELS[name])
    domains = {v.name: v.domain for v in contract.variables}
    printer = SpinPrinter(domains)
    sides = [
        spot.formula.And([read(printer.print_conjunct(conjunct)) for conjunct in conjuncts])
        for conjuncts in (contract.assumptions, contract.guarantees)
    ]
    assert read(print_spin(contract)) == spot.formula.Implies(*sides)


def test_a_changed_formula_is_noticed():
    (contract,) = derive_contracts(MODELS["gate"])
    domains = {v.name: v.domain for v in contract.variables}
    conjunct = next(c for c in contract.guarantees if c.class_ is Class.SAFETY)
    wrong = Apply(Op.NOT, (conjunct.formula,))
    world = spot.formula(axioms(domains, {v.name for v in variables(wrong)}))
    pair = [
        spot.formula.And([world, part])
        for part in (read_body(conjunct, domains), spot.formula(translate(domains, wrong)))
    ]
    assert not spot.are_equivalent(*pair)


# -- the examples: too large for Spot's automata, so its decision diagrams compare one step -----


def one_step(formula):
    """Return the formula over two copies of the propositions: ``X p`` becomes ``p'``."""
    return _mark_propositions(formula, "")


def _mark_propositions(formula, mark):
    if formula.kind() == spot.op_X:
        assert not mark, "a conjunct looks one step ahead, not two"
        return _mark_propositions(formula[0], "'")
    if formula.kind() == spot.op_ap:
        return spot.formula.ap(formula.ap_name() + mark)
    return formula.map(lambda part: _mark_propositions(part, mark))


def differ(world, actual, expected, names=()):
    """Whether two formulas about one step differ where the axioms hold.

    Diagrams are small when variables that occur together are close in their order, so ``names``
    are the variables in the order of the formula.
    """
    owner = spot.make_twa_graph(spot.make_bdd_dict())
    steps = [one_step(formula) for formula in (world, actual, expected)]
    position = {name: index for index, name in enumerate(names)}
    propositions = {ap.ap_name() for step in steps for ap in spot.atomic_prop_collect(step)}
    for name in sorted(propositions, key=lambda text: (position.get(_variable(text), 0), text)):
        owner.register_ap(name)
    diagrams = (spot.formula_to_bdd(step, owner.get_dict(), owner) for step in steps)
    world_bdd, actual_bdd, expected_bdd = diagrams
    difference = buddy.bdd_xor(actual_bdd, expected_bdd)
    return buddy.bdd_and(world_bdd, difference) != buddy.bddfalse


def _variable(proposition):
    """Return the variable of a proposition: ``x`` for ``x==3``, ``x.0`` and ``x'``."""
    return re.split(r"==|\.|'", proposition)[0]


@pytest.mark.parametrize(
    "model", quick_first(sorted(EXAMPLES.glob("*/*.uml")), 2), ids=lambda path: path.stem
)
def test_conjuncts_of_the_shipped_examples_are_equivalent(model):
    assert_model_is_equivalent(model)


REAL = (
    "TankBarrelExample",
    "fUML-Tests",
    "moka-master",
    "TutoFMU",
    "AssertionLibrary",
    "fUML-Exception-Tests",
    "Alf.library",
)
"""Of Alf.library, which has hundreds of contracts, every eighth."""


@pytest.mark.corpus
@pytest.mark.parametrize("name", quick_first(REAL, 2))
def test_conjuncts_of_real_models_are_equivalent(corpus, name):
    assert_model_is_equivalent(corpus / "xmi" / "papyrus" / f"{name}.uml")


def assert_model_is_equivalent(model):
    contracts = compile_model(Request((model,))).graph.derived(Contract)
    assert contracts
    for contract in contracts[:: len(contracts) // 50 + 1]:
        domains = {v.name: v.domain for v in contract.variables}
        for conjunct in (*contract.assumptions, *contract.guarantees):
            names = dict.fromkeys(v.name for v in variables(conjunct.formula))
            world = spot.formula(axioms(domains, names))
            expected = spot.formula(translate(domains, conjunct.formula))
            text = SpinPrinter(domains).print_conjunct(conjunct)
            assert not differ(world, read_body(conjunct, domains), expected, names), text


def test_decision_diagrams_see_a_difference_only_where_the_axioms_hold():
    world = spot.formula('(("n==1") <-> ("b")) & X(("n==1") <-> ("b"))')
    assert not differ(world, spot.formula('X"n==1"'), spot.formula('X"b"'))
    assert differ(world, spot.formula('X"n==1"'), spot.formula('"b"'))
