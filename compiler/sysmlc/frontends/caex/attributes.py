"""Attributes: value properties of classes."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import constraints, fitting, measures, mirrors
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Edge, Element, Kind


def attribute(context: Context, owner: Type, top: Node, document: Document) -> None:
    """Add an attribute of a class, with those below it as features of a type of its own."""
    waiting = [(owner, top)]
    while waiting:
        holder, node = waiting.pop()
        structure = _attribute(context, holder, node, document)
        if structure is not None:
            inner_nodes = list(node.of("Attribute"))
            waiting += [(structure, inner) for inner in reversed(inner_nodes)]


def _attribute(context: Context, owner: Type, node: Node, document: Document) -> Type | None:
    data_type = node.attributes.get("AttributeDataType", "")
    value, default = node.text("Value"), node.text("DefaultValue")
    given = default if value is None else value
    element = context.add(
        Kind.PROPERTY,
        node,
        document,
        owner.id,
        role="value",
        data_type=data_type,
        default_value=default if default != value else None,
        semantics=_semantics(node),
    )
    declared = mirrors.named_class(context, node, document)
    fitting.know(context, document, node.row, data_type)
    if given:
        element.attrs["default"] = fitting.value(context, node, given, data_type, declared)
    if default and default != given:
        fitting.value(context, node, default, data_type, declared)
    measures.multiply(element.attrs, declared)
    redefine(context, owner, node, element)
    structure = _structure(context, owner, node, document, element, declared)
    measures.type_value(context, element, node, document, structure or declared)
    constraints.lower(context, element, node, document)
    owner.members["Attribute", node.name] = Member(
        element.id, structure or declared, document, node.row
    )
    return structure


def redefine(context: Context, owner: Type, node: Node, element: Element) -> None:
    """Overriding is by name and replaces the whole feature (AML.Engine does the same)."""
    inherited = owner.base.find(node.tag, node.name) if owner.base else None
    if inherited is not None:
        context.graph.connect(Edge.REDEFINES, element.id, inherited.id)


def _structure(
    context: Context,
    owner: Type,
    node: Node,
    document: Document,
    element: Element,
    declared: Type | None,
) -> Type | None:
    """The data type made for an attribute that has attributes of its own."""
    if not any(True for _ in node.of("Attribute")):
        return None
    type = Element(f"{element.id}#type", Kind.DATA_TYPE, node.name, owner.id)
    type.attrs.update(role="value type", subkind="attribute")
    return own_type(context, type, Type(type.id, document, node.row, Family.ATTRIBUTE), declared)


def own_type(context: Context, element: Element, type: Type, declared: Type | None) -> Type:
    """Add the type that only one feature has; it specialises the declared one."""
    element.id = type.id = context.free(element.id, type.node)
    context.place(element, type.document, type.node.ordinal)
    context.graph.add(element)
    type.base = declared
    if declared is not None:
        context.graph.connect(Edge.SPECIALIZES, type.id, declared.id)
    return type


def _semantics(node: Node) -> tuple[str, ...]:
    found = list(node.of("RefSemantic"))
    for one in found:
        one.verdict = Verdict.MAPPED
    paths = (one.attributes.get("CorrespondingAttributePath", "") for one in found)
    return tuple(path for path in paths if path)
