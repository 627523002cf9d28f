"""Answers that leave no choice: outputs that follow from the step before, the inputs and others.

Of the outputs of a modelled machine most follow: a position from the command before it, a flag
from the position. They are functions once and for all, whatever is aimed at; what is left to be
chosen are few bits.
"""

from collections.abc import Iterable, Mapping

from msgspec import Struct

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.skolem_functions import substituted
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.games.arena import Arena, Turn, in_range

LARGE = 5_000
"""Nodes of what is said about a variable that is not worth the looking."""


class Answers(Struct, frozen=True):
    """The last turn of a step, with what there is to choose."""

    bits: tuple[str, ...]
    """Bits that are chosen, primed."""
    parts: tuple[Node, ...]
    """What binds them."""
    functions: tuple[Mapping[str, Node], ...]
    """The other bits of the turn, primed, variable by variable; each may speak of later ones."""

    def within(self, symbols: Symbols, node: Node) -> Node:
        """What is said about the next step, without the bits that follow."""
        for bits in self.functions:
            node = substituted(symbols.manager, node, bits)
        return node

    def completed(self, symbols: Symbols, chosen: Mapping[str, Node]) -> dict[str, Node]:
        """All bits of the turn, from those that were chosen."""
        found = dict(chosen)
        for bits in reversed(self.functions):
            found |= {bit: substituted(symbols.manager, node, found) for bit, node in bits.items()}
        return found


def answers(arena: Arena) -> Answers:
    """The answers of the system, when all that follows is taken out."""
    turn = arena.turns[-1]
    names = [
        one.name
        for one in arena.symbols.variables.values()
        if one.owner is Owner.SYSTEM and arena.symbols.bits(one.name, primed=True)[0] in turn.bits
    ]
    return _Search(arena, turn, names).run()


class _Search:
    def __init__(self, arena: Arena, turn: Turn, names: list[str]) -> None:
        self._arena, self._names = arena, names
        self._manager, self._symbols = arena.manager, arena.symbols
        self._bits, self._parts = turn.bits, list(turn.parts)
        self._found: list[Mapping[str, Node]] = []

    def run(self) -> Answers:
        """Take out one variable after the other; those of whom least is said first."""
        for is_alone in (True, False):
            while any(self._taken(name, is_alone) for name in self._names):
                pass
        return Answers(self._bits, tuple(self._parts), tuple(self._found))

    def _taken(self, name: str, is_alone: bool) -> bool:
        own = frozenset(self._symbols.bits(name, primed=True))
        others = frozenset(self._bits) - own
        about = [
            part
            for part in self._parts
            if not own.isdisjoint(support := self._manager.support(part))
            and not (is_alone and not others.isdisjoint(support))
        ]
        function = self._function(about, own)
        if function is None:
            return False
        self._found.append(function)
        self._names = [one for one in self._names if one != name]
        self._bits = tuple(bit for bit in self._bits if bit not in own)
        self._parts = [substituted(self._manager, part, function) for part in self._parts]
        self._parts = [part for part in self._parts if part != self._manager.true]
        return True

    def _function(self, about: Iterable[Node], own: frozenset[str]) -> dict[str, Node] | None:
        """Each bit, if there is at most one value for what the others are."""
        manager = self._manager
        relation = manager.true
        for part in about:
            relation = relation & part
            if len(relation) > LARGE:
                return None
        relation = relation & in_range(self._symbols, self._symbols.names(relation))
        found: dict[str, Node] = {}
        for bit in sorted(own):
            on = manager.and_exist(relation, manager.var(bit), own)
            if on & manager.and_exist(relation, ~manager.var(bit), own) != manager.false:
                return None
            found[bit] = on
        return found
