"""Why a contract cannot be kept: guarantees that together cannot, while all but any one can.

Assumptions stay.
"""

from collections.abc import Sequence

from msgspec.structs import replace

from sysmlc.logic.contract import Conjunct
from sysmlc.synthesis.games.derived import without_derived
from sysmlc.synthesis.games.game import Game, Part
from sysmlc.synthesis.games.shift import shifted
from sysmlc.synthesis.games.solve import solve_arena
from sysmlc.synthesis.unrealizable.explain import MOST_ASKED, conflict


def unrealizable_core(game: Game, most: int = MOST_ASKED) -> tuple[Conjunct, ...]:
    """Guarantees of a lost game that cannot be kept together, in the order of the contract.

    None of them can be left out, unless ``most`` games were not enough to find that out. Empty
    when the ranges of variables alone cannot be kept. Raises LimitError.
    """
    parts = (*game.init_guarantees, *game.guarantees, *game.goals)
    promised = [one for one in parts if one.conjunct is not None]
    found = conflict(promised, lambda some: not is_won(_with(game, promised, some)), most)
    return tuple(one.conjunct for one in found if one.conjunct is not None)


def _with(game: Game, promised: Sequence[Part], chosen: Sequence[Part]) -> Game:
    """The game with some of what is promised, and the ranges."""
    left_out = {id(one) for one in promised} - {id(one) for one in chosen}

    def of(parts: Sequence[Part]) -> tuple[Part, ...]:
        return tuple(one for one in parts if id(one) not in left_out)

    return replace(
        game,
        init_guarantees=of(game.init_guarantees),
        guarantees=of(game.guarantees),
        goals=of(game.goals),
    )


def is_won(game: Game) -> bool:
    """Whether a game is won; raises LimitError."""
    with game.manager.guard():
        arena = shifted(without_derived(game))
    return solve_arena(arena, is_complete=False).is_realizable
