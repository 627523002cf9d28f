"""Attributes: value properties of classes, with their nested attributes and constraints."""

import json
import re

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import data_types, value_types
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.findings import Findings
from sysmlc.frontends.caex.scales import check_scales
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Edge, Element, Graph, Kind

_IDENTIFIER = re.compile(r"[^\W\d]\w*$")
_BOUND_OPERATORS = {"RequiredMinValue": ">=", "RequiredValue": "==", "RequiredMaxValue": "<="}


def lower_attribute(context: Context, owner: Type, node: Node, document: Document) -> None:
    """Add an attribute of a class; nested attributes are features of a type added for it."""
    worklist = [(owner, node)]
    while worklist:
        holder, attribute = worklist.pop()
        structure = _lower_single(context, holder, attribute, document)
        if structure is not None:
            nested = list(attribute.iter_children("Attribute"))
            worklist += [(structure, inner) for inner in reversed(nested)]


def _lower_single(context: Context, owner: Type, node: Node, document: Document) -> Type | None:
    """Add an attribute; return the type added for its nested attributes, None if it has none."""
    data_type = node.attributes.get("AttributeDataType", "")
    value, default = node.child_text("Value"), node.child_text("DefaultValue")
    initial = default if value is None else value
    element = context.add_element(
        Kind.PROPERTY,
        node,
        document,
        owner.id,
        role="value",
        data_type=data_type,
        default_value=default if default != value else None,
        semantics=_read_semantics(node),
    )
    declared = context.resolve_member_class(node, document)
    data_types.check_data_type(context.findings, document, node.row, data_type)
    if initial:
        converted = data_types.convert_value(context.findings, node, initial, data_type, declared)
        element.attrs["default"] = converted
    if default and default != initial:
        # The text is stored as it is written; the conversion only checks it.
        data_types.convert_value(context.findings, node, default, data_type, declared)
    value_types.set_multiplicity(element.attrs, declared)
    connect_redefined(context.graph, owner, node, element)
    structure = _add_structure(context, owner, node, document, element, declared)
    type = structure or declared
    value_types.connect_type(context.graph, context.findings, element, node, document, type)
    lower_constraints(context, element, node, document)
    check_scales(context.findings, document, node, [node], declared)
    owner.members["Attribute", node.name] = Member(element.id, type, document, node.row)
    return structure


def connect_redefined(graph: Graph, owner: Type, node: Node, element: Element) -> None:
    """Connect a feature to the inherited feature of its name, which it replaces as a whole.

    AML.Engine overrides by name, too, and does not merge nested attributes.
    """
    inherited = owner.base.find_member(node.tag, node.name) if owner.base else None
    if inherited is not None:
        graph.connect(Edge.REDEFINES, element.id, inherited.id)


def _add_structure(
    context: Context,
    owner: Type,
    node: Node,
    document: Document,
    element: Element,
    declared: Type | None,
) -> Type | None:
    """Add the data type for an attribute that has nested attributes."""
    if not node.has_child("Attribute"):
        return None
    data_type = Element(f"{element.id}#type", Kind.DATA_TYPE, node.name, owner.id)
    data_type.attrs.update(role="value type", subkind="attribute")
    type = Type(data_type.id, document, node.row, Family.ATTRIBUTE)
    return add_own_type(context, data_type, type, declared)


def add_own_type(context: Context, element: Element, type: Type, declared: Type | None) -> Type:
    """Add a type for a single feature, which specialises the declared type of the feature."""
    element.id = type.id = context.make_unique(element.id, type.node)
    context.set_location(element, type.document, type.node.ordinal)
    context.graph.add(element)
    type.base = declared
    if declared is not None:
        context.graph.connect(Edge.SPECIALIZES, type.id, declared.id)
    return type


def _read_semantics(node: Node) -> tuple[str, ...]:
    """Return the references to dictionaries such as ECLASS, and mark them as mapped."""
    paths = []
    for reference in node.iter_children("RefSemantic"):
        reference.verdict = Verdict.MAPPED
        paths.append(reference.attributes.get("CorrespondingAttributePath", ""))
    return tuple(path for path in paths if path)


# -- constraints -----------------------------------------------------------------------------------


def lower_constraints(context: Context, attribute: Element, node: Node, document: Document) -> None:
    """Add the constraints of an attribute (IEC 62424: ordinal, nominal and unknown scale).

    Bounds and lists of values become expressions, requirements of an unknown scale stay text.
    """
    data_type = node.attributes.get("AttributeDataType", "")
    for child in node.iter_children("Constraint"):
        body, language = _format_body(context.findings, child, attribute.name, data_type)
        id = f"{attribute.id}/{child.name or 'Constraint'}"
        constraint = context.add_element(
            Kind.CONSTRAINT,
            child,
            document,
            attribute.owner,
            id=context.make_unique(id, child),
            body=body,
            language=language,
        )
        context.graph.connect(Edge.REFERENCES, constraint.id, attribute.id)
        child.mark_subtree()


def _format_body(findings: Findings, node: Node, name: str, data_type: str) -> tuple[str, str]:
    """Return the expression or text of a constraint, and its language."""
    subject = name if _IDENTIFIER.match(name) else f"'{name}'"
    for scale in node.children:
        if scale.tag == "OrdinalScaledType":
            comparisons = [
                f"{subject} {operator} {_format_literal(findings, node, text, data_type)}"
                for tag, operator in _BOUND_OPERATORS.items()
                for text in scale.child_texts(tag)
            ]
            return " && ".join(comparisons), "sysmlc"
        if scale.tag == "NominalScaledType":
            texts = scale.child_texts("RequiredValue")
            literals = [_format_literal(findings, node, text, data_type) for text in texts]
            return " || ".join(f"{subject} == {literal}" for literal in literals), "sysmlc"
        if scale.tag == "UnknownType":
            return " ".join(scale.child_texts("Requirements")).strip(), ""
    return "", ""


def _format_literal(findings: Findings, node: Node, text: str, data_type: str) -> str:
    value = data_types.convert_value(findings, node, text, data_type, None)
    if isinstance(value, str):
        value = _parse_number(text)
    return json.dumps(value, ensure_ascii=False)


def _parse_number(text: str) -> float | int | str:
    """Return a number if the text is one.

    Bounds are texts in CAEX 3.0, also where the attribute has no data type.
    """
    for convert in (int, float):
        try:
            return convert(text.strip())
        except ValueError:
            continue
    return text
