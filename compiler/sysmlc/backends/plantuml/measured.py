"""Units and quantity kinds, as value types and value properties show them."""

from collections.abc import Iterator

from sysmlc.backends.plantuml import labels
from sysmlc.ir import Edge, Element, Graph
from sysmlc.ir.query.units import is_quantity_kind, is_unit, quantity_kind_of, unit_of
from sysmlc.support.plantuml_text import lines


def rows(graph: Graph, item: Element) -> tuple[str, ...]:
    """``unit = kilogram (kg)`` and the like: of a value type its own, of a unit what it says."""
    if item.role != "value type" or is_unit(item) or is_quantity_kind(item):
        return ()
    measures = (("unit", unit_of(graph, item)), ("quantityKind", quantity_kind_of(graph, item)))
    found = ((title, one) for title, one in measures if one is not None)
    return tuple(row for title, one in found for row in lines(f"{title} = {_text(one)}"))


def shown(graph: Graph, item: Element) -> Iterator[str]:
    """Ids of the elements that the rows stand for."""
    for one in graph.targets(item, Edge.REFERENCES):
        if is_unit(one) or is_quantity_kind(one):
            yield one.id


def unit_text(graph: Graph, feature: Element) -> str:
    """``{unit = kg}`` behind a value property, unless the name of its type says it already."""
    unit = unit_of(graph, feature)
    if unit is None:
        return ""
    text = str(unit.attrs.get("symbol") or labels.name(unit))
    type_ = labels.type_name(graph, feature)
    return "" if text in type_ or labels.name(unit) in type_ else f"{{unit = {text}}}"


def _text(element: Element) -> str:
    symbol = str(element.attrs.get("symbol", ""))
    name = labels.name(element)
    return f"{name} ({symbol})" if symbol and symbol != name else name
