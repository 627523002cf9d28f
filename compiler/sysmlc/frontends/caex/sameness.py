"""Whether a member that an instance repeats says what its class says, or more."""

from collections.abc import Iterator

from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Member, Type, Types
from sysmlc.frontends.caex.vocabulary import Family

_STATED = ("Unit", "AttributeDataType")
"""What an attribute states in attributes of XML; one that is left out states nothing."""
_KEPT = ("Constraint", "RefSemantic")
_TOLD = frozenset({"", "xs:string", "xs:boolean", "xs:integer", "xs:double"})
"""Data types that a value has anyway."""
_STANDARD = frozenset({"Direction", "Cardinality", "Category"})
"""Attribute types of what a port says by itself (IEC 62714-1)."""
_BOOKKEEPING = frozenset({"ID", "ChangeMode"})


def says_more(types: Types, document: Document, top: Node, known: Member) -> bool:
    """Whether a repeated attribute needs a redefinition: a value alone does not."""
    waiting = [(top, known)]
    while waiting:
        node, member = waiting.pop()
        if _differs(types, document, node, member):
            return True
        for child in node.of("Attribute"):
            inner = member.type.find("Attribute", child.name) if member.type else None
            if inner is None:
                return True
            waiting.append((child, inner))
    return False


def more_than_values(
    types: Types, document: Document, interface: Node, type: Type | None
) -> Iterator[Node]:
    """Attributes of an interface that say more than values for what its class has."""
    for node in interface.of("Attribute"):
        known = type.find("Attribute", node.name) if type is not None else None
        if known is None:
            if _is_more_than_a_value(node):
                yield node
        elif _describes(node, known) or _port_says_more(types, document, node, known):
            yield node


def _port_says_more(types: Types, document: Document, node: Node, known: Member) -> bool:
    """As ``says_more``; what a port has of its own (direction, cardinality) has one type."""
    if node.name in _STANDARD and not any(one.tag in _KEPT for one in node.walk()):
        return False
    return says_more(types, document, node, known)


def _is_more_than_a_value(top: Node) -> bool:
    """Whether an attribute that no class has says more than name and value."""
    waiting = [top]
    for node in waiting:
        if node.text("Value") is None and not node.children:
            return True
        if node.attributes.get("Unit") or not _is_told(node):
            return True
        if node.text("DefaultValue") or node.text("Description"):
            return True
        inside = list(node.of("Attribute"))
        if len(inside) < len(node.children):
            return True
        waiting += inside
    return False


def _is_told(node: Node) -> bool:
    """Whether the value of an attribute tells its type: that of a standard name is known."""
    path = node.attributes.get("RefAttributeType", "")
    if path:
        return path.rpartition("/")[2] in _STANDARD
    return node.attributes.get("AttributeDataType", "") in _TOLD


def _describes(node: Node, known: Member) -> bool:
    text = (node.text("Description") or "").strip()
    return bool(text) and text != (known.node.text("Description") or "").strip()


def _differs(types: Types, document: Document, node: Node, known: Member) -> bool:
    for name in _STATED:
        value = node.attributes.get(name)
        if value and value != known.node.attributes.get(name) and value not in _known(known, name):
            return True
    default = node.text("DefaultValue")
    if default is not None and default != known.node.text("DefaultValue"):
        return True
    if node.children:
        kept = [_form(child) for child in node.of(*_KEPT)]
        of_class = [_form(c) for source in _sources(known) for c in source.of(*_KEPT)]
        if any(form not in of_class for form in kept):
            return True
    return _is_typed_otherwise(types, document, node, known)


def _sources(known: Member) -> Iterator[Node]:
    """The nodes that say what the known attribute is: itself, and its types."""
    yield known.node
    if known.type is not None:
        yield from (type.node for type in known.type.chain())


def _known(known: Member, name: str) -> list[str | None]:
    return [node.attributes.get(name) for node in _sources(known)]


def _is_typed_otherwise(types: Types, document: Document, node: Node, known: Member) -> bool:
    path = node.attributes.get("RefAttributeType", "").strip()
    if not path or path == known.node.attributes.get("RefAttributeType", "").strip():
        return False
    found = types.find(path, Family.ATTRIBUTE, document)
    return isinstance(found, Type) and (known.type is None or found not in known.type.chain())


def _form(node: Node) -> tuple[object, ...]:
    """The node without what tells one copy from another."""
    attributes = {k: v for k, v in node.attributes.items() if k not in _BOOKKEEPING}
    texts = {k: t.strip() for k, t in (node.texts or {}).items() if t.strip()}
    return (
        node.tag,
        tuple(sorted(attributes.items())),
        tuple(sorted(texts.items())),
        tuple(_form(child) for child in node.children),
    )
