"""Controllers as Mealy machines: states, and for each input an output and the next state.

State 0 is before the first step; its moves take the first inputs. What the assumptions exclude has
no move.
"""

from collections.abc import Hashable, Iterable, Iterator, Mapping

from sysmlc.logic.contract import Owner, Variable
from sysmlc.logic.formula import Literal
from sysmlc.synthesis.manager import LimitError
from sysmlc.synthesis.strategy import Bits, Controller, State
from sysmlc.values import dataclass

Row = tuple[Literal, ...]
"""Values of variables, in their order."""
MOST_STATES = 100_000
MOST_MOVES = 200_000


@dataclass(frozen=True, slots=True)
class Move:
    """What a machine answers, and where it goes on."""

    output: Row
    state: int


@dataclass(frozen=True, slots=True)
class Machine:
    """A deterministic machine; ``moves[state][input]`` is what it does."""

    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    moves: tuple[Mapping[Row, Move], ...]

    @property
    def size(self) -> int:
        """Number of states, the one before the first step among them."""
        return len(self.moves)

    def run(self, inputs: Iterable[Row]) -> Iterator[Row]:
        """The outputs for some inputs, step by step; KeyError for one without a move."""
        state = 0
        for row in inputs:
            move = self.moves[state][row]
            yield move.output
            state = move.state


def explored(
    controller: Controller, most_states: int = MOST_STATES, most_moves: int = MOST_MOVES
) -> Machine:
    """The machine of a controller, with the states that some environment can lead it to.

    Raises LimitError when there are more states or moves, or a limit of the manager is reached.
    """
    return _Exploration(controller, most_states, most_moves).run()


class _Exploration:
    def __init__(self, controller: Controller, most_states: int, most_moves: int) -> None:
        self._controller = controller
        self._most = most_states, most_moves
        self._found: list[State] = []
        self._places: dict[State, int] = {}
        self._futures: dict[Hashable, int] = {}
        self._rows: dict[tuple[Owner, tuple[bool, ...]], Row] = {}
        self._count = 0
        variables = controller.symbols.variables.values()
        self._sides = {
            owner: tuple(one for one in variables if one.owner is owner) for owner in Owner
        }

    def run(self) -> Machine:
        """Follow all inputs, the states that were found first first."""
        controller = self._controller
        moves = [self._moves((one, controller.first(one)) for one in controller.first_inputs())]
        for state in self._found:
            given = controller.next_inputs(state)
            moves.append(self._moves((one, controller.after(state, one)) for one in given))
        sides = self._sides
        return Machine(sides[Owner.ENVIRONMENT], sides[Owner.SYSTEM], tuple(moves))

    def _moves(self, found: Iterable[tuple[Bits, State]]) -> dict[Row, Move]:
        moves: dict[Row, Move] = {}
        for given, state in found:
            if state not in self._places:
                self._places[state] = self._place(state)
            row = self._row(Owner.ENVIRONMENT, tuple(given.values()))
            count = len(self._controller.inputs)
            moves[row] = Move(self._row(Owner.SYSTEM, state.code[count:]), self._places[state])
            self._limit()
        return moves

    def _place(self, state: State) -> int:
        """The number of the state, that of an earlier one with the same future if there is one."""
        future = self._controller.future(state)
        if future not in self._futures:
            self._found.append(state)
            self._futures[future] = len(self._found)
        return self._futures[future]

    def _limit(self) -> None:
        self._count += 1
        self._controller.symbols.manager.check("listing the states of a machine")
        for what, used, most in (
            ("states", len(self._found), self._most[0]),
            ("moves", self._count, self._most[1]),
        ):
            if used > most:
                raise LimitError(f"{what} of the machine", f"{most:,}")

    def _row(self, owner: Owner, code: tuple[bool, ...]) -> Row:
        """The values of one side's variables for their bits."""
        key = owner, code
        if key not in self._rows:
            controller = self._controller
            bits = controller.inputs if owner is Owner.ENVIRONMENT else controller.outputs
            values = controller.symbols.decode(dict(zip(bits, code, strict=True)))
            self._rows[key] = tuple(values[one.name] for one in self._sides[owner])
        return self._rows[key]
