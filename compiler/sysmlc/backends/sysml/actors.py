"""Actors of use cases: associations that the notation says inside the use case."""

from collections.abc import Iterator

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import type_of


def actors(graph: Graph, use_case: Element) -> Iterator[tuple[str, Element]]:
    """Types of actors that associations join with the use case, with the names of such ends."""
    for end in graph.sources(use_case, Edge.TYPED_BY):
        for association in graph.sources(end, Edge.END):
            other = actor_of(graph, association)
            if other is not None:
                type_ = type_of(graph, other)
                yield from () if type_ is None else [(other.name, type_)]
                continue
            types = [type_of(graph, one) for one in graph.targets(association, Edge.END)]
            yield from (("", one) for one in types if one is not None and one.kind is Kind.ACTOR)


def actor_of(graph: Graph, association: Element) -> Element | None:
    """The end that is the actor, where an association says nothing else; else None.

    Neither it nor its end at the use case has a name, and both ends are its own.
    """
    ends = graph.targets(association, Edge.END)
    if association.name or len(ends) != 2 or graph.owned(association) != ends:
        return None
    case, actor = ends
    type_ = type_of(graph, case)
    is_case = type_ is not None and type_.kind is Kind.USE_CASE
    is_beside = type_ is not None and type_.owner == association.owner
    is_plain = not (case.name or case.attrs or graph.owned(actor) or graph.owned(case))
    return actor if is_case and is_beside and is_plain and not actor.attrs else None
