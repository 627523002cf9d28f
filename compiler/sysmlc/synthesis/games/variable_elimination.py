"""Elimination of variables that are functions of others in every step.

If the owner of ``free`` must satisfy ``free' <-> pos'!=3`` from the first step on, it has no
choice, so the definition replaces the variable everywhere. The definition may be spread over many
conjuncts (``pos'=0 -> !up'``, ``pos'=3 -> (up' <-> free')``). The condition is that the conjuncts
leave exactly one value for all values of the other variables. The winning region over these stays
the same.
"""

from collections.abc import Collection, Iterable, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.bdd.skolem_functions import find_functions
from sysmlc.synthesis.bdd.symbols import current_bit, is_next
from sysmlc.synthesis.games.arena import domain_constraint
from sysmlc.synthesis.games.game import Constraint, Game

MAX_DEFINITION_NODES = 5_000
"""Nodes above which the search for a definition is abandoned."""

_STEPS = ("init_assumptions", "init_guarantees", "assumptions", "guarantees")
_RECURRING = ("fairness", "goals")
_LISTS = (*_STEPS, *_RECURRING)


def eliminate_determined_variables(game: Game) -> Game:
    """Return the game without determined variables.

    Constraints of the result do not refer to conjuncts of the contract any more.
    """
    game = _merge_parts(game)
    is_changed = True
    while is_changed:
        is_changed = False
        for name in (*game.names(Owner.ENVIRONMENT), *game.names(Owner.SYSTEM)):
            definition = _find_definition(game, name)
            if definition is not None:
                game, is_changed = _substitute_definition(game, name, definition), True
    return game


def _merge_parts(game: Game) -> Game:
    """Conjoin the constraints of each list that have the same support."""
    lists: dict[str, list[Constraint]] = {}
    for name in _STEPS:
        groups: dict[frozenset[str], list[Node]] = {}
        for part in getattr(game, name):
            groups.setdefault(game.manager.support(part.node), []).append(part.node)
        lists[name] = [Constraint(game.manager.conjoin(nodes)) for nodes in groups.values()]
    return _replace_lists(game, lists)


class _Definition(Struct, frozen=True):
    """A variable as a function of others."""

    bits: Mapping[str, Node]
    """Each primed bit as a function of primed bits of other variables."""
    parts: tuple[Constraint, ...]
    """The constraints from which the definition follows, and which it makes true."""


def _find_definition(game: Game, name: str) -> _Definition | None:
    """Return the definition of a variable, or None if its owner has a choice in some step."""
    symbols, manager = game.symbols, game.manager
    own_bits = frozenset(symbols.bits(name, primed=True))
    is_input = symbols.variables[name].owner is Owner.ENVIRONMENT
    parts = _parts_over(game, game.assumptions if is_input else game.guarantees, own_bits)
    parts = [part for part in parts if all(map(is_next, manager.support(part.node)))]
    relation = manager.conjoin_small((part.node for part in parts), MAX_DEFINITION_NODES)
    if not parts or relation is None:
        return None
    # Codes outside of the ranges have no meaning, so the definition may be partial there.
    other_names = [name_ for name_ in symbols.names(relation, primed=True) if name_ != name]
    care = domain_constraint(symbols, other_names, primed=True)
    # A relation that leaves no value for some assignment restricts the other variables.
    if not care <= manager.exist(own_bits, relation):
        return None
    functions = find_functions(manager, relation & care, own_bits)
    if functions is None:
        return None
    bits = {bit: manager.restrict(node, care) for bit, node in functions.items()}
    return (
        _Definition(bits, tuple(parts))
        if _holds_initially(game, is_input, bits, other_names)
        else None
    )


def _holds_initially(
    game: Game, is_input: bool, bits: Mapping[str, Node], other_names: Collection[str]
) -> bool:
    """Whether the definition also holds in the first step."""
    manager, symbols = game.manager, game.symbols
    current_bits = {current_bit(bit): symbols.unprime(node) for bit, node in bits.items()}
    parts = game.init_assumptions if is_input else game.init_guarantees
    constraint = manager.conjoin(
        part.node for part in _parts_over(game, parts, frozenset(current_bits))
    )
    initial_states = constraint & domain_constraint(symbols, other_names)
    return all(initial_states <= manager.var(bit).equiv(node) for bit, node in current_bits.items())


def _substitute_definition(game: Game, name: str, definition: _Definition) -> Game:
    """Return the game with the definition in place of the variable."""
    next_bits = dict(definition.bits)
    current_bits = {current_bit(bit): game.symbols.unprime(node) for bit, node in next_bits.items()}
    substitution = current_bits | next_bits
    removed = {id(part) for part in definition.parts}
    lists = {
        kind: [
            _compose_part(game, part, substitution)
            for part in getattr(game, kind)
            if id(part) not in removed
        ]
        for kind in _LISTS
    }
    definitions = dict(game.definitions) | {name: current_bits}
    return replace(_replace_lists(game, lists), definitions=definitions)


def _compose_part(game: Game, part: Constraint, substitution: Mapping[str, Node]) -> Constraint:
    substituted_bits = game.manager.support(part.node).intersection(substitution)
    if not substituted_bits:
        return part
    return replace(
        part,
        node=game.manager.compose(part.node, {bit: substitution[bit] for bit in substituted_bits}),
    )


def _replace_lists(game: Game, lists: Mapping[str, Iterable[Constraint]]) -> Game:
    """Return the game with the fields *lists* replaced.

    Constraints that are true are dropped, except recurring ones.
    """
    true = game.manager.true

    def list_parts(kind: str) -> tuple[Constraint, ...]:
        parts: Iterable[Constraint] = lists.get(kind, getattr(game, kind))
        return tuple(part for part in parts if kind in _RECURRING or part.node != true)

    return replace(
        game,
        init_assumptions=list_parts("init_assumptions"),
        init_guarantees=list_parts("init_guarantees"),
        assumptions=list_parts("assumptions"),
        guarantees=list_parts("guarantees"),
        fairness=list_parts("fairness"),
        goals=list_parts("goals"),
    )


def _parts_over(game: Game, parts: Iterable[Constraint], bits: frozenset[str]) -> list[Constraint]:
    return [part for part in parts if not bits.isdisjoint(game.manager.support(part.node))]
