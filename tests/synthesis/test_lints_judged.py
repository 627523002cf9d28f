"""What is suspicious in random contracts, judged by listing their states."""

import pytest
from explicit import Explicit, rules
from listed_runs import Listed
from msgspec.structs import replace
from small_games import contract as random_contract

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, IntegerDomain, Owner
from sysmlc.logic.formula import Const, Var
from sysmlc.synthesis import Manager
from sysmlc.synthesis.lints import lint

DECIDED = {"SM533", "SM534", "SM535", "SM536", "SM538", "SM541", "SM542"}


def told(made) -> set[str]:
    sink = Sink()
    lint(made, lambda origin: Subject(origin), sink, Manager)
    return {one.rule.code for one in sink} & DECIDED


class Judge:
    """The definitions of the rules, word for word, over lists."""

    def __init__(self, made) -> None:
        self.made = made
        self.inputs = {one.name for one in made.variables if one.owner is Owner.ENVIRONMENT}

    def codes(self) -> set[str]:
        if not Listed(self.made.variables, self.made.assumptions).is_possible():
            return {"SM533"}
        asked = {
            "SM534": bool(self.dead()),
            "SM535": self.is_forced(self.made),
            "SM536": any(map(self.is_free, self.outputs())),
            **self.of_games(),
        }
        return {code for code, is_so in asked.items() if is_so}

    def of_games(self) -> dict[str, bool]:
        assumed, promised = (recurring(side) for side in sides(self.made))
        if not self.is_won(self.made):
            return {"SM538": bool(promised) and self.is_helped()}
        frames = [f.eq(Var(one.name, True), Var(one.name)) for one in self.outputs()]
        is_idle = bool(assumed or promised) and self.is_won(self.promising(frames))
        if is_idle or not (assumed and promised):
            return {"SM541": is_idle}
        return {"SM542": self.is_won(without_recurring(self.made, "assumptions"))}

    def is_won(self, made) -> bool:
        return Explicit(made).is_realizable()

    def promising(self, formulas):
        more = tuple(Conjunct(one, Class.SAFETY, "") for one in formulas)
        return replace(self.made, guarantees=(*self.made.guarantees, *more))

    def is_helped(self) -> bool:
        """Whether an input that recurs with one of few values would do."""
        if not self.is_won(without_recurring(self.made, "guarantees")):
            return False
        return any(
            self.is_won(helped) and not self.is_forced(helped) for helped in self.with_fairness()
        )

    def with_fairness(self):
        for one in self.made.variables:
            if one.owner is Owner.ENVIRONMENT and not isinstance(one.domain, IntegerDomain):
                for value in domains.values(one.domain):
                    wanted = Conjunct(f.eq(Var(one.name), Const(value)), Class.LIVENESS, "")
                    yield replace(self.made, assumptions=(*self.made.assumptions, wanted))

    def is_forced(self, made) -> bool:
        never = Conjunct(f.FALSE, Class.LIVENESS, "")
        kept = without_recurring(made, "guarantees")
        game = Explicit(self.timely(replace(kept, guarantees=(*kept.guarantees, never))))
        seen = self.reached(kept)
        return any(game.value[one] in seen for one in game.winning())

    def timely(self, made):
        """What is assumed of inputs alone is asked of its own step."""
        assumed = []
        for one in made.assumptions:
            found = f.variables(one.formula)
            is_plain = all(v.name in self.inputs and not v.primed for v in found)
            if one.class_ is Class.SAFETY and is_plain:
                assumed.append(replace(one, class_=Class.INIT))
                one = replace(one, formula=f.prime(one.formula))
            assumed.append(one)
        return replace(made, assumptions=tuple(assumed))

    def reached(self, made):
        made = self.timely(made)
        listed = Listed(made.variables, (*made.assumptions, *made.guarantees))
        return [listed.values[one] for one in sorted(listed.reachable())]

    def outputs(self):
        return [one for one in self.made.variables if one.owner is Owner.SYSTEM]

    def dead(self):
        return [one for one in self.reached(self.made) if not self.next_inputs(one)]

    def next_inputs(self, now):
        assumed = rules(self.timely(self.made).assumptions, Class.SAFETY)
        known = {v.name: v.domain for v in self.made.variables if v.name in self.inputs}
        return [one for one in domains.valuations(known) if all(r(now, one) for r in assumed)]

    def is_free(self, variable) -> bool:
        """Whether every value may follow: of a quantity somewhere, of a choice everywhere."""
        states = [one for one in self.reached(self.made) if self.next_inputs(one)]
        found = [self.may_be_all(now, i, variable) for now in states for i in self.next_inputs(now)]
        size = domains.size(variable.domain)
        is_quantity = isinstance(variable.domain, IntegerDomain) and size >= 3
        return any(found) if is_quantity else all(found)

    def may_be_all(self, now, given, variable) -> bool:
        promised = rules(self.made.guarantees, Class.SAFETY)
        known = {one.name: one.domain for one in self.outputs()}
        seen = {
            out[variable.name]
            for out in domains.valuations(known)
            if all(rule(now, given | out) for rule in promised)
        }
        return len(seen) == domains.size(variable.domain)


def sides(made):
    return made.assumptions, made.guarantees


def recurring(conjuncts):
    return [one for one in conjuncts if one.class_ is Class.LIVENESS]


def without_recurring(made, side):
    kept = tuple(one for one in getattr(made, side) if one.class_ is not Class.LIVENESS)
    return replace(made, **{side: kept})


@pytest.mark.parametrize("start", range(0, 160, 20))
def test_what_is_told_of_random_contracts_is_so(start):
    for seed in range(start, start + 20):
        made = random_contract(seed)
        assert told(made) == Judge(made).codes(), seed


def test_random_contracts_have_everything_that_is_judged():
    assert set().union(*(Judge(random_contract(seed)).codes() for seed in range(160))) == DECIDED
