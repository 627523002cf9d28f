"""Contracts of random activities admit exactly the runs of the drawn activity."""

import random

import pytest
from drawn_token_game import compute_next_states, is_over, start
from msgspec.structs import replace
from random_activities import (
    BODIES,
    GUARDS,
    WORKERS,
    ActivityGenerator,
    AssignmentGenerator,
    RegionGenerator,
)

from long_runs import quick_first
from refinement import run_all
from sysmlc.diagnostics import Sink
from sysmlc.ir.text import parse_text
from sysmlc.logic import domains, evaluate
from sysmlc.logic import formula as f
from sysmlc.logic.activities import derivation as activity_contract
from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.contract import Class, Owner
from sysmlc.logic.formula import has_primes
from sysmlc.synthesis.algebra.fair_systems import Universe
from sysmlc.synthesis.bdd.manager import Manager

ROUNDS = 10
ACTIVITIES_PER_ROUND = 36
STEPS = 25


def iter_seeds(part):
    return range(part * ACTIVITIES_PER_ROUND, (part + 1) * ACTIVITIES_PER_ROUND)


def derive_contract(drawing):
    """Return the contract, or None if the compiler reports that a second token may arrive."""
    graph, sink = parse_text(drawing.print_text()), Sink()
    run_all(graph, sink)
    games = graph.derived(TokenGraph)
    assert games or {diagnostic.rule.code for diagnostic in sink} & {"SM454", "SM455"}
    return derive_repeated(games[0]) if games else None


def derive_repeated(token_graph):
    """Return the contract of an activity that starts again, as the game of the drawing does."""
    return activity_contract.derive_contract(replace(token_graph, handshake=None))


class VariableMap:
    """Maps the variables of a contract to the flows, nodes and properties of the drawing."""

    def __init__(self, drawing, contract):
        self.drawing = drawing
        self.contract = contract
        self.outputs = {v.name: v for v in contract.variables if v.owner is Owner.SYSTEM}
        self.inputs = [v for v in contract.variables if v.owner is Owner.ENVIRONMENT]

    def read_state(self, tokens, values):
        """Return the values of the outputs in a state of the game, with these inputs."""
        inputs = self.read_inputs(values)
        return {
            name: self._read_value(output, tokens, inputs) for name, output in self.outputs.items()
        }

    def _read_value(self, variable, tokens, inputs):
        origin = variable.origin
        if origin in self.drawing.flows:
            return origin in tokens.flows
        if origin in dict(tokens.values):
            return dict(tokens.values)[origin]
        if variable.name == f"at_{origin}_to_{origin}":
            (flow,) = (id for id in self.drawing.implied if self.drawing.flows[id][0] == origin)
            return flow in tokens.flows
        if origin in self.drawing.nodes:
            assert self.drawing.nodes[origin] in WORKERS
            return origin in tokens.running
        return is_over(self.drawing, tokens, inputs)

    def read_inputs(self, values):
        """Return the ended actions and the open guards, as the game expects its inputs."""
        return {
            variable.name if variable.name[0] == "g" else variable.origin
            for variable in self.inputs
            if values[variable.name] is True
        }


class ContractSteps:
    """The first states and the steps that the guarantees of a contract admit, found with BDDs."""

    def __init__(self, variables):
        self.outputs = list(variables.outputs)
        self.manager = Manager()
        universe = Universe([variables.contract], self.manager)
        self.symbols = universe.symbols
        nodes = {class_: [] for class_ in Class}
        for conjunct in variables.contract.guarantees:
            is_step = has_primes(conjunct.formula)
            nodes[conjunct.class_].append((is_step, universe.node(conjunct)))
        invariants = [node for is_step, node in nodes[Class.SAFETY] if not is_step]
        self.initial = [*invariants, *(node for _, node in nodes[Class.INIT])]
        # An invariant holds in the state after the step, too.
        self.transitions = [node for is_step, node in nodes[Class.SAFETY] if is_step]
        self.transitions += map(self.symbols.prime, invariants)

    def list_first_states(self, inputs):
        bits = self._encode(inputs, primed=False)
        return self._list_solutions(self._conjoin(self.initial, bits), primed=False)

    def _encode(self, values, primed):
        return {
            bit: bit_value
            for name, value in values.items()
            for bit, bit_value in self.symbols.code(name, value, primed).items()
        }

    def list_next_states(self, values, next_inputs):
        bits = self._encode(values, primed=False) | self._encode(next_inputs, primed=True)
        return self._list_solutions(self._conjoin(self.transitions, bits), primed=True)

    def _conjoin(self, nodes, bits):
        conjunction = self.manager.true
        for node in nodes:
            conjunction = conjunction & self.manager.assign(node, bits)
        return conjunction

    def _list_solutions(self, node, primed):
        bits = self.symbols.all_bits(self.outputs, primed)
        assert self.manager.support(node) <= {*bits}
        solutions = []
        while (solution := self.manager.pick(node, bits)) is not None:
            solutions.append(self.symbols.decode(solution, primed))
            node = node & ~self.manager.cube(solution)
        return solutions


def compare_with_game(seed, generator=ActivityGenerator, derive=derive_contract):
    """Assert that the contract of a random activity admits what the game does.

    Return False for an activity that has no contract.
    """
    drawing = generator(seed).draw()
    contract = derive(drawing)
    if contract is None:
        return False
    variables, dice = VariableMap(drawing, contract), random.Random(seed)
    steps, tokens = ContractSteps(variables), start(drawing)
    inputs = draw_inputs(variables, tokens, dice)
    assert steps.list_first_states(inputs) == [variables.read_state(tokens, inputs)]
    for _ in range(STEPS):
        values = {**variables.read_state(tokens, inputs), **inputs}
        successors = compute_next_states(drawing, tokens, variables.read_inputs(inputs))
        inputs = draw_inputs(variables, tokens, dice)
        expected = [variables.read_state(successor, inputs) for successor in successors]
        admitted = steps.list_next_states(values, inputs)
        assert sort_states(admitted) == sort_states(expected), drawing.print_text()
        tokens = dice.choice(sorted(successors, key=str))
    return True


def draw_inputs(variables, tokens, dice):
    """Return random inputs."""
    inputs = {variable.name: dice.random() < 0.6 for variable in variables.inputs}
    # A property that no action assigns is an input; here the environment does not change it.
    return inputs | {name: value for name, value in tokens.values if name in inputs}


def sort_states(states):
    """Return each state once: the game also knows values that the contract has no variable for."""
    return sorted({tuple(sorted(state.items())) for state in states})


# -- contracts and the game ----------------------------------------------------------------------


@pytest.mark.parametrize("part", quick_first(range(ROUNDS)))
def test_contracts_of_activities_admit_exactly_the_runs_of_the_drawing(part):
    results = [compare_with_game(seed) for seed in iter_seeds(part)]
    assert results.count(True) > ACTIVITIES_PER_ROUND * 0.85


@pytest.mark.parametrize("part", quick_first(range(ROUNDS)))
def test_contracts_of_activities_with_assignments_admit_exactly_the_runs_of_the_drawing(part):
    results = [compare_with_game(seed, AssignmentGenerator) for seed in iter_seeds(part)]
    assert results.count(True) > ACTIVITIES_PER_ROUND * 0.85


@pytest.mark.parametrize("part", quick_first(range(ROUNDS)))
def test_accept_actions_wait_as_soon_as_a_token_enters_their_region(part):
    results = [compare_with_game(seed, RegionGenerator) for seed in iter_seeds(part)]
    assert results.count(True) > ACTIVITIES_PER_ROUND * 0.6


# -- contracts and the interpreter ---------------------------------------------------------------


@pytest.mark.parametrize("part", quick_first(range(4)))
def test_the_reference_interpreter_satisfies_the_contracts(part):
    for seed in iter_seeds(part):
        graph = parse_text(AssignmentGenerator(seed).draw().print_text())
        run_all(graph, Sink())
        for token_graph in graph.derived(TokenGraph):
            contract = derive_repeated(token_graph)
            run_interpreter(replace(token_graph, handshake=None), contract, random.Random(seed))


def run_interpreter(token_graph, contract, dice):
    """Assert that each step of a random run satisfies the guarantees."""
    state = token_game.initial_state(token_graph)
    inputs = [v for v in contract.variables if v.owner is Owner.ENVIRONMENT]
    for _ in range(STEPS):
        values = {v.name: dice.choice(domains.values(v.domain)) for v in inputs}
        values |= token_game.values_of(token_graph, state, values)
        state = token_game.next_state(
            token_graph, state, values, evaluate.is_true, lambda _, flows: dice.choice(flows)
        )
        next_values = {**values, **token_game.values_of(token_graph, state, values)}
        for conjunct in contract.guarantees:
            if conjunct.class_ is Class.SAFETY:
                assert evaluate.is_true(conjunct.formula, values, next_values), conjunct.text


# -- the comparison itself -----------------------------------------------------------------------


def test_many_random_activities_have_regions_and_some_nest_them():
    drawings = [RegionGenerator(seed).draw() for seed in range(ROUNDS * ACTIVITIES_PER_ROUND)]
    assert sum(len(drawing.regions) > 0 for drawing in drawings) > 100
    nested = [
        drawing
        for drawing in drawings
        if any(a < b for a in drawing.regions.values() for b in drawing.regions.values())
    ]
    assert len(nested) > 10


def test_random_activities_contain_every_assignment_and_every_guard():
    drawings = [AssignmentGenerator(seed).draw() for seed in range(ROUNDS * ACTIVITIES_PER_ROUND)]
    bodies = [body for drawing in drawings for body in drawing.bodies.values()]
    assert min(bodies.count(body) for body in BODIES) > 20
    guards = [guard for drawing in drawings for _, _, guard in drawing.flows.values()]
    assert min(guards.count(guard) for guard in GUARDS) > 20


def test_more_than_three_hundred_random_activities_contain_nodes_of_every_kind():
    seeds = range(ROUNDS * ACTIVITIES_PER_ROUND)
    kinds = [kind for seed in seeds for kind in ActivityGenerator(seed).draw().nodes.values()]
    assert len(seeds) * 0.85 > 300
    for kind in (*WORKERS, "value", "fork", "join", "decision", "merge", "object", "flow-final"):
        assert kinds.count(kind) > 20, kind


def drop_last_step(contract):
    """Return the contract without the last of its safety guarantees."""
    steps = [conjunct for conjunct in contract.guarantees if conjunct.class_ is Class.SAFETY]
    guarantees = tuple(c for c in contract.guarantees if c not in steps[-1:])
    return replace(contract, guarantees=guarantees)


def weaken_equivalences(contract):
    """Return the contract with an implication for each equivalence."""

    def weaken(conjunct):
        match conjunct.formula:
            case f.Apply(f.Op.IFF, (left, right)):
                return replace(conjunct, formula=f.implies(left, right))
        return conjunct

    return replace(contract, guarantees=tuple(map(weaken, contract.guarantees)))


@pytest.mark.parametrize("damage", [drop_last_step, weaken_equivalences])
def test_the_comparison_fails_for_most_damaged_contracts(damage):
    def derive_damaged(drawing):
        contract = derive_contract(drawing)
        return None if contract is None else damage(contract)

    failures = 0
    for seed in range(20):
        try:
            compare_with_game(seed, derive=derive_damaged)
        except AssertionError:
            failures += 1
    assert failures > 15
