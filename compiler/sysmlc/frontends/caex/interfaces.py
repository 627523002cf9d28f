"""External interfaces: ports of classes."""

from sysmlc.frontends.caex import attributes, documents, mirrors, ports, sameness, special
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.libraries import mark
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Edge, Element, Kind


def interface(context: Context, owner: Type, top: Node, document: Document) -> None:
    """Add an external interface of a class; nested ones are ports of a class of its own."""
    waiting = [(owner, top)]
    while waiting:
        holder, node = waiting.pop()
        made = _interface(context, holder, node, document)
        waiting += [(made, child) for child in node.of("ExternalInterface") if made is not None]


def _interface(context: Context, owner: Type, node: Node, document: Document) -> Type | None:
    element = context.add(Kind.PORT, node, document, owner.id)
    declared = mirrors.named_class(context, node, document) or _inherited(owner, node)
    attributes.redefine(context, owner, node, element)
    said = ports.said_of(context, node)
    element.attrs.update(said)
    for child in node.of("Attribute"):
        mark(child)
    own = _own_interface(context, owner, node, document, element, declared)
    type = own or declared
    if type is not None:
        context.graph.connect(Edge.TYPED_BY, element.id, type.id)
    owner.members["ExternalInterface", node.name] = Member(element.id, type, document, node.row)
    meaning = special.meaning(declared)
    if meaning:
        context.special[element.id] = meaning
    if meaning in special.DOCUMENTS:
        documents.lower(context, node, document, owner.id, element.id, meaning, said)
    return own


def _inherited(owner: Type, node: Node) -> Type | None:
    """The class of the interface that it overrides, where it names none itself."""
    known = owner.base.find(node.tag, node.name) if owner.base else None
    return known.type if known and not node.attributes.get("RefBaseClassPath", "").strip() else None


def _own_interface(
    context: Context,
    owner: Type,
    node: Node,
    document: Document,
    element: Element,
    declared: Type | None,
) -> Type | None:
    """The interface block made for what an interface has more than its class, but for values."""
    more = list(sameness.more_than_values(context.types, document, node, declared))
    if not more and not any(True for _ in node.of("ExternalInterface")):
        return None
    block = Element(f"{element.id}#type", Kind.CLASS, node.name, owner.id)
    block.attrs.update(role="interface block", subkind="external-interface")
    type = Type(block.id, document, node.row, Family.INTERFACE)
    attributes.own_type(context, block, type, declared)
    for child in more:
        attributes.attribute(context, type, child, document)
    return type
