"""Edges that no relation of SysML v2 says."""

from collections.abc import Iterator

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry, Plan
from sysmlc.backends.sysml.references import is_around
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import bounds, conforms, generals, type_of

_EDGES = frozenset(
    {
        Edge.OWNS,
        Edge.FEATURE,
        Edge.TYPED_BY,
        Edge.SPECIALIZES,
        Edge.SUBSETS,
        Edge.REDEFINES,
        Edge.REALIZES,
        Edge.CONVEYS,
        Edge.FLOW_SOURCE,
        Edge.FLOW_TARGET,
        Edge.REALIZING,
        Edge.END,
        Edge.ROLE,
        Edge.PATH,
        Edge.TRIGGER,
        Edge.GUARD,
        Edge.EFFECT,
        Edge.ENTRY,
        Edge.DO,
        Edge.EXIT,
        Edge.CALLS,
        Edge.IN_PARTITION,
        Edge.INSTANCE_OF,
        Edge.CLIENT,
        Edge.SUPPLIER,
        Edge.INCLUDES,
        Edge.APPLIES,
        Edge.SUBJECT,
        Edge.SATISFIES,
        Edge.DERIVES,
        Edge.VERIFIES,
        Edge.REFINES,
        Edge.TRACES,
        Edge.DEPENDS,
        Edge.SEND_EVENT,
        Edge.RECEIVE_EVENT,
    }
)
"""Edges that are written where they are, or follow from what is written."""
_OF_KINDS = {
    Edge.REFERENCES: frozenset(
        {
            Kind.PROPERTY,
            Kind.PORT,
            Kind.COMMENT,
            Kind.CONSTRAINT,
            Kind.IMPORT,
            Kind.SLOT,
            Kind.FACET,
            Kind.GROUP,
            Kind.DOCUMENT,
            Kind.METADATA,
            Kind.DATA_TYPE,
            Kind.ENUMERATION,
            Kind.PSEUDOSTATE,
            Kind.ACTIVITY_PARAMETER,
            Kind.EXTEND,
            Kind.UNIT,
            Kind.QUANTITY_KIND,
            Kind.APPLICATION,
            Kind.VIEW,
        }
    ),
    Edge.REPRESENTS: frozenset({Kind.INSTANCE, Kind.LIFELINE, Kind.PARTITION, Kind.VIEW}),
    Edge.EXTENDS: frozenset({Kind.USE_CASE, Kind.EXTEND}),
    Edge.ALLOCATED_TO: frozenset(Kind),
    Edge.BINDS: frozenset({Kind.PROPERTY, Kind.PORT}),
    Edge.COVERS: frozenset({Kind.OCCURRENCE, Kind.EXECUTION}),
}


def unsaid_edges(book: Book, element: Element) -> Iterator[tuple[Edge, Element]]:
    """Edges of an element of the model that nothing else in the text says."""
    if element.attrs.get("external"):
        return
    for edge in _ASKED:
        is_unsaid = _UNLIKE.get(edge)
        if is_unsaid is None and element.kind in _OF_KINDS.get(edge, ()):
            continue
        for target in book.graph.targets(element, edge):
            if is_unsaid is not None and not is_unsaid(book, element, target):
                continue
            if not _is_measure(element, target):
                yield edge, target


def _is_measure(one: Element, other: Element) -> bool:
    return one.role in ("unit", "quantity kind") or other.kind in (Kind.UNIT, Kind.QUANTITY_KIND)


def is_apart(book: Book, feature: Element, other: Element) -> bool:
    """Whether a feature subsets what SysML v2 does not let it.

    That is what its owner neither has nor inherits, or a feature of another kind.
    """
    owner, above = book.graph.owner(feature), book.graph.owner(other)
    if is_unlike(book.plan, feature, other):
        return True
    return owner is None or not (above is owner or above in generals(book.graph, owner))


def _is_unlike(book: Book, feature: Element, other: Element) -> bool:
    return is_unlike(book.plan, feature, other)


def _is_elsewhere(book: Book, action: Element, target: Element) -> bool:
    """Whether an action is about a feature of something that is not around it."""
    entry, other = book.plan.entry(action), book.plan.entry(target)
    if action.kind is not Kind.ACTION or entry is None or other is None:
        return False
    return not is_called(action) and not is_around(book.plan, entry, other)


def is_called(action: Element) -> bool:
    """Whether an action calls, sends or accepts what it is about."""
    return action.subkind.partition("-")[0] in ("call", "send", "broadcast", "accept", "start")


def is_unlike(plan: Plan, feature: Element, other: Element) -> bool:
    """Whether one is a port and the other a part, or may have more values than the other."""
    entries = [plan.entry(one) for one in (feature, other)]
    words = {one.shape.keyword for one in entries if one is not None}
    if "port" in words and "part" in words:
        return True
    above, own = (plan.entry(plan.graph.owner(one)) for one in (other, feature))
    if above is not None and own is not None and ends_differ(plan, above, own):
        return True
    return _most(feature) > _most(other) and Kind.PORT not in (feature.kind, other.kind)


def ends_differ(plan: Plan, general: Entry, specific: Entry) -> bool:
    """Whether ends of an association are of other types than those that they would redefine."""
    graph, pair = plan.graph, (general.element, specific.element)
    if any(one is None or one.kind is not Kind.ASSOCIATION for one in pair):
        return False
    ends = [[] if one is None else graph.targets(one, Edge.END) for one in pair]
    for above, end in zip(*ends, strict=False):
        wanted, given = type_of(graph, above), type_of(graph, end)
        if wanted is not None and given is not None and not conforms(graph, given, wanted):
            return True
    return False


def _most(feature: Element) -> float:
    """How many values a feature may have."""
    found = bounds(str(feature.attrs.get("multiplicity", "1")))
    return 1 if found is None else (float("inf") if found[1] is None else found[1])


def _always(_book: Book, _source: Element, _target: Element) -> bool:
    return True


def _is_of_owner(_book: Book, source: Element, target: Element) -> bool:
    """References that no relation says; what a constraint is about besides its owner is said."""
    if source.kind is Kind.CONSTRAINT:
        return target.id == source.owner or not source.name
    return source.kind not in _OF_KINDS[Edge.REFERENCES]


def differs_in_parameters(book: Book, operation: Element, method: Element) -> bool:
    """Whether an operation states no parameters and would inherit those of its method."""
    has_own, has = (
        any(one.kind is Kind.PARAMETER for one in book.graph.owned(two))
        for two in (operation, method)
    )
    return has and not has_own


def _is_apart_from_method(book: Book, operation: Element, method: Element) -> bool:
    entries = (book.plan.entry(operation), book.plan.entry(method))
    return entries[0] is not entries[1] and differs_in_parameters(book, operation, method)


def _is_of_other_kind(book: Book, _owner: Element, behaviour: Element) -> bool:
    """Whether a classifier behaviour is neither an action nor a state, which are performed."""
    entry = book.plan.entry(behaviour)
    return entry is not None and entry.shape.plain not in ("action", "state")


_UNLIKE = {
    Edge.METHOD: _is_apart_from_method,
    Edge.CLASSIFIER_BEHAVIOR: _is_of_other_kind,
    Edge.REFERENCES: _is_of_owner,
    Edge.SUBSETS: is_apart,
    Edge.REDEFINES: _is_unlike,
    Edge.APPLIES: _always,
    Edge.CALLS: _is_elsewhere,
}
_ASKED = tuple(dict.fromkeys((*(edge for edge in Edge if edge not in _EDGES), *_UNLIKE)))
"""Edges that are not said of every kind of element."""
