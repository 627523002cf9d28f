"""Whether a member that an instance repeats says what its class says, or more."""

from collections.abc import Iterator

from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Member, Type, Types
from sysmlc.frontends.caex.vocabulary import Family

_STATED = ("Unit", "AttributeDataType")
"""What an attribute states in attributes of XML; one that is left out states nothing."""
_KEPT = ("Constraint", "RefSemantic")
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
