"""Attributes and attribute types."""

from dataclasses import dataclass

from sysmlc.backends.aml import constraints, header
from sysmlc.backends.aml.book import Book, File
from sysmlc.backends.aml.families import PRIMITIVES, Family, is_inline, is_measured, is_primitive
from sysmlc.backends.aml.node import Node
from sysmlc.backends.aml.rules import APPROXIMATED, UNSAID_EDGE
from sysmlc.backends.aml.values import text_of
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query.units import unit_of

_LISTS = ("ListType", "OrderedListType")


@dataclass(slots=True)
class Typing:
    """What types an attribute: the AttributeType, the type with its inner attributes, the
    primitive; each may be missing."""

    declared: Element | None = None
    structure: Element | None = None
    primitive: str = ""


def write(book: Book, feature: Element, file: File) -> Node:
    """The attribute for a value property, with those below it."""
    top = _attribute(book, feature, file)
    waiting = [(top, _typing(book, feature).structure)]
    while waiting:
        node, structure = waiting.pop()
        if structure is None:
            continue
        book.said.add(structure.id)
        for one in book.graph.owned(structure):
            if one.kind is Kind.PROPERTY:
                inner = node.add(_attribute(book, one, file))
                waiting.append((inner, _typing(book, one).structure))
    return top


def _attribute(book: Book, feature: Element, file: File) -> Node:
    node = book.put(feature, Node("Attribute", {"Name": feature.name}))
    if book.ids.literal(feature):
        node.attributes["ID"] = book.ids.literal(feature)
    declare(book, feature, node, file)
    _values(feature, node)
    header.write(book, feature, node)
    header.semantics(feature, node)
    _list(book, feature, node)
    constraints.write(book, feature, node)
    return node


def declare(book: Book, feature: Element, node: Node, file: File) -> None:
    """Add data type, unit and attribute type; an instance says them again."""
    found = _typing(book, feature)
    ours = book.ids.is_ours(feature)
    type_ = str(feature.attrs.get("data_type", "")) or ("" if ours else found.primitive)
    if type_:
        node.attributes["AttributeDataType"] = type_
    unit = _unit(book, feature)
    if unit:
        node.attributes["Unit"] = unit
    _refer(book, feature, found, node, file)


def _refer(book: Book, feature: Element, found: Typing, node: Node, file: File) -> None:
    master = book.graph.target(feature, Edge.MIRRORS)
    if master is not None:
        book.say(Edge.MIRRORS, feature, master)
        book.late.append((node, "RefAttributeType", master))
        return
    path = book.path(found.declared, file) if found.declared is not None else ""
    if not node.is_copy:
        path = path or unresolved(feature, "Attribute")
    if path:
        node.attributes["RefAttributeType"] = path
    elif found.declared is not None:
        facts = {"edge": "typed-by", "kind": str(feature.kind), "target": str(found.declared.kind)}
        book.losses.note(UNSAID_EDGE, feature, **facts)


def unresolved(element: Element, *tags: str) -> str:
    """A reference that led nowhere, as it was written in an element of one of these tags."""
    found = element.attrs.get("unresolved_paths")
    for pair in found if isinstance(found, tuple) else ():
        if isinstance(pair, tuple) and pair[0] in tags:
            return str(pair[1])
    return ""


def _typing(book: Book, feature: Element) -> Typing:
    found = Typing()
    graph = book.graph
    targets = graph.targets(feature, Edge.TYPED_BY)
    for one in targets:
        book.say(Edge.TYPED_BY, feature, one)
    one_type = targets[0] if targets else None
    seen: set[str] = set()
    while one_type is not None and one_type.id not in seen:
        seen.add(one_type.id)
        if is_primitive(one_type):
            found.primitive = PRIMITIVES.get(one_type.name, "")
            break
        if is_inline(one_type):
            found.structure = one_type
        elif not is_measured(one_type):
            found.declared = one_type
            found.primitive = base_primitive(book, one_type)
            break
        one_type = graph.target(one_type, Edge.SPECIALIZES)
    return found


def base_primitive(book: Book, type_: Element | None) -> str:
    """XML Schema type of what a value type specialises in the end."""
    seen: set[str] = set()
    while type_ is not None and type_.id not in seen:
        if is_primitive(type_):
            return PRIMITIVES.get(type_.name, "")
        if type_.kind is Kind.ENUMERATION:
            return "xs:string"
        seen.add(type_.id)
        type_ = book.graph.target(type_, Edge.SPECIALIZES)
    return ""


def _unit(book: Book, element: Element) -> str:
    written = element.attrs.get("unit")
    if written or book.ids.is_ours(element):
        return str(written or "")
    found = unit_of(book.graph, element)
    return "" if found is None else str(found.attrs.get("symbol") or found.name)


def _values(feature: Element, node: Node) -> None:
    value, default = feature.attrs.get("default"), feature.attrs.get("default_value")
    if default is not None:
        node.say("DefaultValue", text_of(default))
    if value is None and default is not None:
        node.say("Value", "")
    elif value is not None and (default is None or not _is_same(value, str(default))):
        node.say("Value", text_of(value))


def _is_same(value: object, text: str) -> bool:
    """Whether a value is what the text of the default means."""
    if isinstance(value, bool):
        return text.strip().lower() in (("true", "1") if value else ("false", "0"))
    if isinstance(value, int | float):
        try:
            return float(text) == value
        except ValueError:
            return False
    return value == text


def _list(book: Book, feature: Element, node: Node) -> None:
    """Many values: told by the semantics that AutomationML has for lists."""
    if feature.attrs.get("multiplicity") != "*" or book.ids.is_ours(feature):
        return
    name = _LISTS[bool(feature.attrs.get("ordered"))]
    node.add(Node("RefSemantic", {"CorrespondingAttributePath": name}))


# -- attribute types ---------------------------------------------------------------------------


def fill_type(book: Book, type_: Element, node: Node, file: File) -> None:
    """What an attribute type says: base, unit, inner attributes, allowed values."""
    ours = book.ids.is_ours(type_)
    primitive = "" if ours else base_primitive(book, type_)
    data_type = str(type_.attrs.get("data_type", "")) or primitive
    if data_type:
        node.attributes["AttributeDataType"] = data_type
    unit = _unit(book, type_)
    if unit:
        node.attributes["Unit"] = unit
    _values(type_, node)
    header.semantics(type_, node)
    constraints.write(book, type_, node)
    for one in book.graph.owned(type_):
        if one.kind is Kind.PROPERTY:
            node.add(write(book, one, file))
    literals = [one for one in book.graph.owned(type_) if one.kind is Kind.ENUMERATION_LITERAL]
    if literals:
        _literals(book, type_, node, literals)


def _literals(book: Book, type_: Element, node: Node, literals: list[Element]) -> None:
    scale = node.add(Node("Constraint", {"Name": "literals"})).add(Node("NominalScaledType"))
    for one in literals:
        scale.say("RequiredValue", one.name)
        book.said.add(one.id)
    facts = {"said": "an enumeration", "written": "an attribute type with nominal values"}
    book.losses.note(APPROXIMATED, type_, **facts)


def is_attribute(book: Book, feature: Element) -> bool:
    """Whether a property has values: it is typed by a value type, or by nothing."""
    if feature.kind is not Kind.PROPERTY or feature.role not in ("value", ""):
        return False
    type_ = book.graph.target(feature, Edge.TYPED_BY)
    if type_ is None or is_primitive(type_) or is_measured(type_) or is_inline(type_):
        return type_ is None or type_.kind is Kind.DATA_TYPE
    return type_.kind in (Kind.DATA_TYPE, Kind.ENUMERATION) or (
        book.families.of(type_) is Family.ATTRIBUTE
    )
