"""Tests, bodies and set-ups: the parts of loops, conditionals and expansion regions.

UML lists only the executable nodes of a part. A fork, decision or buffer between them belongs to
the part that its tokens come from, or to the part that they go to when they come from outside.
"""

from collections.abc import Callable, Iterator

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.identity import derived_id

NODES = (
    Kind.ACTION,
    Kind.STRUCTURED,
    Kind.CONTROL,
    Kind.ACTIVITY_PARAMETER,
    Kind.OBJECT_NODE,
    Kind.DATA_STORE,
)


class Part(Struct, frozen=True):
    """A part of the structured node ``owner``; ``nodes`` are ids of its direct members."""

    id: str
    owner: Element
    word: str
    nodes: tuple[str, ...]


def parts_of(graph: Graph, node: Element) -> list[Part]:
    """Parts in the order in which they run first."""
    listed = [(word, tuple(query.ids_in(ids))) for word, ids in _listed(graph, node)]
    parts = [Part(derived_id(node.id, word), node, word, ids) for word, ids in listed if ids]
    return _completed(graph, node, parts) if parts else []


def _listed(graph: Graph, node: Element) -> list[tuple[str, object]]:
    if node.subkind == "loop":
        words = ("setup_part", "test", "body_part")
        return [(word.removesuffix("_part"), node.attrs.get(word)) for word in words]
    if node.subkind == "expansion":
        inside = tuple(one.id for one in graph.owned(node) if one.kind in NODES)
        return [("element", inside)]
    if node.subkind != "conditional":
        return []
    clauses = node.attrs.get("clauses") or ()
    return [
        (f"{word} {number}", ids)
        for number, clause in enumerate(clauses if isinstance(clauses, tuple) else (), 1)
        if isinstance(clause, tuple)
        for word, ids in zip(("test", "body"), clause, strict=False)
    ]


# -- nodes that no part lists ------------------------------------------------------------------


def _completed(graph: Graph, node: Element, parts: list[Part]) -> list[Part]:
    home = {id: part.id for part in parts for id in part.nodes}
    loose = [one for one in graph.owned(node) if one.kind in NODES and one.id not in home]
    for beside in (_sources, _targets):
        while any(_assign(graph, node, one, home, beside) for one in loose):
            loose = [one for one in loose if one.id not in home]
    found = {part.id: [id for id, place in home.items() if place == part.id] for part in parts}
    return [replace(part, nodes=tuple(found[part.id])) for part in parts]


def _assign(
    graph: Graph,
    owner: Element,
    node: Element,
    home: dict[str, str],
    beside: Callable[[Graph, Element], Iterator[Element]],
) -> bool:
    """Note the only part that the nodes beside it are in, if there is one."""
    if node.id in home:
        return False
    members = [_member(graph, owner, one) for one in beside(graph, node)]
    places = {home[one.id] for one in members if one is not None and one.id in home}
    if len(places) != 1:
        return False
    home[node.id] = places.pop()
    return True


def _member(graph: Graph, owner: Element, element: Element) -> Element | None:
    """The direct member of the owner that the element is, or is in."""
    found: Element | None = element
    while found is not None and found.owner != owner.id:
        found = graph.owner(found)
    return found


def _own(graph: Graph, node: Element) -> list[Element]:
    return [node, *(one for one in graph.owned(node) if one.kind is Kind.PIN)]


def _sources(graph: Graph, node: Element) -> Iterator[Element]:
    for end in _own(graph, node):
        for flow in query.incoming(graph, end):
            yield from graph.targets(flow, Edge.FLOW_SOURCE)


def _targets(graph: Graph, node: Element) -> Iterator[Element]:
    for end in _own(graph, node):
        for flow in query.outgoing(graph, end):
            yield from graph.targets(flow, Edge.FLOW_TARGET)
