"""Extraction of a strategy from the layers of a solved game: outputs as functions, goal by goal.

The memory of a strategy is the values of all variables in the previous step, and the current goal:
goals are pursued in turn. Outputs are functions, as decision diagrams, of memory and inputs; states
are not enumerated. In each step the system moves to the nearest layer of the goal that the inputs
allow. If no layer is nearer than the current one, it waits among states in which a fairness
assumption does not hold (Piterman, Pnueli, Sa'ar 2006, section 4).

The arena may be encoded (``variable_elimination``, ``command_elimination``), but the functions are
those of the contract's outputs. In an encoded arena commands are chosen at the beginning of a step,
in the contract with the other outputs at the end of the previous step. Eliminated variables are
computed from the others.

Most outputs of a modelled machine are determined by the previous step, the inputs and other
outputs: a position by the command before it, a flag by the position. Their functions are found once
for all goals, so few bits remain to be chosen.
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

from msgspec import Struct

from sysmlc.logic.contract import Owner
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.skolem_functions import (
    choose_functions,
    combine_cases,
    find_functions,
    substitute,
)
from sysmlc.synthesis.bdd.symbols import Symbols, current_bit, is_next, next_bit
from sysmlc.synthesis.games.arena import (
    Arena,
    PredecessorOperator,
    Turn,
    domain_constraint,
    predecessors_through,
    turn_products,
)
from sysmlc.synthesis.games.game import Game
from sysmlc.synthesis.games.relational_product import Product
from sysmlc.synthesis.games.solver import Layer, Solution

Functions = Mapping[str, Node]


class Mode(Struct, frozen=True):
    """The behaviour of a strategy while it pursues one goal."""

    outputs: Functions
    """Each output bit as a function of bits of the previous step and primed bits of the inputs."""
    successors: tuple[Node, ...]
    """For each mode, the condition over the same bits under which it is the next mode."""


class Strategy(Struct, frozen=True):
    """A winning strategy as functions of memory and inputs."""

    symbols: Symbols
    first: Mode
    """The behaviour in the first step, which has no memory."""
    modes: tuple[Mode, ...]
    """The behaviour in later steps: a mode for each goal, and possibly one for the second step."""

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of the environment's variables."""
        return self.symbols.names_of(Owner.ENVIRONMENT)

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of the system's variables."""
        return self.symbols.names_of(Owner.SYSTEM)

    @property
    def manager(self) -> Manager:
        """Owner of the diagrams."""
        return self.symbols.manager


def extract_strategy(game: Game, solution: Solution) -> Strategy:
    """Return the strategy of a solution of the (encoded) game.

    Raises ValueError if the game is lost or not completely solved; LimitError.
    """
    if not (solution.is_realizable and solution.is_complete):
        raise ValueError("a strategy needs a game that was won and solved to its end")
    with game.manager.guard():
        return _StrategyExtractor(game, solution).extract()


class _StrategyExtractor:
    def __init__(self, game: Game, solution: Solution) -> None:
        self.game, self.solution, self.arena = game, solution, solution.arena
        self.manager, self.symbols = game.manager, game.symbols
        self.goal_count = max(1, len(self.arena.goals))
        self.operator = PredecessorOperator(self.arena)
        self.open_answers = _find_open_answers(self.arena)
        self._answer_product = Product(self.manager, self.open_answers.parts, ())

    def extract(self) -> Strategy:
        """Return the strategy with its first step and all modes."""
        first, modes = self._extract_ahead() if self.arena.is_ahead else self._extract_plain()
        return Strategy(self.symbols, first, modes)

    def _extract_plain(self) -> tuple[Mode, tuple[Mode, ...]]:
        first = self._first_outputs(self.solution.winning)
        modes = (
            self._build_mode(goal, self._choose_answers(goal), ())
            for goal in range(self.goal_count)
        )
        return self._build_mode(0, first, ()), tuple(modes)

    def _extract_ahead(self) -> tuple[Mode, tuple[Mode, ...]]:
        """Extract first step and modes from an arena in which a step begins with commands.

        The additional last mode answers in the second step: the start turns of such an arena lead
        to the second state.
        """
        winning = self.solution.winning
        commands = [self._choose_commands(goal) for goal in range(self.goal_count)]
        modes = [
            self._build_mode(goal, self._choose_answers(goal), commands)
            for goal in range(self.goal_count)
        ]
        first_answer = choose_functions(
            self.manager, self._answers_into(winning), self.open_answers.bits
        )
        modes.append(self._build_mode(0, self._complete_answer(first_answer), commands))
        successors = (*(self.manager.false,) * self.goal_count, self.manager.true)
        return Mode(
            self._add_eliminated_outputs(self._first_outputs(self.symbols.prime(winning))),
            successors,
        ), tuple(modes)

    def _first_outputs(self, winning: Node) -> Functions:
        """Return first outputs, as functions of the first inputs, that let the system win."""
        _, turn, *later_turns = self.arena.start
        outputs = [bit for bit in turn.bits if not is_next(bit)]
        plant_bits = list(filter(is_next, turn.bits))
        possible = Product(self.manager, turn.parts, plant_bits)(
            predecessors_through(turn_products(self.manager, later_turns), winning)
        )
        functions = choose_functions(self.manager, possible, outputs)
        return {bit: self.symbols.prime(node) for bit, node in functions.items()}

    def _choose_answers(self, goal: int) -> Functions:
        """Return the outputs without commands, chosen in the last turn of a step."""
        return self._complete_answer(self._choose(goal, self._answers_into, self.open_answers.bits))

    def _choose(
        self, goal: int, predecessor_choices: Callable[[Node], Node], bits: Sequence[str]
    ) -> Functions:
        """Return functions for *bits* that lead towards the goal (``_choose_targets``)."""
        targets = _choose_targets(self.solution, self.operator, goal, predecessor_choices, bits)
        return choose_functions(self.manager, self.manager.disjoin(targets), bits)

    def _complete_answer(self, functions: Functions) -> Functions:
        """Add the determined bits of the answer; keys lose their primes."""
        functions = self.open_answers.complete(self.symbols, functions)
        return {current_bit(bit): node for bit, node in functions.items()}

    def _answers_into(self, target: Node) -> Node:
        """Return the answers that lead into *target*, as a relation over the open bits."""
        return self._answer_product(
            self.open_answers.substitute_functions(self.symbols, self.symbols.prime(target))
        )

    def _choose_commands(self, goal: int) -> Functions:
        """Return the commands as functions of the state in which they are chosen."""
        command, later_turns = self.arena.command, turn_products(self.manager, self.arena.turns[1:])
        if command is None:
            return {}
        bits = [bit for bit in command.bits if not is_next(bit)]
        choice = Product(self.manager, command.parts, list(filter(is_next, command.bits)))

        def choices_into(target: Node) -> Node:
            return choice(predecessors_through(later_turns, self.symbols.prime(target)))

        return self._choose(goal, choices_into, bits)

    def _build_mode(self, goal: int, answers: Functions, commands: Sequence[Functions]) -> Mode:
        """Return the mode with these answers, and with the commands for the goal that is next."""
        successors = self._next_goal_conditions(goal, answers)
        by_case = combine_cases(
            self.manager,
            (
                (
                    condition,
                    {bit: self._evaluate_after(node, answers) for bit, node in functions.items()},
                )
                for condition, functions in zip(successors, commands, strict=False)
            ),
        )
        extra_successors = (self.manager.false,) if commands else ()
        return Mode(
            self._add_eliminated_outputs({**answers, **by_case}), (*successors, *extra_successors)
        )

    def _next_goal_conditions(self, goal: int, answers: Functions) -> tuple[Node, ...]:
        """Return for each goal the condition under which it is the next goal.

        That is the first goal in cyclic order, from the current one on, that the new state does not
        satisfy. The goal stays if all goals are satisfied.
        """
        if not self.arena.goals:
            return (self.manager.true,)
        conditions = [self.manager.false] * self.goal_count
        remaining = self.manager.true
        for offset in range(self.goal_count):
            candidate = (goal + offset) % self.goal_count
            is_held = self._evaluate_after(self.arena.goals[candidate], answers)
            conditions[candidate] = remaining & ~is_held
            remaining = remaining & is_held
        conditions[goal] = conditions[goal] | remaining
        return tuple(conditions)

    def _evaluate_after(self, node: Node, answers: Functions) -> Node:
        """Return a condition on the state after the answers as a condition on memory and inputs."""
        functions = {next_bit(bit): function for bit, function in answers.items()}
        return substitute(self.manager, self.symbols.prime(node), functions)

    def _add_eliminated_outputs(self, outputs: Functions) -> Functions:
        """Add the outputs that were eliminated before solving."""
        completed = dict(outputs)
        # A definition may read variables that were eliminated after it.
        for name, bits in reversed(list(self.game.definitions.items())):
            if self.symbols.variables[name].owner is Owner.SYSTEM:
                completed |= {
                    bit: self._evaluate_after(node, completed) for bit, node in bits.items()
                }
        return completed


def _choose_targets(
    solution: Solution,
    operator: PredecessorOperator,
    goal: int,
    predecessor_choices: Callable[[Node], Node],
    bits: Collection[str],
) -> Iterator[Node]:
    """Yield relations between states and the choices that lead towards a goal, nearest layer first.

    The relations are about disjoint sets of states. *predecessor_choices* returns the states and
    choices of *bits* that certainly lead into a set of states.
    """
    manager = solution.arena.manager
    settled = waiting = previous = manager.false
    # Choices that lead into the empty set leave the environment without a next input: the system
    # wins at once. So the empty layer comes first.
    empty_layer = Layer(manager.false, ())
    for layer in (empty_layer, *solution.layers[goal]):
        manager.check("computing the strategy")
        for waiting_states, target_states in _states_that_wait(
            solution, operator, goal, layer, previous
        ):
            states = waiting_states & ~settled
            yield states & predecessor_choices(target_states)
            waiting = waiting | waiting_states
        possible = predecessor_choices(layer.states)
        deciding_states = manager.exist(manager.support(possible).intersection(bits), possible)
        states = deciding_states & ~settled & ~waiting
        yield states & possible
        settled, previous = settled | deciding_states, layer.states


def _states_that_wait(
    solution: Solution, operator: PredecessorOperator, goal: int, layer: Layer, previous: Node
) -> Iterator[tuple[Node, Node]]:
    """Yield states of a layer in which the system has to wait, with the states that it may reach.

    States from which the previous layer can be forced need no waiting. In goal states there is
    nothing to wait for: another goal is pursued there.
    """
    if not layer.waiting:
        return
    arena = solution.arena
    goal_states = arena.goals[goal] if arena.goals else arena.manager.true
    remaining = layer.states & solution.winning & ~previous & ~goal_states
    # Waiting is the second choice: states that can force the layer before have no reason to wait.
    remaining = remaining & ~operator.controllable_predecessors(previous)
    for waiting in layer.waiting:
        waiting_states = remaining & waiting
        if waiting_states != arena.manager.false:
            yield waiting_states, waiting | previous
        remaining = remaining & ~waiting


# -- determined outputs ------------------------------------------------------------------------

MAX_RELATION_NODES = 5_000
"""Nodes of the conjoined constraints of a variable above which it counts as undetermined."""


class OpenAnswers(Struct, frozen=True):
    """The last turn of a step, divided into determined bits and bits with a choice (open bits)."""

    bits: tuple[str, ...]
    """The open bits, primed."""
    parts: tuple[Node, ...]
    """The constraints of the open bits."""
    functions: tuple[Mapping[str, Node], ...]
    """The determined bits, primed, as functions; one entry for each variable. The functions of an
    entry may read bits of later entries."""

    def substitute_functions(self, symbols: Symbols, node: Node) -> Node:
        """Replace the determined bits of *node*, a condition on the next step, by functions."""
        for bits in self.functions:
            node = substitute(symbols.manager, node, bits)
        return node

    def complete(self, symbols: Symbols, choices: Mapping[str, Node]) -> dict[str, Node]:
        """Return functions for all bits of the turn, given functions for the open bits."""
        completed = dict(choices)
        for bits in reversed(self.functions):
            completed |= {
                bit: substitute(symbols.manager, node, completed) for bit, node in bits.items()
            }
        return completed


def _find_open_answers(arena: Arena) -> OpenAnswers:
    """Divide the last turn of an arena into determined bits and open bits."""
    turn = arena.turns[-1]
    names = [
        name
        for name in arena.symbols.names_of(Owner.SYSTEM)
        if arena.symbols.bits(name, primed=True)[0] in turn.bits
    ]
    return _Elimination(arena, turn, names).run()


class _Elimination:
    """Eliminates the determined variables of a turn."""

    def __init__(self, arena: Arena, turn: Turn, names: list[str]) -> None:
        self._arena, self._names = arena, names
        self._manager, self._symbols = arena.manager, arena.symbols
        self._bits, self._parts = turn.bits, list(turn.parts)
        self._functions: list[Mapping[str, Node]] = []

    def run(self) -> OpenAnswers:
        """Eliminate variables until no further one is determined.

        Constraints about a single variable are tried first, then all constraints of a variable.
        """
        # Functions of memory and inputs alone come first: substituting them enlarges no other
        # function.
        for without_other_bits in (True, False):
            while any(self._eliminate(name, without_other_bits) for name in self._names):
                pass
        return OpenAnswers(self._bits, tuple(self._parts), tuple(self._functions))

    def _eliminate(self, name: str, without_other_bits: bool) -> bool:
        own_bits = frozenset(self._symbols.bits(name, primed=True))
        other_bits = frozenset(self._bits) - own_bits
        constraints = [
            part
            for part in self._parts
            if not own_bits.isdisjoint(support := self._manager.support(part))
            and not (without_other_bits and not other_bits.isdisjoint(support))
        ]
        function = self._find_functions(constraints, own_bits)
        if function is None:
            return False
        self._functions.append(function)
        self._names = [other_name for other_name in self._names if other_name != name]
        self._bits = tuple(bit for bit in self._bits if bit not in own_bits)
        self._parts = [substitute(self._manager, part, function) for part in self._parts]
        self._parts = [part for part in self._parts if part != self._manager.true]
        return True

    def _find_functions(
        self, constraints: Iterable[Node], own_bits: frozenset[str]
    ) -> dict[str, Node] | None:
        """Return each bit as a function of other bits if the constraints leave at most one value.

        For assignments that leave no value, the function is arbitrary.
        """
        manager = self._manager
        relation = manager.conjoin_small(constraints, MAX_RELATION_NODES)
        if relation is None:
            return None
        relation = relation & domain_constraint(self._symbols, self._symbols.names(relation))
        return find_functions(manager, relation, own_bits)
