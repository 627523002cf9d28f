"""Fewer states: equal ones are one, then those that nothing that can happen tells apart.

Inputs that the assumptions exclude have no move: don't-cares. Two states can be one when wherever
both have a move they answer the same, and so on from where the moves lead. Which pairs to join is
chosen greedily, in the order of states; the outcome answers every run of allowed inputs as before.
"""

from collections.abc import Mapping

from msgspec.structs import replace

from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.controllers.explicit_states import Answer, Draft

MOST_COMPARED = 400_000
"""Pairs of moves that are compared to use don't-cares: their number grows with the square of the
states."""

Moves = Mapping[Answer, Node]


def minimised(draft: Draft, most: int = MOST_COMPARED) -> Draft:
    """The draft with equal states joined, then others until ``most`` moves are compared."""
    manager = draft.strategy.manager
    states = _quotient(draft.states, _classes(draft.states, manager), manager)
    joining = _Joining(states, manager, most)
    return replace(draft, states=joining.run(is_first_apart=bool(draft.registers)))


def _classes(states: tuple[Moves, ...], manager: Manager) -> list[int]:
    """The class of each state: states of one class have the same moves to the same classes."""
    found = [0] * len(states)
    count = 0
    while True:
        keys: dict[object, int] = {}
        finer = []
        for moves in states:
            joined: dict[Answer, Node] = {}
            for (output, state), node in moves.items():
                key = output, found[state]
                joined[key] = joined.get(key, manager.false) | node
            finer.append(keys.setdefault(frozenset(joined.items()), len(keys)))
        if len(keys) == count:
            return finer
        found, count = finer, len(keys)


def _quotient(states: tuple[Moves, ...], classes: list[int], manager: Manager) -> tuple[Moves, ...]:
    """A state for each class, in the order in which they occur; the moves of all its states."""
    names: dict[int, int] = {}
    for one in classes:
        names.setdefault(one, len(names))
    found: list[dict[Answer, Node]] = [{} for _ in names]
    for state, moves in enumerate(states):
        here = found[names[classes[state]]]
        for (output, after), node in moves.items():
            key = output, names[classes[after]]
            here[key] = here.get(key, manager.false) | node
    return tuple(found)


class _Joining:
    """Classes of states that grow; a trial that fails is taken back."""

    def __init__(self, states: tuple[Moves, ...], manager: Manager, most: int) -> None:
        self._states, self._manager = states, manager
        self._left = most
        self._heads = list(range(len(states)))
        self._moves: list[Moves] = list(states)

    def run(self, is_first_apart: bool) -> tuple[Moves, ...]:
        """Join each state with the first earlier one that it can be joined with.

        The state before the first step stays by itself where others read registers.
        """
        kept: list[int] = []
        for state in range(len(self._states)):
            if self._left <= 0:
                break
            self._manager.check("joining the states of a machine")
            if self._head(state) != state or any(self._join(one, state) for one in kept):
                continue
            if state or not is_first_apart:
                kept.append(state)
            kept = [one for one in kept if self._head(one) == one]
        heads = [self._head(state) for state in range(len(self._states))]
        return _quotient(self._states, heads, self._manager)

    def _head(self, state: int) -> int:
        while self._heads[state] != state:
            state = self._heads[state]
        return state

    def _join(self, left: int, right: int) -> bool:
        """Join two states and all that must then be joined; nothing when an answer differs."""
        undo: list[tuple[int, int, Moves]] = []
        pairs = [(left, right)]
        while pairs:
            one, other = sorted(map(self._head, pairs.pop()))
            if one == other:
                continue
            more = self._demanded(one, other)
            if more is None:
                self._take_back(undo)
                return False
            undo.append((one, other, self._moves[one]))
            self._heads[other] = one
            self._moves[one] = _both(self._moves[one], self._moves[other], self._manager)
            pairs += more
        return True

    def _demanded(self, one: int, other: int) -> list[tuple[int, int]] | None:
        """The states that must be one as well; None when the two answer something differently."""
        found: list[tuple[int, int]] = []
        for (output, state), node in self._moves[one].items():
            for (its_output, its_state), its in self._moves[other].items():
                self._left -= 1
                if output == its_output and state == its_state:
                    continue
                if node & its == self._manager.false:
                    continue
                if output != its_output:
                    return None
                found.append((state, its_state))
        return found

    def _take_back(self, undo: list[tuple[int, int, Moves]]) -> None:
        for one, other, moves in reversed(undo):
            self._heads[other] = other
            self._moves[one] = moves


def _both(moves: Moves, more: Moves, manager: Manager) -> Moves:
    found = dict(moves)
    for answer, node in more.items():
        found[answer] = found.get(answer, manager.false) | node
    return found
