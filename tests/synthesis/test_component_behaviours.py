"""The step relation of a component has exactly the runs of two interpreters.

The player of ``sysmlc simulate`` reads the model; ``component_runs`` has read only the random block
from which the model was written, and shares no code with the compiler.
"""

from itertools import product
from random import Random

import pytest
from component_runs import EVENTS, FEATURES, list_observed_steps, make_block, write_block
from msgspec.structs import replace
from signal_runs import PARTS, SIGNALS, STATES, make_line, write_line
from signal_runs import list_observed_steps as list_signal_steps

from sysmlc import compile_model
from sysmlc.logic import evaluate
from sysmlc.logic import formula as f
from sysmlc.logic.components.component import Component
from sysmlc.logic.components.derivation import describe_component
from sysmlc.logic.components.names import ComponentNames
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Owner, Variable
from sysmlc.logic.domains import values
from sysmlc.logic.machines.reader import MachineOptions
from sysmlc.simulation.components import open_component as open_player
from sysmlc.synthesis.algebra.fair_systems import Runs, Universe
from sysmlc.synthesis.decision import Options
from sysmlc.synthesis.witnesses import manager_factory

LIMIT = 250
"""States of a block; larger ones are left out."""


def open_component(path):
    graph = compile_model(path).graph
    block = next(element for element in graph if graph.qualified_name(element) == "P::B")
    return Component(graph, block, MachineOptions())


def list_atoms(component, facts):
    """Return the observed facts with their formulas in the component."""
    names = ComponentNames(component)
    atoms = {}
    for fact in facts:
        name, _, value = fact.partition("=")
        meaning = names.find(name)
        if meaning is not None and value in meaning.domain.literals:
            atoms[fact] = f.eq(meaning.formula, f.const(value))
    # The first path of an action is drawn; the others name the state or what is called.
    paths = {action.node: action.names for action in component.performances.paths[::-1]}
    for path in map(".".join, paths.values()):
        for kind in ("running", "finished"):
            atoms[f"{kind}({path})"] = names.find(f"{kind}({path})").formula
    return atoms


def list_features(variables):
    """Return the features of a random block as formulas; b1 may belong to part ``cell``."""
    declared = {variable.name for variable in variables}
    places = ((name, place) for name in FEATURES for place in (name, f"cell_{name}"))
    return {name: f.var(place) for name, place in places if place in declared}


def list_facts(block):
    facts = [f"state={state}" for state in block.states]
    return facts + [f"event={event}" for event in ("none", *EVENTS)]


def read_observed_steps(component, facts):
    """Return the pairs of observations of successive steps of the component's relation."""
    atoms = list_atoms(component, facts)
    contract = describe_component(component, "P::B").contract
    atoms |= list_features(contract.variables)
    facts = {f"seen_{index}": fact for index, fact in enumerate(atoms)}
    observers = tuple(Variable(name, Owner.SYSTEM, BooleanDomain()) for name in facts)
    definitions = [
        Conjunct(f.iff(f.var(name), atoms[fact]), Class.SAFETY, "") for name, fact in facts.items()
    ]
    manager = manager_factory(Options())()
    whole = replace(contract, variables=(*contract.variables, *observers))
    with manager.guard():
        universe = Universe((whole,), manager)
        runs = Runs(universe.system((*contract.guarantees, *definitions)))
        states = runs.fair
        pairs = set()
        for observation in list_observations(runs, states, facts):
            same = states & describe(runs, observation, facts)
            for later in list_observations(runs, runs.successors(same) & states, facts):
                pairs.add((observation, later))
        return frozenset(atoms), pairs


def list_observations(runs, states, facts):
    """Yield the sets of facts that are true in some of the states."""
    bits = runs.system.symbols.all_bits(tuple(facts))
    rest = runs.manager.exist([bit for bit in runs.bits if bit not in bits], states)
    while rest != runs.manager.false:
        assignment = runs.manager.pick(rest, bits)
        values = runs.system.symbols.decode(assignment)
        yield frozenset(fact for name, fact in facts.items() if values.get(name))
        rest = rest & ~runs.manager.cube(assignment)


def describe(runs, observation, facts):
    """Return the states with exactly the facts of an observation."""
    node = runs.manager.true
    for name, fact in facts.items():
        seen = runs.system.symbols.bdd(f.var(name))
        node = node & (seen if fact in observation else ~seen)
    return node


def observe_with(atoms):
    """Return a function from a valuation to the facts that are true in it, which caches them."""
    observations = {}

    def observe(valuation):
        key = frozenset(valuation.items())
        if key not in observations:
            observations[key] = frozenset(
                fact for fact in atoms if evaluate.is_true(atoms[fact], valuation)
            )
        return observations[key]

    return observe


def play_observed_steps(player, facts):
    """Return the pairs of observations of successive steps of the player."""
    atoms = list_atoms(player.parts, facts)
    atoms |= list_features(player.variables)
    observe = observe_with(atoms)
    inputs = [variable for variable in player.variables if variable.owner is Owner.ENVIRONMENT]
    runs = {
        variable.name: node.run
        for node in player.parts.performances.nodes
        for variable in f.variables(node.done if node.done is not None else f.TRUE)
    }
    rest = {variable.name: values(variable.domain)[0] for variable in inputs}

    def list_choices(valuation):
        """Return the valuation with all inputs; an action that does not run does not end."""
        choices = (
            [False]
            if variable.name in runs and not valuation[runs[variable.name]]
            else values(variable.domain)
            for variable in inputs
        )
        return [valuation | dict(zip(rest, row, strict=True)) for row in product(*choices)]

    worklist = player.initial(rest)
    seen = {frozenset(valuation.items()) for valuation in worklist}
    pairs = set()
    while worklist:
        for now in list_choices(worklist.pop()):
            for following in player.successors(now, rest):
                if frozenset(following.items()) not in seen:
                    seen.add(frozenset(following.items()))
                    worklist.append(following)
                pairs |= {(observe(now), observe(later)) for later in list_choices(following)}
    return frozenset(atoms), pairs


def compare(seed, tmp_path, *, has_part=False):
    """Compare both readings of a random block; return whether it is small enough.

    *has_part* states that one of its features belongs to a part, which it assigns by a path.
    """
    block = make_block(Random(seed))
    expected = list_observed_steps(block, LIMIT)
    if expected is None:
        return False
    path = tmp_path / f"block{seed}.sysml"
    path.write_text(write_block(block, has_part=has_part), "utf-8")
    component = open_component(path)
    observed, actual = read_observed_steps(component, list_facts(block))
    # Facts that the component has no name for, because it never reads them.
    visible = {(before & observed, after & observed) for before, after in expected}
    missing, surplus = visible - actual, actual - visible
    assert (missing, surplus) == (set(), set()), path.read_text("utf-8")
    player = open_player(component.graph, component.subject)
    observed, played = play_observed_steps(player, list_facts(block))
    visible = {(before & observed, after & observed) for before, after in expected}
    assert played == visible, path.read_text("utf-8")
    return True


def play_signals(player, facts):
    """Return the pairs of observations of a player that decides some of the events itself."""
    observe = observe_with(atoms := list_atoms(player.parts, facts))
    inputs = [variable for variable in player.variables if variable.owner is Owner.ENVIRONMENT]
    rows = [
        dict(zip((variable.name for variable in inputs), row, strict=True))
        for row in product(*(values(variable.domain) for variable in inputs))
    ]

    worklist = [valuation for row in rows for valuation in player.initial(row)]
    seen = {frozenset(valuation.items()) for valuation in worklist}
    pairs = set()
    while worklist:
        now = worklist.pop()
        for row in rows:
            for following in player.successors(now, row):
                pairs.add((observe(now), observe(following)))
                if frozenset(following.items()) not in seen:
                    seen.add(frozenset(following.items()))
                    worklist.append(following)
    return frozenset(atoms), pairs


def compare_signals(seed, tmp_path):
    """Compare the readings of random parts that send signals."""
    line = make_line(Random(seed))
    expected, _ = list_signal_steps(line)
    path = tmp_path / f"line{seed}.sysml"
    path.write_text(write_line(line), "utf-8")
    component = open_component(path)
    facts = [
        f"{part}.{name}"
        for part in PARTS
        for name in (*(f"state={state}" for state in STATES), "event=none", "event=Go")
    ]
    facts += [f"{part}.event={signal}" for part in PARTS for signal in SIGNALS]
    player = open_player(component.graph, component.subject)
    for observed, actual in (
        read_observed_steps(component, facts),
        play_signals(player, facts),
    ):
        visible = {(before & observed, after & observed) for before, after in expected}
        assert actual == visible, path.read_text("utf-8")


@pytest.mark.parametrize("seed", range(6))
def test_random_signals_have_the_steps_of_both_interpreters(seed, tmp_path):
    compare_signals(seed, tmp_path)


@pytest.mark.long
def test_many_random_signals_have_the_steps_of_both_interpreters(tmp_path):
    for seed in range(100, 125):
        compare_signals(seed, tmp_path)


@pytest.mark.parametrize("seed", range(6))
def test_random_blocks_have_the_steps_of_both_interpreters(seed, tmp_path):
    compare(seed, tmp_path)


@pytest.mark.parametrize("seed", range(6))
def test_random_blocks_with_a_part_have_the_steps_of_both_interpreters(seed, tmp_path):
    compare(seed, tmp_path, has_part=True)


@pytest.mark.long
@pytest.mark.parametrize("first", range(100, 160, 20))
def test_many_random_blocks_have_the_steps_of_both_interpreters(first, tmp_path):
    assert sum(compare(seed, tmp_path) for seed in range(first, first + 20)) >= 15


@pytest.mark.long
@pytest.mark.parametrize("first", range(200, 260, 20))
def test_many_blocks_with_a_part_have_the_steps_of_both_interpreters(first, tmp_path):
    seeds = range(first, first + 20)
    assert sum(compare(seed, tmp_path, has_part=True) for seed in seeds) >= 15
