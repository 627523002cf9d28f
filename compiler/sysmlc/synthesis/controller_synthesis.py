"""Synthesis of a controller that is verified against its contract.

A game may consist of independent games over disjoint variables. If the system wins each of them,
the combination of its strategies wins all of them at once. The converse does not hold: an
environment without a next input in one game loses the others, too.
"""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from enum import StrEnum
from itertools import product
from math import prod

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.controllers.machine import Machine
from sysmlc.controllers.table import Table
from sysmlc.diagnostics import Diagnostic, Sink
from sysmlc.logic.contract import Contract, Owner
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.support.counts import count
from sysmlc.support.disjoint_sets import group_related
from sysmlc.synthesis import rules
from sysmlc.synthesis.bdd.limits import LimitError, Limits, TooLargeError
from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.bdd.symbols import Symbols
from sysmlc.synthesis.decision import Options, Place, Verdict, decide_game
from sysmlc.synthesis.games.arena import Arena, nodes_of
from sysmlc.synthesis.games.command_elimination import eliminate_commands
from sysmlc.synthesis.games.game import Constraint, Game
from sysmlc.synthesis.games.solver import solve_arena
from sysmlc.synthesis.lints import describe_vacuity
from sysmlc.synthesis.strategies.closed_loop import Controller
from sysmlc.synthesis.strategies.conditions import build_machine
from sysmlc.synthesis.strategies.explicit_states import enumerate_states
from sysmlc.synthesis.strategies.minimisation import minimise
from sysmlc.synthesis.strategies.strategy import Mode, Strategy, extract_strategy
from sysmlc.synthesis.strategies.strategy_memory import choose_registers, explore_strategy
from sysmlc.synthesis.strategies.tables import build_table, rebuild_in_variable_order
from sysmlc.synthesis.strategies.verification import Fault, find_faults

MAX_MACHINE_NODES = 500_000
"""Live nodes that the search for a machine may use; a machine that needs more is unreadable."""
_MIN_CHECK_SECONDS = 0.01
"""CPU seconds for verification if the time limit is used up."""


class Form(StrEnum):
    """Representation of a controller."""

    ANY = "any"
    """A machine, or a table if there are too many states or conditions."""
    LISTED = "listed"
    """A machine without registers, or none."""
    TABLE = "table"


class Synthesis(Struct, frozen=True):
    """A verdict, and a controller that has passed verification, if there is one."""

    verdict: Verdict
    contract: Contract
    """The contract, with history bits if it needs them."""
    machine: Controller | None = None
    vacuity: str = ""
    """Why the controller need not do anything, if that is so."""
    diagnostics: tuple[Diagnostic, ...] = ()
    """The findings, in a result of the analysis ``controllers``."""

    @property
    def exit_code(self) -> int:
        """0 with a controller, 1 for an unrealizable contract, 2 if undecided or no controller."""
        return self.verdict.exit_code or 2 * (self.machine is None)

    def text(self) -> str:
        """Return the verdict on one line, followed by the size of the controller."""
        if self.machine is None:
            return self.verdict.text()
        vacuity = f"; vacuous: {self.vacuity}" if self.vacuity else ""
        return f"{self.verdict.text()}; {_describe_size(self.machine)}, checked{vacuity}"


def _describe_size(controller: Controller) -> str:
    if not isinstance(controller, Machine):
        nodes, modes = count(len(controller.nodes), "node"), count(len(controller.modes), "mode")
        return f"controller: {nodes}, {modes}"
    sizes = [count(controller.size, "state"), count(controller.count, "move")]
    if controller.registers:
        sizes.append(count(len(controller.registers), "register"))
    return f"machine: {', '.join(sizes)}"


def synthesise_controller(
    contract: Contract, place: Place, sink: Sink, options: Options, form: Form = Form.ANY
) -> Synthesis:
    """Decide a contract and build a controller for it; failures are reported."""
    decision = decide_game(contract, place, sink, options)
    if not decision.verdict.is_realizable or decision.game is None or decision.arena is None:
        return Synthesis(decision.verdict, contract)
    reduced_contract = reduce_contract(contract).contract
    try:
        controller_or_reason = build_controller(
            reduced_contract, decision.game, decision.arena, options, form
        )
    except LimitError as problem:
        controller_or_reason = str(problem)
    if not isinstance(controller_or_reason, str):
        vacuity = _find_vacuity(reduced_contract, decision.game.manager, options)
        return Synthesis(decision.verdict, reduced_contract, controller_or_reason, vacuity)
    component = contract.component
    sink.report(
        rules.NO_MACHINE, place(contract.origin), component=component, why=controller_or_reason
    )
    return Synthesis(decision.verdict, reduced_contract)


def _find_vacuity(contract: Contract, manager: Manager, options: Options) -> str:
    """Return why a realizable contract demands nothing; empty also if that takes too long."""
    with suppress(LimitError):
        return describe_vacuity(contract, lambda: _new_manager(manager, options))
    return ""


def build_controller(
    contract: Contract, game: Game, arena: Arena, options: Options, form: Form = Form.ANY
) -> Controller | str:
    """Return a verified controller, or as text the fault that verification found.

    *game* and *arena* are the encoded game of the contract (``decision.Decision``); the system must
    win it. Raises LimitError.
    """
    with game.manager.guard():
        # The decision needed a verdict only; a strategy needs the layers of a complete solution.
        winning_strategy = extract_strategy(game, solve_arena(arena))
        result = build_controller_form(contract, game, winning_strategy, form)
    if isinstance(result, Table):
        result = rebuild_in_variable_order(result, _new_manager(game.manager, options))
    fault = next(find_faults(result, contract, _new_manager(game.manager, options)), None)
    return _describe_fault(fault) if fault else result


def build_controller_form(
    contract: Contract, game: Game, winning_strategy: Strategy, form: Form = Form.ANY
) -> Controller:
    """Return an unverified controller of a strategy in the requested form. Raises LimitError."""
    # Tables are built from the strategies of independent games: the three joints of the ICE
    # laboratory's arm have 1,536 nodes in this way, as one game more than 40,000.
    if form is Form.TABLE:
        return build_table(combine_independent_strategies(game) or winning_strategy)
    try:
        with game.manager.limit_nodes(MAX_MACHINE_NODES):
            return _build_machine(contract, game, winning_strategy, form)
    except TooLargeError:
        if form is Form.LISTED:
            raise
    return build_table(combine_independent_strategies(game) or winning_strategy)


def _build_machine(
    contract: Contract, game: Game, winning_strategy: Strategy, form: Form
) -> Machine:
    reachable = explore_strategy(
        winning_strategy, nodes_of(game.init_assumptions), nodes_of(game.assumptions)
    )
    register_names = () if form is Form.LISTED else choose_registers(reachable)
    # Enumeration builds many small diagrams; reordering would take longer than their construction.
    with game.manager.without_reordering():
        return build_machine(minimise(enumerate_states(reachable, register_names)), contract)


def _new_manager(manager: Manager, options: Options) -> Manager:
    """Create another manager with the time that *manager* has left."""
    limits = options.limits
    if limits.seconds:
        seconds_left = max(_MIN_CHECK_SECONDS, limits.seconds - manager.usage().seconds)
        limits = Limits(limits.nodes, limits.memory, seconds_left)
    return Manager(options.engine, limits, options.progress)


def _describe_fault(fault: Fault) -> str:
    if fault.conjunct is None:
        return "the one that was made has no answer to inputs that are allowed"
    formula = print_formula(fault.conjunct.formula)
    return f"the one that was made does not keep '{formula}'"


# -- independent games -------------------------------------------------------------------------


def split_game(game: Game) -> tuple[Game, ...]:
    """Divide a game into independent games, which have no variable in common."""
    related_names = [_variables_of(game, node) for node in _all_nodes(game)]
    for name, bits in game.definitions.items():
        related_names += [frozenset([name, *_variables_of(game, node)]) for node in bits.values()]
    components = group_related(game.symbols.variables, related_names)
    return (
        (game,)
        if len(components) == 1
        else tuple(_restrict_game(game, component) for component in components)
    )


def _all_nodes(game: Game) -> Iterator[Node]:
    for constraints in (
        game.init_assumptions,
        game.init_guarantees,
        game.assumptions,
        game.guarantees,
        game.fairness,
        game.goals,
    ):
        yield from (constraint.node for constraint in constraints)


def _variables_of(game: Game, node: Node) -> frozenset[str]:
    return frozenset((*game.symbols.names(node), *game.symbols.names(node, primed=True)))


def _restrict_game(game: Game, names: frozenset[str]) -> Game:
    """Return the game over the variables *names*.

    Constraints without variables belong to every game.
    """

    def select_constraints(constraints: Iterable[Constraint]) -> tuple[Constraint, ...]:
        return tuple(
            constraint
            for constraint in constraints
            if _variables_of(game, constraint.node) <= names
        )

    return replace(
        game,
        symbols=game.symbols.only(names),
        init_assumptions=select_constraints(game.init_assumptions),
        init_guarantees=select_constraints(game.init_guarantees),
        assumptions=select_constraints(game.assumptions),
        guarantees=select_constraints(game.guarantees),
        fairness=select_constraints(game.fairness),
        goals=select_constraints(game.goals),
        definitions={name: bits for name, bits in game.definitions.items() if name in names},
    )


MAX_MODES = 16
"""Modes of a combined strategy above which strategies are not combined."""


def combine_independent_strategies(game: Game) -> Strategy | None:
    """Return the combination of the strategies of independent games.

    None if the game cannot be divided, one of the games is lost, or there are too many modes.
    """
    games = split_game(game)
    if len(games) == 1 or prod(max(1, len(part.goals)) for part in games) > MAX_MODES:
        return None
    strategies = list[Strategy]()
    for part in games:
        solution = solve_arena(eliminate_commands(part))
        if not solution.is_realizable:
            return None
        strategies.append(extract_strategy(part, solution))
    return (
        _combine_strategies(strategies, game.symbols)
        if prod(len(part.modes) for part in strategies) <= MAX_MODES
        else None
    )


def _combine_strategies(strategies: Sequence[Strategy], symbols: Symbols) -> Strategy:
    first = _combine_modes([strategy.first for strategy in strategies], symbols)
    modes = tuple(
        _combine_modes(modes, symbols)
        for modes in product(*(strategy.modes for strategy in strategies))
    )
    return Strategy(symbols, first, modes)


def _combine_modes(modes: Sequence[Mode], symbols: Symbols) -> Mode:
    outputs = {bit: node for mode in modes for bit, node in mode.outputs.items()}
    ordered = {bit: outputs[bit] for bit in symbols.bits_of_owner(Owner.SYSTEM)}
    # For each combination of modes, the condition under which it is the next mode.
    successors = map(symbols.manager.conjoin, product(*(mode.successors for mode in modes)))
    return Mode(ordered, tuple(successors))
