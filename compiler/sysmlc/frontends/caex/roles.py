"""Roles: what a class or an internal element realises (thesis, Table 3.1)."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import features, special
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Node
from sysmlc.frontends.caex.holders import instance
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.sites import Sites
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import BASE_ROLE, ROLE_REFERENCES, Family
from sysmlc.ir import Edge

PORT_ATTRIBUTES = ("direction", "multiplicity", "category")


def lower(context: Context, sites: Sites) -> None:
    """Draw the realizations: once each, and not again where the class realises the role."""
    of_class: dict[Type, set[Type]] = {}
    played: dict[Type, str] = {}
    ordered = sorted(sites, key=lambda site: bool(site.root.instance))
    for site in ordered:
        if site.type is None:
            continue
        inherited = {r for t in _above(site) for r in of_class.get(t, ())}
        site.ppr = next((played[t] for t in _above(site) if played.get(t)), "")
        for role in _roles(context, site):
            if role in inherited:
                continue
            _play(context, site, special.ppr(role), played)
            _be_port(context, site, role)
            context.graph.connect(Edge.REALIZES, _client(context, site), role.id)
            if site.own is not None:
                of_class.setdefault(site.own, set()).add(role)


def _be_port(context: Context, site: Site, role: Type) -> None:
    """A port object of CAEX 2.15 (role Port): a part that says what an interface Port says."""
    if site.part and not site.is_known and role.conforms(*BASE_ROLE, "Port"):
        told = features.port_attributes(site.node)
        kept = {key: told[key] for key in PORT_ATTRIBUTES if key in told}
        context.graph.set(context.graph[site.part], subkind="port-object", **kept)


def _play(context: Context, site: Site, ppr: str, played: dict[Type, str]) -> None:
    """Note that something is a product, process or resource."""
    if ppr:
        site.ppr = ppr
        context.graph.set(context.graph[_client(context, site)], ppr=ppr)
        if site.own is not None:
            played.setdefault(site.own, ppr)


def _above(site: Site) -> list[Type]:
    """The classes whose roles an internal element has anyway; a class says its own again."""
    is_class = site.own is not None and site.own.node is site.node and bool(site.own.path)
    return [] if is_class or site.declared is None else list(site.declared.chain())


def _client(context: Context, site: Site) -> str:
    if site.own is not None:
        return site.own.id
    if site.is_known or not site.part:
        return instance(context, site)
    return site.part


def _roles(context: Context, site: Site) -> list[Type]:
    found: dict[Type, None] = {}
    for node in site.node.of(*ROLE_REFERENCES):
        node.verdict = Verdict.MAPPED
        path = _path(node)
        role = context.type(path, Family.ROLE, site.document, node) if path else None
        if role is not None:
            found[role] = None
    return list(found)


def _path(node: Node) -> str:
    return node.attributes.get(ROLE_REFERENCES[node.tag], "").strip()
