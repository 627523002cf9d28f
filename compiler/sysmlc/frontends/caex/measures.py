"""Types of values: UML primitives, and value types with a unit."""

from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Node
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import PRIMITIVES
from sysmlc.ir import Edge, Element, Kind, Reference

_PRIMITIVE_TYPES = "http://www.omg.org/spec/UML/20161101/PrimitiveTypes.xmi#"


def type_value(context: Context, element: Element, node: Node, type: Type | None) -> None:
    """Type a value property: by its class, by a value type with its unit, or by a primitive."""
    unit = node.attributes.get("Unit", "").strip()
    if unit:
        context.graph.set(element, unit=unit)
    if type is not None:
        context.graph.connect(Edge.TYPED_BY, element.id, type.id)
        return
    name = primitive(node.attributes.get("AttributeDataType", ""))
    href = _PRIMITIVE_TYPES + name
    context.graph.refer(
        Reference(Edge.TYPED_BY, element.id, href, Kind.DATA_TYPE, name, element.ordinal)
    )


def primitive(data_type: str) -> str:
    """UML primitive of an XML Schema data type."""
    return PRIMITIVES.get(data_type.rpartition(":")[2], "String")
