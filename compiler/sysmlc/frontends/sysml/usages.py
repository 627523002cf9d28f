"""Usages in packages: instances when they only give values, else classes of their own."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import nodes, values
from sysmlc.frontends.sysml.definitions import define, marked, outside, visibility
from sysmlc.frontends.sysml.features import is_interface_id
from sysmlc.frontends.sysml.types import types_of
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_UNITS = {"SimpleUnit": "unit", "DerivedUnit": "unit", "QuantityDimension": "quantity kind"}
_CLASSES = {"PortUsage": "interface block", "AttributeUsage": "value type"}


def in_package(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A usage that no definition owns."""
    role = next((_UNITS[n] for one in types_of(low, node) if (n := one.name or "") in _UNITS), "")
    if role:
        _unit(low, node, owner, role)
    elif is_instance(node):
        instance(low, node, owner)
    else:
        kind = Kind.DATA_TYPE if node.kind == "AttributeUsage" else Kind.CLASS
        made = define(low, node, owner, kind, _CLASSES.get(node.kind, "block"), usage=True)
        low.set(made, multiplicity=values.multiplicity(low, node))


def _unit(low: "Lowering", node: Node, owner: Element | None, role: str) -> None:
    made = low.add(node, Kind.INSTANCE, node.name or "", owner, role=role, symbol=node.short_name)
    low.lower_texts(node, made)


def is_instance(node: Node) -> bool:
    """Whether all that stands in a usage are values for what its type has, and links between."""
    inside = [one for one in nodes.body_of(node) if not nodes.is_text(one)]
    return all(one.kind in _LINKS or (_redefines(one) and is_instance(one)) for one in inside)


_NAMES = """
    ConnectionUsage InterfaceUsage BindingConnectorAsUsage FlowUsage Dependency AllocationUsage
"""
_LINKS = frozenset(_NAMES.split())


def _redefines(node: Node) -> bool:
    is_structural = not node.kind.startswith(("Action", "State", "Perform", "Exhibit"))
    return nodes.reference(node, "Redefinition") is not None and is_structural


def instance(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A usage as an instance of its types, with a slot for each value."""
    _, subkind = marked(node, Kind.INSTANCE)
    attrs: dict[str, AttrValue] = {"subkind": subkind, **visibility(node), **outside(node)}
    made = low.add(node, Kind.INSTANCE, nodes.name_of(node), owner, **attrs)
    value = nodes.value_of(node)
    if value is not None:
        values.give(low, made, "value", value)
    low.later(lambda: _typed(low, node, made))
    _slots(low, node, made)


def _typed(low: "Lowering", node: Node, made: Element) -> None:
    for type_ in types_of(low, node):
        low.lead(Edge.INSTANCE_OF, made, type_)
    for found in nodes.subsetted(node):
        known = low.element(found.target)
        if known is not None:
            low.graph.connect(Edge.INSTANCE_OF, made, known)


def _slots(low: "Lowering", node: Node, made: Element) -> None:
    for one in nodes.body_of(node):
        is_part = one.kind == "PartUsage" and nodes.value_of(one) is None
        if nodes.is_text(one) or one.kind in _LINKS:
            low.lower(one, made)
        elif is_interface_id(low, one, made):
            continue
        elif is_part or [inner for inner in nodes.body_of(one) if not nodes.is_text(inner)]:
            _part(low, one, made)
        else:
            _slot(low, one, made)


def _part(low: "Lowering", node: Node, above: Element) -> None:
    """Values for a part of an instance."""
    made = low.add(node, Kind.INSTANCE, nodes.name_of(node), above, subkind="part")
    low.refer(Edge.REPRESENTS, made, nodes.reference(node, "Redefinition"))
    low.later(lambda: _typed(low, node, made))
    _slots(low, node, made)


def _slot(low: "Lowering", node: Node, owner: Element) -> None:
    made = low.add(node, Kind.SLOT, nodes.name_of(node), owner)
    low.refer(Edge.INSTANCE_OF, made, nodes.reference(node, "Redefinition"))
    value = nodes.value_of(node)
    if value is not None:
        _value(low, made, value)
    low.lower_texts(node, made)


def _value(low: "Lowering", made: Element, value: Node) -> None:
    target = (
        nodes.target(value, "Membership") if value.kind == "FeatureReferenceExpression" else None
    )
    if target is not None and target.kind != "EnumerationUsage" and low.document(target):
        low.later(lambda: low.lead(Edge.REFERENCES, made, target))
    else:
        values.give(low, made, "value", value)
