"""Composition judged by implementations of random parts: what is said to hold does hold."""

import random

import pytest
from contracts_in_lines import contract
from listed_runs import Listed

from long_runs import quick_first
from sysmlc.logic.contract import Class, Composite, Contract, Part
from sysmlc.logic.evaluate import compile_evaluation
from sysmlc.synthesis import Manager
from sysmlc.synthesis.algebra.composition import compose_parts

NAMES = ("x", "y", "e")
TRIED = 60


def literal(pick, names):
    return pick.choice(("", "!")) + pick.choice(names)


def said(pick, chosen):
    """A condition of each class about variables that are all seen, and next values of some; and
    one about each step alone.
    """
    then = [f"{one}'" for one in chosen]
    return [
        ("at first", literal(pick, chosen)),
        ("always", f"{literal(pick, [*NAMES, *then])} | {literal(pick, then)}"),
        ("recurs", f"{literal(pick, NAMES)} | {literal(pick, chosen)}"),
        ("always", f"{literal(pick, NAMES)} | {literal(pick, chosen)}"),
    ]


def part(pick, own):
    """A part with a random contract that decides one variable."""
    others = [one for one in NAMES if one != own]
    lines = [f"sys {own}: bool", *(f"env {one}: bool" for one in others)]
    for side, chosen in (("assume", others), ("promise", [own])):
        conditions = said(pick, chosen)
        lines += [f"{side} {how} {what}" for how, what in conditions if pick.random() < 0.6]
    return Part(own, contract("\n".join(lines)), own)


def pair(seed):
    pick = random.Random(seed)
    return part(pick, "x"), part(pick, "y")


def told(parts):
    """Every condition of the parts, and whether it is said to hold in every run."""
    every = tuple(c for one in parts for c in (*one.contract.assumptions, *one.contract.guarantees))
    outside = compose_parts(Composite("c", "", parts), Manager()).contract
    whole = Contract("c", "", outside.variables, outside.assumptions, every)
    found = compose_parts(Composite("c", "", parts, (), whole), Manager())
    failed = every if found.conflict else [one.conjunct for one in found.failures]
    return outside, {one: one not in failed for one in every}


class Implemented(Listed):
    """Runs in which conjuncts hold and variables begin and go on as implementations say."""

    def __init__(self, variables, conjuncts, *made) -> None:
        super().__init__(variables, conjuncts)
        for name, start, table in made:
            self.starts = [one for one in self.starts if self.values[one][name] == start]
            wrong = [(a, b) for a, b in self.graph.edges if self.values[b][name] != table[a]]
            self.graph.remove_edges_from(wrong)

    def holds(self, conjunct):
        """As a component has to keep it: at once, whatever comes later; or again and again."""
        rule = compile_evaluation(conjunct.formula)
        if conjunct.class_ is Class.INIT:
            return all(rule(self.values[one], None) for one in self.starts)
        if conjunct.class_ is Class.SAFETY:
            ways = self.graph.edges(self.reachable())
            return all(rule(self.values[one], self.values[other]) for one, other in ways)
        return not self.is_violated(conjunct)


def implementations(part, pick):
    """Tables that keep the contract: a first value and the next one for each of eight states."""
    given = part.contract.variables
    variables = tuple(sorted(given, key=lambda one: one.name))
    for _ in range(TRIED):
        made = part.name, pick.random() < 0.5, [pick.random() < 0.5 for _ in range(8)]
        runs = Implemented(variables, part.contract.assumptions, made)
        if all(runs.holds(one) for one in part.contract.guarantees):
            yield made


def judged(seed):
    """What is said to hold of a random pair, and how many pairs of implementations confirm it."""
    parts, pick = pair(seed), random.Random(seed)
    outside, holding = told(parts)
    variables = tuple(sorted(outside.variables, key=lambda one: one.name))
    one, other = (list(implementations(part, pick))[:4] for part in parts)
    for runs in (Implemented(variables, outside.assumptions, a, b) for a in one for b in other):
        wrong = [c.text for c, is_said in holding.items() if is_said and runs.is_violated(c)]
        assert wrong == [], (seed, wrong)
    return holding, len(one) * len(other)


@pytest.mark.parametrize("start", quick_first(range(0, 200, 20), 2))
def test_what_follows_of_the_contracts_holds_of_what_implements_them(start):
    for seed in range(start, start + 20):
        judged(seed)


def test_the_random_pairs_have_implementations_and_both_answers():
    found = [judged(seed) for seed in range(50)]
    assert sum(number > 0 for _, number in found) > 20
    assert {said for holding, _ in found for said in holding.values()} == {True, False}
