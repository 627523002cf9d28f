"""Mapping objects: which feature of an element is which feature of its role."""

from collections.abc import Iterator

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Node
from sysmlc.frontends.caex.groups import roles_of
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.sites import Sites
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.ir import Edge

_MAPPINGS = {
    "AttributeNameMapping": (
        "Attribute",
        "SystemUnitAttributeName",
        ("RoleAttributeName", "RefRoleAttributeName"),
    ),
    "InterfaceNameMapping": (
        "ExternalInterface",
        "SystemUnitInterfaceName",
        ("RoleInterfaceName", "RefRoleInterfaceName"),
    ),
    "InterfaceIDMapping": (
        "ExternalInterface",
        "SystemUnitInterfaceID",
        ("RoleInterfaceID", "RefRoleInterfaceID"),
    ),
}
"""Tag: tag of what is mapped, attribute with its name or id, attributes with the role's."""


def lower(context: Context, sites: Sites) -> None:
    """Let each mapped feature redefine that of the role."""
    if not any("MappingObject" in document.tags for document in context.documents):
        return
    for site in sites:
        for node in _mapping_objects(site):
            node.verdict = Verdict.MAPPED
            for mapping in node.of(*_MAPPINGS):
                _map(context, site, mapping)


def _mapping_objects(site: Site) -> Iterator[Node]:
    yield from site.node.of("MappingObject")
    for role in site.node.of("RoleRequirements", "SupportedRoleClass"):
        yield from role.of("MappingObject")


def _map(context: Context, site: Site, node: Node) -> None:
    node.verdict = Verdict.MAPPED
    tag, own_name, role_names = _MAPPINGS[node.tag]
    own = _own(context, site, tag, node.attributes.get(own_name, ""))
    name = next((node.attributes[n] for n in role_names if n in node.attributes), "")
    of_role = _of_role(context, site, tag, name)
    if own and of_role:
        context.graph.connect(Edge.REDEFINES, own, of_role)
        return
    missing = name if own else node.attributes.get(own_name, "")
    context.report(rules.MAPPING, site.document, node, element=site.node.name, feature=missing)


def _own(context: Context, site: Site, tag: str, name: str) -> str:
    found = context.find(name)
    if found is not None and found[1].element:
        return found[1].element
    known = _member(site.type, tag, name)
    return known.id if known else ""


def _member(type: Type | None, tag: str, name: str) -> Member | None:
    """A feature; ``.`` leads to those inside it, unless it is part of a name."""
    found = type.find(tag, name) if type is not None else None
    if found is not None or type is None:
        return found
    places = [place for place, sign in enumerate(name) if sign == "."]
    for place in places:
        outer = type.find(tag, name[:place])
        inner = _member(outer.type, tag, name[place + 1 :]) if outer is not None else None
        if inner is not None:
            return inner
    return None


def _of_role(context: Context, site: Site, tag: str, name: str) -> str:
    found = context.find(name)
    if found is not None and found[1].element:
        return found[1].element
    members = (_member(role, tag, name) for role in roles_of(context, site))
    return next((member.id for member in members if member is not None), "")
