"""Lints of random contracts, compared with their definitions over enumerated states."""

import pytest
from explicit import ExplicitGame, list_evaluations
from listed_runs import ListedRuns
from msgspec.structs import replace
from small_games import random_contract

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, IntegerDomain, Owner
from sysmlc.logic.formula import Const, Var
from sysmlc.synthesis import Manager
from sysmlc.synthesis.lints import lint

COMPARED = {"SM533", "SM534", "SM535", "SM536", "SM538", "SM541", "SM542"}


def find_lints(contract) -> set[str]:
    sink = Sink()
    lint(contract, lambda origin: Subject(origin), sink, Manager)
    return {diagnostic.rule.code for diagnostic in sink} & COMPARED


class ReferenceLints:
    """Direct implementations of the definitions of the rules over enumerated states."""

    def __init__(self, contract) -> None:
        self.contract = contract
        self.game = ExplicitGame(contract)

    def find_codes(self) -> set[str]:
        if not ListedRuns(self.contract.variables, self.contract.assumptions).is_possible():
            return {"SM533"}
        verdicts = {
            "SM534": bool(self.list_dead_ends()),
            "SM535": self.is_forced(self.contract),
            "SM536": any(map(self.is_free, self.list_outputs())),
            **self.check_games(),
        }
        return {code for code, is_violated in verdicts.items() if is_violated}

    def check_games(self) -> dict[str, bool]:
        fairness, goals = (list_recurring(side) for side in list_sides(self.contract))
        if not self.is_won(self.contract):
            return {"SM538": bool(goals) and self.is_helped()}
        frames = [f.eq(Var(output.name, True), Var(output.name)) for output in self.list_outputs()]
        is_idle = bool(fairness or goals) and self.is_won(self.add_guarantees(frames))
        if is_idle or not (fairness and goals):
            return {"SM541": is_idle}
        return {"SM542": self.is_won(drop_recurring(self.contract, "assumptions"))}

    def is_won(self, contract) -> bool:
        return ExplicitGame(contract).is_realizable()

    def add_guarantees(self, formulas):
        conjuncts = tuple(Conjunct(formula, Class.SAFETY, "") for formula in formulas)
        return replace(self.contract, guarantees=(*self.contract.guarantees, *conjuncts))

    def is_helped(self) -> bool:
        """Whether the recurrence of some value of an input makes the contract realizable."""
        if not self.is_won(drop_recurring(self.contract, "guarantees")):
            return False
        return any(
            self.is_won(contract) and not self.is_forced(contract)
            for contract in self.iter_fair_contracts()
        )

    def iter_fair_contracts(self):
        for variable in self.contract.variables:
            if variable.owner is Owner.ENVIRONMENT and not isinstance(
                variable.domain, IntegerDomain
            ):
                for value in domains.values(variable.domain):
                    fairness = Conjunct(f.eq(Var(variable.name), Const(value)), Class.LIVENESS, "")
                    yield replace(self.contract, assumptions=(*self.contract.assumptions, fairness))

    def is_forced(self, contract) -> bool:
        never = Conjunct(f.FALSE, Class.LIVENESS, "")
        without_goals = drop_recurring(contract, "guarantees")
        game = ExplicitGame(replace(without_goals, guarantees=(*without_goals.guarantees, never)))
        reachable = self.list_reachable_states(without_goals)
        return any(game.value[state] in reachable for state in game.find_winning_states())

    def list_reachable_states(self, contract):
        """Return the states that a run reaches in which all inputs can be continued."""
        runs = ListedRuns(contract.variables, (*contract.assumptions, *contract.guarantees))
        runs.remove_states(
            index
            for index, value in enumerate(runs.values)
            if not any(inputs.items() <= value.items() for inputs in self.game.inputs)
        )
        return [runs.values[state] for state in sorted(runs.find_reachable_states())]

    def list_outputs(self):
        return [variable for variable in self.contract.variables if variable.owner is Owner.SYSTEM]

    def list_dead_ends(self):
        return [
            state
            for state in self.list_reachable_states(self.contract)
            if not self.list_next_inputs(state)
        ]

    def list_next_inputs(self, state):
        moves = next(
            self.game.moves[index] for index, value in self.game.value.items() if value == state
        )
        return [self.game.inputs[next_input] for next_input in moves]

    def is_free(self, variable) -> bool:
        """Whether each value may follow: in some step for a quantity, in all steps for a choice."""
        states = [
            state
            for state in self.list_reachable_states(self.contract)
            if self.list_next_inputs(state)
        ]
        results = [
            self.may_take_all_values(state, inputs, variable)
            for state in states
            for inputs in self.list_next_inputs(state)
        ]
        size = domains.size(variable.domain)
        is_quantity = isinstance(variable.domain, IntegerDomain) and size >= 3
        return any(results) if is_quantity else all(results)

    def may_take_all_values(self, state, inputs, variable) -> bool:
        guarantees = list_evaluations(self.contract.guarantees, Class.SAFETY)
        domains_by_name = {output.name: output.domain for output in self.list_outputs()}
        values = {
            outputs[variable.name]
            for outputs in domains.valuations(domains_by_name)
            if all(rule(state, inputs | outputs) for rule in guarantees)
        }
        return len(values) == domains.size(variable.domain)


def list_sides(contract):
    return contract.assumptions, contract.guarantees


def list_recurring(conjuncts):
    return [conjunct for conjunct in conjuncts if conjunct.class_ is Class.LIVENESS]


def drop_recurring(contract, side):
    conjuncts = tuple(
        conjunct for conjunct in getattr(contract, side) if conjunct.class_ is not Class.LIVENESS
    )
    return replace(contract, **{side: conjuncts})


@pytest.mark.parametrize("start", range(0, 160, 20))
def test_lints_of_random_contracts_match_their_definitions(start):
    for seed in range(start, start + 20):
        contract = random_contract(seed)
        assert find_lints(contract) == ReferenceLints(contract).find_codes(), seed


def test_random_contracts_have_every_compared_lint():
    assert (
        set().union(*(ReferenceLints(random_contract(seed)).find_codes() for seed in range(160)))
        == COMPARED
    )
