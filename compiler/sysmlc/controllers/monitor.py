"""Runtime monitors: the part of a contract that a finite run can break.

A monitor reads one valuation after another and needs only the last one: history bits store what a
formula asks about earlier steps, as in the reduction to GR(1). A number is one more kind of input:
its region is computed. Liveness is not monitored, because every finite run can still satisfy it
(Bauer, Leucker and Schallhart, Runtime Verification for LTL and TLTL).
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    Class,
    Conjunct,
    Contract,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.domains import make_region_domain, regions_of
from sysmlc.logic.evaluate import compile_evaluation
from sysmlc.logic.formula import Formula, Literal, Op, has_primes, variable_names
from sysmlc.logic.reduction.contract_reduction import reduce_contract
from sysmlc.logic.reduction.history import (
    HistoryBit,
    list_history_bits,
    list_history_conjuncts,
)
from sysmlc.logic.region_formulas import describe_literals
from sysmlc.logic.regions import LINE, Regions, Term

Valuation = Mapping[str, Literal]


class Check(Struct, frozen=True):
    """A conjunct in a form that one step decides, or two consecutive steps if it has primes."""

    conjunct: Conjunct
    owner: Owner
    """The side that breaks the conjunct: the environment for assumptions."""


class NumericInput(Struct, frozen=True):
    """A number that a run gives, and from which regions are computed."""

    unit: str
    """Symbol of the unit; empty for plain numbers."""
    is_integral: bool


class InputSum(Struct, frozen=True):
    """A sum of numeric inputs, and the regions of which a variable of the contract is one."""

    term: Term
    regions: Regions


class Monitor(Struct, frozen=True):
    """The checks of one contract, assumptions first, and the history bits that they read."""

    contract: Contract
    """The contract; its variables are those that a run has to contain."""
    checks: tuple[Check, ...]
    bits: tuple[HistoryBit, ...]
    unmonitored: tuple[Conjunct, ...]
    """Conjuncts that no finite run breaks, and those that have no known form with history bits."""

    @property
    def sums(self) -> dict[str, InputSum]:
        """The sum of inputs for each variable that is the region of a number."""
        variables = self.contract.variables
        # The input for the only number of a variable has the name of the variable.
        names = {variable.wording: variable.name for variable in variables}
        names |= {v.term[0][0]: v.name for v in variables if len(v.term) == 1}
        sums: dict[str, InputSum] = {}
        for variable in variables:
            regions = regions_of(variable.domain)
            if regions is not None:
                term = variable.term or ((variable.name, Fraction(1)),)
                own = tuple((names.get(key, key), factor) for key, factor in term)
                sums[variable.name] = InputSum(own, regions)
        return sums

    @property
    def numbers(self) -> dict[str, NumericInput]:
        """The numeric inputs by name; Integers in a range are none."""
        inputs: dict[str, NumericInput] = {}
        sums = self.sums
        others = {variable.name for variable in self.contract.variables} - sums.keys()
        # A sum that is compared with a number without a unit has the unit of its features.
        for item in sorted(sums.values(), key=lambda item: len(item.term)):
            names = [name for name, _ in item.term if name not in others]
            units = (inputs[name].unit for name in names if name in inputs)
            unit = item.regions.unit or next(filter(None, units), "")
            for name in names:
                known = inputs.get(name, NumericInput("", False))
                is_integral = known.is_integral or item.regions.is_integral
                inputs[name] = NumericInput(known.unit or unit, is_integral)
        return inputs

    def find_needed_variables(self, formula: Formula) -> set[str]:
        """Return the variables that a formula reads, directly or by history bits."""
        rules = {bit.name: bit.rule for bit in self.bits}
        needed: set[str] = set()
        worklist = [formula]
        while worklist:
            names = variable_names(worklist.pop()) - needed
            needed |= names
            worklist += [rules[name] for name in names if name in rules]
        return needed - rules.keys()


class Violation(Struct, frozen=True):
    """The first step (from 0) in which a check fails; for a check of two steps, the second one."""

    step: int
    check: Check


def build_monitor(contract: Contract) -> Monitor:
    """Return the monitor of a contract.

    An integer outside of its range, or a number in no region, breaks a check, too, of the side that
    decides the variable.
    """
    reduced = reduce_contract(contract)
    bits = list_history_bits(reduced.contract)
    bit_names = {bit.name for bit in bits}
    recorded = tuple(item for item in contract.variables if item.name not in bit_names)
    # The rules of the bits compute them, so that there is nothing to check about them.
    rules = frozenset(list_history_conjuncts(reduced.contract))
    sides = (
        (Owner.ENVIRONMENT, reduced.contract.assumptions),
        (Owner.SYSTEM, reduced.contract.guarantees),
    )
    checks: list[Check] = []
    unmonitored: list[Conjunct] = []
    for owner, conjuncts in sides:
        checks += _check_ranges(recorded, owner)
        for conjunct in conjuncts:
            if conjunct in rules:
                continue
            if conjunct.class_ in (Class.INIT, Class.SAFETY):
                checks.append(Check(conjunct, owner))
            else:
                unmonitored.append(conjunct)
    observed = replace(contract, variables=recorded)
    return Monitor(observed, tuple(checks), bits, tuple(unmonitored))


def _check_ranges(declared: Iterable[Variable], owner: Owner) -> Iterator[Check]:
    """Yield a check for each number of one side: the value lies in the range or in a region.

    Nothing is guaranteed outside of a range that the compiler assumes.
    """
    for variable in declared:
        side = Owner.ENVIRONMENT if variable.is_range_assumed else variable.owner
        match variable.domain:
            case IntegerDomain(low, high) if side is owner:
                value = f.var(variable.name)
                formula = f.both(
                    f.compare(Op.LE, f.const(low), value), f.compare(Op.LE, value, f.const(high))
                )
                source = ", which is assumed" if variable.is_range_assumed else ""
                text = f"'{variable.name}' stays between {low} and {high}{source}."
                yield Check(Conjunct(formula, Class.SAFETY, variable.origin, text), owner)
            case EnumerationDomain(literals, regions=Regions() as regions) if side is owner:
                # A number such as NaN has no region.
                name = f.var(variable.name)
                formula = f.either(*(f.eq(name, f.const(literal)) for literal in literals))
                limits = regions.join_neighbours()
                widest = replace(variable, domain=make_region_domain(limits))
                conditions = " or ".join(condition for _, condition in describe_literals(widest))
                shown = "" if LINE in limits.intervals else f": {conditions}"
                text = f"'{variable.wording or variable.name}' has a value in each step{shown}."
                yield Check(Conjunct(formula, Class.SAFETY, variable.origin, text), owner)


class MonitorRun:
    """One run of a monitor: ``observe`` takes the valuation of each step.

    Checks that read a variable in *missing* are skipped. The run ends with the first violation:
    after a broken assumption the component owes nothing more.
    """

    def __init__(self, monitor: Monitor, missing: frozenset[str] = frozenset()) -> None:
        checks = [
            check
            for check in monitor.checks
            if missing.isdisjoint(monitor.find_needed_variables(check.conjunct.formula))
        ]
        self._checks = [(check, _compile_check(check.conjunct)) for check in checks]
        self._bits = [
            (bit, compile_evaluation(bit.rule))
            for bit in monitor.bits
            if missing.isdisjoint(monitor.find_needed_variables(bit.rule))
        ]
        self._previous: Valuation | None = None
        self._step = -1
        self.violation: Violation | None = None

    def observe(self, values: Valuation) -> Violation | None:
        """Check the next step; return the violation of the run so far."""
        if self.violation is not None:
            return self.violation
        self._step += 1
        now = self._add_bits(values)
        for check, holds in self._checks:
            if not holds(self._previous, now):
                self.violation = Violation(self._step, check)
                break
        self._previous = now
        return self.violation

    def _add_bits(self, values: Valuation) -> Valuation:
        """Return the valuation with the history bits, those that others read first."""
        now = dict(values)
        for bit, rule in self._bits:
            now[bit.name] = bit.start if self._previous is None else rule(self._previous, now)
        return now


_StepCheck = Callable[[Valuation | None, Valuation], bool]
"""Whether a check holds for the previous valuation, None in the first step, and the present one."""


def _compile_check(conjunct: Conjunct) -> _StepCheck:
    evaluation = compile_evaluation(conjunct.formula)
    if conjunct.class_ is Class.INIT:
        return lambda previous, now: previous is not None or bool(evaluation(now, None))
    if has_primes(conjunct.formula):
        return lambda previous, now: previous is None or bool(evaluation(previous, now))
    return lambda previous, now: bool(evaluation(now, None))


def find_first_violation(
    monitor: Monitor, trace: Iterable[Valuation], missing: frozenset[str] = frozenset()
) -> Violation | None:
    """Return the first violation in a finite run, whose steps have no values for *missing*."""
    run = MonitorRun(monitor, missing)
    for values in trace:
        if run.observe(values) is not None:
            break
    return run.violation
