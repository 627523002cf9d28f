"""Players: activities and state machines that can be simulated, behind one interface."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Protocol

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.logic import evaluate
from sysmlc.logic.activities import derivation as activity_contract
from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities.action_names import name_actions
from sysmlc.logic.activities.interpreter import BranchPlan
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_step import State
from sysmlc.logic.components.names import Atom
from sysmlc.logic.contract import (
    BooleanDomain,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.domains import contains, regions_of, values
from sysmlc.logic.expressions.linear import read_quantity
from sysmlc.logic.formula import Formula, Literal, both, var, variable_names
from sysmlc.logic.machines import interpreter as machine_interpreter
from sysmlc.logic.machines.interpreter import Valuation
from sysmlc.logic.machines.machine import Machine
from sysmlc.logic.machines.reader import read_machine
from sysmlc.simulation.components import ComponentPlayer, open_component
from sysmlc.support.units import find_scale

_LASTING_KINDS = (Kind.PROPERTY, Kind.PORT, Kind.FLOW_PROPERTY)
"""Kinds of inputs whose value lasts until it is set again; other inputs are events."""


class Player(Protocol):
    """A component that can be simulated step by step.

    A step is a valuation of all variables. Where the diagram leaves a choice, several steps are
    possible.
    """

    @property
    def component(self) -> str:
        """Qualified name of the component."""

    @property
    def variables(self) -> tuple[Variable, ...]:
        """Inputs, outputs and internal states of the component."""

    @property
    def pulses(self) -> frozenset[str]:
        """Names of the inputs that last one step, such as events."""

    def initial(self, inputs: Mapping[str, Literal]) -> list[Valuation]:
        """Return the possible first steps with these inputs."""

    def successors(
        self, now: Mapping[str, Literal], inputs: Mapping[str, Literal]
    ) -> list[Valuation]:
        """Return the steps that may follow the step *now* if the inputs are *inputs*."""


def find_players(graph: Graph) -> dict[str, Player]:
    """Return a player for every component that can be simulated, by qualified name."""
    players_by_name: dict[str, Player] = {}
    for tokens in graph.derived(TokenGraph):
        # Alone, an activity starts again after each end.
        repeated = replace(tokens, handshake=None)
        players_by_name.setdefault(tokens.component, ActivityPlayer(repeated))
    for element in graph.of_kind(Kind.STATE_MACHINE):
        # The pass that derives contracts has reported the faults of the machine.
        machine = read_machine(graph, element, Sink())
        if machine is not None:
            name = query.component_name(graph, element)
            players_by_name.setdefault(name, MachinePlayer(graph, machine, name))
    return players_by_name


def list_blocks(graph: Graph) -> list[Element]:
    """List the blocks; a requirement, which has the name of its subject, is none."""
    blocks = graph.of_kind(Kind.CLASS, Kind.COMPONENT)
    return [block for block in blocks if not query.is_requirement(block)]


def find_component_player(graph: Graph, name: str) -> Player | None:
    """Return the player of a block that does more than one behaviour alone describes, or None.

    Such a block performs activities, has several state machines, or has parts with behaviours.
    *name* is its qualified name, or its plain name if no other block has it.
    """
    blocks = list_blocks(graph)
    matches = [block for block in blocks if query.component_name(graph, block) == name]
    matches = matches or [block for block in blocks if block.name == name]
    player = open_component(graph, matches[0]) if len(matches) == 1 else None
    if player is None:
        return None
    has_parts = any(machine.owner.path for machine in player.parts.machines)
    is_composed = bool(player.parts.performances.nodes) or len(player.parts.machines) > 1
    return player if is_composed or has_parts else None


def list_atoms(graph: Graph, player: Player) -> list[Atom]:
    """List what formulas about the component may say of its steps, as far as it is played."""
    if isinstance(player, ComponentPlayer):
        atoms = player.behaviour.atoms
    else:
        named = [
            b for b in list_blocks(graph) if query.component_name(graph, b) == player.component
        ]
        opened = open_component(graph, named[0]) if named else None
        atoms = _list_own_atoms(graph, player) if opened is None else opened.behaviour.atoms
    variables = {variable.name for variable in player.variables}
    return [atom for atom in atoms if variables.issuperset(variable_names(atom.meaning))]


def _list_own_atoms(graph: Graph, player: Player) -> tuple[Atom, ...]:
    """Return what formulas may say of the steps of a state machine or activity alone."""
    names: Mapping[str, str] = {}
    if isinstance(player, ActivityPlayer):
        names = name_actions(graph, player.tokens)
    elif isinstance(player, MachinePlayer):
        names = player.machine.wordings
    variables = {wording: name for name, wording in names.items()}
    atoms: list[Atom] = []
    for variable in player.variables:
        if variable.is_auxiliary:
            continue
        name = names.get(variable.name) or variable.wording or variable.name
        meaning: Formula = var(variable.name)
        if name.startswith("finished(") and variable.owner is Owner.ENVIRONMENT:
            # The environment may end an action only while the action runs.
            runs = variables[name.replace("finished", "running", 1)]
            meaning = both(var(runs), meaning)
        atoms.append(Atom(replace(variable, name=name), meaning, variable.name))
    return tuple(atoms)


class NamedPlayer(Struct, frozen=True, dict=True):
    """Player whose steps also have the values of the names that formulas use."""

    player: Player
    atoms: Sequence[Atom]

    @property
    def component(self) -> str:
        """The qualified name of the component."""
        return self.player.component

    @cached_property
    def variables(self) -> tuple[Variable, ...]:
        """The variables of the player, and those of the names that it does not have."""
        own = {variable.name: variable for variable in self.player.variables}
        named = {atom.variable.name: atom.variable for atom in self.atoms}
        return tuple((named | own).values())

    @property
    def pulses(self) -> frozenset[str]:
        """The inputs that last one step."""
        return self.player.pulses

    def initial(self, inputs: Mapping[str, Literal]) -> list[Valuation]:
        """Return the possible first steps."""
        return list(map(self._name, self.player.initial(self._select(inputs))))

    def successors(
        self, now: Mapping[str, Literal], inputs: Mapping[str, Literal]
    ) -> list[Valuation]:
        """Return the possible steps after *now*."""
        successors = self.player.successors(self._select(now), self._select(inputs))
        return list(map(self._name, successors))

    @property
    def hidden_names(self) -> frozenset[str]:
        """The variables that diagrams omit: formulas use other names for them."""
        names = {atom.replaced: atom.variable.name for atom in self.atoms}
        replaced = {name for name, author_name in names.items() if name != author_name}
        return frozenset(
            replaced | {atom.variable.name for atom in self.atoms if atom.variable.is_auxiliary}
        )

    @cached_property
    def _own_names(self) -> frozenset[str]:
        return frozenset(variable.name for variable in self.player.variables)

    def _select(self, valuation: Mapping[str, Literal]) -> Valuation:
        """Return the values of the player's own variables."""
        return {name: value for name, value in valuation.items() if name in self._own_names}

    def _name(self, valuation: Valuation) -> Valuation:
        named = {
            atom.variable.name: evaluate.value_of(atom.meaning, valuation)
            for atom in self.atoms
            if valuation.keys() >= set(variable_names(atom.meaning))
        }
        return named | dict(valuation)


def find_resting_value(graph: Graph, variable: Variable) -> Literal:
    """Return the value that an input has until a scenario sets it.

    It is the default of the feature, else false, 0 or the first value of the domain.
    """
    regions = regions_of(variable.domain)
    if regions is not None:
        number = find_default_number(graph, variable)
        if number is None:
            zero = find_scale(regions.symbol)[1]
            number = sum((factor * zero for _, factor in variable.term), Fraction(0))
        return values(variable.domain)[regions.find(number) or 0]
    element = graph.get(variable.origin)
    default = _default_value(graph, element, variable.domain) if element is not None else None
    if default is not None:
        return default
    return 0 if contains(variable.domain, 0) else values(variable.domain)[0]


def find_default_number(graph: Graph, variable: Variable) -> Fraction | None:
    """Return the number that a real feature has by default, if any."""
    element = graph.get(variable.origin) if len(variable.term) == 1 else None
    default = None if element is None else read_quantity(graph, element, "default")
    return None if default is None else default.number


def _default_value(graph: Graph, element: Element, domain: Domain) -> Literal | None:
    text = element.attrs.get("default")
    if element.kind not in _LASTING_KINDS or text is None:
        return None
    value = _parse_value(graph, str(text), domain)
    return value if value is not None and contains(domain, value) else None


def _parse_value(graph: Graph, text: str, domain: Domain) -> Literal | None:
    match domain:
        case BooleanDomain():
            return {"true": True, "false": False}.get(text.lower())
        case IntegerDomain():
            return int(text) if text.removeprefix("-").isdecimal() else None
        case EnumerationDomain():
            literal = graph.get(text)
            return text.rpartition("::")[2] if literal is None else literal.name


class ActivityPlayer(Struct, frozen=True, dict=True):
    """Player of an activity, whose steps are those of its token game."""

    tokens: TokenGraph

    @property
    def component(self) -> str:
        return self.tokens.component

    @property
    def pulses(self) -> frozenset[str]:
        return frozenset(self.tokens.pulses)

    @property
    def variables(self) -> tuple[Variable, ...]:
        return activity_contract.list_variables(self.tokens)

    def initial(self, inputs: Mapping[str, Literal]) -> list[Valuation]:
        return [
            {
                **inputs,
                **token_game.values_of(self.tokens, token_game.initial_state(self.tokens), inputs),
            }
        ]

    def successors(
        self, now: Mapping[str, Literal], inputs: Mapping[str, Literal]
    ) -> list[Valuation]:
        state = token_game.state_of(self.tokens, now)
        states: dict[State, None] = {}
        worklist: list[list[int]] = [[]]
        while worklist:
            plan = BranchPlan(worklist.pop())
            successor = token_game.next_state(
                self.tokens, state, now, evaluate.is_true, plan.choose
            )
            states[successor] = None
            worklist += plan.list_alternatives()
        return [{**inputs, **token_game.values_of(self.tokens, after, inputs)} for after in states]


class MachinePlayer(Struct, frozen=True, dict=True):
    """Player of a state machine."""

    graph: Graph
    machine: Machine
    component: str

    @property
    def variables(self) -> tuple[Variable, ...]:
        return self.machine.variables

    @property
    def pulses(self) -> frozenset[str]:
        origins = {
            variable.name: self.graph.get(variable.origin)
            for variable in machine_interpreter.list_inputs(self.machine)
        }
        return frozenset(
            name
            for name, element in origins.items()
            if element is None or element.kind not in _LASTING_KINDS
        )

    def initial(self, inputs: Mapping[str, Literal]) -> list[Valuation]:
        return machine_interpreter.initial_steps(self.machine, inputs)

    def successors(
        self, now: Mapping[str, Literal], inputs: Mapping[str, Literal]
    ) -> list[Valuation]:
        return machine_interpreter.next_steps(self.machine, now, inputs)
