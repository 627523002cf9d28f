"""Features of behaviours: parameters, buffers, and values that they keep."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.definitions import marked, visibility
from sysmlc.frontends.sysml.features import describe, property_
from sysmlc.frontends.sysml.parameters import parameter, pin
from sysmlc.ir import Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

_BUFFERS = (Kind.OBJECT_NODE, Kind.DATA_STORE)
_STEPS = frozenset({Kind.ACTION, Kind.STRUCTURED})


def in_behaviour(low: "Lowering", node: Node, owner: Element) -> Element:
    """A feature of an activity, a step, a state machine or an operation."""
    is_result = node.membership == "ReturnParameterMembership"
    if "direction" in node.attributes or is_result:
        return (pin if owner.kind in _STEPS else parameter)(low, node, owner)
    kind, subkind = marked(node, _kind(low, node, owner))
    if kind in _BUFFERS or subkind == "expansion":
        kind, name = kind if kind in _BUFFERS else Kind.OBJECT_NODE, nodes.name_of(node)
        made = low.add(node, kind, name, owner, subkind=subkind, **visibility(node))
        describe(low, node, made)
        return made
    return property_(low, node, owner)


def _kind(low: "Lowering", node: Node, owner: Element) -> Kind:
    """Items are objects that the activity holds; other features are, when objects flow there."""
    is_flowing = id(node) in low.flowing
    is_item = node.kind == "ItemUsage" and not node.attributes.get("isReference")
    is_node = owner.kind in (Kind.ACTIVITY, Kind.STRUCTURED) and (is_item or is_flowing)
    return Kind.OBJECT_NODE if is_node else Kind.PROPERTY
