"""Counts the names in a plant that AutomationML and SysML can both express."""

from collections import Counter

from sysmlc.ir import Edge, Kind
from sysmlc.ir.query import type_of
from sysmlc.ir.query.classifiers import unit_of

CLASSES = (Kind.CLASS, Kind.COMPONENT, Kind.INTERFACE)


def count_structure(graph):
    """Return multisets of names by subject."""
    internal = [element for element in graph if not element.attrs.get("external")]
    blocks = {e.id: e for e in internal if e.kind in CLASSES and e.role in ROLES}
    members = [element for element in internal if element.owner in blocks]
    ports = [member for member in members if member.kind is Kind.PORT]
    values = [member for member in members if member.role == "value"]
    connectors = [member for member in members if member.kind is Kind.CONNECTOR]
    return {
        "classes": Counter((block.name, ROLES[block.role]) for block in blocks.values()),
        "generalizations": count_edges(graph, blocks.values(), Edge.SPECIALIZES, blocks),
        "parts": count_features(graph, [member for member in members if member.role == "part"]),
        "values": count_features(graph, values),
        "ports": count_features(graph, ports),
        "directions": Counter(
            (port.name, port.attrs["direction"]) for port in ports if "direction" in port.attrs
        ),
        "units": Counter((value.name, find_symbol(graph, value)) for value in values),
        "links": Counter(describe_link(graph, connector) for connector in connectors),
    }


ROLES = {"block": "block", "interface block": "interface block", "": "block"}


def count_edges(graph, sources, edge, among):
    """Count the edges inside the model by the names of their ends."""
    ends = ((source, target) for source in sources for target in graph.targets(source, edge))
    return Counter((source.name, target.name) for source, target in ends if target.id in among)


def count_features(graph, members):
    """Count features by the names of owner, feature and type."""
    counts = Counter()
    for feature in members:
        type_ = type_of(graph, feature)
        counts[graph.owner(feature).name, feature.name, type_.name if type_ else ""] += 1
    return counts


def find_symbol(graph, value):
    """Return the symbol of the unit of a value, or the empty string."""
    unit = unit_of(graph, value)
    return "" if unit is None else str(unit.attrs.get("symbol") or unit.name)


def describe_link(graph, connector):
    """Return the name of the connector, and the paths to its ends."""
    ends = graph.targets(connector, Edge.END)
    return connector.name, tuple(sorted(describe_end(graph, end) for end in ends))


def describe_end(graph, end):
    """Return the names of the parts on the path to a port, and of the port."""
    path = [*graph.targets(end, Edge.PATH), *graph.targets(end, Edge.ROLE)]
    return ".".join(step.name for step in path)
