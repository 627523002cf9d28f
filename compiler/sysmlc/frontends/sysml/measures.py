"""Quantities and units of value types: those of the libraries ISQ and SI as docs/ir.md has them."""

import re
from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import nodes
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
    """The quantity kind and the unit that a value type's declaration says."""
    for found in nodes.references(node, "Subclassification", "Subsetting", "FeatureTyping"):
        if is_measured(found):
            name = kind_name(nodes.last_name(found))
            _own(low, node, made, Kind.QUANTITY_KIND, name, "")
    for member in node.members:
        value = nodes.value_of(member)
        if nodes.name_of(member) == "mRef" and value is not None:
            unit = nodes.reference(value, "Membership")
            if unit is not None:
                name, symbol = unit_name(unit)
                _own(low, member, made, Kind.UNIT, name, symbol)


def _own(low: "Lowering", node: Node, made: Element, kind: Kind, name: str, symbol: str) -> None:
    one = low.make(node, kind, name, made, symbol=symbol, external=True)
    low.graph.connect(Edge.REFERENCES, made, one)


def kind_name(value_type: str) -> str:
    """``ThermodynamicTemperatureValue`` is the value type of ``thermodynamic temperature``."""
    found = _VALUE.fullmatch(value_type)
    return _UPPER.sub(" ", found["name"] if found else value_type).lower()


def unit_name(unit: Reference) -> tuple[str, str]:
    """Name and symbol of a unit of the library."""
    target, symbol = unit.target, nodes.last_name(unit)
    if target is None:
        return symbol, symbol
    return target.name or symbol, target.short or symbol
