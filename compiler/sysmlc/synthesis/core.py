"""Why a contract cannot be kept: guarantees that together cannot, while all but any one can.

The search is Junker's QuickXplain (2004): halves are tried before single conjuncts, so that a
small core of many conjuncts takes few games. Assumptions stay.
"""

from collections.abc import Sequence

from sysmlc.logic.contract import Conjunct
from sysmlc.synthesis.derived import without_derived
from sysmlc.synthesis.game import Game, Part
from sysmlc.synthesis.shift import shifted
from sysmlc.synthesis.solve import solve_arena
from sysmlc.values import replace

MOST_GAMES = 200
"""Games that are decided at most; what is left of the guarantees then may still be too many."""


def unrealizable_core(game: Game, most: int = MOST_GAMES) -> tuple[Conjunct, ...]:
    """Guarantees of a lost game that cannot be kept together, in the order of the contract.

    None of them can be left out, unless ``most`` games were not enough to find that out. Empty
    when the ranges of variables alone cannot be kept. Raises LimitError.
    """
    return _Search(game, most).run()


class _Search:
    def __init__(self, game: Game, most: int) -> None:
        self._game = game
        self._left = most
        parts = (*game.init_guarantees, *game.guarantees, *game.goals)
        self._all = [one for one in parts if one.conjunct is not None]
        self._promised = frozenset(map(id, self._all))

    def run(self) -> tuple[Conjunct, ...]:
        """The core."""
        found = frozenset(map(id, self._needed((), tuple(self._all), is_new=True)))
        return tuple(one.conjunct for one in self._all if one.conjunct and id(one) in found)

    def _needed(
        self, given: Sequence[Part], among: Sequence[Part], is_new: bool
    ) -> tuple[Part, ...]:
        """What of ``among`` is needed for a lost game, when all of ``given`` is promised."""
        if is_new and self._is_lost(given):
            return ()
        if len(among) == 1 or not self._left:
            return tuple(among)
        first, second = among[: len(among) // 2], among[len(among) // 2 :]
        later = self._needed((*given, *first), second, is_new=bool(first))
        return (*self._needed((*given, *later), first, is_new=bool(later)), *later)

    def _is_lost(self, promised: Sequence[Part]) -> bool:
        if not self._left:
            return False
        self._left -= 1
        return not is_won(self._with(promised))

    def _with(self, promised: Sequence[Part]) -> Game:
        """The game with these guarantees and the ranges."""
        kept = frozenset(map(id, promised))

        def of(parts: Sequence[Part]) -> tuple[Part, ...]:
            return tuple(one for one in parts if id(one) in kept or id(one) not in self._promised)

        game = self._game
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
