"""External interfaces: ports of classes, with their properties and the documents they name."""

from sysmlc.frontends.caex import attributes, data_types
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.findings import Findings
from sysmlc.frontends.caex.overrides import iter_overriding_attributes
from sysmlc.frontends.caex.types import Member, Type, find_meaning
from sysmlc.frontends.caex.vocabulary import (
    DIRECTIONS,
    DOCUMENT_MEANINGS,
    INTERFACE_MEANINGS,
    Family,
)
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind


def lower_interface(context: Context, owner: Type, node: Node, document: Document) -> None:
    """Add an external interface of a class; nested interfaces are ports of a class added for it."""
    worklist = [(owner, node)]
    while worklist:
        holder, interface = worklist.pop()
        own_type = _lower_single(context, holder, interface, document)
        if own_type is not None:
            worklist += [
                (own_type, child) for child in interface.iter_children("ExternalInterface")
            ]


def _lower_single(context: Context, owner: Type, node: Node, document: Document) -> Type | None:
    """Add an interface without its nested interfaces; return the type added for it, if any."""
    element = context.add_element(Kind.PORT, node, document, owner.id)
    declared = context.resolve_member_class(node, document)
    declared = declared or _find_inherited_class(owner, node)
    attributes.connect_redefined(context.graph, owner, node, element)
    properties = read_port_properties(context.findings, node)
    direction = _find_inherited_direction(context.graph, owner, node, declared)
    if direction:
        properties.setdefault("direction", direction)
    element.attrs.update(properties)
    for child in node.iter_children("Attribute"):
        child.mark_subtree()
    own_type = _add_own_type(context, owner, node, document, element, declared)
    type = own_type or declared
    if type is not None:
        context.graph.connect(Edge.TYPED_BY, element.id, type.id)
    owner.members["ExternalInterface", node.name] = Member(element.id, type, document, node.row)
    meaning = find_meaning(declared, INTERFACE_MEANINGS)
    if meaning:
        context.interface_meanings[element.id] = meaning
        add_external_document(context, node, document, owner.id, element.id, properties)
    return own_type


def _find_inherited_class(owner: Type, node: Node) -> Type | None:
    """Return the class of the interface that *node* overrides, if *node* names none itself."""
    inherited = owner.base.find_member(node.tag, node.name) if owner.base else None
    if inherited is None or node.attributes.get("RefBaseClassPath", "").strip():
        return None
    return inherited.type


def _find_inherited_direction(graph: Graph, owner: Type, node: Node, declared: Type | None) -> str:
    """Return the direction of the interface that *node* overrides, else that of its class."""
    inherited = owner.base.find_member(node.tag, node.name) if owner.base else None
    if inherited is not None and "direction" in graph[inherited.id].attrs:
        return str(graph[inherited.id].attrs["direction"])
    chain = declared.iter_chain() if declared is not None else ()
    directions = (
        _read_direction(child)
        for type in chain
        for child in type.node.iter_children("Attribute")
        if child.name == "Direction"
    )
    return next(filter(None, directions), "")


def _read_direction(node: Node) -> str:
    """Return the direction that an attribute states, or an empty text."""
    value = node.child_text("Value") or node.child_text("DefaultValue") or ""
    return DIRECTIONS.get(value.strip().lower(), "")


def _add_own_type(
    context: Context,
    owner: Type,
    node: Node,
    document: Document,
    element: Element,
    declared: Type | None,
) -> Type | None:
    """Add an interface block with the nested interfaces and attributes that the class lacks."""
    overriding = list(iter_overriding_attributes(context.types, document, node, declared))
    if not overriding and not node.has_child("ExternalInterface"):
        return None
    block = Element(f"{element.id}#type", Kind.CLASS, node.name, owner.id)
    block.attrs.update(role="interface block", subkind="external-interface")
    type = Type(block.id, document, node.row, Family.INTERFACE)
    attributes.add_own_type(context, block, type, declared)
    for attribute in overriding:
        attributes.lower_attribute(context, type, attribute, document)
    return type


# -- properties of a port --------------------------------------------------------------------------


def read_port_properties(findings: Findings, node: Node) -> dict[str, AttrValue]:
    """Return direction, multiplicity, category and values that the attributes of a port give.

    The attributes Direction, Cardinality and Category are those of the class Port (IEC 62714-1).
    """
    properties: dict[str, AttrValue] = {}
    for child in node.iter_children("Attribute"):
        value = child.child_text("Value") or child.child_text("DefaultValue") or ""
        if child.name == "Direction" and _read_direction(child):
            properties["direction"] = _read_direction(child)
        elif child.name == "Cardinality":
            multiplicity = _read_cardinality(child)
            if multiplicity:
                properties["multiplicity"] = multiplicity
        elif child.name == "Category" and value:
            properties["category"] = value
        else:
            properties.update(_read_values(findings, child))
    return properties


def _read_cardinality(node: Node) -> str:
    """Return the multiplicity, or nothing if neither bound has a value."""
    bounds = {
        child.name: (child.child_text("Value") or "").strip()
        for child in node.iter_children("Attribute")
    }
    lower, upper = bounds.get("MinOccur", ""), bounds.get("MaxOccur", "")
    if not lower and not upper:
        return ""
    lower, upper = lower or "0", upper or "*"
    return lower if lower == upper else f"{lower}..{upper}"


def _read_values(findings: Findings, node: Node) -> dict[str, AttrValue]:
    """Return the values of an attribute and its nested attributes, by ``value.`` and their path."""
    values: dict[str, AttrValue] = {}
    worklist = [(node, f"value.{node.name}")]
    while worklist:
        attribute, key = worklist.pop()
        text = attribute.child_text("Value")
        text = attribute.child_text("DefaultValue") if text is None else text
        if text is not None:
            data_type = attribute.attributes.get("AttributeDataType", "")
            values[key] = data_types.convert_value(findings, attribute, text, data_type, None)
        nested = attribute.iter_children("Attribute")
        worklist += [(child, f"{key}.{child.name}") for child in nested]
    return values


# -- external documents ----------------------------------------------------------------------------


def add_external_document(
    context: Context,
    node: Node,
    document: Document,
    owner: str,
    port: str,
    properties: dict[str, AttrValue],
) -> None:
    """Add the document of another language that a port refers to, if it does.

    Such files are recorded, but never loaded (IEC 62714-3 and -4).
    """
    meaning = context.interface_meanings.get(port, "")
    href = properties.get("value.refURI")
    if meaning not in DOCUMENT_MEANINGS or not href:
        return
    id = context.make_unique(f"{owner}/{node.name}#document", node)
    element = Element(id, Kind.DOCUMENT, node.name, owner, node.ordinal, document.name)
    element.attrs.update(subkind=meaning, href=str(href).strip())
    if properties.get("value.MIMEType"):
        element.attrs["media_type"] = properties["value.MIMEType"]
    context.graph.add(element)
    context.graph.connect(Edge.REFERENCES, id, port)
