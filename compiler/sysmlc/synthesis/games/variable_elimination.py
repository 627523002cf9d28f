"""Variables that are functions of others in every step leave the game.

A side that promises ``free' <-> pos'!=3`` from the first step on has no choice: the variable is
replaced by its definition wherever it stands. The definition may be spread over many conjuncts
(``pos'=0 -> !up'``, ``pos'=3 -> (up' <-> free')``); what counts is that exactly one value is left
for every value of the others. Winning states of the others are the same.
"""

from collections.abc import Collection, Iterable, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.games.arena import in_range
from sysmlc.synthesis.games.game import Game, Part

LARGE = 5_000
"""Nodes of a definition that is not worth the looking."""

_STEPS = ("init_assumptions", "init_guarantees", "assumptions", "guarantees")
_RECURRING = ("fairness", "goals")
_LISTS = (*_STEPS, *_RECURRING)


def without_derived(game: Game) -> Game:
    """The game without variables that follow from others; its parts name no conjuncts any more."""
    game = merged(game)
    is_changed = True
    while is_changed:
        is_changed = False
        for name in (*game.names(Owner.ENVIRONMENT), *game.names(Owner.SYSTEM)):
            found = _definition(game, name)
            if found is not None:
                game, is_changed = _replaced(game, name, found), True
    return game


def merged(game: Game) -> Game:
    """The game with the parts of each list joined that speak of the same bits."""
    return _with_lists(game, {name: _merged(game, getattr(game, name)) for name in _STEPS})


def _merged(game: Game, parts: Iterable[Part]) -> list[Part]:
    groups: dict[frozenset[str], list[Node]] = {}
    for part in parts:
        groups.setdefault(game.manager.support(part.node), []).append(part.node)
    return [Part(_joined(game.manager, members)) for members in groups.values()]


def _joined(manager: Manager, members: Iterable[Node]) -> Node:
    found = manager.true
    for member in members:
        found = found & member
    return found


def _joined_while_small(manager: Manager, members: Iterable[Node]) -> Node | None:
    """The conjunction, unless it grows beyond what is worth the looking on the way."""
    found = manager.true
    for member in members:
        found = found & member
        if len(found) > LARGE:
            return None
    return found


class _Definition(Struct, frozen=True):
    bits: Mapping[str, Node]
    """The value of each primed bit over primed bits of others."""
    parts: tuple[Part, ...]
    """What says so."""


def _definition(game: Game, name: str) -> _Definition | None:
    """What the variable is in every step, if one side leaves it no choice."""
    symbols, manager = game.symbols, game.manager
    own = frozenset(symbols.bits(name, primed=True))
    is_input = symbols.variables[name].owner is Owner.ENVIRONMENT
    parts = _about(game, game.assumptions if is_input else game.guarantees, own)
    parts = [part for part in parts if _is_of_next_step(game, part.node)]
    relation = _joined_while_small(manager, (part.node for part in parts))
    if not parts or relation is None:
        return None
    others = [one for one in symbols.names(relation, primed=True) if one != name]
    care = in_range(symbols, others, primed=True)
    bits = _function(manager, relation, own, care)
    if bits is None or not _holds_at_first(game, is_input, bits, others):
        return None
    return _Definition(bits, tuple(parts))


def _function(
    manager: Manager, relation: Node, own: frozenset[str], care: Node
) -> dict[str, Node] | None:
    """Each bit as a function of the other bits, if the relation leaves exactly one value."""
    if not care <= manager.exist(own, relation):
        return None
    found: dict[str, Node] = {}
    for bit in sorted(own):
        on = manager.and_exist(relation & care, manager.var(bit), own)
        off = manager.and_exist(relation & care, ~manager.var(bit), own)
        if on & off != manager.false:
            return None
        found[bit] = manager.restrict(on, care)
    return found


def _holds_at_first(
    game: Game, is_input: bool, bits: Mapping[str, Node], others: Collection[str]
) -> bool:
    """Whether the variable has to be in the first step what it is in the others."""
    manager, symbols = game.manager, game.symbols
    now = {_present(bit): symbols.unprime(node) for bit, node in bits.items()}
    parts = game.init_assumptions if is_input else game.init_guarantees
    said = _joined(manager, (part.node for part in _about(game, parts, frozenset(now))))
    given = said & in_range(symbols, others)
    return all(given <= manager.var(bit).equiv(node) for bit, node in now.items())


def _replaced(game: Game, name: str, definition: _Definition) -> Game:
    """The game without the variable."""
    after = dict(definition.bits)
    now = {_present(bit): game.symbols.unprime(node) for bit, node in after.items()}
    by = now | after
    gone = {id(part) for part in definition.parts}
    lists = {
        kind: [_composed(game, part, by) for part in getattr(game, kind) if id(part) not in gone]
        for kind in _LISTS
    }
    known = dict(game.definitions) | {name: now}
    return replace(_with_lists(game, lists), definitions=known)


def _composed(game: Game, part: Part, by: Mapping[str, Node]) -> Part:
    touched = game.manager.support(part.node).intersection(by)
    if not touched:
        return part
    return replace(part, node=game.manager.compose(part.node, {bit: by[bit] for bit in touched}))


def _with_lists(game: Game, lists: Mapping[str, Iterable[Part]]) -> Game:
    """The game with some of its lists replaced, without steps' parts that say nothing."""
    true = game.manager.true

    def of(kind: str) -> tuple[Part, ...]:
        parts: Iterable[Part] = lists.get(kind, getattr(game, kind))
        return tuple(part for part in parts if kind in _RECURRING or part.node != true)

    return replace(
        game,
        init_assumptions=of("init_assumptions"),
        init_guarantees=of("init_guarantees"),
        assumptions=of("assumptions"),
        guarantees=of("guarantees"),
        fairness=of("fairness"),
        goals=of("goals"),
    )


def _about(game: Game, parts: Iterable[Part], bits: frozenset[str]) -> list[Part]:
    return [part for part in parts if not bits.isdisjoint(game.manager.support(part.node))]


def _is_of_next_step(game: Game, node: Node) -> bool:
    return all(bit.endswith("'") for bit in game.manager.support(node))


def _present(bit: str) -> str:
    return bit.removesuffix("'")
