"""Outputs that nothing remembers leave the state, and a plant that only obeys moves with them.

When a command is bound by nothing but the inputs of its own step, it is chosen and used up between
two states: a state is what was there before the command. What the environment must then do (a
plant: exactly one next input is left for each command) is no choice of its own either, so command
and effect are one turn of the system, in which the command is quantified away: "the command is the
chosen step". The turn of the environment, over what it does choose, comes after it. All this is
rewriting of the same predecessor; nothing is added that a system may do.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import TypeVar

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.games.arena import Arena, Turn, in_range, nodes, plain
from sysmlc.synthesis.games.game import Game
from sysmlc.synthesis.games.relational_product import Product

LARGE = 20_000
"""Nodes up to which parts are joined to quantify a command once and for all."""


def shifted(game: Game) -> Arena:
    """The arena of the game, without commands in its states if there are any."""
    commands = _commands(game)
    return _Shift.of(game, commands).arena() if commands else plain(game)


def _commands(game: Game) -> tuple[str, ...]:
    """Outputs that are bound by their own step only, and that need not recur."""
    recurring = frozenset[str]().union(
        *(game.symbols.names(node) for node in nodes((*game.goals, *game.fairness)))
    )
    return tuple(
        name
        for name in game.names(Owner.SYSTEM)
        if name not in recurring and _is_forgotten(game, name)
    )


def _is_forgotten(game: Game, name: str) -> bool:
    bits = game.symbols.bits(name, primed=True)
    return all(
        all(bit.endswith("'") for bit in support)
        for support in map(game.manager.support, nodes(game.guarantees))
        if not support.isdisjoint(bits)
    )


class _Shift(Struct, frozen=True):
    """The parts of a game, sorted into the turns that they belong to."""

    game: Game
    commands: tuple[str, ...]
    choice: tuple[Node, ...]
    """What binds the commands, in the present step."""
    plant: Mapping[str, tuple[Node, ...]]
    """Inputs that have one next value for each state and command, with what says so."""
    invariants: tuple[Node, ...]
    """What the system has to see to before the environment moves."""
    answer: tuple[Node, ...]
    """What binds the other outputs."""
    is_at_once: bool
    """Whether plant and invariants are found so for any first command too, allowed later or not."""

    @classmethod
    def of(cls, game: Game, commands: tuple[str, ...]) -> "_Shift":
        """Sort the parts."""
        manager, symbols = game.manager, game.symbols
        own = frozenset(symbols.all_bits(commands, primed=True))
        promised = nodes(game.guarantees)
        bound = _speaking(manager, promised, own)
        choice = tuple(symbols.unprime(node) for node in bound)
        rest = [node for node in promised if node not in bound]
        invariants = _invariants(game, rest, choice)
        answer = tuple(node for node in rest if node not in invariants)
        plant = _plant(game, choice)
        is_at_once = _plant(game, ()) == plant and _invariants(game, rest, ()) == invariants
        return cls(game, commands, choice, plant, tuple(invariants), answer, is_at_once)

    def arena(self) -> Arena:
        """States without commands; three turns: command and effect, environment, answer."""
        game, symbols = self.game, self.game.symbols
        names = (*game.names(Owner.ENVIRONMENT), *game.names(Owner.SYSTEM))
        effect = _flat(self.plant.values())
        moved = symbols.all_bits(self.plant, primed=True)
        commanded = symbols.all_bits(self.commands, primed=True)
        answered = _without(game.next_outputs, commanded)
        assumed = nodes(game.assumptions)
        after = (
            Turn(Owner.ENVIRONMENT, _without(game.next_inputs, moved), _without(assumed, effect)),
            Turn(Owner.SYSTEM, answered, self.answer),
        )
        chosen = symbols.all_bits(self.commands)
        parts = (*self.choice, *effect, *self.invariants)
        command = Turn(Owner.SYSTEM, (*chosen, *moved), parts)
        start = plain(game).start
        if self.is_at_once:
            first = (*start[1].parts, *effect, *self.invariants)
            start = (start[0], Turn(Owner.SYSTEM, (*game.outputs, *moved), first), *after)
        else:
            answers = (*self.answer, *self.invariants)
            all_inputs = Turn(Owner.ENVIRONMENT, game.next_inputs, assumed)
            start = (*start, all_inputs, Turn(Owner.SYSTEM, answered, answers))
        return replace(
            plain(game),
            states=in_range(symbols, _without(names, self.commands)),
            turns=(_used_up(game.manager, command, chosen, after), *after),
            start=start,
            is_ahead=True,
            command=command,
        )


def _plant(game: Game, choice: Sequence[Node]) -> dict[str, tuple[Node, ...]]:
    """Inputs whose next value follows from state and command, with what says so."""
    manager, symbols = game.manager, game.symbols
    assumed = nodes(game.assumptions)
    found: dict[str, tuple[Node, ...]] = {}
    for name in game.names(Owner.ENVIRONMENT):
        own = frozenset(symbols.bits(name, primed=True))
        parts = _speaking(manager, assumed, own)
        others = frozenset(game.next_inputs) - own
        is_alone = all(others.isdisjoint(manager.support(node)) for node in parts)
        if is_alone and _is_function(symbols, parts, own, choice):
            found[name] = tuple(parts)
    return found


def _is_function(
    symbols: Symbols, parts: Sequence[Node], own: frozenset[str], choice: Sequence[Node]
) -> bool:
    """Whether the parts leave exactly one value of the bits, for commands that are allowed."""
    manager = symbols.manager
    relation = manager.true
    for part in parts:
        relation = relation & part
        if len(relation) > LARGE:
            return False
    care = in_range(symbols, symbols.names(relation))
    stuck = care & ~manager.exist(own, relation)
    if _some_allowed(manager, stuck, choice) != manager.false:
        return False
    doubtful = manager.false
    for bit in sorted(own):
        on = manager.and_exist(relation & care, manager.var(bit), own)
        doubtful = doubtful | (on & manager.and_exist(relation & care, ~manager.var(bit), own))
    return _some_allowed(manager, doubtful, choice) == manager.false


def _some_allowed(manager: Manager, states: Node, choice: Sequence[Node]) -> Node:
    """Those of the states in which the commands may be what they are, or more."""
    for node in choice:
        if states == manager.false or len(states) > LARGE:
            break
        states = states & node
    return states


def _invariants(game: Game, promised: Iterable[Node], choice: Sequence[Node]) -> list[Node]:
    """Guarantees about the present step alone, if the environment always has a next input.

    Where it has none, they are not owed.
    """
    found = [
        node
        for node in promised
        if not any(bit.endswith("'") for bit in game.manager.support(node))
    ]
    if not found:
        return []
    going_on = Product(game.manager, nodes(game.assumptions), game.next_inputs)
    names = (*game.names(Owner.ENVIRONMENT), *game.names(Owner.SYSTEM))
    stuck = in_range(game.symbols, names) & ~going_on(game.manager.true)
    is_total = _some_allowed(game.manager, stuck, choice) == game.manager.false
    return found if is_total else []


def _used_up(manager: Manager, command: Turn, chosen: Sequence[str], after: Iterable[Turn]) -> Turn:
    """The turn without the bits that nobody looks at after it, while its parts stay small."""
    seen = frozenset[str]().union(*(manager.support(node) for turn in after for node in turn.parts))
    parts, bits = list(command.parts), list(command.bits)
    for bit in chosen:
        about = _speaking(manager, parts, frozenset([bit]))
        joined = manager.true
        for node in about:
            joined = joined & node
        if bit in seen or len(joined) > LARGE:
            continue
        parts = [node for node in parts if node not in about]
        parts.append(manager.exist([bit], joined))
        bits.remove(bit)
    return replace(command, bits=tuple(bits), parts=tuple(parts))


def _speaking(manager: Manager, parts: Iterable[Node], bits: frozenset[str]) -> list[Node]:
    return [node for node in parts if not bits.isdisjoint(manager.support(node))]


_T = TypeVar("_T")


def _without(those: Iterable[_T], gone: Iterable[_T]) -> tuple[_T, ...]:
    left = frozenset(gone)
    return tuple(one for one in those if one not in left)


def _flat(groups: Iterable[Iterable[Node]]) -> tuple[Node, ...]:
    return tuple(node for group in groups for node in group)
