"""Classes made for one feature (SysML 1.6, 8.3.2.10): in SysML v2 its members are its own."""

from collections.abc import Iterator

from sysmlc.ir import Edge, Element, Graph, Kind

_CLASSES = (Kind.CLASS, Kind.DATA_TYPE)
_FEATURES = (Kind.PROPERTY, Kind.FLOW_PROPERTY, Kind.PORT)
_SAID = frozenset({"role", "property_specific", "variation"})
"""Attributes of such a class that a usage says."""
_REFERRING = tuple(edge for edge in Edge if edge not in (Edge.TYPED_BY, Edge.OWNS, Edge.FEATURE))


def feature_of(graph: Graph, element: Element) -> Element | None:
    """The feature whose members a class holds; None when it is a definition of its own.

    It has the name of the feature or none, stands beside it, and nothing else refers to it.
    """
    if not element.attrs.get("property_specific") or element.kind not in _CLASSES:
        return None
    typed = graph.sources(element, Edge.TYPED_BY)
    if len(typed) != 1 or typed[0].kind not in _FEATURES or not _SAID.issuperset(element.attrs):
        return None
    (feature,) = typed
    is_beside = feature.owner == element.owner and element.name in ("", feature.name)
    is_alone = graph.targets(feature, Edge.TYPED_BY) == [element]
    is_used = any(graph.sources(element, edge) for edge in _REFERRING)
    return feature if is_beside and is_alone and not is_used else None


def types_of(graph: Graph, feature: Element) -> Iterator[Element]:
    """Types of a feature as the text states them: those of its own class for that class."""
    for type_ in graph.targets(feature, Edge.TYPED_BY):
        if feature_of(graph, type_) is feature:
            yield from graph.targets(type_, Edge.SPECIALIZES)
        else:
            yield type_
