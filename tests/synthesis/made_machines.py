"""Controllers of contracts, random plays of them, and ones that are spoilt on purpose."""

import random

import networkx as nx
from explicit import rules, valuations
from msgspec.structs import replace

from sysmlc.logic import domains
from sysmlc.logic.contract import Class, Owner
from sysmlc.logic.evaluate import compile_evaluation, find_violation
from sysmlc.logic.formula import Const, negate
from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.controller_synthesis import Form, build_controller_form
from sysmlc.synthesis.controllers.forms import Machine
from sysmlc.synthesis.controllers.strategy import extract_strategy
from sysmlc.synthesis.controllers.verification import find_faults
from sysmlc.synthesis.games.arena import build_plain_arena
from sysmlc.synthesis.games.command_elimination import eliminate_commands
from sysmlc.synthesis.games.solver import solve_arena
from sysmlc.synthesis.games.variable_elimination import eliminate_determined_variables


def planned(contract, engine="", is_encoded=True):
    """The game and its strategy, or None when there is none."""
    game = make_game(contract, Manager(engine))
    game = eliminate_determined_variables(game) if is_encoded else game
    solution = solve_arena(eliminate_commands(game) if is_encoded else build_plain_arena(game))
    return (game, extract_strategy(game, solution)) if solution.is_realizable else None


def controller(contract, form=Form.ANY, engine="", is_encoded=True):
    """A controller that is not checked, or None when there is none."""
    found = planned(contract, engine, is_encoded)
    return found and build_controller_form(contract, *found, form)


def said(machine, contract):
    """What the check says: conjuncts by their formula, and where there is no answer."""
    return list(find_faults(machine, contract, Manager()))


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
    found = [one for one in safe if find_violation(one, steps) not in (None, len(steps) - 1)]
    return found + [
        one for one in safe if one.class_ is Class.INIT and find_violation(one, steps) == 0
    ]


def followed(controller):
    """An ``answer`` for a play of a controller."""
    state, last = 0, {}

    def answer(inputs):
        nonlocal state, last
        outputs, state = controller.step(state, last, inputs)
        last = inputs | outputs
        return outputs

    return answer


def spoilt(controller, seed):
    """The controller with one thing changed, or None when there is nothing to change."""
    die = random.Random(seed)
    change = spoilt_machine if isinstance(controller, Machine) else spoilt_table
    return change(controller, die)


def spoilt_machine(machine, die):
    """One move with another output, state or condition, or without it."""
    places = [(at, move) for at, moves in enumerate(machine.states) for move in moves]
    if not places:
        return None
    state, move = die.choice(places)
    kind = die.choice(["output", "state", "when", "none", "twice"])
    changed = [move]
    if kind == "output":
        at = die.randrange(len(move.output))
        values = domains.values(machine.outputs[at].domain)
        output = [*move.output[:at], Const(die.choice(values)), *move.output[at + 1 :]]
        changed = [replace(move, output=tuple(output))]
    if kind == "state":
        changed = [replace(move, state=die.randrange(machine.size))]
    if kind == "when":
        changed = [replace(move, when=negate(move.when))]
    if kind == "none":
        changed = []
    states = [list(moves) for moves in machine.states]
    place = states[state].index(move)
    states[state][place : place + 1] = changed
    if kind == "twice":
        die.shuffle(states[state])
    return replace(machine, states=tuple(map(tuple, states)))


def spoilt_table(table, die):
    """One node with its ends exchanged or one of them constant, or an output that is constant."""
    kind = die.choice(["exchange", "end", "output"])
    if kind == "output":
        at = die.randrange(len(table.modes))
        mode = table.modes[at]
        outputs = list(mode.outputs)
        outputs[die.randrange(len(outputs))] = die.randrange(2)
        modes = [*table.modes[:at], replace(mode, outputs=tuple(outputs)), *table.modes[at + 1 :]]
        return replace(table, modes=tuple(modes))
    if not table.nodes:
        return None
    at = die.randrange(len(table.nodes))
    bit, low, high = table.nodes[at]
    ends = (bit, high, low) if kind == "exchange" else (bit, die.randrange(2), high)
    return replace(table, nodes=(*table.nodes[:at], ends, *table.nodes[at + 1 :]))


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
        last = steps[-1] if steps else {}
        for inputs in allowed:
            try:
                outputs, after = self.machine.step(state, last, inputs)
            except (LookupError, ValueError):
                outputs, after = {}, None
            if after is None or not self.are_values(outputs):
                self.stuck = True
            else:
                found.append((tuple((inputs | outputs).items()), after))
        return found

    def are_values(self, outputs):
        known = {one.name: one.domain for one in self.contract.variables}
        return all(domains.contains(known[name], value) for name, value in outputs.items())

    def broken(self):
        """The guarantees that some run breaks."""
        return [one for one in self.contract.guarantees if self.is_broken(one)]

    def is_broken(self, conjunct):
        rule = compile_evaluation(conjunct.formula)
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
