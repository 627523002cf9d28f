"""Composition compared with implementations of random parts: predicted conjuncts do hold."""

import random

import pytest
from contracts_in_lines import parse_contract
from listed_runs import ListedRuns
from msgspec.structs import replace

from long_runs import quick_first
from sysmlc.logic.contract import Class, Composite, Owner, Part
from sysmlc.logic.evaluate import compile_evaluation
from sysmlc.synthesis import Manager
from sysmlc.synthesis.algebra.composition import _contract_with_environment, compose_parts

NAMES = ("x", "y", "e")
TRIED = 60


def random_literal(pick, names):
    return pick.choice(("", "!")) + pick.choice(names)


def random_conditions(pick, chosen):
    """Return a random condition of each class, and one about single steps.

    Initial and next-step literals are about the variables *chosen*.
    """
    next_values = [f"{name}'" for name in chosen]
    return [
        ("at first", random_literal(pick, chosen)),
        (
            "always",
            f"{random_literal(pick, [*NAMES, *next_values])} | {random_literal(pick, next_values)}",
        ),
        ("recurs", f"{random_literal(pick, NAMES)} | {random_literal(pick, chosen)}"),
        ("always", f"{random_literal(pick, NAMES)} | {random_literal(pick, chosen)}"),
    ]


def random_part(pick, output):
    """Return a part with a random contract and one output."""
    inputs = [name for name in NAMES if name != output]
    lines = [f"sys {output}: bool", *(f"env {name}: bool" for name in inputs)]
    for side, chosen in (("assume", inputs), ("promise", [output])):
        conditions = random_conditions(pick, chosen)
        lines += [
            f"{side} {class_} {condition}"
            for class_, condition in conditions
            if pick.random() < 0.6
        ]
    return Part(output, parse_contract("\n".join(lines)), output)


def random_pair(seed):
    pick = random.Random(seed)
    return random_part(pick, "x"), random_part(pick, "y")


def predict_holding(parts):
    """Return the contract of the whole, and whether each conjunct is predicted to hold."""
    conjuncts = tuple(
        c for part in parts for c in (*part.contract.assumptions, *part.contract.guarantees)
    )
    variables = {
        variable.name: variable
        for owner in (Owner.ENVIRONMENT, Owner.SYSTEM)
        for part in parts
        for variable in part.contract.variables
        if variable.owner is owner
    }
    outside = _contract_with_environment(Composite("c", "", parts))
    whole = replace(outside, variables=tuple(variables.values()), guarantees=conjuncts)
    composition = compose_parts(Composite("c", "", parts, (), whole), Manager())
    failing = (
        conjuncts
        if composition.conflict
        else [failure.conjunct for failure in composition.failures]
    )
    return whole, {conjunct: conjunct not in failing for conjunct in conjuncts}


class ImplementedRuns(ListedRuns):
    """Runs in which conjuncts hold and implementations determine the start and next values."""

    def __init__(self, variables, conjuncts, *implementations) -> None:
        super().__init__(variables, conjuncts)
        for name, start, table in implementations:
            self.starts = [state for state in self.starts if self.values[state][name] == start]
            excluded = [(a, b) for a, b in self.graph.edges if self.values[b][name] != table[a]]
            self.graph.remove_edges_from(excluded)

    def holds(self, conjunct):
        """Whether the implementation satisfies *conjunct*: in each step, or again and again."""
        rule = compile_evaluation(conjunct.formula)
        if conjunct.class_ is Class.INIT:
            return all(rule(self.values[state], None) for state in self.starts)
        if conjunct.class_ is Class.SAFETY:
            edges = self.graph.edges(self.find_reachable_states())
            return all(
                rule(self.values[state], self.values[successor]) for state, successor in edges
            )
        return not self.is_violated(conjunct)


def iter_implementations(part, pick):
    """Yield tables that satisfy the contract: a first value, and the next one for each state."""
    unordered = part.contract.variables
    variables = tuple(sorted(unordered, key=lambda variable: variable.name))
    for _ in range(TRIED):
        implementation = (
            part.name,
            pick.random() < 0.5,
            [pick.random() < 0.5 for _ in range(8)],
        )
        runs = ImplementedRuns(variables, part.contract.assumptions, implementation)
        if all(runs.holds(guarantee) for guarantee in part.contract.guarantees):
            yield implementation


def check_implementations(seed):
    """Return the predictions for a random pair and the number of confirming implementations."""
    parts, pick = random_pair(seed), random.Random(seed)
    whole, predictions = predict_holding(parts)
    variables = tuple(sorted(whole.variables, key=lambda variable: variable.name))
    first, second = (list(iter_implementations(part, pick))[:4] for part in parts)
    for runs in (
        ImplementedRuns(variables, whole.assumptions, a, b) for a in first for b in second
    ):
        wrong_predictions = [
            c.text
            for c, is_predicted in predictions.items()
            if is_predicted and runs.is_violated(c)
        ]
        assert wrong_predictions == [], (seed, wrong_predictions)
    return predictions, len(first) * len(second)


@pytest.mark.parametrize("start", quick_first(range(0, 200, 20), 2))
def test_predicted_conjuncts_hold_in_all_implementations(start):
    for seed in range(start, start + 20):
        check_implementations(seed)


@pytest.mark.long
def test_random_pairs_have_implementations_and_both_predictions():
    results = [check_implementations(seed) for seed in range(50)]
    assert sum(number > 0 for _, number in results) > 20
    assert {is_predicted for holding, _ in results for is_predicted in holding.values()} == {
        True,
        False,
    }
