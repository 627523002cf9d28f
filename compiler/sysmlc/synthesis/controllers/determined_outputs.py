"""Determined outputs: outputs that follow from the previous step, the inputs and other outputs.

Most outputs of a modelled machine are determined: a position by the command before it, a flag by
the position. They become functions once, whatever the goal is, so few bits remain to be chosen.
"""

from collections.abc import Iterable, Mapping

from msgspec import Struct

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.skolem_functions import substitute
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.games.arena import Arena, Turn, domain_constraint

MAX_RELATION_NODES = 5_000
"""Nodes of a variable's constraints above which the search is abandoned."""


class OpenAnswers(Struct, frozen=True):
    """The last turn of a step, reduced to the bits that leave a choice."""

    bits: tuple[str, ...]
    """The open bits, primed."""
    parts: tuple[Node, ...]
    """The constraints of the open bits."""
    functions: tuple[Mapping[str, Node], ...]
    """The determined bits of the turn, primed, by variable; each may depend on later entries."""

    def substitute_functions(self, symbols: Symbols, node: Node) -> Node:
        """Replace the determined bits in a condition on the next step."""
        for bits in self.functions:
            node = substitute(symbols.manager, node, bits)
        return node

    def complete(self, symbols: Symbols, choices: Mapping[str, Node]) -> dict[str, Node]:
        """Return all bits of the turn, given functions of the open ones."""
        completed = dict(choices)
        for bits in reversed(self.functions):
            completed |= {
                bit: substitute(symbols.manager, node, completed) for bit, node in bits.items()
            }
        return completed


def find_open_answers(arena: Arena) -> OpenAnswers:
    """Return the system's answers of an arena with all determined bits eliminated."""
    turn = arena.turns[-1]
    names = [
        variable.name
        for variable in arena.symbols.variables.values()
        if variable.owner is Owner.SYSTEM
        and arena.symbols.bits(variable.name, primed=True)[0] in turn.bits
    ]
    return _Elimination(arena, turn, names).run()


class _Elimination:
    def __init__(self, arena: Arena, turn: Turn, names: list[str]) -> None:
        self._arena, self._names = arena, names
        self._manager, self._symbols = arena.manager, arena.symbols
        self._bits, self._parts = turn.bits, list(turn.parts)
        self._functions: list[Mapping[str, Node]] = []

    def run(self) -> OpenAnswers:
        """Eliminate one variable after the other, those with the fewest constraints first."""
        for without_other_bits in (True, False):
            while any(self._eliminate(name, without_other_bits) for name in self._names):
                pass
        return OpenAnswers(self._bits, tuple(self._parts), tuple(self._functions))

    def _eliminate(self, name: str, without_other_bits: bool) -> bool:
        own_bits = frozenset(self._symbols.bits(name, primed=True))
        other_bits = frozenset(self._bits) - own_bits
        constraints = [
            part
            for part in self._parts
            if not own_bits.isdisjoint(support := self._manager.support(part))
            and not (without_other_bits and not other_bits.isdisjoint(support))
        ]
        function = self._find_functions(constraints, own_bits)
        if function is None:
            return False
        self._functions.append(function)
        self._names = [other_name for other_name in self._names if other_name != name]
        self._bits = tuple(bit for bit in self._bits if bit not in own_bits)
        self._parts = [substitute(self._manager, part, function) for part in self._parts]
        self._parts = [part for part in self._parts if part != self._manager.true]
        return True

    def _find_functions(
        self, constraints: Iterable[Node], own_bits: frozenset[str]
    ) -> dict[str, Node] | None:
        """Return each bit as a function of the others if at most one value is left."""
        manager = self._manager
        relation = manager.true
        for part in constraints:
            relation = relation & part
            if len(relation) > MAX_RELATION_NODES:
                return None
        relation = relation & domain_constraint(self._symbols, self._symbols.names(relation))
        functions: dict[str, Node] = {}
        for bit in sorted(own_bits):
            can_be_true = manager.and_exist(relation, manager.var(bit), own_bits)
            if (
                can_be_true & manager.and_exist(relation, ~manager.var(bit), own_bits)
                != manager.false
            ):
                return None
            functions[bit] = can_be_true
        return functions
