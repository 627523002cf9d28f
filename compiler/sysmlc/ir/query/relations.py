"""Relations: ends of connectors and flows, their directions, allocations."""

from collections.abc import Callable, Iterable, Iterator

from sysmlc.ir.element import Element, list_items
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.pending import TextFile
from sysmlc.ir.query.classifiers import flow_properties, type_of

_OPPOSITE = {"in": "out", "out": "in"}


# -- flows -------------------------------------------------------------------------------------


def flow_source(graph: Graph, flow: Element) -> Element | None:
    """Return the source of a flow or transition, or None."""
    return graph.target(flow, Edge.FLOW_SOURCE)


def flow_target(graph: Graph, flow: Element) -> Element | None:
    """Return the target of a flow or transition, or None."""
    return graph.target(flow, Edge.FLOW_TARGET)


def runs_both_ways(graph: Graph, flow: Element) -> bool:
    """Return whether an item flow has both of its ends as source and as target."""
    sources = {end.id for end in graph.targets(flow, Edge.FLOW_SOURCE)}
    targets = {end.id for end in graph.targets(flow, Edge.FLOW_TARGET)}
    return len(sources) > 1 and sources == targets


def incoming(graph: Graph, node: Element, *kinds: Kind) -> list[Element]:
    """Return the flows (of these kinds) or transitions that end at *node*."""
    return _filter_kinds(graph.sources(node, Edge.FLOW_TARGET), kinds)


def outgoing(graph: Graph, node: Element, *kinds: Kind) -> list[Element]:
    """Return the flows (of these kinds) or transitions that start at *node*."""
    return _filter_kinds(graph.sources(node, Edge.FLOW_SOURCE), kinds)


def _filter_kinds(elements: Iterable[Element], kinds: tuple[Kind, ...]) -> list[Element]:
    return [element for element in elements if not kinds or element.kind in kinds]


def flow_path(graph: Graph, flow: Element, edge: Edge) -> list[Element]:
    """Return the parts that lead from the owner of an item flow to the feature at one end.

    The path is empty for a feature of the owner itself. *edge* is FLOW_SOURCE or FLOW_TARGET.
    """
    ids = list_items(flow.attrs.get("source_path" if edge is Edge.FLOW_SOURCE else "target_path"))
    return [part for id in ids if (part := graph.get(str(id))) is not None]


# -- connectors --------------------------------------------------------------------------------


def ends(graph: Graph, relation: Element) -> list[Element]:
    """Return the ends of a connector or association, in order."""
    return graph.targets(relation, Edge.END)


def opposite_end(graph: Graph, relation: Element, end: Element) -> Element | None:
    """Return the other end of a binary connector or association, or None."""
    opposite_ends = [item for item in ends(graph, relation) if item is not end]
    return opposite_ends[0] if len(opposite_ends) == 1 else None


def role_of(graph: Graph, end: Element) -> Element | None:
    """Return the part or port that a connector end is attached to, or None."""
    return graph.target(end, Edge.ROLE)


def path_to_port(graph: Graph, holder: Element) -> tuple[Element, ...]:
    """Return the parts and ports that lead to the port of a trigger or action, and then that port.

    The path is empty if the holder names no port. In SysML v1 it begins with the port of the
    holder and leads to a port nested in it.
    """
    port = graph.get(str(holder.attrs.get("on_port", holder.attrs.get("port", ""))))
    path = tuple(graph.targets(holder, Edge.PATH))
    return path if port is None or port in path[:1] else (*path, port)


def port_names(graph: Graph, holder: Element) -> tuple[str, ...]:
    """Return the names on the path to the port of a trigger or action, empty without a port.

    A path that is no chain of features, such as ``belts#(1).inlet``, is one name.
    """
    text = holder.attrs.get("port_path")
    return (str(text),) if text else tuple(step.name for step in path_to_port(graph, holder))


def is_boundary(graph: Graph, end: Element) -> bool:
    """Whether a connector end is a port of the connector's own classifier, not of a part.

    A port nested in such a port counts too.
    """
    role = role_of(graph, end)
    path = [] if role is None else [*graph.targets(end, Edge.PATH), role]
    return bool(path) and all(step.kind is Kind.PORT for step in path)


def end_direction(graph: Graph, end: Element) -> str | None:
    """Return the direction of the port at a connector end, seen from the outermost part.

    A conjugated port inverts the ports nested in it too (SysML 1.6 clause 9.3.2.15).
    """
    port = role_of(graph, end)
    attribute = None if port is None else port.attrs.get("direction")
    direction = attribute if isinstance(attribute, str) else None
    for step in graph.targets(end, Edge.PATH):
        if step.kind is Kind.PORT and step.attrs.get("conjugated"):
            direction = opposite(direction)
    return direction


def flow_directions(graph: Graph, port: Element) -> list[tuple[Element, str]]:
    """Return the flow properties of the type of a port, with their directions at the port."""
    type_ = type_of(graph, port)
    properties = [] if type_ is None else flow_properties(graph, type_)
    directions = [(item, str(item.attrs.get("direction", "inout"))) for item in properties]
    if not port.attrs.get("conjugated"):
        return directions
    return [
        (item, direction if _is_stated_at_port(graph, item) else opposite(direction) or direction)
        for item, direction in directions
    ]


def _is_stated_at_port(graph: Graph, flow_property: Element) -> bool:
    """Whether a usage of SysML v2 declares the flow property itself.

    The conjugation ``port p : ~Pipe { out water; }`` reverses only what the port inherits.
    """
    owner = graph.owner(flow_property)
    is_own = owner is not None and owner.attrs.get("property_specific")
    return bool(is_own) and TextFile(flow_property.source) in graph.derived(TextFile)


def opposite(direction: str | None) -> str | None:
    """Return the direction seen from the other side; ``inout`` and None stay the same."""
    return None if direction is None else _OPPOSITE.get(direction, direction)


def connectors_of(graph: Graph, role: Element) -> Iterator[Element]:
    """Iterate over the connectors with an end at a part or port."""
    for end in graph.sources(role, Edge.ROLE):
        connector = graph.source(end, Edge.END)
        if connector is not None:
            yield connector


# -- allocations -------------------------------------------------------------------------------


def allocated_to(graph: Graph, element: Element) -> list[Element]:
    """Return the elements that *element*, or its definition, is allocated to.

    An allocation of a definition holds for all its usages (SysML 1.6 clause 15.3.1.1): the
    definition of a part is its type, that of an action the behaviour that it calls.
    """
    return _list_allocations(graph, element, graph.targets)


def allocated_from(graph: Graph, element: Element) -> list[Element]:
    """Return the elements that are allocated to *element*, or to its definition."""
    return _list_allocations(graph, element, graph.sources)


def _list_allocations(
    graph: Graph, element: Element, follow: Callable[[Element, Edge], list[Element]]
) -> list[Element]:
    definitions = [*graph.targets(element, Edge.CALLS), type_of(graph, element)]
    elements = [element, *(item for item in definitions if item is not None)]
    allocations = (end for item in elements for end in follow(item, Edge.ALLOCATED_TO))
    return list(dict.fromkeys(allocations))
