"""Symbols of derived units that have none: ``m·s^-1`` from the factors of QUDV.

SysML 1.6 annex E.5: a DerivedUnit has UnitFactors, each a unit with an exponent, which is a number
or an instance of Rational.
"""

from collections.abc import Iterator

from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir.query.units import is_unit


def give_symbols(graph: Graph) -> None:
    """Set the symbol of each unit without one whose factors are all known."""
    for unit in graph.of_kind(Kind.INSTANCE):
        if is_unit(unit) and "symbol" not in unit.attrs:
            parts = [_part(graph, factor) for factor in _referred(graph, unit, "factor")]
            if parts and all(parts):
                graph.set(unit, symbol="·".join(parts))


def _part(graph: Graph, factor: Element) -> str:
    unit = next(_referred(graph, factor, "unit"), None)
    if unit is None or not is_unit(unit):
        return ""
    exponent = _exponent(graph, factor)
    text = str(unit.attrs.get("symbol") or unit.name)
    return text if exponent in ("", "1") else f"{text}^{exponent}"


def _exponent(graph: Graph, factor: Element) -> str:
    rational = next(_referred(graph, factor, "exponent"), None)
    if rational is None:
        return _shown(_value(graph, factor, "exponent"))
    above, below = (_shown(_value(graph, rational, n)) for n in ("numerator", "denominator"))
    return above if below in ("", "1") else f"({above}/{below})"


def _shown(value: AttrValue) -> str:
    return "" if value is None else str(value)


def _slots(graph: Graph, instance: Element, feature: str) -> Iterator[Element]:
    for slot in graph.owned(instance):
        if slot.kind is Kind.SLOT:
            names = {one.name for one in graph.targets(slot, Edge.INSTANCE_OF)}
            if names & {feature, f"{feature}s"}:
                yield slot


def _referred(graph: Graph, instance: Element, feature: str) -> Iterator[Element]:
    for slot in _slots(graph, instance, feature):
        yield from graph.targets(slot, Edge.REFERENCES)


def _value(graph: Graph, instance: Element, feature: str) -> AttrValue:
    found = (slot.attrs.get("value") for slot in _slots(graph, instance, feature))
    return next((one for one in found if one is not None), None)
