"""Machines of contracts, random plays of them, and machines that are spoilt on purpose."""

import random

import networkx as nx
from explicit import rules, valuations

from sysmlc.logic.contract import Class, Owner
from sysmlc.logic.evaluate import evaluation, violation
from sysmlc.synthesis import Manager, make_game, solve
from sysmlc.synthesis.mealy import Move, explored
from sysmlc.synthesis.strategy import Controller
from sysmlc.synthesis.verify import faults
from sysmlc.values import replace


def controller(contract, engine=""):
    """The controller, or None when there is none."""
    solution = solve(make_game(contract, Manager(engine)))
    return Controller(solution) if solution.is_realizable else None


def machine(contract, engine=""):
    found = controller(contract, engine)
    return found and explored(found)


def said(machine, contract):
    """What the check says: conjuncts by their formula, and where there is no answer."""
    return list(faults(machine, contract, Manager()))


def play(contract, answer, length, seed):
    """A random play that keeps the assumptions; ``answer(inputs)`` is what the system does.

    It ends early when the environment has no input left.
    """
    die = random.Random(seed)
    steps = []
    given = valuations(contract, Owner.ENVIRONMENT)
    class_ = Class.INIT
    while len(steps) < length:
        assumed = rules(contract.assumptions, class_)
        allowed = [one for one in given if all(holds(rule, steps, one) for rule in assumed)]
        if not allowed:
            return steps
        inputs = die.choice(allowed)
        steps.append(inputs | answer(inputs))
        class_ = Class.SAFETY
    return steps


def holds(rule, steps, inputs):
    return rule(steps[-1], inputs) if steps else rule(inputs, None)


def broken(contract, steps):
    """The initial guarantees and those for every step that a finite play breaks."""
    safe = [one for one in contract.guarantees if one.class_ is not Class.LIVENESS]
    found = [one for one in safe if violation(one, steps) not in (None, len(steps) - 1)]
    return found + [one for one in safe if one.class_ is Class.INIT and violation(one, steps) == 0]


def followed(machine):
    """An ``answer`` for a play of a machine."""
    state = 0

    def answer(inputs):
        nonlocal state
        move = machine.moves[state][tuple(inputs[one.name] for one in machine.inputs)]
        state = move.state
        return dict(zip([one.name for one in machine.outputs], move.output, strict=True))

    return answer


def spoilt(machine, contract, seed):
    """The machine with one move changed: another output, another state, or none at all."""
    die = random.Random(seed)
    moves = [dict(one) for one in machine.moves]
    state = die.choice([at for at, one in enumerate(moves) if one])
    row = die.choice(list(moves[state]))
    move = moves[state].pop(row)
    kind = die.choice(["output", "state", "none"])
    outputs = [tuple(one.values()) for one in valuations(contract, Owner.SYSTEM)]
    if kind == "output":
        others = [one for one in outputs if one != move.output] or [move.output]
        moves[state][row] = Move(die.choice(others), move.state)
    if kind == "state":
        moves[state][row] = Move(move.output, die.randrange(machine.size))
    return replace(machine, moves=tuple(moves))


class Closed:
    """A machine in all environments that keep the assumptions, every state listed: the judge."""

    def __init__(self, machine, contract):
        self.machine, self.contract = machine, contract
        self.given = valuations(contract, Owner.ENVIRONMENT)
        self.stuck = False
        self.graph = nx.DiGraph()
        self.starts = self.following([], 0, Class.INIT)
        waiting = list(self.starts)
        self.graph.add_nodes_from(waiting)
        for node in waiting:
            for after in self.following([dict(node[0])], node[1], Class.SAFETY):
                if after not in self.graph:
                    waiting.append(after)
                self.graph.add_edge(node, after)

    def following(self, steps, state, class_):
        """Values of a step and the machine's state after it."""
        assumed = rules(self.contract.assumptions, class_)
        allowed = [one for one in self.given if all(holds(rule, steps, one) for rule in assumed)]
        found = []
        for inputs in allowed:
            row = tuple(inputs[one.name] for one in self.machine.inputs)
            move = self.machine.moves[state].get(row)
            if move is None:
                self.stuck = True
            else:
                names = [one.name for one in self.machine.outputs]
                values = inputs | dict(zip(names, move.output, strict=True))
                found.append((tuple(values.items()), move.state))
        return found

    def broken(self):
        """The guarantees that some run breaks."""
        return [one for one in self.contract.guarantees if self.is_broken(one)]

    def is_broken(self, conjunct):
        rule = evaluation(conjunct.formula)
        if conjunct.class_ is Class.INIT:
            return any(not rule(dict(one[0]), None) for one in self.starts)
        if conjunct.class_ is Class.SAFETY:
            edges = self.graph.edges
            return any(not rule(dict(one[0]), dict(other[0])) for one, other in edges)
        left = self.graph.subgraph([n for n in self.graph if not rule(dict(n[0]), None)])
        return any(self.is_fair(left, part) for part in nx.strongly_connected_components(left))

    def is_fair(self, graph, part):
        has_step = any(other in part for one in part for other in graph.successors(one))
        recurring = rules(self.contract.assumptions, Class.LIVENESS)
        return has_step and all(any(rule(dict(n[0]), None) for n in part) for rule in recurring)
