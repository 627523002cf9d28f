"""Units and quantity kinds of features and value types (SysML 1.6 clause 8.3.2)."""

from collections.abc import Iterator

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.query.classifiers import STRUCTURAL_FEATURES, generals, type_of


def is_unit(element: Element) -> bool:
    """Return whether *element* is a measurement unit, in SysML v1 or v2."""
    return element.kind is Kind.UNIT or element.role == "unit"


def is_quantity_kind(element: Element) -> bool:
    """Return whether *element* is a kind of quantity, in SysML v1 or v2."""
    return element.kind is Kind.QUANTITY_KIND or element.role == "quantity kind"


def unit_of(graph: Graph, feature: Element) -> Element | None:
    """Return the unit of a feature or a value type: its own or the nearest inherited one."""
    return next(filter(is_unit, _iter_references(graph, feature)), None)


def quantity_kind_of(graph: Graph, feature: Element) -> Element | None:
    """Return the quantity kind of a feature or a value type; else that of its unit."""
    own = next(filter(is_quantity_kind, _iter_references(graph, feature)), None)
    unit = None if own else unit_of(graph, feature)
    references = [] if unit is None else graph.targets(unit, Edge.REFERENCES)
    return own or next(filter(is_quantity_kind, references), None)


def _iter_references(graph: Graph, feature: Element) -> Iterator[Element]:
    is_feature = feature.kind in (*STRUCTURAL_FEATURES, Kind.PARAMETER)
    type_ = type_of(graph, feature) if is_feature else feature
    for classifier in () if type_ is None else (type_, *generals(graph, type_)):
        yield from graph.targets(classifier, Edge.REFERENCES)
