"""Machines whose guards compare numbers: ``contracts check`` and an explicit checker agree."""

import json
from collections import Counter
from fractions import Fraction
from itertools import product
from random import Random

import pytest
from click.testing import CliRunner
from explicit_numbers import ExploredMachine, Grid, Step
from numeric_machines import (
    RESOLUTION,
    Feature,
    InState,
    Literal,
    Machine,
    Move,
    Not,
    Pair,
    Requirement,
    list_machine_literals,
    make_assigning_machine,
    make_machine,
    make_requirements,
    write_machine,
)

from contract_oracle import combine_verdicts
from sysmlc.cli import group
from sysmlc.logic.inequalities import Inequality, find_solution

REQUIREMENTS = 6
UNDECIDED = 0.05
"""The share of requirements about machines without assignments that may have no answer."""


# -- the checker -----------------------------------------------------------------------------------


def compare_with(name, comparison, bound):
    """Return the comparison of a feature, or of the difference of two (``x-y``), with a number."""
    names = name.split("-")
    return Literal(tuple(zip(names, (1, -1), strict=False)), comparison, bound)


X = Feature("x")
LOW, HIGH = (Feature(name, "constant") for name in ("low", "high"))
COLD, WARM = compare_with("x", "<", 1), compare_with("x", ">=", 1)
HOT = compare_with("x", ">", 3)
HEATER = Machine((X,), ("A", "B", "C"), (Move("A", "B", COLD), Move("A", "C", WARM)))
GAUGE = Machine((X,), ("A", "B"), (Move("A", "B", COLD), Move("A", "B", compare_with("x", ">", 1))))
BELOW_LOW, ABOVE_HIGH = compare_with("x-low", "<", 0), compare_with("x-high", ">", 0)
SWITCH = Machine(
    (X, LOW, HIGH),
    ("A", "B", "C"),
    (
        Move("A", "B", BELOW_LOW),
        Move("B", "A", ABOVE_HIGH),
        Move("A", "C", Pair("and", BELOW_LOW, ABOVE_HIGH)),
    ),
    (compare_with("low-high", "<", 0),),
)
BOILER = Machine(
    (X,),
    ("A", "B", "C"),
    (Move("A", "B", when=WARM), Move("B", "A", when=COLD), Move("B", "C", when=HOT)),
    (compare_with("x", "<=", 2),),
)
VALVE = Machine(
    (X, Feature("y")),
    ("A", "B", "C"),
    (
        Move("A", "B", compare_with("x-y", ">", 0)),
        Move(
            "B",
            "C",
            Pair(
                "and",
                Pair("and", WARM, compare_with("y", "<", 0)),
                Not(compare_with("x-y", ">", 1)),
            ),
        ),
    ),
)
COUNTER = Machine(
    (Feature("x", "attribute", 0),),
    ("A", "B"),
    (
        Move("A", "A", compare_with("x", "<", 4), "E0", effect=("x", 1), is_sum=True),
        Move("A", "B", compare_with("x", ">=", 4)),
    ),
)
STATE = {name: InState(name) for name in "ABC"}


def at_once(p, q):
    return Requirement("G (p -> X q)", p, q)


@pytest.mark.parametrize(
    ("machine", "requirement", "verdict"),
    [
        (HEATER, Requirement("F p", Not(STATE["A"]), COLD), "holds"),
        (HEATER, Requirement("F p", STATE["B"], COLD), "broken"),
        (HEATER, at_once(Pair("and", STATE["A"], Not(WARM)), STATE["B"]), "holds"),
        (HEATER, Requirement("G F p", Pair("or", COLD, WARM), COLD), "holds"),
        (HEATER, Requirement("G F p", Pair("or", COLD, HOT), COLD), "broken"),
        (GAUGE, Requirement("F p", STATE["B"], COLD), "broken"),
        (GAUGE, Requirement("G (p -> F q)", compare_with("x", "!=", 1), STATE["B"]), "holds"),
        (SWITCH, Requirement("G p", Not(STATE["C"]), COLD), "holds"),
        (SWITCH, Requirement("G p", Not(Pair("and", BELOW_LOW, ABOVE_HIGH)), COLD), "holds"),
        (SWITCH, at_once(Pair("and", STATE["B"], Not(BELOW_LOW)), STATE["A"]), "broken"),
        (BOILER, Requirement("G p", Not(STATE["C"]), COLD), "holds"),
        (BOILER, at_once(Pair("and", STATE["B"], COLD), STATE["A"]), "holds"),
        (BOILER, Requirement("G p", Pair("or", Not(STATE["B"]), WARM), COLD), "broken"),
        (VALVE, Requirement("G p", Not(STATE["C"]), COLD), "holds"),
        (COUNTER, Requirement("G p", compare_with("x", "<=", 4), COLD), "holds"),
        (COUNTER, Requirement("G p", compare_with("x", "<=", 3), COLD), "broken"),
        (COUNTER, Requirement("F p", STATE["B"], COLD), "broken"),
        (COUNTER, at_once(compare_with("x", "==", 4), STATE["B"]), "holds"),
    ],
)
def test_the_checker_gives_known_answers(machine, requirement, verdict):
    assert ExploredMachine(machine, [requirement]).decide(requirement) == verdict


def test_the_checker_names_states_that_no_numbers_reach():
    unreachable = [ExploredMachine(m).list_unreachable() for m in (HEATER, SWITCH, BOILER, VALVE)]
    assert unreachable == [[], ["C"], ["C"], ["C"]]


def test_the_grid_has_points_in_all_regions():
    """Exact inequalities have a solution for the same combinations of literals."""
    for seed in range(60):
        machine = make_machine(Random(seed))
        if machine.constraints or any(feature.is_integer for feature in machine.features):
            continue
        literals = [
            Literal(item.terms, "<=", item.bound) for item in list_machine_literals(machine)
        ]
        literals = list(dict.fromkeys(literals))
        grid = Grid(machine, literals)
        letters = {
            letter for fixed in grid.list_fixed_values() for letter in grid.list_letters(fixed)
        }
        values = [
            row
            for feature in machine.features
            if feature.value is not None
            for row in list_rows(Literal(((feature.name, 1),), "==", feature.value), is_true=True)
        ]
        for signs in product((False, True), repeat=len(literals)):
            rows = [row for pair in zip(literals, signs, strict=True) for row in list_rows(*pair)]
            letter = frozenset(item for item, sign in zip(literals, signs, strict=True) if sign)
            assert (find_solution([*values, *rows]) is not None) == (letter in letters)


def list_rows(literal, is_true):
    """Return the inequalities that state whether a literal is true."""
    terms = {name: Fraction(factor) for name, factor in literal.terms}
    opposite = {name: -factor for name, factor in terms.items()}
    at_most = Inequality(terms, Fraction(literal.bound), False)
    if literal.comparison == "==":
        return [at_most, Inequality(opposite, -at_most.bound, False)]
    return [at_most if is_true else Inequality(opposite, -at_most.bound, True)]


# -- against the checker ---------------------------------------------------------------------------


def check(path):
    """Return the document of ``contracts check`` about a model."""
    arguments = ["contracts", "check", "--format", "json", str(path)]
    result = CliRunner().invoke(group.sysmlc, arguments, catch_exceptions=False)
    return json.loads(result.stdout)


def read_steps(machine, witness):
    """Return the steps of a run; an input without a number is one that nothing compares.

    There are no steps if the run does not know the number of an attribute or of a constrained
    input, or if a constraint compares several features: the numbers need not satisfy it.
    """
    if any(len(literal.terms) > 1 for literal in machine.constraints):
        return []
    attributes = {item.name for item in machine.features if item.kind == "attribute"}
    shown = attributes | {name for literal in machine.constraints for name, _ in literal.terms}
    # A run without any known number has no member ``numbers``.
    known_numbers = witness.get("numbers", [{}])
    if not all(shown <= numbers.keys() for numbers in known_numbers):
        return []
    scale = RESOLUTION / machine.unit
    steps = []
    for step, numbers in zip(witness["steps"], known_numbers, strict=True):
        values = {item.name: Fraction((item.value or 0) * RESOLUTION) for item in machine.features}
        for name, entry in numbers.items():
            values[name] = Fraction(str(entry["number"])) * scale
        steps.append(Step(step["state"], step.get("event", "").replace("none", ""), values))
    return steps


def compare(random, make_machine, path):
    """Return the disagreements about a random machine, and the verdicts of ``contracts check``."""
    machine = make_machine(random)
    requirements = make_requirements(random, machine, REQUIREMENTS)
    explored = ExploredMachine(machine, requirements)
    path.write_text(write_machine(machine, requirements), "utf-8")
    document = check(path)
    verdicts, wrong = [], []
    for number, requirement in enumerate(requirements):
        name, expected = f"P::R{number}", explored.decide(requirement)
        entries = [entry for entry in document["requirements"] if entry["requirement"] == name]
        verdict = combine_verdicts(entries)
        verdicts.append(verdict)
        if verdict not in (expected, "not-decided"):
            wrong.append((name, verdict, expected))
        for witness in (entry["witness"] for entry in entries if entry["verdict"] == "broken"):
            steps = read_steps(machine, witness)
            if steps and not explored.replay(requirement, steps, witness["loop"]):
                wrong.append((name, "no run of the machine violates it so", witness))
    for behaviour in document["behaviours"]:
        unreachable, never_taken = set(behaviour["unreachable"]), behaviour["never_taken"]
        expected = set(explored.list_unreachable()), explored.count_never_taken()
        # The values of an attribute may be approximated, so that fewer states are reported.
        is_exact = not explored.has_attributes
        if (unreachable, len(never_taken)) != expected if is_exact else unreachable - expected[0]:
            wrong.append((unreachable, never_taken, expected))
    return wrong, verdicts


def compare_many(seeds, make_machine, tmp_path):
    """Compare the answers about many machines; return the share of requirements without answer."""
    failures, answers = {}, Counter()
    for seed in seeds:
        wrong, verdicts = compare(Random(seed), make_machine, tmp_path / f"{seed}.sysml")
        failures.update({seed: wrong} if wrong else {})
        answers.update(verdicts)
    print(dict(answers))
    assert failures == {}
    return answers["not-decided"] / answers.total()


def test_requirements_about_numbers_have_the_verdicts_of_the_checker(tmp_path):
    assert compare_many(range(16), make_machine, tmp_path) <= UNDECIDED


def test_requirements_about_assigned_numbers_have_the_verdicts_of_the_checker(tmp_path):
    compare_many(range(6), make_assigning_machine, tmp_path)


@pytest.mark.long
@pytest.mark.parametrize("start", range(1000, 1500, 50))
def test_requirements_of_many_machines_have_the_verdicts_of_the_checker(start, tmp_path):
    assert compare_many(range(start, start + 50), make_machine, tmp_path) <= UNDECIDED
    compare_many(range(start, start + 20), make_assigning_machine, tmp_path)
