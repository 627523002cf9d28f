"""Machines with fewer states: equal ones are one, then those that no allowed input tells apart.

A machine has no move for inputs that the assumptions exclude: don't-cares. Two states can be one
when every input that both have a move for gets the same output from both, and so on from where the
moves lead. Which pairs to join is chosen greedily, in the order of states; the outcome answers
every run of allowed inputs as the machine does.
"""

from collections.abc import Mapping

from sysmlc.synthesis.mealy import Machine, Move, Row
from sysmlc.values import replace

MOST_COMPARED = 20_000_000
"""Moves that are compared to use don't-cares: that takes time with the square of the states."""


def minimised(machine: Machine, most: int = MOST_COMPARED) -> Machine:
    """The machine with equal states joined, then the others until ``most`` moves are compared."""
    return _Joining(_quotient(machine, _classes(machine)), most).run()


def _classes(machine: Machine) -> list[int]:
    """The class of each state: states of one class have the same moves to the same classes."""
    found = [0] * machine.size
    count = 0
    while True:
        keys: dict[object, int] = {}
        finer = [
            keys.setdefault(
                frozenset((row, move.output, found[move.state]) for row, move in moves.items()),
                len(keys),
            )
            for moves in machine.moves
        ]
        if len(keys) == count:
            return finer
        found, count = finer, len(keys)


def _quotient(machine: Machine, classes: list[int]) -> Machine:
    """A state for each class, in the order in which they occur; the moves of all its states."""
    names: dict[int, int] = {}
    for one in classes:
        names.setdefault(one, len(names))
    moves: list[dict[Row, Move]] = [{} for _ in names]
    for state, those in enumerate(machine.moves):
        here = moves[names[classes[state]]]
        for row, move in those.items():
            here[row] = Move(move.output, names[classes[move.state]])
    return replace(machine, moves=tuple(moves))


class _Joining:
    """Classes of states that grow; a trial that fails is taken back."""

    def __init__(self, machine: Machine, most: int) -> None:
        self._machine = machine
        self._left = most
        self._heads = list(range(machine.size))
        self._moves: list[Mapping[Row, Move]] = list(machine.moves)

    def run(self) -> Machine:
        """Join each state with the first earlier one that it can be joined with."""
        kept: list[int] = []
        for state in range(self._machine.size):
            if self._left <= 0:
                break
            if self._head(state) != state or any(self._join(one, state) for one in kept):
                continue
            kept.append(state)
            kept = [one for one in kept if self._head(one) == one]
        heads = [self._head(state) for state in range(self._machine.size)]
        return _quotient(self._machine, heads)

    def _head(self, state: int) -> int:
        while self._heads[state] != state:
            state = self._heads[state]
        return state

    def _join(self, left: int, right: int) -> bool:
        """Join two states and all that must then be joined; nothing when an output differs."""
        undo: list[tuple[int, int, Mapping[Row, Move]]] = []
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
            self._moves[one] = {**self._moves[other], **self._moves[one]}
            pairs += more
        return True

    def _demanded(self, one: int, other: int) -> list[tuple[int, int]] | None:
        """The states that must be one as well; None when the two answer an input differently."""
        fewer, more = sorted((self._moves[one], self._moves[other]), key=len)
        self._left -= len(fewer)
        found: list[tuple[int, int]] = []
        for row, move in fewer.items():
            its = more.get(row)
            if its is None:
                continue
            if move.output != its.output:
                return None
            found.append((move.state, its.state))
        return found

    def _take_back(self, undo: list[tuple[int, int, Mapping[Row, Move]]]) -> None:
        for one, other, moves in reversed(undo):
            self._heads[other] = other
            self._moves[one] = moves
