"""Quantities and units of value types: those of the libraries ISQ and SI as docs/ir.md has them."""

import re
from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import annotations, nodes
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.tree import Node, Reference

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_VALUE = re.compile(r"(?P<name>\w+)Value")
_UPPER = re.compile(r"(?<=[a-z])(?=[A-Z])")


def is_measured(found: Reference) -> bool:
    """Whether a reference leads to a quantity of the standard library (``ISQ::LengthValue``)."""
    target = found.target
    if target is None or target.owner is None or not target.owner.name:
        return found.chain[-1][0] == "ISQ" and bool(_VALUE.fullmatch(found.chain[-1][-1]))
    is_library = target.owner.name.startswith("ISQ") and target.owner.kind == "LibraryPackage"
    return is_library and bool(_VALUE.fullmatch(target.name or ""))


def give_measures(low: "Lowering", node: Node, made: Element) -> None:
    """The quantity kind and the unit that a value type's declaration says.

    Quantities are real numbers unless the declaration says otherwise.
    """
    found = nodes.references(node, "Subclassification", "Subsetting", "FeatureTyping")
    measured = [one for one in found if is_measured(one)]
    for one in measured:
        name = kind_name(nodes.last_name(one))
        low.last(lambda name=name: _kind(low, node, made, name))  # type: ignore[misc]
    if measured and len(found) == len(measured):
        low.lead_to(Edge.SPECIALIZES, made, "ScalarValues::Real", Kind.DATA_TYPE)
    _told(low, node, made)
    for member in node.members:
        value = nodes.value_of(member)
        if nodes.name_of(member) == "mRef" and value is not None:
            low.skipped.add(id(member))
            unit = nodes.reference(value, "Membership")
            if unit is not None:
                low.later(lambda member=member, unit=unit: _unit(low, member, made, unit))  # type: ignore[misc]


def _told(low: "Lowering", node: Node, made: Element) -> None:
    """A unit that the library does not have, as metadata of ours says."""
    one = annotations.ours(node).get("Unit")
    if one is None:
        return
    said = {key: str(value) for key, value in annotations.constants_of(one)}
    name, symbol = said.get("name", ""), said.get("symbol", "")
    outside = {"external": True, "library": True}
    unit = low.make(one, Kind.UNIT, name, made, symbol=symbol, **outside)
    low.graph.connect(Edge.REFERENCES, made, unit)
    if said.get("quantity"):
        quantity = low.make(one, Kind.QUANTITY_KIND, said["quantity"], made, **outside)
        low.graph.connect(Edge.REFERENCES, made, quantity)
        low.graph.connect(Edge.REFERENCES, unit, quantity)


def _unit(low: "Lowering", node: Node, made: Element, unit: Reference) -> None:
    """A unit that the model defines itself, by its symbol; else one of the library."""
    name, symbol = unit_name(unit)
    known = low.element(unit.target)
    for one in low.graph.of_kind(Kind.INSTANCE) if known is None else ():
        if one.role == "unit" and (one.attrs.get("symbol") == symbol or one.name == name):
            known = one
            break
    if known is None:
        known = low.make(node, Kind.UNIT, name, made, symbol=symbol, external=True, library=True)
    low.graph.connect(Edge.REFERENCES, made, known)


def _kind(low: "Lowering", node: Node, made: Element, name: str) -> None:
    """A quantity kind; one that the unit of a model's own tells needs no element."""
    units = low.graph.targets(made, Edge.REFERENCES)
    if any(one.kind is Kind.INSTANCE for one in units):
        return
    one = low.make(node, Kind.QUANTITY_KIND, name, made, external=True, library=True)
    low.graph.connect(Edge.REFERENCES, made, one)
    for unit in units:
        if unit.kind is Kind.UNIT and unit.owner == made.id:
            low.graph.connect(Edge.REFERENCES, unit, one)


def kind_name(value_type: str) -> str:
    """``ThermodynamicTemperatureValue`` is the value type of ``thermodynamic temperature``."""
    found = _VALUE.fullmatch(value_type)
    return _UPPER.sub(" ", found["name"] if found else value_type).lower()


def unit_name(unit: Reference) -> tuple[str, str]:
    """Name and symbol of a unit of the library."""
    target, symbol = unit.target, nodes.last_name(unit)
    if target is None:
        return symbol, symbol
    return target.name or symbol, target.short_name or symbol
