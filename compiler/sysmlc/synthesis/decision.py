"""The decision whether a contract is realizable, and the search for the smallest bound of a timer.

A timer is an integer of the contract that counts steps, for instance since a target was assigned.
The smallest bound is found by binary search over contracts with an additional bound, because a
larger bound is never harder to guarantee. The upper end of the range is no bound: a timer that
saturates there guarantees nothing.
"""

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Sink, Subject
from sysmlc.logic import formula as f
from sysmlc.logic.basis import Basis, find_basis
from sysmlc.logic.contract import Class, Conjunct, Contract, Domain, IntegerDomain
from sysmlc.logic.formula import Apply, Const, Op, Var
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.logic.region_formulas import print_worded
from sysmlc.support.counts import count
from sysmlc.synthesis import rules
from sysmlc.synthesis.bdd.limits import LimitError, Limits, Progress, TooLargeError
from sysmlc.synthesis.bdd.manager import Manager
from sysmlc.synthesis.bdd.variable_order import VariableOrder
from sysmlc.synthesis.games.arena import Arena
from sysmlc.synthesis.games.command_elimination import eliminate_commands
from sysmlc.synthesis.games.game import Game, OutsideGr1Error, make_game
from sysmlc.synthesis.games.solver import Solution, solve_arena
from sysmlc.synthesis.games.variable_elimination import eliminate_determined_variables
from sysmlc.synthesis.unrealizable import explain_unrealizability

Place = Callable[[str], Subject]
"""Maps the origin of a contract or conjunct to the subject of diagnostics."""
_FIRST_ORDERS = (VariableOrder.CONJUNCTS, VariableOrder.DECLARED)
"""The orders of variables that are tried in turn with few nodes. If both need more, the first one
is tried again with as many nodes as the limits allow."""
_FIRST_CEILING = 200_000
"""Live nodes for each of these orders."""


class Options(Struct, frozen=True):
    """Options of a decision."""

    engine: str = ""
    limits: Limits = Limits()
    progress: Progress | None = None
    is_explained: bool = False
    """Whether conflicting guarantees of an unrealizable contract are searched and reported."""


class Figures(Struct, frozen=True):
    """The costs of a decision."""

    variables: int
    bits: int
    """Bits of the variables, without those of next values."""
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
            f"{count(self.variables, 'variable')}, {count(self.bits, 'bit')}, "
            f"{count(self.conjuncts, 'conjunct')}; {count(self.rounds, 'round')}, "
            f"{count(self.steps, 'step')}, {count(self.nodes, 'node')}, {self.seconds:.2f} s"
        )


class Verdict(Struct, frozen=True):
    """The verdict about a contract."""

    component: str
    is_realizable: bool | None
    """None if that is not decided."""
    figures: Figures | None = None
    basis: Basis = Basis()
    """The ranges that are assumed and the conditions without formula in the contract."""

    @property
    def exit_code(self) -> int:
        """0 for a realizable contract, 1 for an unrealizable one, 2 if it is not decided."""
        return 2 if self.is_realizable is None else int(not self.is_realizable)

    def text(self) -> str:
        """Return the verdict on one line, with figures."""
        words = {None: "not decided", True: "realizable", False: "unrealizable"}
        figures = f" ({self.figures.text()})" if self.figures else ""
        within = "" if self.is_realizable is None else self.basis.range_text
        return f"{self.component}: {words[self.is_realizable]}{within}{figures}"


class Decision(Struct, frozen=True):
    """A verdict, with the encoded game if the contract could be translated and decided."""

    verdict: Verdict
    game: Game | None = None
    """The game after the elimination of determined variables."""
    arena: Arena | None = None
    """The arena that was solved, after the elimination of commands."""


def decide(contract: Contract, place: Place, sink: Sink, options: Options) -> Verdict:
    """Decide whether a contract is realizable.

    Unrealizable contracts, conjuncts outside GR(1) and exceeded limits are reported. Conjuncts of
    general LTL are first reduced to GR(1) with history bits, if possible (``logic.reduction``).
    """
    return decide_game(contract, place, sink, options).verdict


def decide_game(contract: Contract, place: Place, sink: Sink, options: Options) -> Decision:
    """Decide a contract like ``decide``, and also return the game for further use."""
    # The last activity is part of the message about an exceeded limit.
    current_activity = ["translating the contract"]

    def progress(step: str) -> None:
        current_activity[0] = step
        if options.progress is not None:
            options.progress(step)

    start_time = time.process_time()
    undecided = Decision(Verdict(contract.component, None))
    try:
        game, encoded, solution = _solve_contract(contract, options, progress, start_time)
    except OutsideGr1Error as problem:
        _report_outside(contract, problem, place, sink)
        return undecided
    except LimitError as problem:
        sink.report(
            rules.LIMIT,
            place(contract.origin),
            component=contract.component,
            reached=str(problem),
            seconds=f"{time.process_time() - start_time:.1f}",
            doing=current_activity[0],
        )
        return undecided
    basis = find_basis((contract,))
    if not solution.is_realizable and basis.conditions:
        question = f"a system can satisfy the contract of '{contract.component}'"
        sink.report(rules.DEPENDS, place(contract.origin), question=question, reason=basis.reason)
        return undecided
    if not solution.is_realizable:
        reasons = tuple(explain_unrealizability(game, contract)) if options.is_explained else ()
        sink.report(
            rules.UNREALIZABLE,
            place(contract.origin),
            notes=reasons,
            component=contract.component,
            within=basis.range_text,
        )
    figures = _collect_figures(contract, game, solution)
    verdict = Verdict(contract.component, solution.is_realizable, figures, basis)
    return Decision(verdict, encoded, solution.arena)


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


def _solve_contract(
    contract: Contract, options: Options, progress: Progress, start_time: float
) -> tuple[Game, Game, Solution]:
    """Return the game of a contract, the game without determined variables, and its solution.

    Raises OutsideGr1Error, or LimitError if a limit is exceeded; CPU time counts from *start_time*.
    """

    def solve_in_order(order: VariableOrder, ceiling: int) -> tuple[Game, Game, Solution]:
        manager = Manager(options.engine, options.limits, progress, start_time)
        with manager.limit_nodes(ceiling):
            game = make_game(reduced, manager, order)
            with manager.without_reordering():
                encoded = eliminate_determined_variables(game)
                arena = eliminate_commands(encoded)
            # The first layer of a large game may take all the time, and reports nothing before.
            progress("solving the game")
            return game, encoded, solve_arena(arena, is_complete=False)

    reduced = reduce_contract(contract).contract
    for order in _FIRST_ORDERS:
        # Few contracts that are decided at all need more nodes; with an unsuitable order nearly
        # every contract does.
        with suppress(TooLargeError):
            return solve_in_order(order, _FIRST_CEILING)
    return solve_in_order(_FIRST_ORDERS[0], 0)


def _report_outside(contract: Contract, problem: OutsideGr1Error, place: Place, sink: Sink) -> None:
    # The exception names one conjunct; report all of its kind at once.
    outside = reduce_contract(contract).irreducible
    for conjunct in outside if problem.conjunct in outside else (problem.conjunct,):
        sink.report(
            rules.OUTSIDE_GR1,
            place(conjunct.origin or contract.origin),
            component=contract.component,
            formula=print_worded(conjunct.formula, contract.variables),
            why=problem.reason,
        )


# -- smallest bounds ---------------------------------------------------------------------------


class Deadline(Struct, frozen=True):
    """The result of the search for the smallest bound of timers."""

    component: str
    timers: tuple[str, ...]
    bound: int | None
    """The smallest bound that the system can guarantee for all timers at once; None if there is
    none below the ends of their ranges, or if that is not decided."""
    tried: Mapping[int, Verdict]
    """The verdicts of the contracts with a bound, by bound."""
    exit_code: int
    """0 with a bound, 1 if there is none, 2 if that is not decided."""

    def text(self) -> str:
        """Return the result of the search on one line."""
        names = ", ".join(self.timers)
        if self.bound is not None:
            return f"{self.component}: {names} <= {self.bound} can be guaranteed, no smaller bound"
        words = {1: "no bound below the end of the range can be guaranteed"}
        return f"{self.component}: {names}: {words.get(self.exit_code, 'not decided')}"


def find_deadline(
    contract: Contract, timers: Sequence[str], place: Place, sink: Sink, options: Options
) -> Deadline:
    """Return the smallest bound that the system can guarantee for all timers at once.

    Bounds of the timers in the contract itself are dropped. Reported are unknown timers (SM575), a
    search without result (SM576), and undecided contracts (SM530, SM531).
    """
    domains_by_name = {variable.name: variable.domain for variable in contract.variables}
    numbers = [
        domain for name in timers if isinstance(domain := domains_by_name.get(name), IntegerDomain)
    ]
    if not timers or len(numbers) < len(timers):
        _report_unknown_timers(contract, timers, domains_by_name, place, sink)
        return Deadline(contract.component, tuple(timers), None, {}, 2)
    bounds = range(min(domain.low for domain in numbers), max(domain.high for domain in numbers))
    return _search_bound(contract, tuple(timers), bounds, place, sink, options)


def set_bound(contract: Contract, timers: Iterable[str], bound: int) -> Contract:
    """Return the contract with *bound* for all timers instead of its own bounds for them."""
    timer_names = frozenset(timers)
    other_guarantees = (
        guarantee for guarantee in contract.guarantees if not _is_bound_of(guarantee, timer_names)
    )
    bounds = (
        Conjunct(f.compare(Op.LE, Var(name), Const(bound)), Class.SAFETY, contract.origin)
        for name in sorted(timer_names)
    )
    return replace(contract, guarantees=(*other_guarantees, *bounds))


def _search_bound(
    contract: Contract,
    timers: tuple[str, ...],
    bounds: range,
    place: Place,
    sink: Sink,
    options: Options,
) -> Deadline:
    options = replace(options, is_explained=False)
    verdicts: dict[int, Verdict] = {}
    low, high = bounds.start, bounds.stop
    while low < high:
        middle = (low + high) // 2
        # An unrealizable bound is an ordinary step of the search and must not be reported.
        discarded_sink = Sink()
        verdicts[middle] = decide(
            set_bound(contract, timers, middle), place, discarded_sink, options
        )
        if verdicts[middle].is_realizable is None:
            # Decide again, now with the caller's sink, to report what prevents the decision.
            decide(set_bound(contract, timers, middle), place, sink, options)
            return Deadline(contract.component, timers, None, verdicts, 2)
        low, high = (low, middle) if verdicts[middle].is_realizable else (middle + 1, high)
    if low < bounds.stop:
        return Deadline(contract.component, timers, low, verdicts, 0)
    names = ", ".join(timers)
    sink.report(
        rules.NO_DEADLINE,
        place(contract.origin),
        component=contract.component,
        timers=names,
        most=bounds.stop - 1,
    )
    return Deadline(contract.component, timers, None, verdicts, 1)


def _is_bound_of(conjunct: Conjunct, timers: frozenset[str]) -> bool:
    """Whether the conjunct is nothing but an upper bound of a timer."""
    if conjunct.class_ is not Class.SAFETY:
        return False
    match conjunct.formula:
        case Apply(Op.LE | Op.LT, (Var(name), Const(int()))):
            return name in timers
        case Apply(Op.GE | Op.GT, (Const(int()), Var(name))):
            return name in timers
        case _:
            return False


def _report_unknown_timers(
    contract: Contract,
    timers: Sequence[str],
    domains_by_name: Mapping[str, Domain],
    place: Place,
    sink: Sink,
) -> None:
    numbers = [
        timer for timer, domain in domains_by_name.items() if isinstance(domain, IntegerDomain)
    ]
    for name in timers:
        if name not in numbers:
            sink.report(
                rules.NO_TIMER,
                place(contract.origin),
                component=contract.component,
                name=name,
                numbers=", ".join(numbers) or "none",
            )
