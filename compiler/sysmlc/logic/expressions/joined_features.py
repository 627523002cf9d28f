"""Features that have one value: connectors and flows join them, and redefinitions replace them."""

from collections.abc import Sequence

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.support.disjoint_sets import DisjointSets


def join_features(graph: Graph) -> DisjointSets[str]:
    """Return the ids of the features of a model; those that have one value are one set."""
    joined: DisjointSets[str] = DisjointSets()
    for feature in graph.of_kind(Kind.PROPERTY):
        for redefined in graph.targets(feature, Edge.REDEFINES):
            joined.union(redefined.id, feature.id)
    for connector in graph.of_kind(Kind.CONNECTOR):
        ends = query.ends(graph, connector)
        _join(graph, [role for end in ends for role in graph.targets(end, Edge.ROLE)], joined)
    for flow in graph.of_kind(Kind.ITEM_FLOW):
        sides = (graph.target(flow, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET))
        _join(graph, [side for side in sides if side is not None], joined)
    return joined


def _join(graph: Graph, features: Sequence[Element], joined: DisjointSets[str]) -> None:
    """Join features, and the equally named features of their types, which are ports."""
    for feature in features[1:]:
        joined.union(features[0].id, feature.id)
    members: dict[str, Element] = {}
    for type_ in filter(None, (query.type_of(graph, feature) for feature in features)):
        for member in query.features(graph, type_):
            first = members.setdefault(member.name, member)
            if first is not member and member.name:
                joined.union(first.id, member.id)
