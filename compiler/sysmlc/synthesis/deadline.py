"""The smallest bound of a timer that a contract can promise, found by deciding bounded contracts.

A timer is a number of the contract that something counts up and sets back: the steps since a target
was given. A larger bound is never harder to keep, so that half of what is left goes with each
decision. The top of the range is no bound: a timer that stops there promises nothing.
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
    """What is known of the smallest bound."""

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
        """The bound on one line."""
        names = ", ".join(self.timers)
        if self.bound is not None:
            return f"{self.component}: {names} <= {self.bound} can be promised, no less"
        words = {1: "no bound below the end of the range can be promised"}
        return f"{self.component}: {names}: {words.get(self.exit_code, 'not decided')}"


def deadline(
    contract: Contract, timers: Sequence[str], place: Place, sink: Sink, options: Options
) -> Deadline:
    """The smallest bound that the system can keep for all the timers at once.

    Bounds of theirs that the contract promises already are left out: they are what is looked for.
    What is no number of the contract, what cannot be decided and that there is no bound is reported
    (SM575, SM576; SM530, SM531).
    """
    named = {one.name: one.domain for one in contract.variables}
    numbers = [domain for one in timers if isinstance(domain := named.get(one), IntegerDomain)]
    if not timers or len(numbers) < len(timers):
        _report_strangers(contract, timers, named, place, sink)
        return Deadline(contract.component, tuple(timers), None, {}, 2)
    bounds = range(min(one.low for one in numbers), max(one.high for one in numbers))
    return _searched(contract, tuple(timers), bounds, place, sink, options)


def bounded(contract: Contract, timers: Iterable[str], bound: int) -> Contract:
    """The contract that promises this bound of the timers, and no other one of theirs."""
    named = frozenset(timers)
    kept = (one for one in contract.guarantees if not _bounds(one, named))
    added = (
        Conjunct(f.compare(Op.LE, Var(one), Const(bound)), Class.SAFETY, contract.origin)
        for one in sorted(named)
    )
    return replace(contract, guarantees=(*kept, *added))


def _searched(
    contract: Contract,
    timers: tuple[str, ...],
    bounds: range,
    place: Place,
    sink: Sink,
    options: Options,
) -> Deadline:
    options = replace(options, is_explained=False)
    tried: dict[int, Verdict] = {}
    low, high = bounds.start, bounds.stop
    while low < high:
        middle = (low + high) // 2
        found = Sink()
        tried[middle] = decide(bounded(contract, timers, middle), place, found, options)
        if tried[middle].is_realizable is None:
            # What stands in the way of one bound stands in the way of the others.
            decide(bounded(contract, timers, middle), place, sink, options)
            return Deadline(contract.component, timers, None, tried, 2)
        low, high = (low, middle) if tried[middle].is_realizable else (middle + 1, high)
    if low < bounds.stop:
        return Deadline(contract.component, timers, low, tried, 0)
    names = ", ".join(timers)
    sink.report(
        rules.NO_DEADLINE,
        place(contract.origin),
        component=contract.component,
        timers=names,
        most=bounds.stop - 1,
    )
    return Deadline(contract.component, timers, None, tried, 1)


def _bounds(conjunct: Conjunct, timers: frozenset[str]) -> bool:
    """Whether the conjunct says nothing but that a timer is at most some number."""
    if conjunct.class_ is not Class.SAFETY:
        return False
    match conjunct.formula:
        case Apply(Op.LE | Op.LT, (Var(name), Const(int()))):
            return name in timers
        case Apply(Op.GE | Op.GT, (Const(int()), Var(name))):
            return name in timers
        case _:
            return False


def _report_strangers(
    contract: Contract,
    timers: Sequence[str],
    named: Mapping[str, Domain],
    place: Place,
    sink: Sink,
) -> None:
    numbers = [one for one, domain in named.items() if isinstance(domain, IntegerDomain)]
    for name in timers:
        if name not in numbers:
            sink.report(
                rules.NO_TIMER,
                place(contract.origin),
                component=contract.component,
                name=name,
                numbers=", ".join(numbers) or "none",
            )
