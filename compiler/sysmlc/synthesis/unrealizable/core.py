"""Why a contract cannot be kept: guarantees that together cannot, while all but any one can.

Assumptions stay.
"""

from collections.abc import Callable, Sequence
from typing import Generic, TypeVar

from msgspec.structs import replace

from sysmlc.logic.contract import Conjunct
from sysmlc.synthesis.games.command_elimination import eliminate_commands
from sysmlc.synthesis.games.game import Constraint, Game
from sysmlc.synthesis.games.solver import solve_arena
from sysmlc.synthesis.games.variable_elimination import eliminate_determined_variables

T = TypeVar("T")
MAX_CHECKS = 200
"""Questions that are asked at most; what is left then may still be too many."""


def minimal_conflict(
    items: Sequence[T], is_conflict: Callable[[Sequence[T]], bool], most: int = MAX_CHECKS
) -> tuple[T, ...]:
    """Items that conflict, of ``items`` that do, in their order.

    None of them can be left out, unless ``most`` questions were not enough to find that out.
    """
    return _QuickXplain(items, is_conflict, most).run()


class _QuickXplain(Generic[T]):
    def __init__(
        self, items: Sequence[T], is_conflict: Callable[[Sequence[T]], bool], most: int
    ) -> None:
        self._items = items
        self._is_conflict = is_conflict
        self._left = most

    def run(self) -> tuple[T, ...]:
        """The conflict."""
        found = set(self._needed((), range(len(self._items)), is_new=True))
        return tuple(one for at, one in enumerate(self._items) if at in found)

    def _needed(self, given: Sequence[int], among: Sequence[int], is_new: bool) -> tuple[int, ...]:
        """What of ``among`` is needed for a conflict, when all of ``given`` is there."""
        if is_new and self._ask(given):
            return ()
        if len(among) == 1 or not self._left:
            return tuple(among)
        first, second = among[: len(among) // 2], among[len(among) // 2 :]
        later = self._needed((*given, *first), second, is_new=bool(first))
        return (*self._needed((*given, *later), first, is_new=bool(later)), *later)

    def _ask(self, places: Sequence[int]) -> bool:
        if not self._left:
            return False
        self._left -= 1
        return self._is_conflict([self._items[at] for at in places])


def unrealizable_core(game: Game, most: int = MAX_CHECKS) -> tuple[Conjunct, ...]:
    """Guarantees of a lost game that cannot be kept together, in the order of the contract.

    None of them can be left out, unless ``most`` games were not enough to find that out. Empty
    when the ranges of variables alone cannot be kept. Raises LimitError.
    """
    parts = (*game.init_guarantees, *game.guarantees, *game.goals)
    promised = [one for one in parts if one.conjunct is not None]
    found = minimal_conflict(
        promised, lambda some: not is_won(_keep_guarantees(game, promised, some)), most
    )
    return tuple(one.conjunct for one in found if one.conjunct is not None)


def _keep_guarantees(
    game: Game, promised: Sequence[Constraint], chosen: Sequence[Constraint]
) -> Game:
    """The game with some of what is promised, and the ranges."""
    left_out = {id(one) for one in promised} - {id(one) for one in chosen}

    def of(parts: Sequence[Constraint]) -> tuple[Constraint, ...]:
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
        arena = eliminate_commands(eliminate_determined_variables(game))
    return solve_arena(arena, is_complete=False).is_realizable
