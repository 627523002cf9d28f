"""Minimisation of machines: merge equivalent states, then states that differ in don't-cares only.

Inputs that the assumptions exclude have no move, so they are don't-cares. Two states are compatible
if they give the same answer wherever both have a move, and if the states to which these moves lead
are compatible too. Pairs are chosen greedily in the order of the states. For all allowed inputs the
result gives the same answers as before.
"""

from collections.abc import Iterable, Mapping

from msgspec.structs import replace

from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.strategies.explicit_states import Answer, DraftMachine

MAX_COMPARISONS = 400_000
"""Comparisons of moves after which no further compatible states are searched; their number grows
with the square of the number of states."""

Moves = Mapping[Answer, Node]


def minimise(draft: DraftMachine, max_comparisons: int = MAX_COMPARISONS) -> DraftMachine:
    """Merge equivalent states, then compatible ones until *max_comparisons* is reached."""
    manager = draft.strategy.manager
    states = _quotient(draft.states, _equivalence_classes(draft.states, manager), manager)
    merger = _StateMerger(states, manager, max_comparisons)
    return replace(draft, states=merger.run(is_first_apart=bool(draft.registers)))


def _equivalence_classes(states: tuple[Moves, ...], manager: Manager) -> list[int]:
    """Return the equivalence class of each state, by partition refinement (Moore).

    States of one class have the same moves to the same classes.
    """
    classes = [0] * len(states)
    count = 0
    while True:
        keys: dict[object, int] = {}
        refined = []
        for moves in states:
            moves_by_class = _unite(
                (((output, classes[state]), node) for (output, state), node in moves.items()),
                manager,
            )
            refined.append(keys.setdefault(frozenset(moves_by_class.items()), len(keys)))
        # Moore's refinement only splits classes, so an equal number means equal classes.
        if len(keys) == count:
            return refined
        classes, count = refined, len(keys)


def _quotient(states: tuple[Moves, ...], classes: list[int], manager: Manager) -> tuple[Moves, ...]:
    """Return one state for each class, with the moves of all its states.

    Classes are ordered by their first states.
    """
    numbers: dict[int, int] = {}
    for class_ in classes:
        numbers.setdefault(class_, len(numbers))
    merged: list[list[tuple[Answer, Node]]] = [[] for _ in numbers]
    for state, moves in enumerate(states):
        merged[numbers[classes[state]]] += (
            ((output, numbers[classes[next_state]]), node)
            for (output, next_state), node in moves.items()
        )
    return tuple(_unite(moves, manager) for moves in merged)


class _StateMerger:
    """Merges compatible states with a union-find structure; failed attempts are undone."""

    def __init__(self, states: tuple[Moves, ...], manager: Manager, max_comparisons: int) -> None:
        self._states, self._manager = states, manager
        self._comparisons_left = max_comparisons
        self._parents = list(range(len(states)))
        self._moves: list[Moves] = list(states)

    def run(self, is_first_apart: bool) -> tuple[Moves, ...]:
        """Merge each state with the first earlier state that is compatible.

        With *is_first_apart*, state 0 stays separate: it has no registers that others may read.
        """
        representatives: list[int] = []
        for state in range(len(self._states)):
            if self._comparisons_left <= 0:
                break
            self._manager.check("merging states of the machine")
            if self._find(state) != state or any(
                self._merge(representative, state) for representative in representatives
            ):
                continue
            if state or not is_first_apart:
                representatives.append(state)
            representatives = [
                representative
                for representative in representatives
                if self._find(representative) == representative
            ]
        classes = [self._find(state) for state in range(len(self._states))]
        return _quotient(self._states, classes, self._manager)

    def _find(self, state: int) -> int:
        # No path compression, so that `_undo` can restore the parents.
        while self._parents[state] != state:
            state = self._parents[state]
        return state

    def _merge(self, left: int, right: int) -> bool:
        """Merge two states and all pairs of states that follow from it.

        Return False and change nothing if some pair gives different answers.
        """
        trail: list[tuple[int, int, Moves]] = []
        pairs = [(left, right)]
        while pairs:
            # The smaller number represents the pair, so the state before the first step stays state
            # 0.
            first, second = sorted(map(self._find, pairs.pop()))
            if first == second:
                continue
            required = self._required_merges(first, second)
            if required is None:
                self._undo(trail)
                return False
            trail.append((first, second, self._moves[first]))
            self._parents[second] = first
            both = (*self._moves[first].items(), *self._moves[second].items())
            self._moves[first] = _unite(both, self._manager)
            pairs += required
        return True

    def _required_merges(self, first: int, second: int) -> list[tuple[int, int]] | None:
        """Return the pairs of next states that must be merged too; None if answers differ."""
        required: list[tuple[int, int]] = []
        for (output, state), node in self._moves[first].items():
            for (other_output, other_state), other_node in self._moves[second].items():
                self._comparisons_left -= 1
                if output == other_output and state == other_state:
                    continue
                if node & other_node == self._manager.false:
                    continue
                if output != other_output:
                    return None
                required.append((state, other_state))
        return required

    def _undo(self, trail: list[tuple[int, int, Moves]]) -> None:
        for first, second, moves in reversed(trail):
            self._parents[second] = second
            self._moves[first] = moves


def _unite(moves: Iterable[tuple[Answer, Node]], manager: Manager) -> dict[Answer, Node]:
    """Return the moves with one condition for each answer."""
    united: dict[Answer, Node] = {}
    for answer, node in moves:
        united[answer] = united.get(answer, manager.false) | node
    return united
