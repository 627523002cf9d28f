"""From a contract to a controller that is known to keep it."""

from enum import StrEnum

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.logic.contract import Contract
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.reduce import reduced
from sysmlc.synthesis import rules
from sysmlc.synthesis.bdd.limits import LimitError, Limits, TooLargeError
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.controllers.closed_loop import Controller
from sysmlc.synthesis.controllers.conditions import build_machine
from sysmlc.synthesis.controllers.explicit_states import enumerate_states
from sysmlc.synthesis.controllers.independent_games import combine_independent_strategies
from sysmlc.synthesis.controllers.mealy import Machine
from sysmlc.synthesis.controllers.minimisation import minimise
from sysmlc.synthesis.controllers.strategy import Strategy, extract_strategy
from sysmlc.synthesis.controllers.strategy_memory import choose_registers, explore_strategy
from sysmlc.synthesis.controllers.table import Table, build_table, rebuild_in_variable_order
from sysmlc.synthesis.controllers.verification import Fault, find_faults
from sysmlc.synthesis.decision import Options, Place, Verdict, decided
from sysmlc.synthesis.games.arena import Arena, nodes_of
from sysmlc.synthesis.games.game import Game
from sysmlc.synthesis.games.solver import solve_arena

MOST_NODES = 500_000
"""Nodes of diagrams that looking for a machine may take: where they are more, there is none that
anybody could read."""
_LEAST = 0.01
"""CPU seconds that a check has when all that were given are used up."""


class Form(StrEnum):
    """What a controller is made as."""

    ANY = "any"
    """A machine; a table when there are too many states or conditions."""
    LISTED = "listed"
    """A machine without registers, or none."""
    TABLE = "table"


class Synthesis(Struct, frozen=True):
    """A verdict, and the controller when there is one that passes the check."""

    verdict: Verdict
    contract: Contract
    """With history bits where it needs them."""
    machine: Controller | None = None

    @property
    def exit_code(self) -> int:
        """0 with a controller, 1 unrealizable, 2 not decided or no controller."""
        return self.verdict.exit_code or 2 * (self.machine is None)

    def text(self) -> str:
        """The verdict on one line, with figures of the controller behind it."""
        if self.machine is None:
            return self.verdict.text()
        return f"{self.verdict.text()}; {_figures(self.machine)}, checked"


def _figures(made: Controller) -> str:
    if not isinstance(made, Machine):
        modes = "1 mode" if len(made.modes) == 1 else f"{len(made.modes)} modes"
        return f"controller: {len(made.nodes):,} nodes, {modes}"
    states = "1 state" if made.size == 1 else f"{made.size:,} states"
    known = len(made.registers)
    kept = f", {known} register{'s' * (known > 1)}" if known else ""
    return f"machine: {states}, {made.count:,} moves{kept}"


def synthesised(
    contract: Contract, place: Place, sink: Sink, options: Options, form: Form = Form.ANY
) -> Synthesis:
    """Decide a contract, and make a controller that keeps it; what fails is reported."""
    decision = decided(contract, place, sink, options)
    if not decision.verdict.is_realizable or decision.game is None or decision.arena is None:
        return Synthesis(decision.verdict, contract)
    told = reduced(contract).contract
    try:
        found = controller(told, decision.game, decision.arena, options, form)
    except LimitError as problem:
        found = str(problem)
    if not isinstance(found, str):
        return Synthesis(decision.verdict, told, found)
    component = contract.component
    sink.report(rules.NO_MACHINE, place(contract.origin), component=component, why=found)
    return Synthesis(decision.verdict, told)


def controller(
    contract: Contract, game: Game, arena: Arena, options: Options, form: Form = Form.ANY
) -> Controller | str:
    """A controller that keeps the contract, or why the one that was made is none.

    ``game`` and ``arena`` are the contract's, encoded (``decide.Decision``), and won. Raises
    LimitError.
    """
    with game.manager.guard():
        plan = extract_strategy(game, solve_arena(arena))
        found = made(contract, game, plan, form)
    if isinstance(found, Table):
        found = rebuild_in_variable_order(found, _fresh(game.manager, options))
    fault = next(find_faults(found, contract, _fresh(game.manager, options)), None)
    return _said(fault) if fault else found


def made(contract: Contract, game: Game, plan: Strategy, form: Form = Form.ANY) -> Controller:
    """A strategy in the form that is wanted, not checked yet. Raises LimitError."""
    if form is Form.TABLE:
        return build_table(combine_independent_strategies(game) or plan)
    try:
        with game.manager.limit_nodes(MOST_NODES):
            return _listed(contract, game, plan, form)
    except TooLargeError:
        if form is Form.LISTED:
            raise
    return build_table(combine_independent_strategies(game) or plan)


def _listed(contract: Contract, game: Game, plan: Strategy, form: Form) -> Machine:
    found = explore_strategy(plan, nodes_of(game.init_assumptions), nodes_of(game.assumptions))
    counting = () if form is Form.LISTED else choose_registers(found)
    # What is listed are many small diagrams: to look for a better order takes longer than they do.
    with game.manager.without_reordering():
        return build_machine(minimise(enumerate_states(found, counting)), contract)


def _fresh(manager: Manager, options: Options) -> Manager:
    """Another manager, with what is left of the time."""
    limits = options.limits
    if limits.seconds:
        left = max(_LEAST, limits.seconds - manager.usage().seconds)
        limits = Limits(limits.nodes, limits.memory, left)
    return Manager(options.engine, limits, options.progress)


def _said(fault: Fault) -> str:
    if fault.conjunct is None:
        return "the one that was made has no answer to inputs that are allowed"
    formula = print_formula(fault.conjunct.formula)
    return f"the one that was made does not keep '{formula}'"
