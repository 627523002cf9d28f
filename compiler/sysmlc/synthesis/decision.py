"""The decision whether a contract is realizable: verdict, figures, and diagnostics for contracts
that cannot be decided.
"""

from collections.abc import Callable

from msgspec import Struct

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic.contract import Conjunct, Contract
from sysmlc.logic.printing import print_formula
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.synthesis import rules
from sysmlc.synthesis.bdd.limits import LimitError, Limits, Progress
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.games.arena import Arena
from sysmlc.synthesis.games.command_elimination import eliminate_commands
from sysmlc.synthesis.games.game import Game, OutsideGr1Error, make_game
from sysmlc.synthesis.games.solver import Solution, solve_arena
from sysmlc.synthesis.games.variable_elimination import eliminate_determined_variables
from sysmlc.synthesis.unrealizable import explain_unrealizability

Place = Callable[[str], Subject]
"""Maps the origin of a contract or conjunct to the subject of diagnostics."""


class Options(Struct, frozen=True):
    """Options of a decision."""

    engine: str = ""
    limits: Limits = Limits()
    progress: Progress | None = None
    is_explained: bool = False
    """Whether conflicting guarantees are searched and reported."""


class Figures(Struct, frozen=True):
    """The costs of a decision."""

    variables: int
    bits: int
    """Bits of one step."""
    conjuncts: int
    rounds: int
    """Number of computed attractors."""
    steps: int
    """Number of computed predecessors."""
    nodes: int
    """Peak of live nodes of decision diagrams."""
    seconds: float
    """CPU time."""

    def text(self) -> str:
        """Return the figures on one line."""
        return (
            f"{self.variables} variables, {self.bits} bits, {self.conjuncts} conjuncts; "
            f"{self.rounds} rounds, {self.steps} steps, {self.nodes:,} nodes, {self.seconds:.2f} s"
        )


class Verdict(Struct, frozen=True):
    """Whether a contract is realizable; None if that is not decided."""

    component: str
    is_realizable: bool | None
    figures: Figures | None = None

    @property
    def exit_code(self) -> int:
        """0 realizable, 1 unrealizable, 2 not decided."""
        return 2 if self.is_realizable is None else int(not self.is_realizable)

    def text(self) -> str:
        """Return the verdict on one line, with figures."""
        words = {None: "not decided", True: "realizable", False: "unrealizable"}
        figures = f" ({self.figures.text()})" if self.figures else ""
        return f"{self.component}: {words[self.is_realizable]}{figures}"


class Decision(Struct, frozen=True):
    """A verdict, with the game that it is about if there is one."""

    verdict: Verdict
    game: Game | None = None
    """The game without eliminated variables."""
    arena: Arena | None = None
    """The encoded game that was solved."""


def decide(contract: Contract, place: Place, sink: Sink, options: Options) -> Verdict:
    """Decide a contract; what is outside GR(1), exceeds the limits or is unrealizable is reported.

    LTL beyond GR(1) is expressed with history bits where a reduction is known
    (``logic.reduction``).
    """
    return decide_game(contract, place, sink, options).verdict


def decide_game(contract: Contract, place: Place, sink: Sink, options: Options) -> Decision:
    """Decide a contract like ``decide``, and also return the game for further use."""
    current_activity = ["translating the contract"]

    def progress(step: str) -> None:
        current_activity[0] = step
        if options.progress is not None:
            options.progress(step)

    manager = Manager(options.engine, options.limits, progress)
    try:
        game = make_game(reduce_contract(contract).contract, manager)
        with manager.guard(), manager.without_reordering():
            encoded = eliminate_determined_variables(game)
            arena = eliminate_commands(encoded)
        solution = solve_arena(arena, is_complete=False)
    except OutsideGr1Error as problem:
        _report_outside(contract, problem, place, sink)
        return Decision(Verdict(contract.component, None))
    except LimitError as problem:
        _report_limit(contract, problem, manager, current_activity[0], place, sink)
        return Decision(Verdict(contract.component, None))
    if not solution.is_realizable:
        reasons = tuple(explain_unrealizability(game, contract)) if options.is_explained else ()
        sink.report(
            rules.UNREALIZABLE,
            place(contract.origin),
            notes=reasons,
            component=contract.component,
        )
    figures = _collect_figures(contract, game, solution)
    return Decision(Verdict(contract.component, solution.is_realizable, figures), encoded, arena)


def _report_outside(contract: Contract, problem: OutsideGr1Error, place: Place, sink: Sink) -> None:
    outside = reduce_contract(contract).irreducible
    for conjunct in outside if problem.conjunct in outside else (problem.conjunct,):
        sink.report(
            rules.OUTSIDE_GR1,
            place(conjunct.origin or contract.origin),
            component=contract.component,
            formula=_print_formula(conjunct),
            why=problem.why,
        )


def _report_limit(
    contract: Contract,
    problem: LimitError,
    manager: Manager,
    activity: str,
    place: Place,
    sink: Sink,
) -> None:
    sink.report(
        rules.LIMIT,
        place(contract.origin),
        component=contract.component,
        reached=str(problem),
        seconds=f"{manager.usage().seconds:.1f}",
        doing=activity,
    )


def _print_formula(conjunct: Conjunct) -> str:
    return print_formula(conjunct.formula)


def _collect_figures(contract: Contract, game: Game, solution: Solution) -> Figures:
    usage = game.manager.usage()
    return Figures(
        variables=len(game.symbols.variables),
        bits=len(game.inputs) + len(game.outputs),
        conjuncts=len(contract.assumptions) + len(contract.guarantees),
        rounds=solution.rounds,
        steps=solution.steps,
        nodes=usage.peak,
        seconds=usage.seconds,
    )
