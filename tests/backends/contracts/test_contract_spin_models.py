"""The SPIN text of every conjunct of a derived contract has the meaning of the conjunct.

Spot compares the formulas below the temporal operators, for a state and the next one.
"""

import re

import pytest
from spin_oracle import (
    list_domains,
    list_names,
    parse_leniently,
    read_text,
    spot,
    translate,
    write_step_axioms,
)

from examples.compiling import ROOT
from long_runs import quick_first
from machine_samples import arrow, choice, machine, machine_of, region, state
from refinement import run_all
from sysmlc.diagnostics import Sink
from sysmlc.driver import Request, compile_model
from sysmlc.ir.text import parse_text
from sysmlc.logic.contract import Class, Contract
from sysmlc.logic.formats.spin import SpinPrinter, print_spin
from sysmlc.logic.formula import Apply, Op

buddy = pytest.importorskip("buddy")

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


def derive_contracts(text):
    graph = parse_text(text)
    run_all(graph, Sink())
    return list(graph.derived(Contract))


def read_body(conjunct, domains):
    """Return the formula in a conjunct's text without the temporal operators of its class."""
    formula = read_text(SpinPrinter(domains).print_conjunct(conjunct), domains)
    operators = {Class.SAFETY: [spot.op_G], Class.LIVENESS: [spot.op_G, spot.op_F]}
    for operator in operators.get(conjunct.class_, []):
        if formula.is_constant():
            break
        assert formula.kind() == operator
        formula = formula[0]
    return formula


def are_equivalent(domains, formula, actual):
    """Whether *actual* equals the formula in all steps."""
    axioms = write_step_axioms(domains, list_names(formula))
    expected = spot.formula(translate(domains, formula))
    return spot.are_equivalent(
        spot.formula.And([axioms, actual]), spot.formula.And([axioms, expected])
    )


@pytest.mark.parametrize("name", MODELS)
def test_the_texts_of_small_state_machines_are_equivalent(name):
    (contract,) = derive_contracts(MODELS[name])
    domains = list_domains(contract)
    for conjunct in (*contract.assumptions, *contract.guarantees):
        text = SpinPrinter(domains).print_conjunct(conjunct)
        assert are_equivalent(domains, conjunct.formula, read_body(conjunct, domains)), text


@pytest.mark.parametrize("name", MODELS)
def test_the_whole_text_is_the_implication_of_its_conjuncts(name):
    (contract,) = derive_contracts(MODELS[name])
    printer = SpinPrinter(list_domains(contract))
    sides = [
        spot.formula.And([parse_leniently(printer.print_conjunct(c)) for c in conjuncts])
        for conjuncts in (contract.assumptions, contract.guarantees)
    ]
    whole = sides[1] if not contract.assumptions else spot.formula.Implies(*sides)
    assert parse_leniently(print_spin(contract)) == whole


def test_the_comparison_sees_a_negated_formula():
    (contract,) = derive_contracts(MODELS["gate"])
    domains = list_domains(contract)
    conjunct = next(part for part in contract.guarantees if part.class_ is Class.SAFETY)
    negation = Apply(Op.NOT, (conjunct.formula,))
    assert not are_equivalent(domains, negation, read_body(conjunct, domains))


# -- the examples: too large for Spot's automata, so its decision diagrams compare one step -----


def rename_next(formula, mark=""):
    """Return the formula over two copies of the propositions: ``X p`` becomes ``p'``."""
    if formula.kind() == spot.op_X:
        assert not mark, "a conjunct looks one step ahead, not two"
        return rename_next(formula[0], "'")
    if formula.kind() == spot.op_ap:
        return spot.formula.ap(formula.ap_name() + mark)
    return formula.map(lambda part: rename_next(part, mark))


def is_different(axioms, actual, expected, names=()):
    """Whether two formulas about one step differ where the axioms hold.

    Diagrams are small when variables that occur together are close in their order, so ``names``
    are the variables in the order of the formula.
    """
    automaton = spot.make_twa_graph(spot.make_bdd_dict())
    formulas = [rename_next(formula) for formula in (axioms, actual, expected)]
    position = {name: index for index, name in enumerate(names)}
    propositions = {
        proposition.ap_name()
        for formula in formulas
        for proposition in spot.atomic_prop_collect(formula)
    }
    for name in sorted(propositions, key=lambda text: (position.get(variable_of(text), 0), text)):
        automaton.register_ap(name)
    axioms_bdd, actual_bdd, expected_bdd = (
        spot.formula_to_bdd(formula, automaton.get_dict(), automaton) for formula in formulas
    )
    difference = buddy.bdd_xor(actual_bdd, expected_bdd)
    return buddy.bdd_and(axioms_bdd, difference) != buddy.bddfalse


def variable_of(proposition):
    """Return the variable of a proposition: ``x`` for ``x.0`` and ``x'``."""
    return re.split(r"\.|'", proposition)[0]


@pytest.mark.parametrize(
    "model", quick_first(sorted((ROOT / "examples").glob("*/*.uml")), 2), ids=lambda path: path.stem
)
def test_the_texts_of_the_examples_are_equivalent(model):
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
"""Alf.library has hundreds of contracts; every eighth of them is compared."""


@pytest.mark.corpus
@pytest.mark.parametrize("name", quick_first(REAL, 2))
def test_the_texts_of_real_models_are_equivalent(corpus, name):
    assert_model_is_equivalent(corpus / "xmi" / "papyrus" / f"{name}.uml")


def assert_model_is_equivalent(model):
    contracts = compile_model(Request((model,))).graph.derived(Contract)
    assert contracts
    for contract in contracts[:: len(contracts) // 50 + 1]:
        domains = list_domains(contract)
        for conjunct in (*contract.assumptions, *contract.guarantees):
            if conjunct.class_ is Class.OTHER:
                continue  # no decision diagram over one step; random formulas cover it
            names = list_names(conjunct.formula)
            axioms = write_step_axioms(domains, names)
            expected = spot.formula(translate(domains, conjunct.formula))
            text = SpinPrinter(domains).print_conjunct(conjunct)
            assert not is_different(axioms, read_body(conjunct, domains), expected, names), text


def test_decision_diagrams_see_a_difference_only_where_the_axioms_hold():
    axioms = spot.formula('(("n==1") <-> ("b")) & X(("n==1") <-> ("b"))')
    assert not is_different(axioms, spot.formula('X"n==1"'), spot.formula('X"b"'))
    assert is_different(axioms, spot.formula('X"n==1"'), spot.formula('"b"'))
