"""Numbers of features whose variables are regions, as people read and write them in runs.

A region of a variable becomes a number inside it, in the unit in which the author writes the
thresholds. Conversely, a number that a scenario or a recorded run states is in one region.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.cells import Fact, list_inequalities
from sysmlc.logic.contract import Owner, Variable
from sysmlc.logic.domains import regions_of, values
from sysmlc.logic.expressions.linear import print_term
from sysmlc.logic.formula import Literal
from sysmlc.logic.inequalities import Inequality, find_solution
from sysmlc.logic.regions import Cut, Interval, Regions, print_number
from sysmlc.support.disjoint_sets import group_related
from sysmlc.support.units import find_scale, read_number, show_symbol

Values = Mapping[str, Literal]
Numbers = Mapping[str, Fraction]
"""Numbers by feature, as the terms of variables name the features."""


class Quantity(Struct, frozen=True):
    """A number of a feature with its unit, and in words the regions that it is in."""

    number: Fraction
    unit: str = ""
    words: tuple[str, ...] = ()

    def __str__(self) -> str:
        words = f"({', '.join(self.words)})" if self.words else ""
        return " ".join(filter(None, (print_number(self.number), self.unit, words)))

    def export(self) -> dict[str, object]:
        """Return number and unit for JSON."""
        is_whole = self.number.denominator == 1
        number = int(self.number) if is_whole else float(self.number)
        return {"number": number, "unit": self.unit} if self.unit else {"number": number}


StepQuantities = Mapping[str, Mapping[str, Quantity]]
"""For each variable of regions the numbers that texts show in its place, by name of a feature."""


def show_numbers(values: Values, quantities: StepQuantities) -> dict[str, Literal | Quantity]:
    """Return the values of a step with numbers in place of regions."""
    shown: dict[str, Literal | Quantity] = {}
    for name, value in values.items():
        for key, quantity in quantities.get(name, {}).items():
            before = shown.get(key)
            words = (*(before.words if isinstance(before, Quantity) else ()), *quantity.words)
            shown[key] = replace(quantity, words=tuple(dict.fromkeys(words)))
        if name not in quantities:
            shown[name] = value
    return shown


def rename_features(
    quantities: Iterable[StepQuantities], names: Mapping[str, str]
) -> tuple[StepQuantities, ...]:
    """Return the numbers of a run with other names of variables and features."""
    return tuple(
        {
            names.get(name, name): {names.get(key, key): item for key, item in numbers.items()}
            for name, numbers in step.items()
        }
        for step in quantities
    )


def choose_numbers(
    variables: Iterable[Variable],
    steps: Sequence[Values],
    given: Sequence[Numbers] = (),
    limits: Sequence[Fact] = (),
) -> tuple[StepQuantities, ...]:
    """Return numbers for the regions in the steps of a run; nothing if no variable is a region.

    A number stays as long as it fits, else it has few digits. The *given* numbers of the steps
    and the *limits* of sums are respected. A step lacks numbers of features if the component
    decides one of them and its region has several, or if no numbers are in all regions at once.
    """
    chosen: list[dict[str, Mapping[str, Quantity]]] = [{} for _ in steps]
    for group in find_groups(variables, limits):
        for quantities, more in zip(chosen, group.choose(steps, given), strict=True):
            quantities.update(more)
    return tuple(chosen) if any(chosen) else ()


class FeatureGroup(Struct, frozen=True, dict=True):
    """Variables of regions that share features, directly or through others."""

    variables: tuple[Variable, ...]
    limits: tuple[Fact, ...] = ()
    """Sums of the features that are always in an interval."""

    @cached_property
    def features(self) -> Mapping[str, str]:
        """The name of each feature: that of its own variable if it has one."""
        names = {key: key for variable in self.variables for key, _ in variable.term}
        own = (v for v in self._list_single() if not v.is_auxiliary)
        return names | {variable.term[0][0]: variable.name for variable in own}

    @cached_property
    def symbols(self) -> Mapping[str, str]:
        """The unit in which people write each feature: that of its conditions, if they state one.

        Otherwise it is that of another condition in the group, because features of a sum have
        units of one kind.
        """
        own = {v.term[0][0]: _regions_of(v).symbol for v in self._list_single()}
        default = next(filter(None, (_regions_of(v).symbol for v in self.variables)), "")
        return {key: own.get(key) or default for key in self.features}

    @cached_property
    def integral(self) -> frozenset[str]:
        """The features that are Integers."""
        terms = (variable.term for variable in self.variables if _regions_of(variable).is_integral)
        return frozenset(key for term in terms for key, _ in term)

    def _list_single(self) -> list[Variable]:
        return [variable for variable in self.variables if len(variable.term) == 1]

    # -- from regions to numbers -------------------------------------------------------------------

    def choose(
        self, steps: Sequence[Values], given: Sequence[Numbers] = ()
    ) -> Iterator[StepQuantities]:
        """Yield numbers for each step; constants have the same one in all of them."""
        pairs = zip(steps, given or [{}] * len(steps), strict=True)
        systems = [self._list_inequalities(step, numbers) for step, numbers in pairs]
        constants = self._choose_constants(list(filter(None, systems)))
        numbers: Numbers = {}
        for step, system in zip(steps, systems, strict=True):
            solution = None if system is None else _solve(system, {**constants, **numbers})
            if solution is None or any(solution.get(key, 0) % 1 for key in self.integral):
                yield {}
                continue
            numbers = dict.fromkeys(self.features, Fraction(0)) | solution
            yield {
                variable.name: {
                    self.features[key]: self._describe(key, numbers[key], variable, step)
                    for key, _ in variable.term
                }
                for variable in self.variables
                if not variable.is_auxiliary
            }

    def _list_inequalities(self, step: Values, given: Numbers) -> list[Inequality] | None:
        """Return what the regions of a step imply about features, each in its own unit.

        None if a region is not known, or if the component decides a number which it leaves open.
        """
        own_numbers = {key: number for key, number in given.items() if key in self.features}
        rows = [row for key, number in own_numbers.items() for row in _equate(key, number)]
        rows += (row for limit in self.limits for row in list_inequalities(*limit))
        for variable in self.variables:
            index = _find_index(variable, step)
            if index is None:
                return None
            regions = _regions_of(variable)
            if variable.owner is Owner.SYSTEM and not regions.is_point(index):
                return None
            rows += list_inequalities(variable.term, regions.intervals[index])
        return [self._rescale(row) for row in rows]

    def _rescale(self, row: Inequality) -> Inequality:
        scales = {key: find_scale(self.symbols[key]) for key in row.coefficients}
        shift = sum(factor * scales[key][1] for key, factor in row.coefficients.items())
        factors = {key: factor * scales[key][0] for key, factor in row.coefficients.items()}
        return Inequality(factors, row.bound - shift, row.is_strict)

    def _choose_constants(self, systems: Sequence[list[Inequality]]) -> Numbers:
        """Return numbers of the features that never change, which fit in all steps."""
        constants = {key for variable in self.variables for key in variable.constants}
        if not constants:
            return {}
        rows = {
            (number, tuple(sorted(row.coefficients.items())), row.bound, row.is_strict)
            for number, system in enumerate(_list_distinct(systems))
            for row in system
        }
        joint = [
            Inequality(
                {key if key in constants else f"{number} {key}": c for key, c in factors},
                bound,
                is_strict,
            )
            for number, factors, bound, is_strict in sorted(rows)
        ]
        solution = find_solution(joint) or {}
        return {key: solution[key] for key in sorted(constants) if key in solution}

    # -- words -------------------------------------------------------------------------------------

    def _describe(self, key: str, number: Fraction, variable: Variable, step: Values) -> Quantity:
        plain = Quantity(number, show_symbol(self.symbols[key]))
        words = self._describe_region(key, variable, step)
        return plain if words in ("", f"at {plain}") else replace(plain, words=(words,))

    def _describe_region(self, key: str, variable: Variable, step: Values) -> str:
        """Return the region of a variable in words about a feature: ``below low``.

        The words about a sum belong to its first feature that is no constant.
        """
        index = _find_index(variable, step)
        keys = [name for name, _ in variable.term]
        subject = next((name for name in keys if name not in variable.constants), keys[0])
        if index is None or key != subject:
            return ""
        regions = _regions_of(variable)
        interval = regions.intervals[index]
        if interval == Interval():
            return ""
        if len(keys) == 1:
            return regions.words[index]
        compared = _compare_features(dict(variable.term), subject, interval)
        named = [(self.features[name], factor) for name, factor in variable.term]
        left = print_term(tuple((name, factor) for name, factor in named if factor > 0))
        right = print_term(tuple((name, -factor) for name, factor in named if factor < 0))
        return compared or regions.describe(index, left, right)


def _compare_features(factors: Numbers, subject: str, interval: Interval) -> str:
    """Return the interval of a difference of features as ``below high``; empty for others."""
    cuts = [cut for cut in (interval.low, interval.high) if cut is not None]
    if sorted(factors.values()) != [-1, 1] or any(cut.number for cut in cuts):
        return ""
    (other,) = (name for name in factors if name != subject)
    turned = interval.move(factors[subject], Fraction(0))
    return Regions((turned,), labels=((Fraction(0), other),)).words[0]


def _solve(system: list[Inequality], preferred: Numbers) -> dict[str, Fraction] | None:
    """Return a solution with as many of the preferred numbers as possible, in their order."""
    rows = list(system)
    for key, number in preferred.items():
        fixed = [*rows, *_equate(key, number)]
        rows = rows if find_solution(fixed) is None else fixed
    return find_solution(rows)


def _equate(key: str, number: Fraction) -> Iterator[Inequality]:
    """Yield the inequalities that state the number of a feature."""
    point = Interval(Cut(number), Cut(number, is_above=True))
    return list_inequalities(((key, Fraction(1)),), point)


def _list_distinct(systems: Iterable[list[Inequality]]) -> list[list[Inequality]]:
    distinct: list[list[Inequality]] = []
    for system in systems:
        if system not in distinct:
            distinct.append(system)
    return distinct


def find_groups(variables: Iterable[Variable], limits: Sequence[Fact] = ()) -> list[FeatureGroup]:
    """Return the variables of regions in groups with common features, or common *limits*."""
    numeric = [v for v in variables if v.term and regions_of(v.domain) is not None]
    keys = {variable.name: {key for key, _ in variable.term} for variable in numeric}
    related = [{key} for key in set().union(*keys.values())]
    related += ({key for key, _ in term} for term, _ in limits)
    relations = ([name for name in keys if keys[name] & features] for features in related)
    groups = []
    for names in group_related(keys, relations):
        features = set[str]().union(*(keys[name] for name in names))
        own = (limit for limit in limits if features.issuperset(key for key, _ in limit[0]))
        members = (variable for variable in numeric if variable.name in names)
        groups.append(FeatureGroup(tuple(members), tuple(own)))
    return groups


def _regions_of(variable: Variable) -> Regions:
    regions = regions_of(variable.domain)
    assert regions is not None
    return regions


def _find_index(variable: Variable, step: Values) -> int | None:
    literals, value = values(variable.domain), step.get(variable.name)
    return literals.index(value) if value in literals else None


# -- from numbers to regions -----------------------------------------------------------------------


class NumberReader:
    """Numbers that people state for features, and the regions in which they are."""

    def __init__(self, variables: Iterable[Variable]) -> None:
        self._groups = find_groups(variables)
        self._group_of = {key: group for group in self._groups for key in group.features}
        keys = {key: key for key in self._group_of}
        own = {name: key for group in self._groups for key, name in group.features.items()}
        self.keys = keys | own
        """The features by their names: those in terms, and those of variables."""

    def describe(self, key: str) -> str:
        """Return the numbers that a feature can have: ``numbers in °C, 0 °C to 100 °C``."""
        group = self._group_of[key]
        symbol = show_symbol(group.symbols[key])
        kind = "Integers" if key in group.integral else "numbers"
        text = f"{kind} in {symbol}" if symbol else f"{kind} without unit"
        own = [_regions_of(v) for v in group.variables if v.term == ((key, Fraction(1)),)]
        for regions in own:
            limits = Interval(regions.intervals[0].low, regions.intervals[-1].high)
            words = replace(regions, intervals=(limits,)).words
            text += "" if limits == Interval() else f", {words[0]}"
        return text

    def read(self, key: str, text: str) -> Fraction | None:
        """Return the number of a feature that a text states; None for other texts."""
        group = self._group_of[key]
        number = read_number(text, group.symbols[key])
        return None if number is None or (key in group.integral and number % 1) else number

    def find_regions(self, numbers: Numbers) -> Iterator[tuple[Variable, str | None]]:
        """Yield each variable whose features all have numbers, with its region or None."""
        for variable in self._list_variables(numbers):
            if all(key in numbers for key, _ in variable.term):
                number = sum((factor * numbers[key] for key, factor in variable.term), Fraction(0))
                index = _regions_of(variable).find(number)
                yield variable, None if index is None else str(values(variable.domain)[index])

    def list_missing(
        self, stated: Iterable[str], numbers: Numbers
    ) -> Iterator[tuple[Variable, list[str]]]:
        """Yield sums of features with *stated* and without *numbers*, and the latter features."""
        for variable in self._list_variables(stated):
            missing = [key for key, _ in variable.term if key not in numbers]
            if missing:
                yield variable, missing

    def _list_variables(self, keys: Iterable[str]) -> list[Variable]:
        """List the variables of regions, except auxiliary ones, about some of the features."""
        wanted = set(keys)
        return [
            variable
            for group in self._groups
            for variable in group.variables
            if not variable.is_auxiliary and any(key in wanted for key, _ in variable.term)
        ]
