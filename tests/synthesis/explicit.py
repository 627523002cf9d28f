"""A solver of GR(1) games that lists every state: slow, plain, and nothing but the definitions.

It shares the semantics of formulas (``logic.evaluate``) with the compiler, nothing else.
"""

from itertools import product

from sysmlc.logic import domains
from sysmlc.logic.contract import Class, Contract, Owner
from sysmlc.logic.evaluate import compile_evaluation

State = tuple[int, int]
"""Places of the inputs and of the outputs in the lists of their valuations."""


class Explicit:
    """The game of a contract, listed."""

    def __init__(self, contract: Contract) -> None:
        self.inputs = valuations(contract, Owner.ENVIRONMENT)
        self.outputs = valuations(contract, Owner.SYSTEM)
        self.contract = contract
        self.states = list(product(range(len(self.inputs)), range(len(self.outputs))))
        self.value = {(i, o): self.inputs[i] | self.outputs[o] for i, o in self.states}
        self.moves = {state: self.answered(state) for state in self.states}

    def answered(self, state: State) -> dict[int, list[State]]:
        """Every next input that the environment may give, with the answers that are allowed."""
        assumed = rules(self.contract.assumptions, Class.SAFETY)
        promised = rules(self.contract.guarantees, Class.SAFETY)
        now, found = self.value[state], {}
        for after in range(len(self.inputs)):
            if all(rule(now, self.inputs[after]) for rule in assumed):
                answers = [(after, out) for out in range(len(self.outputs))]
                found[after] = [
                    one for one in answers if all(rule(now, self.value[one]) for rule in promised)
                ]
        return found

    def where(self, rule) -> set[State]:
        return {state for state in self.states if rule(self.value[state], None)}

    def force(self, target: set[State]) -> set[State]:
        """Where each next input has an answer in the target."""
        return {
            state
            for state in self.states
            if all(any(one in target for one in found) for found in self.moves[state].values())
        }

    def winning(self) -> set[State]:
        """nu Z. for all goals: mu Y. for some fairness: nu X. ..., word for word."""
        goals = [self.where(rule) for rule in rules(self.contract.guarantees, Class.LIVENESS)]
        fair = [self.where(rule) for rule in rules(self.contract.assumptions, Class.LIVENESS)]
        goals, fair, everything = goals or [set(self.states)], fair or [set(self.states)], None
        z = set(self.states)
        while z != everything:
            everything = z
            z = set.intersection(*(self.reach(goal, fair, everything) for goal in goals))
        return z

    def reach(self, goal: set[State], fair: list[set[State]], z: set[State]) -> set[State]:
        y, before = set(), None
        target = goal & self.force(z)
        while y != before:
            before = y
            start = target | self.force(before)
            y = set.union(*(self.wait(start, set(self.states) - one) for one in fair))
        return y

    def wait(self, start: set[State], unfair: set[State]) -> set[State]:
        x, before = set(self.states), None
        while x != before:
            before = x
            x = start | (unfair & self.force(before))
        return x

    def is_realizable(self) -> bool:
        winning = self.winning()
        assumed = rules(self.contract.assumptions, Class.INIT)
        promised = rules(self.contract.guarantees, Class.INIT)
        return all(
            any(
                all(rule(self.value[i, o], None) for rule in promised) and (i, o) in winning
                for o in range(len(self.outputs))
            )
            for i, given in enumerate(self.inputs)
            if all(rule(given, None) for rule in assumed)
        )


def valuations(contract: Contract, owner: Owner):
    return list(
        domains.valuations({v.name: v.domain for v in contract.variables if v.owner is owner})
    )


def rules(conjuncts, class_: Class):
    return [compile_evaluation(one.formula) for one in conjuncts if one.class_ is class_]
