"""Enumeration of the reachable states of a strategy; conditions of moves are diagrams.

Counters in the memory of the strategy become registers (``strategy_memory``). The rest of the
memory is enumerated: with its values inserted, the functions of a mode depend on registers and
inputs only. A state is a mode with such functions, so memory contents with the same functions are
one state from the start. Inputs are not enumerated; they are split only where outputs or next
states differ.
"""

from collections.abc import Iterator, Mapping, Sequence

from msgspec import Struct

from sysmlc.logic import domains
from sysmlc.logic.formula import Const, Formula
from sysmlc.synthesis.bdd.limits import TooLargeError
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.strategies.strategy import Mode, Strategy
from sysmlc.synthesis.strategies.strategy_memory import (
    ReachableStrategy,
    counter_changes,
    states_with_value,
)

MAX_STATES = 1_000
MAX_MOVES = 5_000
"""States and moves of a machine above which a controller is a table instead."""

Answer = tuple[tuple[Formula, ...], int]
"""The outputs, as in ``forms.Move``, and the next state."""


class DraftMachine(Struct, frozen=True):
    """A machine whose conditions are diagrams over registers and primed inputs.

    Values that satisfy no condition of a state cannot occur in that state.
    """

    strategy: Strategy
    registers: tuple[str, ...]
    states: tuple[Mapping[Answer, Node], ...]


def enumerate_states(
    reachable: ReachableStrategy,
    registers: Sequence[str],
    max_states: int = MAX_STATES,
    max_moves: int = MAX_MOVES,
) -> DraftMachine:
    """Enumerate all reachable states of a strategy.

    Raises TooLargeError if there are more states or moves than allowed; LimitError.
    """
    return _StateEnumeration(reachable, tuple(registers), max_states, max_moves).run()


Functions = Mapping[str, Node]


class _State(Struct, frozen=True):
    """A mode with the memory, except for registers, inserted into its functions."""

    mode: Mode
    care: Node
    """The values of registers and primed inputs that are possible in the state."""


class _MemoryClass(Struct, frozen=True):
    """The memory contents that make a mode one state."""

    memory: Node
    """The contents, over the bits of the previous step that belong to no register."""
    state: int


class _StateEnumeration:
    def __init__(
        self,
        reachable: ReachableStrategy,
        registers: tuple[str, ...],
        max_states: int,
        max_moves: int,
    ) -> None:
        self._reached, self._strategy = reachable, reachable.strategy
        self._manager, self._symbols = self._strategy.manager, self._strategy.symbols
        self._registers = registers
        self._max_states, self._max_moves = max_states, max_moves
        self._move_count = 0
        self._hidden_bits = self._symbols.all_bits(
            name for name in self._symbols.variables if name not in registers
        )
        outputs = [name for name in self._strategy.outputs if name not in registers]
        self._listed_bits = self._symbols.all_bits(outputs)
        """Bits of the outputs that are no registers; moves give their values."""
        self._states = [_State(self._strategy.first, reachable.first)]
        self._classes: list[list[_MemoryClass]] = []
        self._class_cache: dict[tuple[int, tuple[bool, ...]], list[_MemoryClass]] = {}

    def run(self) -> DraftMachine:
        """Enumerate all states, then the moves of each."""
        for mode_index in range(len(self._strategy.modes)):
            self._classes.append(list(self._split_mode(mode_index)))
        # The state after steps that no allowed input can follow, so that it needs no moves.
        end = len(self._states)
        states = [self._compute_moves(state, end) for state in self._states]
        if any(after == end for moves in states for _, after in moves):
            states.append({})
        return DraftMachine(self._strategy, self._registers, tuple(states))

    def _split_mode(self, mode_index: int) -> Iterator[_MemoryClass]:
        """Yield the memory classes of a mode, and add their states."""
        mode, care = self._strategy.modes[mode_index], self._reached.care_sets[mode_index]
        vector = (*mode.outputs.values(), *mode.successors)
        for functions, memory in self._split_functions(vector, care).items():
            possible = self._manager.and_exist(memory, care, self._hidden_bits)
            count = len(mode.outputs)
            outputs = dict(zip(mode.outputs, functions, strict=False))
            yield _MemoryClass(memory, len(self._states))
            self._states.append(_State(Mode(outputs, functions[count:]), possible))
            self._check_count("state", len(self._states), self._max_states)

    def _split_functions(
        self, vector: tuple[Node, ...], care: Node
    ) -> dict[tuple[Node, ...], Node]:
        """Return the cofactors of *vector* by the hidden bits, each with the values of these bits.

        *vector* contains the functions of a mode. Equal cofactors have one entry.
        """
        manager = self._manager
        support = frozenset[str]().union(*map(manager.support, vector))
        deciding_bits = [bit for bit in self._hidden_bits if bit in support]
        possible = manager.exist(manager.support(care) - frozenset(deciding_bits), care)
        vectors = {vector: possible}
        for bit in deciding_bits:
            vectors = self._split_by_bit(vectors, bit)
        return vectors if possible != manager.false else {}

    def _split_by_bit(
        self, vectors: dict[tuple[Node, ...], Node], bit: str
    ) -> dict[tuple[Node, ...], Node]:
        """Return the cofactors by one more bit."""
        # Many vectors have functions in common, so cofactors are memoised.
        manager = self._manager
        cubes = {value: manager.cube({bit: value}) for value in (False, True)}
        cofactors: dict[tuple[Node, bool], Node] = {}

        def cofactor(node: Node, value: bool) -> Node:
            key = node, value
            if key not in cofactors:
                cofactors[key] = manager.assign(node, {bit: value})
            return cofactors[key]

        split: dict[tuple[Node, ...], Node] = {}
        for functions, memory in vectors.items():
            for value, cube in cubes.items():
                restricted = memory & cube
                if restricted != manager.false:
                    key = tuple(cofactor(function, value) for function in functions)
                    split[key] = split.get(key, manager.false) | restricted
            self._check_count("state", len(self._states) + len(split), self._max_states)
        return split

    def _compute_moves(self, state: _State, end: int) -> dict[Answer, Node]:
        """Return the moves of a state: its possible values, split by outputs and next state."""
        moves: dict[Answer, Node] = {}
        outputs = state.mode.outputs
        for mode, condition in enumerate(state.mode.successors):
            for bits, bit_condition in self._split_by_output_bits(outputs, state.care & condition):
                for next_state, state_condition in self._split_by_next_state(
                    mode, bits, bit_condition, end
                ):
                    for answer, answer_condition in self._split_by_output_values(
                        outputs, bits, state_condition
                    ):
                        key = answer, next_state
                        moves[key] = moves.get(key, self._manager.false) | answer_condition
                        self._move_count += 1
                        self._check_count("move", self._move_count, self._max_moves)
        return moves

    def _split_by_output_bits(
        self, outputs: Functions, condition: Node
    ) -> Iterator[tuple[tuple[bool, ...], Node]]:
        """Split a condition by the values of ``_listed_bits``."""
        stack: list[tuple[tuple[bool, ...], Node]] = [((), condition)]
        while stack:
            bits, remaining = stack.pop()
            if remaining == self._manager.false:
                continue
            if len(bits) == len(self._listed_bits):
                yield bits, remaining
                continue
            output_function = outputs[self._listed_bits[len(bits)]]
            stack += [
                ((*bits, True), remaining & output_function),
                ((*bits, False), remaining & ~output_function),
            ]

    def _split_by_next_state(
        self, mode: int, bits: tuple[bool, ...], condition: Node, end: int
    ) -> Iterator[tuple[int, Node]]:
        """Split a condition by the next state, for given output bits."""
        for memory_class in self._possible_classes(mode, bits):
            overlap = condition & memory_class.memory
            if overlap != self._manager.false:
                yield memory_class.state, overlap
                condition = condition & ~memory_class.memory
        if condition != self._manager.false:
            yield end, condition

    def _possible_classes(self, mode: int, bits: tuple[bool, ...]) -> list[_MemoryClass]:
        """Return the memory classes of a mode that are possible after outputs with these *bits*.

        Their memory is expressed by the inputs of the step, primed.
        """
        key = mode, bits
        if key not in self._class_cache:
            values = dict(zip(self._listed_bits, bits, strict=True))
            restricted_classes = (
                (self._symbols.prime(self._manager.assign(item.memory, values)), item.state)
                for item in self._classes[mode]
            )
            self._class_cache[key] = [
                _MemoryClass(memory, state)
                for memory, state in restricted_classes
                if memory != self._manager.false
            ]
        return self._class_cache[key]

    def _split_by_output_values(
        self, outputs: Functions, bits: tuple[bool, ...], condition: Node
    ) -> Iterator[tuple[tuple[Formula, ...], Node]]:
        """Split a condition by outputs: values of listed outputs, and changes of registers."""
        values = self._symbols.decode(dict(zip(self._listed_bits, bits, strict=True)))
        cases: list[tuple[dict[str, Formula], Node]] = [
            ({name: Const(value) for name, value in values.items()}, condition)
        ]
        for name in self._strategy.outputs:
            if name in self._registers:
                cases = [
                    (formulas | {name: value}, restricted)
                    for formulas, case_condition in cases
                    for value, restricted in self._split_by_register_change(
                        outputs, name, case_condition
                    )
                ]
        for formulas, restricted in cases:
            yield tuple(formulas[name] for name in self._strategy.outputs), restricted

    def _split_by_register_change(
        self, outputs: Functions, name: str, remaining: Node
    ) -> list[tuple[Formula, Node]]:
        """Split a condition by the change of a register: unchanged, counted, or set to a value.

        The split ends with the first change that applies to all remaining values.
        """
        variable = self._symbols.variables[name]
        # Registers have no previous value in the first step.
        steps = () if outputs is self._strategy.first.outputs else counter_changes(name)
        candidates = [*steps, *map(Const, domains.values(variable.domain))]
        changes: list[tuple[Formula, Node]] = []
        for value in candidates:
            overlap = remaining & states_with_value(self._strategy, outputs, name, value)
            if overlap == remaining:
                return [*changes, (value, remaining)]
            if overlap != self._manager.false:
                changes.append((value, overlap))
                remaining = remaining & ~overlap
        return changes

    def _check_count(self, noun: str, number: int, limit: int) -> None:
        self._manager.check("listing the states of the machine")
        if number > limit:
            raise TooLargeError.of_number(limit, noun, "of the machine")
