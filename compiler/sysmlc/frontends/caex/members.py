"""Attributes and interfaces of internal elements: those of their class, and new ones."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import features
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Node
from sysmlc.frontends.caex.holders import instance, own
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.types import Member
from sysmlc.frontends.caex.vocabulary import value_of
from sysmlc.ir import Edge, Kind


def lower(context: Context, site: Site) -> None:
    """The members of an internal element: values for what its class has, features for the rest."""
    for child in site.node.children:
        if child.tag == "Attribute":
            _attribute(context, site, child)
        elif child.tag == "ExternalInterface":
            _interface(context, site, child)


def _attribute(context: Context, site: Site, node: Node) -> None:
    known = site.declared.find("Attribute", node.name) if site.declared else None
    if known is None:
        features.attribute(context, own(context, site), node, site.document)
        return
    waiting = [(node, known, "")]
    while waiting:
        one, member, slot = waiting.pop()
        one.verdict = Verdict.MAPPED
        slot = _value(context, site, one, member) or slot
        for child in one.of("Attribute"):
            inner = member.type.find("Attribute", child.name) if member.type else None
            if inner is None:
                features.attribute(context, own(context, site), child, site.document)
            else:
                waiting.append((child, inner, slot))


def _value(context: Context, site: Site, node: Node, known: Member) -> str:
    """A slot for the value, unless it is the one that the class gives."""
    text = node.text("Value")
    if text is None or text == known.node.text("Value"):
        return ""
    owner = instance(context, site)
    data_type = node.attributes.get("AttributeDataType", "")
    slot = context.add(Kind.SLOT, node, site.document, owner, value=value_of(text, data_type))
    context.graph.connect(Edge.INSTANCE_OF, slot.id, known.id)
    return slot.id


def _interface(context: Context, site: Site, node: Node) -> None:
    known = site.declared.find(node.tag, node.name) if site.declared else None
    if known is None:
        features.interface(context, own(context, site), node, site.document)
        return
    waiting = [(node, known)]
    while waiting:
        one, member = waiting.pop()
        one.verdict, one.element = Verdict.MAPPED, member.id
        for child in one.walk():
            child.verdict = child.verdict or Verdict.MAPPED
        id = one.attributes.get("ID")
        if id:
            site.interface_ids.append((member.id, id))
        for child in one.of("ExternalInterface"):
            inner = member.type.find(child.tag, child.name) if member.type else None
            if inner is not None:
                waiting.append((child, inner))
