"""The states of a strategy as they are reached, with diagrams for the conditions of their moves.

Of what is remembered, numbers that count stay in registers (``memory``); a state is a mode and
what the rest of the memory makes of the functions: values that leave the same functions are one
state from the start. Inputs are not listed; they are split where outputs or next states differ.
"""

from collections.abc import Iterator, Mapping, Sequence

from msgspec import Struct

from sysmlc.logic import domains
from sysmlc.logic.formula import Const, Formula
from sysmlc.synthesis.bdd.limits import TooLargeError
from sysmlc.synthesis.bdd.manager import Node
from sysmlc.synthesis.controllers.strategy import Mode, Strategy
from sysmlc.synthesis.controllers.strategy_memory import Reached, gives, steps

MOST_STATES = 1_000
MOST_MOVES = 5_000

Answer = tuple[tuple[Formula, ...], int]
"""Outputs, as in ``mealy.Move``, and the next state."""


class Draft(Struct, frozen=True):
    """States with their moves; conditions are over registers and primed inputs that are possible.

    What no move's condition holds for cannot be in that state.
    """

    strategy: Strategy
    registers: tuple[str, ...]
    states: tuple[Mapping[Answer, Node], ...]


def listed(
    reached: Reached,
    registers: Sequence[str],
    most_states: int = MOST_STATES,
    most_moves: int = MOST_MOVES,
) -> Draft:
    """All states of a strategy that are reached.

    Raises TooLargeError when there are more states or moves; LimitError.
    """
    return _Listing(reached, tuple(registers), most_states, most_moves).run()


Functions = Mapping[str, Node]


class _State(Struct, frozen=True):
    """A mode with the functions that some of what is remembered leaves."""

    mode: Mode
    care: Node
    """Registers and primed inputs that are possible."""


class _Class(Struct, frozen=True):
    """What is remembered that leads to one state."""

    memory: Node
    """Over bits of the step before that are in no register."""
    state: int


class _Listing:
    def __init__(
        self, reached: Reached, registers: tuple[str, ...], most_states: int, most_moves: int
    ) -> None:
        self._reached, self._strategy = reached, reached.strategy
        self._manager, self._symbols = self._strategy.manager, self._strategy.symbols
        self._registers = registers
        self._most = most_states, most_moves
        self._count = 0
        self._hidden = [
            bit
            for name in self._symbols.variables
            if name not in registers
            for bit in self._symbols.bits(name)
        ]
        outputs = [name for name in self._strategy.outputs if name not in registers]
        self._listed = self._symbols.all_bits(outputs)
        """Bits of outputs that are told by their values."""
        self._states = [_State(self._strategy.first, reached.first)]
        self._classes: list[list[_Class]] = []
        self._near: dict[tuple[int, tuple[bool, ...]], list[_Class]] = {}

    def run(self) -> Draft:
        """Find all states, then the moves of each."""
        for place in range(len(self._strategy.modes)):
            self._classes.append(list(self._split_mode(place)))
        end = len(self._states)
        states = [self._moves(state, end) for state in self._states]
        if any(after == end for moves in states for _, after in moves):
            states.append({})
        return Draft(self._strategy, self._registers, tuple(states))

    def _split_mode(self, place: int) -> Iterator[_Class]:
        """The states of a mode."""
        mode, care = self._strategy.modes[place], self._reached.cares[place]
        vector = (*mode.outputs.values(), *mode.onward)
        for functions, memory in self._vectors(vector, care).items():
            possible = self._manager.and_exist(memory, care, self._hidden)
            count = len(mode.outputs)
            outputs = dict(zip(mode.outputs, functions, strict=False))
            yield _Class(memory, len(self._states))
            self._states.append(_State(Mode(outputs, functions[count:]), possible))
            self._limit("states", len(self._states), self._most[0])

    def _vectors(self, vector: tuple[Node, ...], care: Node) -> dict[tuple[Node, ...], Node]:
        """What hidden bits make of functions, with the values of the bits that do."""
        manager = self._manager
        support = frozenset[str]().union(*map(manager.support, vector))
        deciding = [bit for bit in self._hidden if bit in support]
        possible = manager.exist(manager.support(care) - frozenset(deciding), care)
        found = {vector: possible}
        for bit in deciding:
            found = self._split(found, bit)
        return found if possible != manager.false else {}

    def _split(self, found: dict[tuple[Node, ...], Node], bit: str) -> dict[tuple[Node, ...], Node]:
        """The same with the values of one more bit told apart where they matter."""
        manager = self._manager
        ends = {value: manager.cube({bit: value}) for value in (False, True)}
        known: dict[tuple[Node, bool], Node] = {}

        def left(node: Node, value: bool) -> Node:
            key = node, value
            if key not in known:
                known[key] = manager.assign(node, {bit: value})
            return known[key]

        split: dict[tuple[Node, ...], Node] = {}
        for functions, memory in found.items():
            for value, end in ends.items():
                here = memory & end
                if here != manager.false:
                    key = tuple(left(one, value) for one in functions)
                    split[key] = split.get(key, manager.false) | here
            self._limit("states", len(self._states) + len(split), self._most[0])
        return split

    def _moves(self, state: _State, end: int) -> dict[Answer, Node]:
        """The moves of a state: what is possible, split by what is answered and what is next."""
        found: dict[Answer, Node] = {}
        outputs = state.mode.outputs
        for place, where in enumerate(state.mode.onward):
            for bits, here in self._by_bits(outputs, state.care & where):
                for after, then in self._by_state(place, bits, here, end):
                    for answer, there in self._by_value(outputs, bits, then):
                        key = answer, after
                        found[key] = found.get(key, self._manager.false) | there
                        self._count += 1
                        self._limit("moves", self._count, self._most[1])
        return found

    def _by_bits(self, outputs: Functions, where: Node) -> Iterator[tuple[tuple[bool, ...], Node]]:
        """The values of the bits of listed outputs."""
        waiting: list[tuple[tuple[bool, ...], Node]] = [((), where)]
        while waiting:
            bits, here = waiting.pop()
            if here == self._manager.false:
                continue
            if len(bits) == len(self._listed):
                yield bits, here
                continue
            on = outputs[self._listed[len(bits)]]
            waiting += [((*bits, True), here & on), ((*bits, False), here & ~on)]

    def _by_state(
        self, mode: int, bits: tuple[bool, ...], here: Node, end: int
    ) -> Iterator[tuple[int, Node]]:
        """The states that come next, for outputs of these values."""
        for one in self._following(mode, bits):
            there = here & one.memory
            if there != self._manager.false:
                yield one.state, there
                here = here & ~one.memory
        if here != self._manager.false:
            yield end, here

    def _following(self, mode: int, bits: tuple[bool, ...]) -> list[_Class]:
        """The states of a mode that outputs of these values may lead to, by primed inputs."""
        key = mode, bits
        if key not in self._near:
            values = dict(zip(self._listed, bits, strict=True))
            found = (
                _Class(self._symbols.prime(self._manager.assign(one.memory, values)), one.state)
                for one in self._classes[mode]
            )
            self._near[key] = [one for one in found if one.memory != self._manager.false]
        return self._near[key]

    def _by_value(
        self, outputs: Functions, bits: tuple[bool, ...], here: Node
    ) -> Iterator[tuple[tuple[Formula, ...], Node]]:
        """What the outputs are: literals, and changes of registers."""
        values = self._symbols.decode(dict(zip(self._listed, bits, strict=True)))
        found: list[tuple[dict[str, Formula], Node]] = [
            ({name: Const(value) for name, value in values.items()}, here)
        ]
        for name in self._strategy.outputs:
            if name in self._registers:
                found = [
                    (known | {name: value}, there)
                    for known, where in found
                    for value, there in self._changes(outputs, name, where)
                ]
        for known, there in found:
            yield tuple(known[name] for name in self._strategy.outputs), there

    def _changes(self, outputs: Functions, name: str, here: Node) -> list[tuple[Formula, Node]]:
        """How a register goes on; in one way if that is so everywhere."""
        variable = self._symbols.variables[name]
        changes = () if outputs is self._strategy.first.outputs else steps(name)
        possible = [*changes, *map(Const, domains.values(variable.domain))]
        found: list[tuple[Formula, Node]] = []
        for value in possible:
            there = here & self._said(outputs, name, value)
            if there == here:
                return [*found, (value, here)]
            if there != self._manager.false:
                found.append((value, there))
                here = here & ~there
        return found

    def _said(self, outputs: Functions, name: str, value: Formula) -> Node:
        return gives(self._strategy, outputs, name, value)

    def _limit(self, what: str, used: int, most: int) -> None:
        self._manager.check("listing the states of a machine")
        if used > most:
            raise TooLargeError(f"{what} of the machine", f"{most:,}")
