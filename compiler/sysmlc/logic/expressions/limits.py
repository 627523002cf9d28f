"""Intervals in which the constraints of blocks keep numbers."""

from collections.abc import Callable, Collection, Iterator, Mapping

from msgspec import Struct

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import (
    Binary,
    Expression,
    Member,
    Name,
    ParsedText,
    dotted_name,
    print_expression,
)
from sysmlc.logic.expressions.feature_paths import iter_paths
from sysmlc.logic.expressions.linear import (
    COMPARISONS,
    Lookup,
    Number,
    UnitError,
    iter_comparisons,
)
from sysmlc.logic.regions import LINE, Interval, Term, select_interval

_MOMENTARY = frozenset(["precondition", "postcondition", "body"])
"""Kinds of constraints that do not hold at all times."""
_SELF = ("self", "this")


class Limits(Struct, frozen=True):
    """What the constraints of blocks state about numbers.

    ``everywhere`` has the intervals of terms wherever their features occur. ``local`` has those
    that apply in the objects of a block only, by its id: the features are inherited, or joined with
    features of other blocks. ``unread`` has the texts of all other constraints by the keys of the
    features that they restrict: runs may have values that these exclude.
    """

    everywhere: Mapping[Term, Interval]
    local: tuple[tuple[str, Term, Interval], ...]
    unread: Mapping[str, str]

    @property
    def has_facts(self) -> bool:
        """Whether a constraint is more than the interval of a single feature."""
        return bool(self.local) or any(len(term) > 1 for term in self.everywhere)

    def list_facts(self, blocks: Collection[str]) -> Iterator[tuple[Term, Interval]]:
        """Yield the facts about the features of an object that is one of each of the *blocks*."""
        yield from ((term, limits) for term, limits in self.everywhere.items() if len(term) > 1)
        yield from ((term, limits) for block, term, limits in self.local if block in blocks)


def read_limits(
    graph: Graph, find: Lookup, is_integral: Callable[[Term], bool], joined: Collection[str]
) -> Limits:
    """Return the limits of a model; *joined* are the keys of several features each."""
    everywhere: dict[Term, Interval] = {}
    local: list[tuple[str, Term, Interval]] = []
    unread: dict[str, str] = {}
    for block, part in _iter_parts(graph):
        if block.kind is Kind.DATA_TYPE:
            for term, interval in _limit_values(graph, block, part, find, is_integral):
                narrowed = everywhere.get(term, LINE).intersect(interval)
                everywhere[term] = interval if narrowed is None else narrowed
            continue
        numbers = {path: find(path) for path in iter_paths(part)}
        keys = {path: n.key for path, n in numbers.items() if n is not None and not n.is_constant}
        term, interval = _read_part(part, find, is_integral)
        is_own = all(_belongs_to(block, path, graph) for path in keys)
        if not term or not all(map(_is_plain, keys)):
            unread |= dict.fromkeys(keys.values(), print_expression(part))
        elif is_own and not set(keys.values()) & set(joined):
            limits = everywhere.get(term, LINE).intersect(interval)
            everywhere[term] = limits or everywhere[term]
        else:
            local.append((block.id, term, interval))
    return Limits(everywhere, tuple(local), unread)


def _limit_values(
    graph: Graph,
    type_: Element,
    part: Expression,
    find: Lookup,
    is_integral: Callable[[Term], bool],
) -> Iterator[tuple[Term, Interval]]:
    """Yield the interval of each feature of a value type that states one about ``self``."""
    special = (t for t in graph.of_kind(Kind.DATA_TYPE) if type_ in query.generals(graph, t))
    for feature in (f for t in (type_, *special) for f in graph.sources(t, Edge.TYPED_BY)):
        value = find(Name((feature.name,), feature.id))

        def find_value(path: Name | Member, value: Number | None = value) -> Number | None:
            is_value = dotted_name(path) in (*_SELF, "value", type_.name)
            return value if is_value else find(path)

        term, interval = _read_part(part, find_value, is_integral)
        if value is not None and [key for key, _ in term] == [value.key]:
            yield term, interval


def _iter_parts(graph: Graph) -> Iterator[tuple[Element, Expression]]:
    """Yield the parts of the constraints that always hold, and the blocks that have them."""
    for constraint in graph.of_kind(Kind.CONSTRAINT):
        body, block = constraint.attrs.get("body"), graph.owner(constraint)
        if block is None or block.kind not in (Kind.CLASS, Kind.COMPONENT, Kind.DATA_TYPE):
            continue
        # What a requirement demands, or assumes, is no fact.
        if query.is_requirement(block):
            continue
        is_lasting = constraint.subkind not in _MOMENTARY
        if is_lasting and isinstance(body, ParsedText) and not isinstance(body.tree, tuple):
            yield from ((block, part) for part in split_conjunction(body.tree))


def _read_part(
    part: Expression, find: Lookup, is_integral: Callable[[Term], bool]
) -> tuple[Term, Interval]:
    """Return the term that a comparison keeps in an interval; an empty term if it is no such."""
    try:
        comparisons = list(iter_comparisons(part, find)) if isinstance(part, Binary) else []
    except UnitError:
        comparisons = []
    # A comparison with a feature that is assigned several numbers holds for some of them.
    if len(comparisons) != 1 or comparisons[0][0] or comparisons[0][1].op == "!=":
        return (), LINE
    _, comparison = comparisons[0]
    integral = is_integral(comparison.term)
    return comparison.term, select_interval(comparison.op, comparison.number, is_integral=integral)


def _is_plain(path: Name | Member) -> bool:
    """Whether a path leads to a feature of the object itself, not of one of its parts."""
    return isinstance(path, Name) or (dotted_name(path) or "").rpartition(".")[0] in _SELF


def _belongs_to(block: Element, path: Name | Member, graph: Graph) -> bool:
    """Whether a block introduces the feature that a path names."""
    feature = graph[path.element]
    is_redefinition = graph.target(feature, Edge.REDEFINES) is not None
    return graph.owner(feature) is block and not is_redefinition


def split_conjunction(expression: Expression) -> Iterator[Expression]:
    """Yield the comparisons of a conjunction; ``0 <= x <= 7`` has two."""
    match expression:
        case Binary("and", left, right):
            yield from split_conjunction(left)
            yield from split_conjunction(right)
        case Binary(op, Binary(first, _, middle) as left, right) if {op, first} <= COMPARISONS:
            yield left
            yield Binary(op, middle, right)
        case _:
            yield expression
