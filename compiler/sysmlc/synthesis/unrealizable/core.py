"""The unrealizable core of a contract: guarantees that cannot be satisfied together, while all but
any one of them can.

Assumptions stay. The search is Junker's QuickXplain (2004): halves are tried before single items,
so that a small conflict among many items takes few checks.
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
"""Checks at most; the result may not be minimal after them."""


def minimal_conflict(
    items: Sequence[T], is_conflict: Callable[[Sequence[T]], bool], max_checks: int = MAX_CHECKS
) -> tuple[T, ...]:
    """Return a conflicting subset of the conflicting *items*, in their order.

    No item of the result can be omitted, unless *most* checks were not enough to find that out.
    """
    return _QuickXplain(items, is_conflict, max_checks).run()


class _QuickXplain(Generic[T]):
    def __init__(
        self, items: Sequence[T], is_conflict: Callable[[Sequence[T]], bool], max_checks: int
    ) -> None:
        self._items = items
        self._is_conflict = is_conflict
        self._checks_left = max_checks

    def run(self) -> tuple[T, ...]:
        """Return the conflict."""
        conflict = set(self._reduce((), range(len(self._items)), is_new=True))
        return tuple(item for index, item in enumerate(self._items) if index in conflict)

    def _reduce(
        self, background: Sequence[int], candidates: Sequence[int], is_new: bool
    ) -> tuple[int, ...]:
        """Return the candidates that are needed for a conflict together with the background."""
        if is_new and self._check(background):
            return ()
        if len(candidates) == 1 or not self._checks_left:
            return tuple(candidates)
        first, second = candidates[: len(candidates) // 2], candidates[len(candidates) // 2 :]
        second_needed = self._reduce((*background, *first), second, is_new=bool(first))
        return (
            *self._reduce((*background, *second_needed), first, is_new=bool(second_needed)),
            *second_needed,
        )

    def _check(self, indices: Sequence[int]) -> bool:
        if not self._checks_left:
            return False
        self._checks_left -= 1
        return self._is_conflict([self._items[index] for index in indices])


def unrealizable_core(game: Game, max_checks: int = MAX_CHECKS) -> tuple[Conjunct, ...]:
    """Return guarantees of a lost game that cannot be satisfied together, in the order of the
    contract.

    No guarantee can be omitted, unless *most* games were not enough to find that out. The result is
    empty if the ranges of variables alone are unrealizable. Raises LimitError.
    """
    parts = (*game.init_guarantees, *game.guarantees, *game.goals)
    guarantees = [part for part in parts if part.conjunct is not None]
    core = minimal_conflict(
        guarantees,
        lambda subset: not is_won(_keep_guarantees(game, guarantees, subset)),
        max_checks,
    )
    return tuple(part.conjunct for part in core if part.conjunct is not None)


def _keep_guarantees(
    game: Game, guarantees: Sequence[Constraint], kept_guarantees: Sequence[Constraint]
) -> Game:
    """Return the game with some of the guarantees, and with the ranges."""
    removed = {id(part) for part in guarantees} - {id(part) for part in kept_guarantees}

    def filter_parts(parts: Sequence[Constraint]) -> tuple[Constraint, ...]:
        return tuple(part for part in parts if id(part) not in removed)

    return replace(
        game,
        init_guarantees=filter_parts(game.init_guarantees),
        guarantees=filter_parts(game.guarantees),
        goals=filter_parts(game.goals),
    )


def is_won(game: Game) -> bool:
    """Return whether the system wins a game. Raises LimitError."""
    with game.manager.guard():
        arena = eliminate_commands(eliminate_determined_variables(game))
    return solve_arena(arena, is_complete=False).is_realizable
