"""Edges that no relation of SysML v2 says."""

from collections.abc import Iterator

from sysmlc.backends.sysml.book import Book
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import generals

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
        Edge.METHOD,
        Edge.CALLS,
        Edge.IN_PARTITION,
        Edge.INSTANCE_OF,
        Edge.CLIENT,
        Edge.SUPPLIER,
        Edge.CLASSIFIER_BEHAVIOR,
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
    """Whether a feature subsets what its owner neither has nor inherits: SysML v2 cannot."""
    owner, above = book.graph.owner(feature), book.graph.owner(other)
    return owner is None or not (above is owner or above in generals(book.graph, owner))


def _always(_book: Book, _source: Element, _target: Element) -> bool:
    return True


_UNLIKE = {Edge.SUBSETS: is_apart, Edge.APPLIES: _always}
_ASKED = (*(edge for edge in Edge if edge not in _EDGES), *_UNLIKE)
"""Edges that are not said of every kind of element."""
