"""Decides whether a member that an instance repeats overrides the member of its class.

An instance of CAEX is a copy: it repeats the members of its class. A repeated member with the
same definition is the member of the class, perhaps with another value; any other is a new one.
"""

from collections.abc import Iterator

from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Member, Type, TypeTable
from sysmlc.frontends.caex.vocabulary import Family

_DEFINING_ATTRIBUTES = ("Unit", "AttributeDataType")
"""XML attributes that define an attribute; one that is omitted changes nothing."""
_DEFINING_TAGS = ("Constraint", "RefSemantic")
_IMPLIED_DATA_TYPES = frozenset({"", "xs:string", "xs:boolean", "xs:integer", "xs:double"})
"""Data types that a value shows by itself."""
_STANDARD_ATTRIBUTES = frozenset({"Direction", "Cardinality", "Category"})
"""Attributes of ports, which are named as their attribute types (IEC 62714-1)."""
_BOOKKEEPING = frozenset({"ID", "ChangeMode"})
"""XML attributes that differ between copies."""


def overrides_attribute(types: TypeTable, document: Document, node: Node, member: Member) -> bool:
    """Whether a repeated attribute, or one below it, defines more than a value."""
    worklist = [(node, member)]
    while worklist:
        attribute, inherited = worklist.pop()
        if _has_other_definition(types, document, attribute, inherited):
            return True
        for child in attribute.iter_children("Attribute"):
            type = inherited.type
            inner = type.find_member(child.tag, child.name) if type is not None else None
            if inner is None:
                return True
            worklist.append((child, inner))
    return False


def iter_overriding_attributes(
    types: TypeTable, document: Document, interface: Node, type: Type | None
) -> Iterator[Node]:
    """Yield the attributes of an interface that override more than the values in its class."""
    for node in interface.iter_children("Attribute"):
        member = type.find_member("Attribute", node.name) if type is not None else None
        if member is None:
            if _defines_more_than_value(node):
                yield node
            continue
        is_described = _has_own_description(node, member)
        if is_described or _overrides_interface_attribute(types, document, node, member):
            yield node


def _overrides_interface_attribute(
    types: TypeTable, document: Document, node: Node, member: Member
) -> bool:
    """Whether an attribute of an interface overrides that of its class.

    Direction, cardinality and category become properties of the port. Of their definition only
    constraints and semantics count, because the standard defines the rest.
    """
    if node.name in _STANDARD_ATTRIBUTES:
        is_constrained = any(inner.tag in _DEFINING_TAGS for inner in node.iter_subtree())
        if not is_constrained:
            return False
    return overrides_attribute(types, document, node, member)


def _defines_more_than_value(node: Node) -> bool:
    """Whether an attribute that no class has defines more than a name and a value."""
    worklist = [node]
    for attribute in worklist:
        if attribute.child_text("Value") is None and not attribute.children:
            return True
        if attribute.attributes.get("Unit") or not _has_implied_type(attribute):
            return True
        if attribute.child_text("DefaultValue") or attribute.child_text("Description"):
            return True
        inner = list(attribute.iter_children("Attribute"))
        if len(inner) < len(attribute.children):
            return True
        worklist += inner
    return False


def _has_implied_type(node: Node) -> bool:
    """Whether the value of an attribute shows its type, or the standard defines it."""
    path = node.attributes.get("RefAttributeType", "")
    if path:
        return path.rpartition("/")[2] in _STANDARD_ATTRIBUTES
    return node.attributes.get("AttributeDataType", "") in _IMPLIED_DATA_TYPES


def _has_own_description(node: Node, member: Member) -> bool:
    text = (node.child_text("Description") or "").strip()
    return bool(text) and text != (member.node.child_text("Description") or "").strip()


def _has_other_definition(types: TypeTable, document: Document, node: Node, member: Member) -> bool:
    """Whether unit, data type, default, constraints or type differ from those of *member*."""
    for name in _DEFINING_ATTRIBUTES:
        value = node.attributes.get(name)
        definitions = _iter_definitions(member)
        if value and all(value != other.attributes.get(name) for other in definitions):
            return True
    default = node.child_text("DefaultValue")
    if default is not None and default != member.node.child_text("DefaultValue"):
        return True
    if node.children:
        inherited_forms = [
            _canonical_form(child)
            for definition in _iter_definitions(member)
            for child in definition.iter_children(*_DEFINING_TAGS)
        ]
        forms = map(_canonical_form, node.iter_children(*_DEFINING_TAGS))
        if any(form not in inherited_forms for form in forms):
            return True
    return _has_other_type(types, document, node, member)


def _iter_definitions(member: Member) -> Iterator[Node]:
    """Yield the nodes that define an attribute: its declaration, and its attribute types."""
    yield member.node
    if member.type is not None:
        yield from (type.node for type in member.type.iter_chain())


def _has_other_type(types: TypeTable, document: Document, node: Node, member: Member) -> bool:
    path = node.attributes.get("RefAttributeType", "").strip()
    if not path or path == member.node.attributes.get("RefAttributeType", "").strip():
        return False
    type = types.find(path, Family.ATTRIBUTE, document)
    return isinstance(type, Type) and (member.type is None or not member.type.specializes(type))


def _canonical_form(node: Node) -> tuple[object, ...]:
    """Return the content of a node in a form that is equal for copies."""
    attributes = {key: text for key, text in node.attributes.items() if key not in _BOOKKEEPING}
    texts = {tag: text.strip() for tag, text in node.texts.items() if text.strip()}
    return (
        node.tag,
        tuple(sorted(attributes.items())),
        tuple(sorted(texts.items())),
        tuple(_canonical_form(child) for child in node.children),
    )
