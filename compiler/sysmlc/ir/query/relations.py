"""Relations: flows, ends of connectors and their directions, allocations."""

from collections.abc import Callable, Iterable, Iterator

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.query.classifiers import flow_properties, type_of

_OPPOSITE = {"in": "out", "out": "in"}


def flow_source(graph: Graph, flow: Element) -> Element | None:
    """Where a flow or transition starts."""
    return graph.target(flow, Edge.FLOW_SOURCE)


def flow_target(graph: Graph, flow: Element) -> Element | None:
    """Where a flow or transition ends."""
    return graph.target(flow, Edge.FLOW_TARGET)


def runs_both_ways(graph: Graph, flow: Element) -> bool:
    """Whether an item flow leads from either of its ends to the other."""
    sources = {one.id for one in graph.targets(flow, Edge.FLOW_SOURCE)}
    return len(sources) > 1 and sources == {t.id for t in graph.targets(flow, Edge.FLOW_TARGET)}


def incoming(graph: Graph, node: Element, *kinds: Kind) -> list[Element]:
    """Flows (of these kinds) or transitions that end at the node."""
    return _of(graph.sources(node, Edge.FLOW_TARGET), kinds)


def outgoing(graph: Graph, node: Element, *kinds: Kind) -> list[Element]:
    """Flows (of these kinds) or transitions that start at the node."""
    return _of(graph.sources(node, Edge.FLOW_SOURCE), kinds)


def _of(elements: Iterable[Element], kinds: tuple[Kind, ...]) -> list[Element]:
    return [one for one in elements if not kinds or one.kind in kinds]


def ends(graph: Graph, relation: Element) -> list[Element]:
    """Ends of a connector or association, in order."""
    return graph.targets(relation, Edge.END)


def opposite_end(graph: Graph, relation: Element, end: Element) -> Element | None:
    """The other end of a binary connector or association, or None."""
    others = [one for one in ends(graph, relation) if one is not end]
    return others[0] if len(others) == 1 else None


def role_of(graph: Graph, end: Element) -> Element | None:
    """The part or port that a connector end is attached to."""
    return graph.target(end, Edge.ROLE)


def is_boundary(graph: Graph, end: Element) -> bool:
    """Whether a connector end is a port of the connector's own classifier, not of a part.

    A port nested in such a port is one too.
    """
    role = role_of(graph, end)
    steps = [] if role is None else [*graph.targets(end, Edge.PATH), role]
    return bool(steps) and all(step.kind is Kind.PORT for step in steps)


def end_direction(graph: Graph, end: Element) -> str | None:
    """Direction of the port at a connector end, as the outermost part of its path shows it.

    A conjugated port turns round the ports nested in it too (SysML 1.6 clause 9.3.2.15).
    """
    port = role_of(graph, end)
    given = None if port is None else port.attrs.get("direction")
    direction = given if isinstance(given, str) else None
    for step in graph.targets(end, Edge.PATH):
        if step.kind is Kind.PORT and step.attrs.get("conjugated"):
            direction = opposite(direction)
    return direction


def flow_directions(graph: Graph, port: Element) -> list[tuple[Element, str]]:
    """Flow properties of a port's type, each with its direction at the port itself."""
    type_ = type_of(graph, port)
    found = [] if type_ is None else flow_properties(graph, type_)
    given = [(one, str(one.attrs.get("direction", "inout"))) for one in found]
    if not port.attrs.get("conjugated"):
        return given
    return [(one, opposite(direction) or direction) for one, direction in given]


def connectors_of(graph: Graph, role: Element) -> Iterator[Element]:
    """Connectors that have an end at the part or port."""
    for end in graph.sources(role, Edge.ROLE):
        connector = graph.source(end, Edge.END)
        if connector is not None:
            yield connector


def allocated_to(graph: Graph, element: Element) -> list[Element]:
    """What the element is allocated to: itself, or what it is a usage of.

    What a definition is allocated to holds for all its usages (SysML 1.6 clause 15.3.1.1): the
    type of a part, the behaviour that an action calls.
    """
    return _allocated(graph, element, graph.targets)


def allocated_from(graph: Graph, element: Element) -> list[Element]:
    """What is allocated to the element, or to what it is a usage of."""
    return _allocated(graph, element, graph.sources)


def _allocated(
    graph: Graph, element: Element, follow: Callable[[Element, Edge], list[Element]]
) -> list[Element]:
    definitions = [*graph.targets(element, Edge.CALLS), type_of(graph, element)]
    known = [element, *(one for one in definitions if one is not None)]
    found = (other for one in known for other in follow(one, Edge.ALLOCATED_TO))
    return list(dict.fromkeys(found))


def opposite(direction: str | None) -> str | None:
    """The direction seen from the other side; ``inout`` and None stay."""
    return None if direction is None else _OPPOSITE.get(direction, direction)


def flow_path(graph: Graph, flow: Element, edge: Edge) -> list[Element]:
    """Parts of the owner of an item flow that lead to the feature at one of its ends.

    Empty where the feature alone says it. ``edge`` is FLOW_SOURCE or FLOW_TARGET.
    """
    found = flow.attrs.get("source_path" if edge is Edge.FLOW_SOURCE else "target_path")
    ids = found if isinstance(found, tuple) else ()
    return [one for id_ in ids if (one := graph.get(str(id_))) is not None]
