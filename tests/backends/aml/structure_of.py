"""The structure of a graph by names alone: what two languages can both say of a plant."""

from collections import Counter

from sysmlc.ir import Edge, Kind
from sysmlc.ir.query import type_of
from sysmlc.ir.query.classifiers import unit_of

CLASSES = (Kind.CLASS, Kind.COMPONENT, Kind.INTERFACE)


def structure(graph):
    """Multisets of sentences by subject."""
    own = [one for one in graph if not one.attrs.get("external")]
    blocks = {one.id: one for one in own if one.kind in CLASSES and one.role in ROLES}
    held = [one for one in own if one.owner in blocks]
    return {
        "classes": Counter((one.name, ROLES[one.role]) for one in blocks.values()),
        "generalizations": pairs(graph, blocks.values(), Edge.SPECIALIZES, blocks),
        "parts": features(graph, held, lambda one: one.role == "part"),
        "values": features(graph, held, lambda one: one.role == "value"),
        "ports": features(graph, held, lambda one: one.kind is Kind.PORT),
        "directions": Counter(
            (one.name, one.attrs["direction"])
            for one in held
            if one.kind is Kind.PORT and "direction" in one.attrs
        ),
        "units": Counter((one.name, symbol(graph, one)) for one in held if one.role == "value"),
        "links": Counter(link(graph, one) for one in held if one.kind is Kind.CONNECTOR),
    }


ROLES = {"block": "block", "interface block": "interface block", "": "block"}


def pairs(graph, sources, edge, among):
    """Pairs of names on edges inside the model."""
    found = ((one, target) for one in sources for target in graph.targets(one, edge))
    return Counter((one.name, target.name) for one, target in found if target.id in among)


def features(graph, held, is_meant):
    """Names of owner, feature and type."""
    found = Counter()
    for one in filter(is_meant, held):
        type_ = type_of(graph, one)
        found[graph.owner(one).name, one.name, type_.name if type_ else ""] += 1
    return found


def symbol(graph, one):
    """How the unit of a value is written, or the empty string."""
    unit = unit_of(graph, one)
    return "" if unit is None else str(unit.attrs.get("symbol") or unit.name)


def link(graph, connector):
    """Name of the connector, and of the steps to both of its ends."""
    ends = graph.targets(connector, Edge.END)
    return connector.name, tuple(sorted(steps(graph, end) for end in ends))


def steps(graph, end):
    """Names of the parts on the way to a port, and of the port."""
    on_the_way = [*graph.targets(end, Edge.PATH), *graph.targets(end, Edge.ROLE)]
    return ".".join(one.name for one in on_the_way)
