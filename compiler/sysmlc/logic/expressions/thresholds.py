"""Numeric features of a model, and the regions that its conditions and formulas tell apart.

A real feature, and an Integer without a range that is only compared, has no finite domain. All
conditions of a model that compare it cut its values into regions (``sysmlc.logic.regions``), the
same ones for features that connectors join. Differences and sums that are compared, such as
``a - b``, have regions of their own.
"""

from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Mapping
from fractions import Fraction
from functools import cached_property, partial
from itertools import islice, product

from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import (
    Assignment,
    Binary,
    Expression,
    Index,
    Member,
    Name,
    ParsedText,
    Statement,
    dotted_name,
    last_name,
    list_names,
    print_expression,
    walk_tree,
)
from sysmlc.logic.contract import EnumerationDomain
from sysmlc.logic.domains import make_region_domain
from sysmlc.logic.expressions.compared_texts import (
    COMPARISON,
    MAX_LENGTH,
    iter_calculated_names,
    parse_comparison,
)
from sysmlc.logic.expressions.feature_paths import distinguish_paths, iter_paths, merge_paths
from sysmlc.logic.expressions.features import NUMBER_KINDS, find_number_type
from sysmlc.logic.expressions.joined_features import join_features
from sysmlc.logic.expressions.limits import read_limits
from sysmlc.logic.expressions.linear import (
    COMPARISONS,
    Comparison,
    Linear,
    Lookup,
    Number,
    is_antisymmetric,
    list_comparisons,
    read_form,
    read_quantity,
)
from sysmlc.logic.expressions.named_elements import VALUE_KINDS
from sysmlc.logic.expressions.number_uses import MAX_VALUES, Updates, find_other_uses
from sysmlc.logic.expressions.ranges import Bounds, find_bounds
from sysmlc.logic.regions import (
    LINE,
    Cut,
    Interval,
    Regions,
    Term,
    list_cuts,
    split_line,
)

_TEXT_ATTRIBUTES = ("guard", "body", "condition", "value")
_MAX_MEANINGS = 64
"""Most combinations of equally named features that one formula may compare."""
_MAX_ROUNDS = 3
"""How often the cuts of an assigned feature are moved to those that it is computed from."""


class Thresholds:
    """The comparisons of numeric features in a model; use ``thresholds_of``."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._groups = join_features(graph)
        self.revision = graph.revision
        self._cuts: dict[Term, dict[Cut, None]] = defaultdict(dict)
        self._labels: dict[Term, dict[Fraction, str]] = defaultdict(dict)
        self._units: dict[Term, tuple[str, str]] = {}
        self._written: set[str] = set()
        for expression in self._iter_conditions():
            self._add_condition(expression, self.find_number)
        for text in dict.fromkeys(self._iter_formal_texts()):
            if len(text) <= MAX_LENGTH:
                self._add_formal_text(text)
        for _ in range(_MAX_ROUNDS):
            self._pull_cuts_back()
        self.limits = read_limits(graph, self.find_number, self.is_integral, self._joined_keys)
        for key, updates in self._updates.items():
            # Sums need a feature with several values, also if nothing compares it by itself.
            term, value = ((key, Fraction(1)),), updates.values[0]
            is_assigned = key in self._written and not updates.steps
            if term in self._cuts or (is_assigned and len(updates.values) > 1):
                self._cuts[term].update({})
                self._units.setdefault(term, (value.unit or "", value.symbol))

    # -- numbers -----------------------------------------------------------------------------------

    def find_number(self, name: Name | Member) -> Number | None:
        """Return what a name with an element stands for, if that is a number.

        Its values are those of all features that redefine it, which inherit the condition.
        """
        element = self._graph.get(name.element)
        number = None if element is None else self.number_of(element)
        updates = None if number is None else self._updates.get(number.key)
        if number is None or updates is None or len(number.values) != 1:
            return number
        return replace(number, values=updates.values)

    def number_of(self, element: Element) -> Number | None:
        """Return the number that an element is or has; None if its values are no numbers."""
        number = self._read_declared(element)
        if number is None or number.is_constant:
            return number
        return replace(number, values=self._list_values(element, number.key))

    def _list_values(self, element: Element, key: str) -> tuple[Linear, ...]:
        """Return all numbers that a feature can have; none if they are not known or too many."""
        updates = self._updates.get(key)
        if element.attrs.get("direction") not in ("in", "inout"):
            if updates is not None and not updates.steps and key in self._written:
                return updates.values
            if updates is not None and key not in self._written:
                # Each type that redefines a feature has its own value.
                family = (element, *query.redefined_features(self._graph, element))
                values = (self.read_initial(item) for item in family)
                return next(((value,) for value in values if value is not None), ())
        return self._list_range(element)

    def _list_range(self, element: Element) -> tuple[Linear, ...]:
        """Return the values of an Integer with a small declared range."""
        low, high = self._find_bounds(element)
        if low is None or high is None or high - low >= MAX_VALUES:
            return ()
        return tuple(
            Linear(number=Fraction(n), unit="" if n else None) for n in range(low, high + 1)
        )

    def _find_bounds(self, element: Element) -> Bounds:
        """Return the declared bounds of an Integer; none for other elements."""
        if find_number_type(self._graph, element) != "integer":
            return None, None
        type_ = query.type_of(self._graph, element)
        family = [] if type_ is None else [type_, *query.generals(self._graph, type_)]
        return find_bounds(self._graph, element, family, {}, None)

    def _read_declared(self, element: Element) -> Number | None:
        """Return a constant with its value, or a feature without the values that it may have."""
        if element.kind is Kind.INSTANCE:
            value = read_quantity(self._graph, element, "value")
            is_fixed = element.attrs.get("value_kind", "bound") == "bound"
            return Number("", (value,), is_constant=True) if value and is_fixed else None
        if element.kind not in NUMBER_KINDS or not find_number_type(self._graph, element):
            return None
        value = read_quantity(self._graph, element, "default")
        is_frozen = element.attrs.get("readonly") is True
        if value is not None and is_frozen:
            return Number("", (value,), is_constant=True)
        return Number(self._groups.find(element.id), is_frozen=is_frozen)

    def read_initial(self, feature: Element) -> Linear | None:
        """Return the initial value of a feature, which may name a constant."""
        instance = self._graph.get(str(feature.attrs.get("default_instance")))
        constant = None if instance is None else self._read_declared(instance)
        if constant is not None and constant.is_constant:
            return constant.values[0]
        return read_quantity(self._graph, feature, "default", self.find_declared)

    def find_declared(self, name: Name | Member) -> Number | None:
        """Return a constant, or a feature without the values that it may have."""
        element = self._graph.get(name.element)
        return None if element is None else self._read_declared(element)

    @cached_property
    def _updates(self) -> dict[str, Updates]:
        """The initial values and the assignments of the features that nothing else changes."""
        values: dict[str, list[Linear]] = defaultdict(list)
        steps: dict[str, list[Fraction]] = defaultdict(list)
        open_keys: set[str] = set()
        decided: set[str] = set()
        for feature in self._graph.of_kind(*VALUE_KINDS):
            number = self._read_declared(feature)
            if number is None or number.is_constant:
                continue
            initial = self.read_initial(feature)
            values[number.key] += [initial] if initial is not None else []
            if feature.attrs.get("direction") not in ("in", "inout"):
                decided.add(number.key)
        for key, value in self._iter_writes():
            self._written.add(key)
            form = None if value is None else read_form(value, self.find_declared)
            if form is not None and not form.factors:
                values[key].append(form)
            elif form is not None and form.factors == {key: 1}:
                steps[key].append(form.number)
            else:
                open_keys.add(key)
        return {
            key: Updates(tuple(distinct.values()), tuple(steps[key]))
            for key, numbers in values.items()
            if key in decided - open_keys
            and 0 < len(distinct := {(n.number, n.unit): n for n in numbers}) <= MAX_VALUES
        }

    @cached_property
    def _joined_keys(self) -> frozenset[str]:
        """The keys that several features share."""
        features = self._graph.of_kind(*VALUE_KINDS)
        counts = Counter(self._groups.find(feature.id) for feature in features)
        return frozenset(key for key, count in counts.items() if count > 1)

    # -- texts of the model ------------------------------------------------------------------------

    def _iter_nodes(self) -> Iterator[tuple[Element, Expression | Statement]]:
        for element in self._graph:
            for key in _TEXT_ATTRIBUTES:
                value = element.attrs.get(key)
                if isinstance(value, ParsedText):
                    for node in walk_tree(value.tree):
                        yield element, node

    def _iter_conditions(self) -> Iterator[Binary]:
        for _, node in self._iter_nodes():
            if isinstance(node, Binary) and node.op in COMPARISONS:
                # ``level`` belongs to both comparisons of ``0 <= level <= 7``.
                if isinstance(node.left, Binary) and node.left.op in COMPARISONS:
                    node = Binary(node.op, node.left.right, node.right)
                yield node

    def _iter_writes(self) -> Iterator[tuple[str, Expression | None]]:
        """Yield the keys of assigned numbers with the values; None for a value that is no text."""
        for element, node in self._iter_nodes():
            if isinstance(node, Assignment) and isinstance(node.target, Name | Member):
                yield from self._name_written(self._graph.get(node.target.element), node.value)
            is_output = element.kind is Kind.PIN and element.attrs.get("direction") == "out"
            if is_output and isinstance(node, Name | Member):
                yield from self._name_written(self._graph.get(node.element), None)
        for action in self._graph.of_kind(Kind.ACTION):
            if action.subkind == "write":
                yield from self._name_written(self._graph.target(action, Edge.CALLS), None)
        for behaviour in self._graph.of_kind(Kind.ACTION, *query.BEHAVIORS):
            body = behaviour.attrs.get("body")
            # A text in a language that is not read may assign whatever it names.
            if isinstance(body, str) and not isinstance(body, ParsedText):
                for name in dict.fromkeys(list_names(body)):
                    for element in self._elements_by_name.get(name, ()):
                        yield from self._name_written(element, None)

    def _name_written(
        self, feature: Element | None, value: Expression | None
    ) -> Iterator[tuple[str, Expression | None]]:
        number = None if feature is None else self._read_declared(feature)
        if number is not None and not number.is_constant:
            yield number.key, value

    @cached_property
    def _other_uses(self) -> set[str]:
        """The keys of the numbers that are used otherwise than in comparisons and own updates."""
        used: set[str] = set()
        for element in self._graph:
            for key in _TEXT_ATTRIBUTES:
                value = element.attrs.get(key)
                if isinstance(value, ParsedText):
                    used |= find_other_uses(value.tree, self.find_declared)
        return used

    def _iter_formal_texts(self) -> Iterator[str]:
        """Yield the texts of constraints in which not all names are resolved."""
        for constraint in self._graph.of_kind(Kind.CONSTRAINT):
            body = constraint.attrs.get("body")
            if isinstance(body, str) and not (isinstance(body, ParsedText) and _is_resolved(body)):
                yield body

    def _add_formal_text(self, text: str) -> None:
        """Add the comparisons in a formula, of all features with the names in it.

        The subject of a formula is not looked up: cuts of other features change no meaning. Their
        units and words do, so that features of one owner state these if there are any.
        """
        for match in COMPARISON.finditer(text):
            expression = parse_comparison(match[0])
            if expression is None:
                continue
            features = dict.fromkeys(map(_last_name, iter_paths(expression)))
            # The subject in ``heater.temp < 22 [K]`` is no number.
            names = [name for name in features if self._find_numbers(name)]
            candidates = [self._find_numbers(name) for name in names]
            meanings = list(islice(product(*candidates), _MAX_MEANINGS))
            own = [meaning for meaning in meanings if self._has_one_owner(meaning)]
            for meaning in meanings:
                find = partial(_find_by_name, dict(zip(names, meaning, strict=True)))
                self._add_condition(expression, find, is_meant=not own or meaning in own)
                self._other_uses |= find_other_uses(expression, find)
        for name in map(last_name, iter_calculated_names(text)):
            self._other_uses |= {number.key for number in self._find_numbers(name)}

    def _find_numbers(self, name: str) -> list[Number]:
        """Return the different numbers that a name may denote."""
        numbers = [(item.id, self.number_of(item)) for item in self._elements_by_name.get(name, ())]
        distinct = {number.key or id: number for id, number in numbers if number is not None}
        return list(distinct.values())

    def _has_one_owner(self, numbers: Collection[Number]) -> bool:
        keys = (number.key for number in numbers if number.key)
        owners = (self._graph.owner(self._graph[key]) for key in keys)
        return len({owner.id for owner in owners if owner is not None}) <= 1

    @cached_property
    def _elements_by_name(self) -> Mapping[str, list[Element]]:
        elements: dict[str, list[Element]] = defaultdict(list)
        for element in self._graph.of_kind(*VALUE_KINDS, Kind.INSTANCE):
            elements[element.name].append(element)
        return elements

    # -- cuts --------------------------------------------------------------------------------------

    def _add_condition(
        self, expression: Expression, find: Lookup, *, is_meant: bool = True
    ) -> None:
        """Add the cuts of a comparison; one that *is_meant* states their unit and words, too."""
        if not isinstance(expression, Binary):
            return
        for comparison in list_comparisons(expression, distinguish_paths(expression, find)):
            term, number, unit = merge_paths(comparison.term), comparison.number, comparison.unit
            if not term or unit not in (None, self._units.get(term, (unit,))[0]):
                # In a formula, the threshold 'low' of a level may have the name of a temperature.
                continue
            for cut in list_cuts(comparison.op, number, is_integral=self.is_integral(term)):
                self._cuts[term][cut] = None
                if is_antisymmetric(term):  # The difference of two parts may be meant either way.
                    self._cuts[term][Cut(-cut.number, not cut.is_above)] = None
            if unit is not None and is_meant:
                self._units.setdefault(term, (unit, comparison.symbol))
            if is_meant:
                self._add_label(expression, find, comparison)

    def _add_label(self, expression: Binary, find: Lookup, comparison: Comparison) -> None:
        """Record how the author writes the number with which a feature is compared."""
        sides = expression.left, expression.right
        for feature, side in (sides, sides[::-1]):
            number = find(feature) if isinstance(feature, Name | Member) else None
            if number is not None and ((number.key, Fraction(1)),) == comparison.term:
                text = _write_side(side)
                if text:
                    self._labels[comparison.term].setdefault(comparison.number, text)

    def _pull_cuts_back(self) -> None:
        """Cut a feature where the value that an assignment computes from it meets a cut.

        The cut b of ``x := 2*y + c`` is the cut (b - c)/2 of y.
        """
        for key, value in list(self._iter_writes()):
            form = None if value is None else read_form(value, self.find_declared)
            if form is None or len(form.factors) != 1 or form.factors == {key: 1}:
                continue
            ((source, factor),) = form.factors.items()
            target, term = ((key, Fraction(1)),), ((source, Fraction(1)),)
            for cut in list(self._cuts.get(target, ())):
                interval = Interval(cut).move(1 / factor, -form.number / factor)
                interval = interval.round_up() if self.is_integral(term) else interval
                for end in (interval.low, interval.high):
                    if end is not None:
                        self._cuts[term][end] = None
                        self._units.setdefault(term, (form.unit or "", form.symbol))

    def _is_own(self, feature: Element, owner: Element | None) -> bool:
        """Whether a feature is a constant, or one of *owner* that no other type redefines."""
        number = self._read_declared(feature)
        is_constant = number is not None and number.is_constant
        is_redefined = any(True for _ in self._graph.sources(feature, Edge.REDEFINES))
        is_redefining = any(True for _ in self._graph.targets(feature, Edge.REDEFINES))
        is_single = not (is_redefined or is_redefining)
        return is_constant or (self._graph.owner(feature) is owner and is_single)

    def is_integral(self, term: Term) -> bool:
        """Whether a term has only Integers as values."""
        return all(
            factor.denominator == 1 and find_number_type(self._graph, self._graph[key]) == "integer"
            for key, factor in term
        )

    # -- results -----------------------------------------------------------------------------------

    @cached_property
    def domains(self) -> Mapping[Term, EnumerationDomain]:
        """The regions of each compared term, as an enumeration."""
        return {term: self._make_domain(term) for term in self._cuts}

    def _make_domain(self, term: Term) -> EnumerationDomain:
        cuts, limits = list(self._cuts[term]), self.limits.everywhere.get(term, LINE)
        if self._written & {key for key, _ in term}:
            limits = LINE  # Behaviours may break what a constraint states.
        if len(term) == 1:
            limits = limits.intersect(self._find_range(term[0][0])) or limits
        updates = self._updates.get(term[0][0]) if len(term) == 1 else None
        points = () if updates is None else updates.list_points(cuts)
        is_integral = self.is_integral(term)
        cuts += [cut for point in points for cut in list_cuts("==", point, is_integral=is_integral)]
        intervals = split_line(cuts, limits)
        if updates is not None and updates.steps and points:
            # Nothing else is reachable; a step from one region leads to another one.
            intervals = tuple(
                item
                for item in intervals
                if any(map(item.contains, points))
                or (item.high is None and any(step > 0 for step in updates.steps))
                or (item.low is None and any(step < 0 for step in updates.steps))
            )
        labels = tuple(self._labels[term].items())
        unit, symbol = self._units.get(term, ("", ""))
        return make_region_domain(Regions(intervals, unit, is_integral, labels, symbol))

    def _find_range(self, key: str) -> Interval:
        """Return the numbers in a declared range of a feature, or of one that is joined to it."""
        bounds = [self._find_bounds(member) for member in self._members[key]]
        lows = [low for low, _ in bounds if low is not None]
        highs = [high for _, high in bounds if high is not None]
        return Interval(
            Cut(Fraction(min(lows))) if len(lows) == len(bounds) else None,
            Cut(Fraction(max(highs) + 1)) if len(highs) == len(bounds) else None,
        )

    def is_assigned(self, number: Number) -> bool:
        """Whether a behaviour assigns the feature."""
        return number.key in self._written

    @property
    def has_sums(self) -> bool:
        """Whether a sum of several features is compared."""
        return any(len(term) > 1 for term in self._cuts)

    def domain_of(self, number: Number) -> EnumerationDomain | None:
        """Return the regions of a feature; None if nothing compares it."""
        return self.domains.get(((number.key, Fraction(1)),))

    def is_only_compared(self, number: Number) -> bool:
        """Whether regions describe all that the model does with an Integer."""
        return number.key in self._only_compared

    @cached_property
    def _only_compared(self) -> set[str]:
        """The keys of the Integers of which the regions describe all that the model does."""
        keys = {key for key, members in self._members.items() if self._is_regional(key, members)}
        sums = [{key for key, _ in term} for term in self._cuts if len(term) > 1]
        while True:
            # A sum has regions only if none of its Integers has a range.
            mixed = [names & keys for names in sums if any(map(self._is_ranged, names - keys))]
            if not any(mixed):
                return keys
            keys -= set().union(*mixed)

    def _is_ranged(self, key: str) -> bool:
        return find_number_type(self._graph, self._graph[key]) == "integer"

    @cached_property
    def _members(self) -> Mapping[str, list[Element]]:
        """The features that have one value, by their key."""
        members: dict[str, list[Element]] = defaultdict(list)
        for element in self._graph.of_kind(*NUMBER_KINDS):
            number = self._read_declared(element)
            if number is not None and number.key:
                members[number.key].append(element)
        return members

    def _is_regional(self, key: str, members: list[Element]) -> bool:
        """Whether a feature is compared and changed only in ways that regions describe."""
        updates, is_assigned = self._updates.get(key), key in self._written
        if key in self._other_uses or (is_assigned and updates is None):
            return False
        if any(None not in self._find_bounds(member) for member in members):
            return False
        terms = [term for term in self._cuts if any(key == name for name, _ in term)]
        if not terms or any(member.kind is not Kind.PROPERTY for member in members):
            return False
        if updates is None or not updates.steps:
            return True
        term = ((key, Fraction(1)),)
        return terms == [term] and self._has_regions_for_steps(term, updates)

    def _has_regions_for_steps(self, term: Term, updates: Updates) -> bool:
        """Whether each step leads from a region into a single one."""
        regions = self.domains[term].regions
        return (
            regions is not None
            and bool(updates.list_points(self._cuts[term]))
            and all(
                any(target.includes(source.move(Fraction(1), step)) for target in regions.intervals)
                for source in regions.intervals
                for step in updates.steps
            )
        )

    def list_terms(
        self, variables: Mapping[str, list[str]]
    ) -> Iterator[tuple[Term, EnumerationDomain]]:
        """Yield the compared sums of several features of a context, with their regions.

        *variables* are the variables of the context by the keys of their features. The terms
        consist of variables.
        """
        for term, domain in self.domains.items():
            regions = domain.regions
            if len(term) > 1 and regions is not None:
                for own, scale in _iter_meanings(term, variables):
                    is_same = scale == 1
                    yield own, domain if is_same else make_region_domain(regions.scale(scale))

    def list_facts(
        self, variables: Mapping[str, list[str]], blocks: Collection[str]
    ) -> Iterator[tuple[Term, Interval]]:
        """Yield the sums of variables that constraints keep in an interval, as ``list_terms``.

        The variables belong to one object, which is one of each of the *blocks*.
        """
        for term, limits in (*self.limits.list_facts(blocks), *self._summand_limits):
            if not self._written & {key for key, _ in term}:
                for own, scale in _iter_meanings(term, variables):
                    yield own, limits.move(scale, Fraction(0))

    @cached_property
    def _summand_limits(self) -> list[tuple[Term, Interval]]:
        """The intervals of the single features in sums, by constraints and declared ranges."""
        keys = {key for term in self._cuts if len(term) > 1 for key, _ in term}
        limits: list[tuple[Term, Interval]] = []
        for key in sorted(keys):
            term = ((key, Fraction(1)),)
            interval = self.limits.everywhere.get(term, LINE).intersect(self._find_range(key))
            if interval not in (None, LINE):
                limits.append((term, interval))
        return limits


def _iter_meanings(
    term: Term, variables: Mapping[str, list[str]]
) -> Iterator[tuple[Term, Fraction]]:
    """Yield a term in variables, and the factor by which it is a multiple of the term in keys."""
    for names in product(*(variables.get(key, ()) for key, _ in term)):
        if len(set(names)) < len(names):
            continue
        factors = (factor for _, factor in term)
        sum_of_variables = sorted(zip(names, factors, strict=True))
        scale = 1 / sum_of_variables[0][1]
        yield tuple((name, factor * scale) for name, factor in sum_of_variables), scale


def thresholds_of(graph: Graph) -> Thresholds:
    """Return the thresholds of a graph; they are collected again after a change."""
    for thresholds in graph.derived(Thresholds):
        if thresholds.revision == graph.revision:
            return thresholds
    thresholds = Thresholds(graph)
    graph.store(Thresholds, (thresholds,))
    return thresholds


def _is_resolved(text: ParsedText[Expression | tuple[Statement, ...]]) -> bool:
    """Whether all names have elements: not in ``G (x < 3)``, which may be read as a call of G."""
    return all(path.element for path in iter_paths(text.tree))


def _write_side(side: Expression) -> str:
    """Return a constant or a quantity as the author writes it; empty for other expressions."""
    if isinstance(side, Name | Member):
        return _last_name(side)
    if isinstance(side, Index):
        return print_expression(side).translate(str.maketrans("", "", "[]'")).removesuffix("_abs")
    return ""


def _find_by_name(numbers: Mapping[str, Number], node: Name | Member) -> Number | None:
    return numbers.get(_last_name(node))


def _last_name(node: Name | Member) -> str:
    return last_name(dotted_name(node) or "")
