"""Regions of activities: parts of loops and conditionals, groups, handlers, interruptible ones."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.identity import derived_id

FLOWS = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)


@dataclass(frozen=True, slots=True)
class Part:
    """Test, body or set-up of a loop or conditional node; ``owner`` is that node."""

    id: str
    owner: Element
    word: str
    nodes: tuple[str, ...]


def handlers_of(graph: Graph, activity: Element) -> frozenset[str]:
    """Ids of the bodies of exception handlers, with their pins and exception types."""
    ids = [id for element in graph.subtree(activity) for id in _ids(element.attrs.get("handlers"))]
    return frozenset(ids)


def groups_of(graph: Graph, activity: Element) -> dict[str, Element]:
    """Plain structured nodes that no flow starts or ends at, but whose border flows cross."""
    found: dict[str, Element] = {}
    for node in graph.subtree(activity):
        if node.kind is not Kind.STRUCTURED or node.subkind not in ("structured", ""):
            continue
        own = [node, *(pin for pin in graph.owned(node) if pin.kind is Kind.PIN)]
        if any(query.incoming(graph, e) or query.outgoing(graph, e) for e in own):
            continue
        inside = {element.id for element in graph.subtree(node)}
        if any(_crosses(graph, e, inside) for e in graph.subtree(activity) if e.kind in FLOWS):
            found[node.id] = node
    return found


def _crosses(graph: Graph, flow: Element, inside: set[str]) -> bool:
    ends = [graph.target(flow, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
    return len({end.id in inside for end in ends if end is not None}) == 2


def _ids(value: object) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from _ids(part)


def parts_of(node: Element) -> list[Part]:
    """Parts in the order in which they run first."""
    if node.subkind == "loop":
        words = ("setup_part", "test", "body_part")
        found = [(word.removesuffix("_part"), node.attrs.get(word)) for word in words]
    elif node.subkind == "conditional":
        clauses = node.attrs.get("clauses") or ()
        found = [
            (f"{word} {number}", ids)
            for number, clause in enumerate(clauses if isinstance(clauses, tuple) else (), 1)
            if isinstance(clause, tuple)
            for word, ids in zip(("test", "body"), clause, strict=False)
        ]
    else:
        found = []
    listed = [(word, tuple(_ids(ids))) for word, ids in found]
    return [Part(derived_id(node.id, word), node, word, ids) for word, ids in listed if ids]


def interruptible_regions(
    graph: Graph, activity: Element, nodes: Iterable[Element]
) -> list[tuple[Element, list[Element]]]:
    """Interruptible regions of the activity with their nodes."""
    regions = [e for e in graph.subtree(activity) if e.subkind == "interruptible"]
    members = list(nodes)
    return [
        (
            region,
            [
                n
                for n in members
                if region in graph.targets(n, Edge.IN_PARTITION) or graph.owner(n) is region
            ],
        )
        for region in regions
    ]
