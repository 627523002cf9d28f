"""Attributes and attribute types, with their values and constraints."""

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass

from sysmlc.backends.aml.class_kinds import (
    PRIMITIVES,
    ClassKind,
    find_class_kind,
    is_inline,
    is_measured_type,
    is_primitive,
)
from sysmlc.backends.aml.context import Context, File, find_unresolved
from sysmlc.backends.aml.header import write_header, write_semantics
from sysmlc.backends.aml.node import Node, format_value
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query.classifiers import name_value_unit, unit_of

_LISTS = ("ListType", "OrderedListType")
"""Semantics of unordered and ordered lists (AutomationML Part 1)."""
_BOUNDS = {"<=": "RequiredMaxValue", "==": "RequiredValue", ">=": "RequiredMinValue"}
"""Children of an OrdinalScaledType in the order of the schema, by the comparison."""
_COMPARISON = re.compile(r"(?P<name>[^\W\d]\w*|'.*?') (?P<sign><=|>=|==) ", re.DOTALL)
_DECODER = json.JSONDecoder()


@dataclass(slots=True)
class Typing:
    """The types of an attribute; each of them may be missing."""

    declared: Element | None = None
    """The AttributeType."""
    structure: Element | None = None
    """The inline type that holds the inner attributes."""
    primitive: str = ""
    """The XML Schema type of a primitive type."""


def is_attribute(context: Context, feature: Element) -> bool:
    """Whether a property has values: it is typed by a value type, or untyped."""
    if feature.kind is not Kind.PROPERTY or feature.role not in ("value", ""):
        return False
    type_ = context.graph.target(feature, Edge.TYPED_BY)
    if type_ is None:
        return True
    if is_primitive(type_) or is_measured_type(type_) or is_inline(type_):
        return type_.kind is Kind.DATA_TYPE
    is_value_type = type_.kind in (Kind.DATA_TYPE, Kind.ENUMERATION)
    return is_value_type or find_class_kind(context.graph, type_) is ClassKind.ATTRIBUTE


def make_attribute(context: Context, feature: Element, file: File) -> Node:
    """Return the attribute of a value property, with its inner attributes."""
    root = _make_outer_attribute(context, feature, file)
    stack = [(root, _find_types(context, feature).structure)]
    while stack:
        node, structure = stack.pop()
        if structure is None:
            continue
        context.written.add(structure.id)
        for inner in context.graph.owned(structure):
            if inner.kind is Kind.PROPERTY:
                child = node.add(_make_outer_attribute(context, inner, file))
                stack.append((child, _find_types(context, inner).structure))
    return root


def _make_outer_attribute(context: Context, feature: Element, file: File) -> Node:
    node = context.register(feature, Node("Attribute", {"Name": feature.name}))
    context.copy_id(feature, node)
    write_attribute_type(context, feature, node, file)
    _write_values(feature, node)
    write_header(context, feature, node)
    write_semantics(feature, node)
    _write_list_semantics(context, feature, node)
    _write_constraints(context, feature, node)
    return node


def write_attribute_type(context: Context, feature: Element, node: Node, file: File) -> None:
    """Add data type, unit and attribute type; the copy of an attribute repeats them."""
    typing = _find_types(context, feature)
    data_type = str(feature.attrs.get("data_type", ""))
    # An AutomationML file states the data type, or omits it on purpose.
    if not data_type and not context.ids.is_from_caex(feature):
        data_type = typing.primitive
    if data_type:
        node.attributes["AttributeDataType"] = data_type
    unit = _find_unit(context, feature)
    if unit:
        node.attributes["Unit"] = unit
    _write_type_reference(context, feature, typing, node, file)


def _write_type_reference(
    context: Context, feature: Element, typing: Typing, node: Node, file: File
) -> None:
    """Write the path of the attribute type, or the ID of the master of a mirror attribute."""
    master = context.graph.target(feature, Edge.MIRRORS)
    if master is not None:
        context.mark_edge(Edge.MIRRORS, feature, master)
        context.pending_references.append((node, "RefAttributeType", master))
        return
    path = context.make_class_path(typing.declared, file) if typing.declared is not None else ""
    if not node.is_copy:
        path = path or find_unresolved(feature, "Attribute")
    if path:
        node.attributes["RefAttributeType"] = path
    elif typing.declared is not None:
        context.losses.record_untyped(feature, str(feature.kind), typing.declared)


def _find_types(context: Context, feature: Element) -> Typing:
    """Return the types of an attribute; inline types specialise the attribute type."""
    types = context.graph.targets(feature, Edge.TYPED_BY)
    for type_ in types:
        context.mark_edge(Edge.TYPED_BY, feature, type_)
    typing = Typing()
    for type_ in context.iter_bases(types[0] if types else None):
        if is_primitive(type_):
            typing.primitive = PRIMITIVES.get(type_.name, "")
            break
        if is_inline(type_):
            typing.structure = type_
        elif not is_measured_type(type_):
            typing.declared = type_
            typing.primitive = _find_base_primitive(context, type_)
            break
    return typing


def _find_base_primitive(context: Context, type_: Element) -> str:
    """Return the XML Schema type of the primitive type that a value type specialises."""
    for base in context.iter_bases(type_):
        if is_primitive(base):
            return PRIMITIVES.get(base.name, "")
        if base.kind is Kind.ENUMERATION:
            return "xs:string"
    return ""


def _find_unit(context: Context, element: Element) -> str:
    """Return the unit of the default value, else the declared unit.

    The declared unit is also that of the bounds in constraints. A default value in another unit
    then has no place for its unit, which is a loss.
    """
    declared = find_declared_unit(context, element)
    unit = name_value_unit(context.graph, element, "default")
    sources = context.graph.sources(element, Edge.REFERENCES)
    has_bounds = any(source.kind is Kind.CONSTRAINT for source in sources)
    return declared if declared and has_bounds else unit or declared


def find_declared_unit(context: Context, element: Element) -> str:
    """Return the unit that an attribute or its type states, without regard to its value."""
    text = element.attrs.get("unit")
    if text or context.ids.is_from_caex(element):
        return str(text or "")
    unit = unit_of(context.graph, element)
    return "" if unit is None else str(unit.attrs.get("symbol") or unit.name)


def _write_values(feature: Element, node: Node) -> None:
    """Write DefaultValue and Value.

    Where an attribute has no Value, the front end ``caex`` reads its DefaultValue as the value
    (``default`` in the graph). So a DefaultValue that equals the value stands alone, and an
    attribute that has only a DefaultValue gets an empty Value.
    """
    value, default = feature.attrs.get("default"), feature.attrs.get("default_value")
    if default is not None:
        node.add_text("DefaultValue", format_value(default))
    if value is None and default is not None:
        node.add_text("Value", "")
    elif value is not None and (default is None or not _is_equal(value, str(default))):
        node.add_text("Value", format_value(value))


def _is_equal(value: object, text: str) -> bool:
    """Whether *text* is a lexical form of the value."""
    if isinstance(value, bool):
        return text.strip().lower() in (("true", "1") if value else ("false", "0"))
    if isinstance(value, int | float):
        try:
            return float(text) == value
        except ValueError:
            return False
    return value == text


def _write_list_semantics(context: Context, feature: Element, node: Node) -> None:
    """Mark a feature with many values as a list, in the way that AutomationML defines."""
    if feature.attrs.get("multiplicity") != "*" or context.ids.is_from_caex(feature):
        return
    name = _LISTS[bool(feature.attrs.get("ordered"))]
    node.add(Node("RefSemantic", {"CorrespondingAttributePath": name}))


# -- attribute types ---------------------------------------------------------------------------


def fill_attribute_type(context: Context, type_: Element, node: Node, file: File) -> None:
    """Add the data type, unit, values, inner attributes and literals of an attribute type."""
    data_type = str(type_.attrs.get("data_type", ""))
    if not data_type and not context.ids.is_from_caex(type_):
        data_type = _find_base_primitive(context, type_)
    if data_type:
        node.attributes["AttributeDataType"] = data_type
    unit = _find_unit(context, type_)
    if unit:
        node.attributes["Unit"] = unit
    _write_values(type_, node)
    write_semantics(type_, node)
    _write_constraints(context, type_, node)
    owned = context.graph.owned(type_)
    for feature in owned:
        if feature.kind is Kind.PROPERTY:
            node.add(make_attribute(context, feature, file))
    literals = [element for element in owned if element.kind is Kind.ENUMERATION_LITERAL]
    if literals:
        _write_literals(context, type_, node, literals)


def _write_literals(context: Context, type_: Element, node: Node, literals: list[Element]) -> None:
    """Write an enumeration as a constraint with nominal values; CAEX has no enumerations."""
    scale = node.add(Node("Constraint", {"Name": "literals"})).add(Node("NominalScaledType"))
    for literal in literals:
        scale.add_text("RequiredValue", literal.name)
        context.written.add(literal.id)
    context.losses.record_approximation(
        type_, "an enumeration", "an attribute type with nominal values"
    )


# -- constraints -------------------------------------------------------------------------------


def _write_constraints(context: Context, subject: Element, node: Node) -> None:
    """Add the constraints that refer to an attribute or attribute type."""
    for source in context.graph.sources(subject, Edge.REFERENCES):
        if source.kind is Kind.CONSTRAINT and source.id not in context.written:
            context.mark_edge(Edge.REFERENCES, source, subject)
            constraint = node.add(
                context.register(source, Node("Constraint", {"Name": source.name}))
            )
            write_header(context, source, constraint)
            constraint.add(_make_scale(context, source, subject.name))


def _make_scale(context: Context, constraint: Element, name: str) -> Node:
    """Return the bounds or values that a constraint allows, or its text if CAEX has no form.

    The front end ``caex`` marks the expressions that it makes of CAEX constraints by the language
    ``sysmlc``; only these are translated back.
    """
    body = str(constraint.attrs.get("body", ""))
    language = constraint.attrs.get("language")
    if language == "sysmlc":
        scale = _translate_expression(body, name)
        if scale is not None:
            return scale
    elif language:
        context.losses.record_approximation(
            constraint, f"a constraint in {language}", "text of unknown type"
        )
    node = Node("UnknownType")
    node.add_text("Requirements", body)
    return node


def _translate_expression(body: str, name: str) -> Node | None:
    """Return the ordinal or nominal scale of an expression about *name*.

    Returns None for an expression other than ``name >= 1 && name <= 3`` or
    ``name == 1 || name == 2``.
    """
    ordinal = Node("OrdinalScaledType")
    if not body:
        return ordinal
    terms = list(_iter_comparisons(body, name, " && "))
    signs = [sign for sign, _ in terms]
    if terms and len(set(signs)) == len(signs) and "" not in signs:
        texts = dict(terms)
        for sign, tag in _BOUNDS.items():
            if sign in texts:
                ordinal.add_text(tag, texts[sign])
        return ordinal
    terms = list(_iter_comparisons(body, name, " || "))
    if not terms or {sign for sign, _ in terms} != {"=="}:
        return None
    nominal = Node("NominalScaledType")
    for _, text in terms:
        nominal.add_text("RequiredValue", text)
    return nominal


def _iter_comparisons(body: str, name: str, separator: str) -> Iterator[tuple[str, str]]:
    """Yield operator and literal of each comparison of *name* in a conjunction or disjunction.

    Yields ``("", "")`` for a term of another form and stops there.
    """
    position = 0
    while position < len(body):
        match = _COMPARISON.match(body, position)
        if match is None or match["name"].strip("'") != name:
            yield "", ""
            return
        try:
            value, position = _DECODER.raw_decode(body, match.end())
        except ValueError:
            yield "", ""
            return
        yield match["sign"], format_value(value)
        if position < len(body) and not body.startswith(separator, position):
            yield "", ""
            return
        position += len(separator)
