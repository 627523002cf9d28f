"""A strategy from the layers of a solved game: outputs as functions, goal by goal.

A controller remembers what all variables were in the step before, and the goal in turn. What it
answers is given by functions of that and of the inputs, as decision diagrams: nothing is listed.
The arena may be encoded (``derived``, ``shift``); the functions are those of the variables of the
contract: a command is chosen with the answers of its step, in which the arena already knows where
it is; variables that follow from others are computed from them.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence

from msgspec import Struct

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.skolem_functions import chosen, joined, substituted
from sysmlc.synthesis.bdd.symbols import Symbols, next_bit
from sysmlc.synthesis.controllers.determined_outputs import answers
from sysmlc.synthesis.games.arena import Steps, played, products
from sysmlc.synthesis.games.game import Game
from sysmlc.synthesis.games.relational_product import Product
from sysmlc.synthesis.games.solver import Layer, Solution

Functions = Mapping[str, Node]


class Mode(Struct, frozen=True):
    """What is done while one goal is in turn."""

    outputs: Functions
    """Each bit of the outputs: over bits of the step before, and primed ones of the inputs."""
    onward: tuple[Node, ...]
    """For each mode, over the same bits, when it is the next one."""


class Strategy(Struct, frozen=True):
    """How to keep a contract."""

    symbols: Symbols
    inputs: tuple[str, ...]
    """Names of the variables of the environment."""
    outputs: tuple[str, ...]
    first: Mode
    """The first step: nothing is remembered."""
    modes: tuple[Mode, ...]
    """Later steps; one for each goal, and maybe one for what comes after the first step."""

    @property
    def manager(self) -> Manager:
        """Owner of the diagrams."""
        return self.symbols.manager


def strategy(game: Game, solution: Solution) -> Strategy:
    """The strategy that a solution of the (encoded) game has.

    Raises ValueError for a game that is lost or not solved to its end, LimitError.
    """
    if not (solution.is_realizable and solution.is_complete):
        raise ValueError("a strategy needs a game that was won and solved to its end")
    with game.manager.guard():
        return _Maker(game, solution).strategy()


class _Maker:
    def __init__(self, game: Game, solution: Solution) -> None:
        self.game, self.solution, self.arena = game, solution, solution.arena
        self.manager, self.symbols = game.manager, game.symbols
        self.count = max(1, len(self.arena.goals))
        self.steps = Steps(self.arena)
        self.answers = answers(self.arena)
        self._owed = Product(self.manager, self.answers.parts, ())

    def strategy(self) -> Strategy:
        """All modes, and the first step."""
        symbols = self.symbols
        sides = {
            owner: tuple(one.name for one in symbols.variables.values() if one.owner is owner)
            for owner in Owner
        }
        first, modes = self._ahead() if self.arena.is_ahead else self._plain()
        inputs, outputs = sides[Owner.ENVIRONMENT], sides[Owner.SYSTEM]
        return Strategy(symbols, inputs, outputs, first, modes)

    def _plain(self) -> tuple[Mode, tuple[Mode, ...]]:
        first = self._first(self.solution.winning)
        modes = (self._mode(goal, self._answers(goal), ()) for goal in range(self.count))
        return self._mode(0, first, ()), tuple(modes)

    def _ahead(self) -> tuple[Mode, tuple[Mode, ...]]:
        """The same for commands that are chosen in the state that the answers lead to."""
        winning = self.solution.winning
        commands = [self._commands(goal) for goal in range(self.count)]
        modes = [self._mode(goal, self._answers(goal), commands) for goal in range(self.count)]
        begun = chosen(self.manager, self._answered(winning), self.answers.bits)
        modes.append(self._mode(0, self._whole(begun), commands))
        onward = (*(self.manager.false,) * self.count, self.manager.true)
        return Mode(self._completed(self._first(self.symbols.prime(winning))), onward), tuple(modes)

    def _first(self, winning: Node) -> Functions:
        """Outputs for the first inputs, so that the rest can be won."""
        _, turn, *later = self.arena.start
        outputs = [bit for bit in turn.bits if not bit.endswith("'")]
        moved = [bit for bit in turn.bits if bit.endswith("'")]
        possible = Product(self.manager, turn.parts, moved)(
            played(products(self.manager, later), winning)
        )
        found = chosen(self.manager, possible, outputs)
        return {bit: self.symbols.prime(node) for bit, node in found.items()}

    def _answers(self, goal: int) -> Functions:
        """The outputs that are chosen after the inputs."""
        return self._whole(self._chosen(goal, self._answered, self.answers.bits))

    def _chosen(self, goal: int, leading: Callable[[Node], Node], bits: Sequence[str]) -> Functions:
        wanted = self.manager.false
        for possible in aims(self.solution, self.steps, goal, leading, bits):
            wanted = wanted | possible
        return chosen(self.manager, wanted, bits)

    def _whole(self, found: Functions) -> Functions:
        """All bits of the answer, by their names without primes."""
        found = self.answers.completed(self.symbols, found)
        return {bit.removesuffix("'"): node for bit, node in found.items()}

    def _answered(self, there: Node) -> Node:
        """The answers that lead to states, as far as there is a choice."""
        return self._owed(self.answers.within(self.symbols, self.symbols.prime(there)))

    def _commands(self, goal: int) -> Functions:
        """Commands as functions of the state in which they are chosen."""
        whole, after = self.arena.command, products(self.manager, self.arena.turns[1:])
        if whole is None:
            return {}
        bits = [bit for bit in whole.bits if not bit.endswith("'")]
        choice = Product(self.manager, whole.parts, [bit for bit in whole.bits if bit not in bits])

        def leading(there: Node) -> Node:
            return choice(played(after, self.symbols.prime(there)))

        return self._chosen(goal, leading, bits)

    def _mode(self, goal: int, answers: Functions, commands: Sequence[Functions]) -> Mode:
        """A mode from the answers of a step and the commands for each goal that may be next."""
        onward = self._onward(goal, answers)
        by_case = joined(
            self.manager,
            (
                (where, {bit: self._after(node, answers) for bit, node in functions.items()})
                for where, functions in zip(onward, commands, strict=False)
            ),
        )
        more = (self.manager.false,) if commands else ()
        return Mode(self._completed({**answers, **by_case}), (*onward, *more))

    def _onward(self, goal: int, answers: Functions) -> tuple[Node, ...]:
        """When which goal is the next: the first one from this one on that does not hold."""
        if not self.arena.goals:
            return (self.manager.true,)
        found = [self.manager.false] * self.count
        left = self.manager.true
        for more in range(self.count):
            place = (goal + more) % self.count
            is_held = self._after(self.arena.goals[place], answers)
            found[place] = left & ~is_held
            left = left & is_held
        found[goal] = found[goal] | left
        return tuple(found)

    def _after(self, node: Node, answers: Functions) -> Node:
        """What is said about a step, over its inputs and what is remembered."""
        by = {next_bit(bit): function for bit, function in answers.items()}
        return substituted(self.manager, self.symbols.prime(node), by)

    def _completed(self, outputs: Functions) -> Functions:
        """With the outputs that follow from others."""
        found = dict(outputs)
        for name, bits in reversed(list(self.game.definitions.items())):
            if self.symbols.variables[name].owner is Owner.SYSTEM:
                found |= {bit: self._after(node, found) for bit, node in bits.items()}
        return found


def aims(
    solution: Solution,
    steps: Steps,
    goal: int,
    leading: Callable[[Node], Node],
    bits: Collection[str],
) -> Iterator[Node]:
    """What may be chosen on the way to a goal: each says it of other places.

    ``steps`` are those of the arena. ``leading`` gives all choices of values of ``bits`` that lead
    to given states for certain; what leads nowhere leaves the environment without a next input,
    which is best of all. A state in which this goal holds and another does not has no aim: the
    other one is in turn.
    """
    manager = solution.arena.manager
    done = waiting = before = manager.false
    nowhere = Layer(manager.false, ())
    for layer in (nowhere, *solution.layers[goal]):
        manager.check("looking for what to do")
        for here, there in _waits(solution, steps, goal, layer, before):
            where = here & ~done
            yield where & leading(there)
            waiting = waiting | here
        possible = leading(layer.states)
        able = manager.exist(manager.support(possible).intersection(bits), possible)
        where = able & ~done & ~waiting
        yield where & possible
        done, before = done | able, layer.states


def _waits(
    solution: Solution, steps: Steps, goal: int, layer: Layer, before: Node
) -> Iterator[tuple[Node, Node]]:
    """From which states of a layer the system may wait, and where."""
    if not layer.waiting:
        return
    arena = solution.arena
    met = arena.goals[goal] if arena.goals else arena.manager.true
    left = layer.states & solution.winning & ~before & ~met
    left = left & ~steps.controllable(before)
    for waiting in layer.waiting:
        here = left & waiting
        if here != arena.manager.false:
            yield here, waiting | before
        left = left & ~waiting
