"""The smallest bound of a timer that a contract can guarantee, found by deciding bounded contracts.

A timer is an integer of the contract that something increments and resets: the steps since a target
was given. A larger bound is never harder to keep, so binary search applies. The upper end of the
range is no bound, because a timer that saturates there guarantees nothing.
"""

from collections.abc import Iterable, Mapping, Sequence

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Conjunct, Contract, Domain, IntegerDomain
from sysmlc.logic.formula import Apply, Const, Op, Var
from sysmlc.synthesis import rules
from sysmlc.synthesis.decision import Options, Place, Verdict, decide


class Deadline(Struct, frozen=True):
    """The result of the search for the smallest bound."""

    component: str
    timers: tuple[str, ...]
    bound: int | None
    """The smallest value that all timers together never have to exceed; None when there is none
    below the end of their ranges, or when that is not decided."""
    tried: Mapping[int, Verdict]
    """The decisions, by bound."""
    exit_code: int
    """0 found, 1 there is none, 2 not decided."""

    def text(self) -> str:
        """Return the bound on one line."""
        names = ", ".join(self.timers)
        if self.bound is not None:
            return f"{self.component}: {names} <= {self.bound} can be promised, no less"
        words = {1: "no bound below the end of the range can be promised"}
        return f"{self.component}: {names}: {words.get(self.exit_code, 'not decided')}"


def find_deadline(
    contract: Contract, timers: Sequence[str], place: Place, sink: Sink, options: Options
) -> Deadline:
    """Return the smallest bound that the system can guarantee for all timers at once.

    Bounds that the contract already guarantees for them are dropped. Unknown timers, undecided
    contracts and missing bounds are reported (SM575, SM576; SM530, SM531).
    """
    domains_by_name = {variable.name: variable.domain for variable in contract.variables}
    numbers = [
        domain for one in timers if isinstance(domain := domains_by_name.get(one), IntegerDomain)
    ]
    if not timers or len(numbers) < len(timers):
        _report_unknown_timers(contract, timers, domains_by_name, place, sink)
        return Deadline(contract.component, tuple(timers), None, {}, 2)
    bounds = range(min(domain.low for domain in numbers), max(domain.high for domain in numbers))
    return _search_bound(contract, tuple(timers), bounds, place, sink, options)


def set_bound(contract: Contract, timers: Iterable[str], bound: int) -> Contract:
    """Return the contract with this bound of the timers instead of its own bounds."""
    timer_names = frozenset(timers)
    other_guarantees = (
        guarantee for guarantee in contract.guarantees if not _is_bound_of(guarantee, timer_names)
    )
    bounds = (
        Conjunct(f.compare(Op.LE, Var(guarantee), Const(bound)), Class.SAFETY, contract.origin)
        for guarantee in sorted(timer_names)
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
        discarded_sink = Sink()
        verdicts[middle] = decide(
            set_bound(contract, timers, middle), place, discarded_sink, options
        )
        if verdicts[middle].is_realizable is None:
            # The obstacle is the same for all bounds: decide again to report it.
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
    """Return whether the conjunct only states that a timer is at most some number."""
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
