"""Controllers of contracts, random plays against them, and mutated controllers with faults."""

import random

import networkx as nx
from explicit import list_evaluations, list_viable_inputs
from msgspec.structs import replace

from sysmlc.controllers.machine import Machine
from sysmlc.logic import domains
from sysmlc.logic.contract import Class
from sysmlc.logic.evaluate import compile_evaluation, find_violation
from sysmlc.logic.formula import Const, negate
from sysmlc.synthesis import Manager, make_game
from sysmlc.synthesis.controller_synthesis import Form, build_controller_form
from sysmlc.synthesis.games.arena import build_plain_arena
from sysmlc.synthesis.games.command_elimination import eliminate_commands
from sysmlc.synthesis.games.solver import solve_arena
from sysmlc.synthesis.games.variable_elimination import eliminate_determined_variables
from sysmlc.synthesis.strategies.strategy import extract_strategy
from sysmlc.synthesis.strategies.verification import find_faults


def plan_strategy(contract, engine="", is_encoded=True):
    """Return the game and its strategy, or None if the contract is unrealizable."""
    game = make_game(contract, Manager(engine))
    game = eliminate_determined_variables(game) if is_encoded else game
    solution = solve_arena(eliminate_commands(game) if is_encoded else build_plain_arena(game))
    return (game, extract_strategy(game, solution)) if solution.is_realizable else None


def build_controller(contract, form=Form.ANY, engine="", is_encoded=True):
    """Return an unverified controller, or None if the contract is unrealizable."""
    plan = plan_strategy(contract, engine, is_encoded)
    return plan and build_controller_form(contract, *plan, form)


def list_faults(machine, contract):
    """Return the faults that verification finds: violated guarantees and missing answers."""
    return list(find_faults(machine, contract, Manager()))


def play_randomly(contract, answer, length, seed):
    """Return the steps of a random play that satisfies the assumptions.

    ``answer(inputs)`` returns the outputs of the system.

    The play ends early when no input satisfies the assumptions.
    """
    die = random.Random(seed)
    steps = []
    valuations = list_viable_inputs(contract)
    class_ = Class.INIT
    while len(steps) < length:
        assumptions = list_evaluations(contract.assumptions, class_)
        allowed = [
            inputs
            for inputs in valuations
            if all(evaluate(rule, steps, inputs) for rule in assumptions)
        ]
        if not allowed:
            return steps
        inputs = die.choice(allowed)
        steps.append(inputs | answer(inputs))
        class_ = Class.SAFETY
    return steps


def evaluate(rule, steps, inputs):
    return rule(steps[-1], inputs) if steps else rule(inputs, None)


def list_broken_guarantees(contract, steps):
    """Return the initial and safety guarantees that a finite play violates."""
    guarantees = [
        guarantee for guarantee in contract.guarantees if guarantee.class_ is not Class.LIVENESS
    ]
    broken = [
        guarantee
        for guarantee in guarantees
        if find_violation(guarantee, steps) not in (None, len(steps) - 1)
    ]
    return broken + [
        guarantee
        for guarantee in guarantees
        if guarantee.class_ is Class.INIT and find_violation(guarantee, steps) == 0
    ]


def follow(controller):
    """Return the function ``answer`` with which *controller* takes part in a play."""
    state, last = 0, {}

    def answer(inputs):
        nonlocal state, last
        outputs, state = controller.step(state, last, inputs)
        last = inputs | outputs
        return outputs

    return answer


def mutate(controller, seed):
    """Return *controller* with one random change, or None if it has nothing to change."""
    die = random.Random(seed)
    mutate_form = mutate_machine if isinstance(controller, Machine) else mutate_table
    return mutate_form(controller, die)


def mutate_machine(machine, die):
    """Return *machine* with one move changed, removed or shuffled among its siblings."""
    positions = [(index, move) for index, moves in enumerate(machine.states) for move in moves]
    if not positions:
        return None
    state, move = die.choice(positions)
    kind = die.choice(["output", "state", "when", "none", "twice"])
    changed = [move]
    if kind == "output":
        index = die.randrange(len(move.output))
        values = domains.values(machine.outputs[index].domain)
        output = [*move.output[:index], Const(die.choice(values)), *move.output[index + 1 :]]
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


def mutate_table(table, die):
    """Return *table* with exchanged branches of a node, or with a constant branch or output."""
    kind = die.choice(["exchange", "end", "output"])
    if kind == "output":
        index = die.randrange(len(table.modes))
        mode = table.modes[index]
        outputs = list(mode.outputs)
        outputs[die.randrange(len(outputs))] = die.randrange(2)
        modes = [
            *table.modes[:index],
            replace(mode, outputs=tuple(outputs)),
            *table.modes[index + 1 :],
        ]
        return replace(table, modes=tuple(modes))
    if not table.nodes:
        return None
    index = die.randrange(len(table.nodes))
    bit, low, high = table.nodes[index]
    ends = (bit, high, low) if kind == "exchange" else (bit, die.randrange(2), high)
    return replace(table, nodes=(*table.nodes[:index], ends, *table.nodes[index + 1 :]))


class ClosedLoop:
    """The closed loop of a machine and all allowed environments, enumerated: the reference."""

    def __init__(self, machine, contract):
        self.machine, self.contract = machine, contract
        self.valuations = list_viable_inputs(contract)
        self.is_stuck = False
        self.graph = nx.DiGraph()
        self.starts = self.list_steps_after([], 0, Class.INIT)
        waiting = list(self.starts)
        self.graph.add_nodes_from(waiting)
        for node in waiting:
            for after in self.list_steps_after([dict(node[0])], node[1], Class.SAFETY):
                if after not in self.graph:
                    waiting.append(after)
                self.graph.add_edge(node, after)

    def list_steps_after(self, steps, state, class_):
        """Return the values of each possible next step and the machine's state after it."""
        assumptions = list_evaluations(self.contract.assumptions, class_)
        allowed = [
            inputs
            for inputs in self.valuations
            if all(evaluate(rule, steps, inputs) for rule in assumptions)
        ]
        steps_after = []
        previous = steps[-1] if steps else {}
        for inputs in allowed:
            try:
                outputs, after = self.machine.step(state, previous, inputs)
            except (LookupError, ValueError):
                outputs, after = {}, None
            if after is None or not self.are_values(outputs):
                self.is_stuck = True
            else:
                steps_after.append((tuple((inputs | outputs).items()), after))
        return steps_after

    def are_values(self, outputs):
        domains_by_name = {variable.name: variable.domain for variable in self.contract.variables}
        return all(
            domains.contains(domains_by_name[name], value) for name, value in outputs.items()
        )

    def list_broken_guarantees(self):
        """Return the guarantees that some run violates."""
        return [guarantee for guarantee in self.contract.guarantees if self.is_broken(guarantee)]

    def is_broken(self, conjunct):
        rule = compile_evaluation(conjunct.formula)
        if conjunct.class_ is Class.INIT:
            return any(not rule(dict(source[0]), None) for source in self.starts)
        if conjunct.class_ is Class.SAFETY:
            edges = self.graph.edges
            return any(not rule(dict(source[0]), dict(target[0])) for source, target in edges)
        violating = self.graph.subgraph([n for n in self.graph if not rule(dict(n[0]), None)])
        return any(
            self.is_fair(violating, part) for part in nx.strongly_connected_components(violating)
        )

    def is_fair(self, graph, part):
        has_step = any(successor in part for node in part for successor in graph.successors(node))
        recurring = list_evaluations(self.contract.assumptions, Class.LIVENESS)
        return has_step and all(any(rule(dict(n[0]), None) for n in part) for rule in recurring)
