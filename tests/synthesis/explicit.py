"""A GR(1) solver that enumerates all states: slow, and a direct copy of the definitions.

It shares the semantics of formulas (``logic.evaluate``) with the compiler, nothing else.
"""

from itertools import product

from sysmlc.logic import domains
from sysmlc.logic.contract import Class, Contract, Owner
from sysmlc.logic.evaluate import compile_evaluation

State = tuple[int, int]
"""Indices of the inputs and of the outputs in the lists of their valuations."""


class ExplicitGame:
    """The game of a contract, with all states and moves in lists."""

    def __init__(self, contract: Contract) -> None:
        self.inputs = list_viable_inputs(contract)
        self.outputs = list_valuations(contract, Owner.SYSTEM)
        self.contract = contract
        self.states = list(product(range(len(self.inputs)), range(len(self.outputs))))
        self.value = {(i, o): self.inputs[i] | self.outputs[o] for i, o in self.states}
        self.moves = {state: self.list_answers(state) for state in self.states}

    def list_answers(self, state: State) -> dict[int, list[State]]:
        """Return the allowed answers to every next input that the environment may give."""
        assumptions = list_evaluations(self.contract.assumptions, Class.SAFETY)
        guarantees = list_evaluations(self.contract.guarantees, Class.SAFETY)
        current, allowed_answers = self.value[state], {}
        for next_input in range(len(self.inputs)):
            if all(rule(current, self.inputs[next_input]) for rule in assumptions):
                answers = [(next_input, output) for output in range(len(self.outputs))]
                allowed_answers[next_input] = [
                    answer
                    for answer in answers
                    if all(rule(current, self.value[answer]) for rule in guarantees)
                ]
        return allowed_answers

    def find_states(self, rule) -> set[State]:
        return {state for state in self.states if rule(self.value[state], None)}

    def find_controllable_predecessors(self, target: set[State]) -> set[State]:
        """Return the states in which each next input has an answer in *target*."""
        return {
            state
            for state in self.states
            if all(
                any(answer in target for answer in answers)
                for answers in self.moves[state].values()
            )
        }

    def find_winning_states(self) -> set[State]:
        """Compute nu Z. for all goals: mu Y. for some fairness: nu X. ..., by definition."""
        goals = [
            self.find_states(rule)
            for rule in list_evaluations(self.contract.guarantees, Class.LIVENESS)
        ]
        fair = [
            self.find_states(rule)
            for rule in list_evaluations(self.contract.assumptions, Class.LIVENESS)
        ]
        goals, fair, previous = goals or [set(self.states)], fair or [set(self.states)], None
        z = set(self.states)
        while z != previous:
            previous = z
            z = set.intersection(
                *(self.find_states_reaching(goal, fair, previous) for goal in goals)
            )
        return z

    def find_states_reaching(
        self, goal: set[State], fair: list[set[State]], z: set[State]
    ) -> set[State]:
        y, before = set(), None
        target = goal & self.find_controllable_predecessors(z)
        while y != before:
            before = y
            start = target | self.find_controllable_predecessors(before)
            y = set.union(
                *(
                    self.find_waiting_states(start, set(self.states) - fair_states)
                    for fair_states in fair
                )
            )
        return y

    def find_waiting_states(self, start: set[State], unfair: set[State]) -> set[State]:
        x, before = set(self.states), None
        while x != before:
            before = x
            x = start | (unfair & self.find_controllable_predecessors(before))
        return x

    def is_realizable(self) -> bool:
        winning = self.find_winning_states()
        assumptions = list_evaluations(self.contract.assumptions, Class.INIT)
        guarantees = list_evaluations(self.contract.guarantees, Class.INIT)
        return all(
            any(
                all(rule(self.value[i, o], None) for rule in guarantees) and (i, o) in winning
                for o in range(len(self.outputs))
            )
            for i, inputs in enumerate(self.inputs)
            if all(rule(inputs, None) for rule in assumptions)
        )


def list_valuations(contract: Contract, owner: Owner):
    return list(
        domains.valuations({v.name: v.domain for v in contract.variables if v.owner is owner})
    )


def list_viable_inputs(contract: Contract):
    """Return the inputs with which some run satisfies the safety assumptions, if outputs help.

    With any other input, the environment has violated the assumptions already.
    """
    assumptions = list_evaluations(contract.assumptions, Class.SAFETY)
    inputs, outputs = (list_valuations(contract, owner) for owner in Owner)
    while True:
        viable = [
            current
            for current in inputs
            if any(
                all(rule(current | answer, after) for rule in assumptions)
                for answer in outputs
                for after in inputs
            )
        ]
        if viable == inputs:
            return viable
        inputs = viable


def list_evaluations(conjuncts, class_: Class):
    return [
        compile_evaluation(conjunct.formula) for conjunct in conjuncts if conjunct.class_ is class_
    ]
