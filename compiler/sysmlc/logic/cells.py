"""Cells: combinations of regions that numbers can have at once.

``a < 5``, ``b > 10`` and ``a - b > 0`` contradict each other, although each is possible. Variables
whose terms share a feature form a group; the combinations without solution are excluded.
"""

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import combinations

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    Class,
    Conjunct,
    Contract,
    EnumerationDomain,
    Owner,
    Source,
    Variable,
    equals,
)
from sysmlc.logic.domains import make_region_domain
from sysmlc.logic.formula import Const, Formula
from sysmlc.logic.identifiers import Names
from sysmlc.logic.inequalities import Inequality, find_solution
from sysmlc.logic.regions import Cut, Interval, Regions, Term, split_line
from sysmlc.support.disjoint_sets import group_related

MAX_CELLS = 512
"""Most combinations of a group; those of a larger one are not excluded."""

Fact = tuple[Term, Interval]
"""A term, and the interval in which a constraint keeps it."""


class Cells(Struct, frozen=True):
    """What is known about the regions of numbers in each step.

    ``orders`` are variables for differences of constants, ``possible`` is true in each step, and
    ``constant`` are the variables that never change. ``unrelated`` are the inputs of groups that
    are too large, or of which the system keeps a number: their values may contradict each other.
    """

    orders: tuple[Variable, ...] = ()
    possible: tuple[Formula, ...] = ()
    constant: tuple[Variable, ...] = ()
    unrelated: frozenset[str] = frozenset()

    def mark_unrelated(self, variables: tuple[Variable, ...]) -> tuple[Variable, ...]:
        """Return the variables; unrelated ones are doubtful, as conditions without formula are."""
        return tuple(
            replace(variable, condition=variable.wording or variable.name)
            if variable.name in self.unrelated
            else variable
            for variable in variables
        )

    def describe(self, origin: str) -> tuple[Conjunct, ...]:
        """Return the facts about each step, with *origin* for those about several numbers."""
        facts = [
            Conjunct(formula, Class.SAFETY, origin, "Numbers cannot be so at once.")
            for formula in self.possible
        ]
        facts += [
            Conjunct(
                equals(variable, f.var(variable.name), is_next=True),
                Class.SAFETY,
                variable.origin or origin,
                "Constants never change.",
            )
            for variable in self.constant
        ]
        return tuple(replace(fact, source=Source.DERIVED) for fact in facts)


def state_facts(
    variables: Sequence[Variable], facts: Sequence[Fact], origin: str
) -> Iterator[Conjunct]:
    """Yield what is true of numbers that the environment decides: initially, and in each step."""
    cells = find_cells(variables, facts, has_orders=False)
    return _iter_assumptions(cells, variables, origin)


def add_facts_about_numbers(
    contract: Contract, facts: Sequence[Fact], *, has_orders: bool
) -> Contract:
    """Return the contract with the assumption that the inputs are possible numbers.

    *facts* are what constraints state about them; *has_orders* is that of ``find_cells``.
    """
    cells = find_cells(contract.variables, facts, has_orders=has_orders)
    variables = (*contract.variables, *cells.orders)
    assumptions = _iter_assumptions(cells, variables, contract.origin)
    return replace(
        contract,
        variables=cells.mark_unrelated(variables),
        assumptions=(*contract.assumptions, *assumptions),
    )


def _iter_assumptions(
    cells: Cells, variables: Sequence[Variable], origin: str
) -> Iterator[Conjunct]:
    """Yield the facts about inputs alone: no environment can promise what the system decides.

    The conjuncts about a next step have primes: no step of the environment leads to other numbers.
    """
    inputs = {variable.name for variable in variables if variable.owner is Owner.ENVIRONMENT}
    for fact in cells.describe(origin):
        if not inputs.issuperset(f.variable_names(fact.formula)):
            continue
        if f.has_primes(fact.formula):
            yield fact
        else:
            yield replace(fact, class_=Class.INIT)
            yield replace(fact, formula=f.prime(fact.formula))


def find_cells(
    variables: Iterable[Variable], facts: Sequence[Fact], *, has_orders: bool = True
) -> Cells:
    """Return what the terms of the variables imply about their regions.

    Without *has_orders*, nothing relates the orders of constants in different steps.
    """
    numeric = [variable for variable in variables if variable.term]
    if not numeric:
        return Cells()
    orders = list(_compare_constants(numeric)) if has_orders else []
    numeric = orders + numeric
    possible: list[Formula] = []
    unrelated: set[str] = set()
    keys = {variable.name: {key for key, _ in variable.term} for variable in numeric}
    relations = [
        [name for name in keys if key in keys[name]] for key in sorted(set().union(*keys.values()))
    ]
    relations += [
        [name for name in keys if keys[name] & {key for key, _ in term}] for term, _ in facts
    ]
    for group in group_related(keys, relations):
        members = [variable for variable in numeric if variable.name in group]
        shared = set().union(*(keys[name] for name in group))
        own_facts = [fact for fact in facts if shared.issuperset(key for key, _ in fact[0])]
        if len(members) == 1 and not own_facts:
            continue
        excluded = _exclude(members, own_facts)
        possible += (f.negate(combination) for combination in excluded or ())
        # A number that the system keeps has one value in the region, not another in each step.
        is_kept = any(not _has_only_points(m) for m in members if m.owner is Owner.SYSTEM)
        if excluded is None or (is_kept and excluded):
            unrelated |= {item.name for item in members if item.owner is Owner.ENVIRONMENT}
    constant = (v for v in numeric if {key for key, _ in v.term} <= set(v.constants))
    return Cells(tuple(orders), tuple(possible), tuple(constant), frozenset(unrelated))


def _has_only_points(variable: Variable) -> bool:
    """Whether each region of a variable is a single number."""
    regions = variable.domain.regions if isinstance(variable.domain, EnumerationDomain) else None
    return regions is not None and all(map(regions.is_point, range(len(regions.intervals))))


def _exclude(members: list[Variable], facts: list[Fact]) -> list[Formula] | None:
    """Return the shortest combinations of regions without solution; None if there are too many."""
    excluded: list[Formula] = []
    cells: list[tuple[Formula, list[Inequality]]] = [
        (f.TRUE, [row for fact in facts for row in list_inequalities(*fact)])
    ]
    for member in members:
        assert isinstance(member.domain, EnumerationDomain)
        assert member.domain.regions is not None
        extended: list[tuple[Formula, list[Inequality]]] = []
        for formula, rows in cells:
            for literal, interval in zip(
                member.domain.literals, member.domain.regions.intervals, strict=True
            ):
                combination = f.both(formula, f.eq(f.var(member.name), Const(literal)))
                extended_rows = [*rows, *list_inequalities(member.term, interval)]
                if find_solution(extended_rows) is None:
                    excluded.append(combination)
                else:
                    extended.append((combination, extended_rows))
        cells = extended
        if len(cells) > MAX_CELLS:
            return None
    return excluded


def list_inequalities(term: Term, interval: Interval) -> Iterator[Inequality]:
    """Yield the inequalities that keep a term in an interval."""
    if interval.high is not None:
        yield Inequality(dict(term), interval.high.number, is_strict=not interval.high.is_above)
    if interval.low is not None:
        negated = {key: -factor for key, factor in term}
        yield Inequality(negated, -interval.low.number, is_strict=interval.low.is_above)


def _compare_constants(variables: Sequence[Variable]) -> Iterator[Variable]:
    """Yield a variable for each difference of constants that two terms imply.

    ``x - low`` and ``x - high`` together tell how ``low`` and ``high`` are ordered, which is the
    same in all steps.
    """
    names = Names(*(variable.name for variable in variables))
    cuts: dict[Term, dict[Cut, None]] = {}
    for left, right in combinations(variables, 2):
        difference = _subtract_constants(left, right)
        if difference is not None:
            term, factor, scale = difference
            cuts.setdefault(term, {}).update(
                dict.fromkeys(
                    Cut((first - factor * second) / scale, is_above)
                    for first in _list_numbers(left)
                    for second in _list_numbers(right)
                    for is_above in (False, True)
                )
            )
    terms = {variable.term for variable in variables}
    constants = {key: None for variable in variables for key in variable.constants}
    for term, places in cuts.items():
        if term in terms:
            continue
        regions = Regions(split_line(places))
        domain = make_region_domain(regions)
        name = names.new("order_of_" + "_and_".join(key for key, _ in term))
        yield Variable(
            name,
            Owner.ENVIRONMENT,
            domain,
            is_auxiliary=True,
            term=term,
            constants=tuple(constants),
        )


def _subtract_constants(left: Variable, right: Variable) -> tuple[Term, Fraction, Fraction] | None:
    """Return the term ``(left - factor * right) / scale`` if it has only constants, and both."""
    constants = {*left.constants, *right.constants}
    changing = [
        {key: factor for key, factor in variable.term if key not in constants}
        for variable in (left, right)
    ]
    if not changing[0] or changing[0].keys() != changing[1].keys():
        return None
    first = next(iter(changing[0]))
    factor = changing[0][first] / changing[1][first]
    factors = dict(left.term)
    for key, value in right.term:
        factors[key] = factors.get(key, Fraction(0)) - factor * value
    rest = sorted((key, value) for key, value in factors.items() if value)
    if not rest or not constants.issuperset(key for key, _ in rest):
        return None
    scale = rest[0][1]
    return tuple((key, value / scale) for key, value in rest), factor, scale


def _list_numbers(variable: Variable) -> list[Fraction]:
    """Return the numbers at which the regions of a variable are cut."""
    regions = variable.domain.regions if isinstance(variable.domain, EnumerationDomain) else None
    intervals = () if regions is None else regions.intervals
    numbers = (cut.number for item in intervals for cut in (item.low, item.high) if cut)
    return list(dict.fromkeys(numbers))
