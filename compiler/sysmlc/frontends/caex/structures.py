"""New attributes that hold attributes and nothing else: a value property with a type of its own.

The general way (``attributes``) gives the same result for each.
"""

from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.plain import Plain
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Edge, Kind
from sysmlc.ir.shared import Shared

_ATTRS = Shared(role="value type", subkind="attribute")


def structure(context: Context, plain: Plain, owner: Type, row: int) -> Type | None:
    """Add such an attribute without those in it; its type, None when there is more to it."""
    document = plain.document
    if document.is_built_in or not _holds_attributes_alone(document, row):
        return None
    name, _, shape = plain.named(row)
    if shape is None or owner.inherits("Attribute", name):
        return None
    id = f"{owner.id}/{name or 'Attribute'}"
    made = (
        None if f"{id}#type" in context.graph else plain.new(id, name, owner.id, row, shape.attrs)
    )
    if made is None:
        return None
    found = Type(f"{id}#type", document, row, Family.ATTRIBUTE)
    found.base = shape.type
    _add_type(context, found, name, owner)
    context.graph.connect_new(Edge.TYPED_BY, made, context.graph[found.id])
    owner.members["Attribute", name] = Member(id, found, document, row)
    return found


def _holds_attributes_alone(document: Document, row: int) -> bool:
    """Whether a row holds attributes and states neither value nor unit nor ID."""
    texts, tags = document.texts, document.tags
    if document.ids[row] or row in texts["Value"] or row in texts["DefaultValue"]:
        return False
    inside = document.children(row)
    is_plain = bool(inside) and not document.attributes[row].get("Unit")
    return is_plain and all(tags[child] == "Attribute" for child in inside)


def _add_type(context: Context, type: Type, name: str, owner: Type) -> None:
    graph, document = context.graph, type.document
    ordinal = document.ordinals[type.row]
    made = graph.new(type.id, Kind.DATA_TYPE, name, owner.id, ordinal, document.name, _ATTRS)
    if made is not None and type.base is not None:
        graph.connect_new(Edge.SPECIALIZES, made, graph[type.base.id])
