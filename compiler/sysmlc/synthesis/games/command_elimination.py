"""Elimination of commands: outputs that no later step reads, and inputs that follow from them.

A *command* is an output that guarantees restrict by values of its own step only. It is chosen and
used between two states, so a state need not contain it. A *plant input* has exactly one next value
for each state and command, so the environment has no choice. Commands and plant inputs become one
turn of the system, in which commands can be quantified: the system chooses the effect directly. The
turn of the environment for its other inputs follows. The controllable predecessors stay the same.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import TypeVar

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols, is_next
from sysmlc.synthesis.games.arena import Arena, Turn, build_plain_arena, domain_constraint, nodes_of
from sysmlc.synthesis.games.game import Game
from sysmlc.synthesis.games.relational_product import Product

MAX_JOINED_NODES = 20_000
"""Nodes of a conjunction up to which commands are quantified, or values counted, beforehand."""


def eliminate_commands(game: Game) -> Arena:
    """Return the arena of the game with states that do not contain commands."""
    commands = _find_commands(game)
    return (
        _TurnSplit.split_constraints(game, commands).build_arena()
        if commands
        else build_plain_arena(game)
    )


def _find_commands(game: Game) -> tuple[str, ...]:
    """Return the outputs that guarantees restrict by their own step only.

    Outputs in liveness conditions are none, because these conditions are about states.
    """
    recurring = frozenset[str]().union(
        *(game.symbols.names(node) for node in nodes_of((*game.goals, *game.fairness)))
    )
    return tuple(
        name
        for name in game.names(Owner.SYSTEM)
        if name not in recurring and _is_bound_by_own_step(game, name)
    )


def _is_bound_by_own_step(game: Game, name: str) -> bool:
    own_bits = game.symbols.bits(name, primed=True)
    return all(
        all(map(is_next, support))
        for support in map(game.manager.support, nodes_of(game.guarantees))
        if not support.isdisjoint(own_bits)
    )


class _TurnSplit(Struct, frozen=True):
    """The constraints of a game, assigned to the turns of an encoded arena."""

    game: Game
    commands: tuple[str, ...]
    choice: tuple[Node, ...]
    """The constraints of the commands, over the current step."""
    plant: Mapping[str, tuple[Node, ...]]
    """The plant inputs, each with the assumptions that determine its next value."""
    invariants: tuple[Node, ...]
    """State invariants, which the system ensures before the environment moves."""
    answer: tuple[Node, ...]
    """The constraints of the other outputs."""
    has_joint_first_turn: bool
    """Whether first outputs and their effect can be one turn too. *choice* does not restrict first
    commands, so plant inputs and invariants must be the same without it."""

    @classmethod
    def split_constraints(cls, game: Game, commands: tuple[str, ...]) -> "_TurnSplit":
        """Sort the constraints of the game into turns."""
        manager, symbols = game.manager, game.symbols
        command_bits = frozenset(symbols.all_bits(commands, primed=True))
        guarantees = nodes_of(game.guarantees)
        command_constraints = _parts_over(manager, guarantees, command_bits)
        choice = tuple(symbols.unprime(node) for node in command_constraints)
        other_guarantees = [node for node in guarantees if node not in command_constraints]
        invariants = _find_state_invariants(game, other_guarantees, choice)
        answer = tuple(node for node in other_guarantees if node not in invariants)
        plant = _find_plant_inputs(game, choice)
        has_joint_first_turn = (
            _find_plant_inputs(game, ()) == plant
            and _find_state_invariants(game, other_guarantees, ()) == invariants
        )
        return cls(game, commands, choice, plant, tuple(invariants), answer, has_joint_first_turn)

    def build_arena(self) -> Arena:
        """Return the arena with states that do not contain commands.

        A step has three turns: commands and plant inputs, the other inputs, the other outputs.
        """
        game, symbols = self.game, self.game.symbols
        names = (*game.names(Owner.ENVIRONMENT), *game.names(Owner.SYSTEM))
        effect = tuple(chain.from_iterable(self.plant.values()))
        plant_bits = symbols.all_bits(self.plant, primed=True)
        next_command_bits = symbols.all_bits(self.commands, primed=True)
        answer_bits = _without(game.next_outputs, next_command_bits)
        assumptions = nodes_of(game.assumptions)
        later_turns = (
            Turn(
                Owner.ENVIRONMENT,
                _without(game.next_inputs, plant_bits),
                _without(assumptions, effect),
            ),
            Turn(Owner.SYSTEM, answer_bits, self.answer),
        )
        command_bits = symbols.all_bits(self.commands)
        parts = (*self.choice, *effect, *self.invariants)
        command = Turn(Owner.SYSTEM, (*command_bits, *plant_bits), parts)
        start = build_plain_arena(game).start
        if self.has_joint_first_turn:
            first_parts = (*start[1].parts, *effect, *self.invariants)
            start = (
                start[0],
                Turn(Owner.SYSTEM, (*game.outputs, *plant_bits), first_parts),
                *later_turns,
            )
        else:
            answers = (*self.answer, *self.invariants)
            all_inputs = Turn(Owner.ENVIRONMENT, game.next_inputs, assumptions)
            start = (*start, all_inputs, Turn(Owner.SYSTEM, answer_bits, answers))
        return replace(
            build_plain_arena(game),
            states=domain_constraint(symbols, _without(names, self.commands)),
            turns=(
                _quantify_unread_bits(game.manager, command, command_bits, later_turns),
                *later_turns,
            ),
            start=start,
            is_ahead=True,
            command=command,
        )


def _find_plant_inputs(game: Game, choice: Sequence[Node]) -> dict[str, tuple[Node, ...]]:
    """Return the plant inputs: state and command determine their next value.

    Each is returned with the assumptions about this value.
    """
    manager, symbols = game.manager, game.symbols
    assumptions = nodes_of(game.assumptions)
    plant: dict[str, tuple[Node, ...]] = {}
    for name in game.names(Owner.ENVIRONMENT):
        own_bits = frozenset(symbols.bits(name, primed=True))
        parts = _parts_over(manager, assumptions, own_bits)
        other_bits = frozenset(game.next_inputs) - own_bits
        # An assumption about a second input would leave the environment a choice between the two.
        is_alone = all(other_bits.isdisjoint(manager.support(node)) for node in parts)
        if is_alone and _has_unique_values(symbols, parts, own_bits, choice):
            plant[name] = tuple(parts)
    return plant


def _has_unique_values(
    symbols: Symbols, parts: Sequence[Node], own_bits: frozenset[str], choice: Sequence[Node]
) -> bool:
    """Whether the parts leave exactly one value of *own_bits* for all allowed commands."""
    manager = symbols.manager
    relation = manager.conjoin_small(parts, MAX_JOINED_NODES)
    if relation is None:
        return False
    care = domain_constraint(symbols, symbols.names(relation))
    stuck = care & ~manager.exist(own_bits, relation)
    if _restrict_to_allowed(manager, stuck, choice) != manager.false:
        return False
    doubtful = manager.disjoin(
        manager.and_exist(relation & care, manager.var(bit), own_bits)
        & manager.and_exist(relation & care, ~manager.var(bit), own_bits)
        for bit in sorted(own_bits)
    )
    return _restrict_to_allowed(manager, doubtful, choice) == manager.false


def _restrict_to_allowed(manager: Manager, states: Node, choice: Sequence[Node]) -> Node:
    """Return the states in which the commands satisfy *choice*, or a superset if that is large.

    A superset only makes callers find fewer plant inputs or invariants.
    """
    for node in choice:
        if states == manager.false or len(states) > MAX_JOINED_NODES:
            break
        states = states & node
    return states


def _find_state_invariants(
    game: Game, guarantees: Iterable[Node], choice: Sequence[Node]
) -> list[Node]:
    """Return the guarantees about the current state alone, if they are state invariants.

    A game checks them in the next step, so they do not bind the system in a state in which the
    environment has no next input. Without such states they must hold in all states.
    """
    invariants = [node for node in guarantees if not any(map(is_next, game.manager.support(node)))]
    if not invariants:
        return []
    progress = Product(game.manager, nodes_of(game.assumptions), game.next_inputs)
    names = (*game.names(Owner.ENVIRONMENT), *game.names(Owner.SYSTEM))
    stuck = domain_constraint(game.symbols, names) & ~progress(game.manager.true)
    is_total = _restrict_to_allowed(game.manager, stuck, choice) == game.manager.false
    return invariants if is_total else []


def _quantify_unread_bits(
    manager: Manager, command: Turn, command_bits: Sequence[str], later_turns: Iterable[Turn]
) -> Turn:
    """Quantify the commands that no later turn reads, as long as the parts stay small."""
    read_bits = frozenset[str]().union(
        *(manager.support(node) for turn in later_turns for node in turn.parts)
    )
    parts, bits = list(command.parts), list(command.bits)
    for bit in command_bits:
        touching = _parts_over(manager, parts, frozenset([bit]))
        conjunction = manager.conjoin(touching)
        if bit in read_bits or len(conjunction) > MAX_JOINED_NODES:
            continue
        parts = [node for node in parts if node not in touching]
        parts.append(manager.exist([bit], conjunction))
        bits.remove(bit)
    return replace(command, bits=tuple(bits), parts=tuple(parts))


def _parts_over(manager: Manager, parts: Iterable[Node], bits: frozenset[str]) -> list[Node]:
    return [node for node in parts if not bits.isdisjoint(manager.support(node))]


_T = TypeVar("_T")


def _without(items: Iterable[_T], removed: Iterable[_T]) -> tuple[_T, ...]:
    removed_items = frozenset(removed)
    return tuple(item for item in items if item not in removed_items)
