"""Numeric features of a model, and the regions that its conditions and formulas tell apart.

A real feature, and an Integer without a range that is only compared, has no finite domain. All
conditions of a model that compare it cut its values into regions (``sysmlc.logic.regions``), the
same ones for features that connectors join. Differences and sums that are compared, such as
``a - b``, have regions of their own.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from fractions import Fraction
from functools import cached_property, partial, reduce
from itertools import islice, product
from math import ceil, floor, gcd

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import (
    Assignment,
    Binary,
    Expression,
    ExpressionError,
    Index,
    Member,
    Name,
    ParsedText,
    Statement,
    dotted_name,
    last_name,
    print_expression,
    walk_tree,
)
from sysmlc.logic.contract import EnumerationDomain
from sysmlc.logic.domains import make_region_domain
from sysmlc.logic.expressions.features import find_number_type
from sysmlc.logic.expressions.limits import iter_paths, read_limits
from sysmlc.logic.expressions.linear import (
    COMPARISONS,
    Comparison,
    Linear,
    Lookup,
    Number,
    UnitError,
    iter_comparisons,
    read_linear,
    read_quantity,
)
from sysmlc.logic.expressions.named_elements import VALUE_KINDS
from sysmlc.logic.expressions.parsing import parse_expression
from sysmlc.logic.regions import (
    LINE,
    Cut,
    Interval,
    Regions,
    Term,
    list_cuts,
    split_line,
)
from sysmlc.support.disjoint_sets import DisjointSets

_TEXT_ATTRIBUTES = ("guard", "body", "condition", "value")
_OPERAND = r"(?:-\s*)?{atom}(?:\s*[-+*/]\s*{atom})*".format(
    atom=r"(?:\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?:\s*\[[^\]\n]+\])?|[^\W\d]\w*(?:(?:\.|::)[^\W\d]\w*)*)"
)
COMPARISON = re.compile(rf"(?<![\w.]){_OPERAND}\s*(?:<=|>=|==|!=|=|<|>)\s*{_OPERAND}(?![\w.(])")
"""A comparison of sums in a formula or a sentence, without parentheses."""
_PATH = "\0"
"""Separates the key of a feature from the path to it."""
_MAX_MEANINGS = 64
"""Most combinations of equally named features that one formula may compare."""
_MAX_VALUES = 64
"""Most assigned constants of a feature that are told apart."""


def parse_comparison(text: str) -> Expression | None:
    """Return the comparison in a formula, in which ``=`` and ``==`` are the same; None if none."""
    try:
        return parse_expression(text)
    except ExpressionError:
        return None


class _Updates(Struct, frozen=True):
    """How the behaviours of a model change a feature: they assign numbers, or add numbers to it.

    The initial value is one of the numbers.
    """

    values: tuple[Linear, ...]
    steps: tuple[Fraction, ...] = ()

    def list_points(self, cuts: Iterable[Cut]) -> tuple[Fraction, ...]:
        """Return the values that are told apart; all between the outer cuts.

        None are if nothing changes the feature, or if there are too many.
        """
        numbers = sorted({value.number for value in self.values})
        if not self.steps:
            return tuple(numbers) if len(numbers) > 1 else ()
        differences = (number - numbers[0] for number in numbers[1:])
        width = reduce(_find_common_measure, (*self.steps, *differences))
        if not width:
            return ()
        ends = [*numbers, *(cut.number for cut in cuts)]
        first = numbers[0] + width * floor((min(ends) - numbers[0]) / width)
        last = numbers[0] + width * ceil((max(ends) - numbers[0]) / width)
        count = int((last - first) / width) + 1
        return tuple(first + width * i for i in range(count)) if count <= _MAX_VALUES else ()


def _find_common_measure(left: Fraction, right: Fraction) -> Fraction:
    """Return the greatest number of which both are multiples."""
    scale = left.denominator * right.denominator
    return Fraction(gcd(int(left * scale), int(right * scale)), scale)


class Thresholds:
    """The comparisons of numeric features in a model; use ``thresholds_of``."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self.revision = graph.revision
        self._cuts: dict[Term, dict[Cut, None]] = defaultdict(dict)
        self._labels: dict[Term, dict[Fraction, str]] = defaultdict(dict)
        self._units: dict[Term, tuple[str, str]] = {}
        self._written: set[str] = set()
        for expression in self._iter_conditions():
            self._add_condition(expression, self.find_number)
        for text in self._iter_formal_texts():
            self._add_formal_text(text)
        self.limits = read_limits(graph, self.find_number, self.is_integral, self._joined_keys)
        for key, values in self._values.items():
            # Sums need a feature with several values, also if nothing compares it by itself.
            term = ((key, Fraction(1)),)
            if len(values) > 1 or term in self._cuts:
                self._cuts[term].update({})
                self._units.setdefault(term, (values[0].unit or "", values[0].symbol))

    # -- numbers -----------------------------------------------------------------------------------

    def find_number(self, name: Name | Member) -> Number | None:
        """Return what a name with an element stands for, if that is a number."""
        element = self._graph.get(name.element)
        return None if element is None else self.number_of(element)

    def number_of(self, element: Element) -> Number | None:
        """Return the number that an element is or has; None if its values are no numbers."""
        number = self._read_declared(element)
        if number is None or number.is_constant:
            return number
        return replace(number, values=self._values.get(number.key, ()))

    def _read_declared(self, element: Element) -> Number | None:
        """Return a constant with its value, or a feature without the values that it may have."""
        if element.kind is Kind.INSTANCE:
            value = read_quantity(self._graph, element, "value")
            is_fixed = element.attrs.get("value_kind", "bound") == "bound"
            return Number("", (value,), is_constant=True) if value and is_fixed else None
        if element.kind not in VALUE_KINDS or not find_number_type(self._graph, element):
            return None
        value = read_quantity(self._graph, element, "default")
        is_frozen = element.attrs.get("readonly") is True
        if value is not None and is_frozen:
            return Number("", (value,), is_constant=True)
        return Number(self._groups.find(element.id), is_frozen=is_frozen)

    def _find_declared(self, name: Name | Member) -> Number | None:
        element = self._graph.get(name.element)
        return None if element is None else self._read_declared(element)

    @cached_property
    def _values(self) -> dict[str, tuple[Linear, ...]]:
        """The numbers that features can have which only constants are assigned to, by their keys.

        A feature whose initial value is not known, and one that something else may set, has none.
        """
        return {key: write.values for key, write in self._updates.items() if not write.steps}

    @cached_property
    def _updates(self) -> dict[str, "_Updates"]:
        """The initial values and the assignments of the features that nothing else changes."""
        values: dict[str, list[Linear]] = defaultdict(list)
        steps: dict[str, list[Fraction]] = defaultdict(list)
        open_keys: set[str] = set()
        decided: set[str] = set()
        for feature in self._graph.of_kind(*VALUE_KINDS):
            number = self._read_declared(feature)
            if number is None or number.is_constant:
                continue
            initial = read_quantity(self._graph, feature, "default")
            values[number.key] += [initial] if initial is not None else []
            if feature.attrs.get("direction") not in ("in", "inout"):
                decided.add(number.key)
        for key, value in self._iter_writes():
            self._written.add(key)
            form = None if value is None else _read(value, self._find_declared)
            if form is not None and not form.factors:
                values[key].append(form)
            elif form is not None and form.factors == {key: 1}:
                steps[key].append(form.number)
            else:
                open_keys.add(key)
        return {
            key: _Updates(tuple(distinct.values()), tuple(steps[key]))
            for key, numbers in values.items()
            if key in decided - open_keys
            and 0 < len(distinct := {(n.number, n.unit): n for n in numbers}) <= _MAX_VALUES
        }

    @cached_property
    def _groups(self) -> DisjointSets[str]:
        """The features that have one value: those that connectors join, and redefinitions."""
        joined: DisjointSets[str] = DisjointSets()
        graph = self._graph
        for feature in graph.of_kind(Kind.PROPERTY):
            for redefined in graph.targets(feature, Edge.REDEFINES):
                joined.union(redefined.id, feature.id)
        for connector in graph.of_kind(Kind.CONNECTOR):
            roles = [
                role
                for end in query.ends(graph, connector)
                for role in graph.targets(end, Edge.ROLE)
            ]
            self._join(joined, roles)
        for flow in graph.of_kind(Kind.ITEM_FLOW):
            edges = Edge.FLOW_SOURCE, Edge.FLOW_TARGET
            ends = [graph.target(flow, edge) for edge in edges]
            self._join(joined, [end for end in ends if end is not None])
        return joined

    @cached_property
    def _joined_keys(self) -> frozenset[str]:
        """The keys that several features share."""
        features = self._graph.of_kind(*VALUE_KINDS)
        counts = Counter(self._groups.find(feature.id) for feature in features)
        return frozenset(key for key, count in counts.items() if count > 1)

    def _join(self, joined: DisjointSets[str], features: list[Element]) -> None:
        """Join features, or the equally named features of the types of ports."""
        for feature in features[1:]:
            joined.union(features[0].id, feature.id)
        types = [query.type_of(self._graph, feature) for feature in features]
        members: dict[str, Element] = {}
        for type_ in filter(None, types):
            for member in query.features(self._graph, type_):
                first = members.setdefault(member.name, member)
                if first is not member and member.name:
                    joined.union(first.id, member.id)

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

    def _name_written(
        self, feature: Element | None, value: Expression | None
    ) -> Iterator[tuple[str, Expression | None]]:
        number = None if feature is None else self._read_declared(feature)
        if number is not None and not number.is_constant:
            yield number.key, value

    def _iter_formal_texts(self) -> Iterator[str]:
        for element in self._graph:
            body = element.attrs.get("body")
            if isinstance(body, str) and not (isinstance(body, ParsedText) and _is_resolved(body)):
                yield body

    def _add_formal_text(self, text: str) -> None:
        """Add the comparisons in a formula, of all features with the names in it.

        The subject of a formula is not looked up: cuts of other features change no meaning.
        """
        for match in COMPARISON.finditer(text):
            expression = parse_comparison(match[0])
            if expression is None:
                continue
            features = dict.fromkeys(map(_last_name, _list_features(expression)))
            # The subject in ``heater.temp < 22 [K]`` is no number.
            names = [name for name in features if name in self._numbers_by_name]
            candidates = [self._numbers_by_name[name] for name in names]
            for meaning in islice(product(*candidates), _MAX_MEANINGS):
                numbers = dict(zip(names, meaning, strict=True))
                self._add_condition(expression, partial(_find_by_name, numbers))

    @cached_property
    def _numbers_by_name(self) -> Mapping[str, list[Number]]:
        numbers: dict[str, dict[str, Number]] = defaultdict(dict)
        for kind in (*VALUE_KINDS, Kind.INSTANCE):
            for element in self._graph.of_kind(kind):
                number = self.number_of(element)
                if number is not None and element.name:
                    numbers[element.name][number.key or element.id] = number
        return {name: list(items.values()) for name, items in numbers.items()}

    # -- cuts --------------------------------------------------------------------------------------

    def _add_condition(self, expression: Expression, find: Lookup) -> None:
        if not isinstance(expression, Binary):
            return
        for comparison in _list_comparisons(expression, _distinguish_paths(expression, find)):
            term, number = _merge_paths(comparison.term), comparison.number
            if not term:
                continue
            for cut in list_cuts(comparison.op, number, is_integral=self.is_integral(term)):
                self._cuts[term][cut] = None
                if _is_antisymmetric(term):  # The difference of two parts may be meant either way.
                    self._cuts[term][Cut(-cut.number, not cut.is_above)] = None
            if comparison.unit is not None:
                self._units.setdefault(term, (comparison.unit, comparison.symbol))
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
        for term, limits in self.limits.list_facts(blocks):
            for own, scale in _iter_meanings(term, variables):
                yield own, limits.move(scale, Fraction(0))


def _iter_meanings(
    term: Term, variables: Mapping[str, list[str]]
) -> Iterator[tuple[Term, Fraction]]:
    """Yield a term in variables, and the factor by which it is a multiple of the term in keys."""
    for names in product(*(variables.get(key, ()) for key, _ in term)):
        if len(set(names)) < len(names):
            continue
        factors = (factor for _, factor in term)
        own = sorted(zip(names, factors, strict=True))
        scale = 1 / own[0][1]
        yield tuple((name, factor * scale) for name, factor in own), scale


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
    nodes = (node for node in walk_tree(text.tree) if isinstance(node, Name | Member))
    return all(node.element for node in nodes)


def _list_features(expression: Expression) -> list[Name | Member]:
    """Return the names in an expression except those of units."""
    nodes = list(walk_tree(expression))
    units = [unit for node in nodes if isinstance(node, Index) for unit in walk_tree(node.index)]
    return [node for node in nodes if isinstance(node, Name | Member) and node not in units]


def _distinguish_paths(expression: Expression, find: Lookup) -> Lookup:
    """Return a lookup with a key for each path to a feature if several lead to the same one.

    ``left.level - right.level`` is not zero if both parts have the same type.
    """
    numbers = {dotted_name(path): find(path) for path in iter_paths(expression)}
    keys = [number.key for number in numbers.values() if number is not None and number.key]
    if len(set(keys)) == len(keys):
        return find

    def find_path(path: Name | Member) -> Number | None:
        number = find(path)
        if number is None or not number.key:
            return number
        return replace(number, key=f"{number.key}{_PATH}{dotted_name(path)}")

    return find_path


def _merge_paths(term: Term) -> Term:
    return tuple((key.partition(_PATH)[0], factor) for key, factor in term)


def _is_antisymmetric(term: Term) -> bool:
    """Whether a term is the difference of one feature in two objects."""
    (first, _), (second, factor) = term if len(term) == 2 else (("", 1), (" ", 1))
    return first == second and factor == -1


def _list_comparisons(expression: Binary, find: Lookup) -> list[Comparison]:
    try:
        return [comparison for _, comparison in iter_comparisons(expression, find)]
    except UnitError:
        return []


def _read(expression: Expression, find: Lookup) -> Linear | None:
    try:
        return read_linear(expression, find)
    except UnitError:
        return None


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
