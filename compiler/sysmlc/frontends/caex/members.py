"""Attributes and interfaces of internal elements: those of their class, and new ones."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import (
    attributes,
    documents,
    fitting,
    interfaces,
    mirrors,
    ports,
    special,
)
from sysmlc.frontends.caex.context import Context, reference_of
from sysmlc.frontends.caex.document import Node
from sysmlc.frontends.caex.holders import instance, own
from sysmlc.frontends.caex.libraries import mark
from sysmlc.frontends.caex.sameness import more_than_values, says_more
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Edge, Element, Kind

REPEATED = frozenset({"Constraint", "RefSemantic"})
"""What a repeated attribute holds that says what its class says."""

_Path = tuple[str, ...]
"""Ids of the features that an inner one lies in, outermost first."""


def lower(context: Context, site: Site) -> None:
    """The members of an internal element: values for what its class has, features for the rest."""
    for child in site.node.children:
        lower_one(context, site, child)


def lower_one(context: Context, site: Site, child: Node) -> None:
    """One member of an internal element, or what its role requires of it."""
    if child.tag == "Attribute":
        _attribute(context, site, child)
    elif child.tag == "ExternalInterface":
        _interface(context, site, child)
    elif child.tag == "RoleRequirements" and child.children:
        _required(context, site, child)


def _required(context: Context, site: Site, requirements: Node) -> None:
    """What an element needs to play its role, and has not already."""
    for node in requirements.of("Attribute", "ExternalInterface"):
        known = site.type.find(node.tag, node.name) if site.type is not None else None
        if known is not None and node.tag == "Attribute":
            keep(context, site, node, requirements, known)
        elif known is not None and known.document is site.document and _is_inside(site, known):
            node.verdict, node.element = Verdict.MAPPED, known.id
        elif node.tag == "ExternalInterface":
            _interface(context, site, node)
        else:
            attributes.attribute(context, own(context, site), node, site.document)


def _is_inside(site: Site, known: Member) -> bool:
    """Whether a feature stands in the element itself."""
    return site.row < known.row < site.document.ends[site.row]


def keep(context: Context, site: Site, node: Node, requirements: Node, known: Member) -> None:
    """A value that the role requires of an attribute that the element has anyway."""
    value = node.text("Value")
    owner = site.own.id if site.own is not None else site.instance or site.part
    node.verdict = Verdict.MAPPED
    if not says_more(context.types, site.document, node, known):
        mark(node)
    if value is None or not owner:
        return
    role = requirements.attributes.get("RefBaseRoleClassPath", "")
    id = context.free(f"{owner}/{node.name}#required", node)
    made = Element(id, Kind.METADATA, "RoleRequirements", owner, node.ordinal)
    made.source = site.document.name
    made.attrs.update({"role_class": role, "attribute": node.name, "required": value})
    unit = node.attributes.get("Unit", "")
    if unit and unit != known.node.attributes.get("Unit"):
        made.attrs["unit"] = unit
    context.graph.add(made)
    context.graph.connect(Edge.REFERENCES, id, owner)


def _attribute(context: Context, site: Site, node: Node) -> None:
    known = site.declared.find("Attribute", node.name) if site.declared else None
    if known is None or says_more(context.types, site.document, node, known):
        attributes.attribute(context, own(context, site), node, site.document)
        return
    waiting: list[tuple[Node, Member, _Path]] = [(node, known, ())]
    while waiting:
        one, member, path = waiting.pop()
        one.verdict = Verdict.MAPPED
        check_class(context, one, site)
        _value(context, site, one, member, path)
        _description(context, site, one, member, path)
        for child in one.children:
            inner = member.type.find(child.tag, child.name) if member.type else None
            if child.tag == "Attribute" and inner is not None:
                waiting.append((child, inner, (*path, member.id)))
            elif child.tag in REPEATED:
                mark(child)


def check_class(context: Context, node: Node, site: Site) -> None:
    """Note that a class leads nowhere which an instance names; that of its class counts."""
    path = reference_of(node)
    if path and not mirrors.is_mirror(context, node):
        context.type(path, mirrors.FAMILIES[node.tag], site.document, node)


def _value(context: Context, site: Site, node: Node, known: Member, path: _Path) -> None:
    """A slot for the value, unless it is the one that the class gives."""
    text = node.text("Value")
    if text is None or text == known.node.text("Value"):
        return
    owner = instance(context, site)
    data_type = known.node.attributes.get("AttributeDataType", "")
    value = fitting.value(context, node, text, data_type, known.type)
    slot = context.add(Kind.SLOT, node, site.document, owner, value=value)
    context.graph.connect(Edge.INSTANCE_OF, slot.id, known.id)
    _lead(context, slot.id, path)


def _lead(context: Context, id: str, path: _Path) -> None:
    """The features that lead to an inner one, outermost first: their types have several uses."""
    for outer in path:
        context.graph.connect(Edge.PATH, id, outer)


def _description(context: Context, site: Site, node: Node, known: Member, path: _Path) -> None:
    """What is told of a feature in an instance alone, where no slot can carry it."""
    text = node.text("Description")
    has_slot = bool(node.element) and node.tag == "Attribute"
    if has_slot or not (text or "").strip() or text == known.node.text("Description"):
        return
    owner = instance(context, site)
    id = context.free(f"{owner}/{node.name}/Description", node)
    comment = Element(id, Kind.COMMENT, "", owner, node.ordinal, site.document.name)
    comment.attrs["body"] = str(text).strip()
    context.graph.add(comment)
    context.graph.connect(Edge.REFERENCES, id, known.id)
    _lead(context, id, path)


def _interface(context: Context, site: Site, node: Node) -> None:
    known = site.declared.find(node.tag, node.name) if site.declared else None
    if (
        known is None
        or is_of_another_class(context, node, known)
        or _has_more(context, node, known)
    ):
        interfaces.interface(context, own(context, site), node, site.document)
        return
    waiting: list[tuple[Node, Member, _Path]] = [(node, known, ())]
    while waiting:
        one, member, path = waiting.pop()
        one.verdict, one.element = Verdict.MAPPED, member.id
        check_class(context, one, site)
        _port_values(context, site, one, member, path)
        _description(context, site, one, member, path)
        id = one.attributes.get("ID")
        if id:
            site.interface_ids.append((member.id, id))
        for child in one.of("ExternalInterface"):
            inner = member.type.find(child.tag, child.name) if member.type else None
            if inner is not None:
                waiting.append((child, inner, (*path, member.id)))


def _has_more(context: Context, top: Node, known: Member) -> bool:
    """Whether an interface has more interfaces than that of its class, or attributes say more."""
    waiting = [(top, known)]
    while waiting:
        node, member = waiting.pop()
        if any(True for _ in more_than_values(context.types, node.document, node, member.type)):
            return True
        for child in node.of("ExternalInterface"):
            inner = member.type.find(child.tag, child.name) if member.type else None
            if inner is None:
                return True
            waiting.append((child, inner))
    return False


def is_of_another_class(context: Context, node: Node, known: Member) -> bool:
    """Whether an interface names a class that the one of its class is not of."""
    path = node.attributes.get("RefBaseClassPath", "").strip()
    if not path or mirrors.is_mirror(context, node):
        return False
    found = context.look_up(path, Family.INTERFACE, node.document)
    if not isinstance(found, Type):
        return False
    return known.type is None or all(one is not found for one in known.type.chain())


def _port_values(context: Context, site: Site, node: Node, known: Member, path: _Path) -> None:
    """A slot for what the attributes of an interface say here and not in the class."""
    said = ports.said_of(context, node)
    of_class = context.graph[known.id].attrs
    new = {key: value for key, value in said.items() if of_class.get(key) != value}
    for child in node.of("Attribute"):
        mark(child)
    if not new:
        return
    owner = instance(context, site)
    id = context.free(f"{owner}/{node.name}", node)
    slot = Element(id, Kind.SLOT, node.name, owner, node.ordinal, site.document.name)
    slot.attrs.update(new)
    context.graph.add(slot)
    context.graph.connect(Edge.INSTANCE_OF, id, known.id)
    _lead(context, id, path)
    meaning = context.special.get(known.id, "")
    if meaning in special.DOCUMENTS:
        documents.lower(context, node, site.document, owner, known.id, meaning, new)
