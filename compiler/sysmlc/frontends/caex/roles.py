"""Roles: what a class or an internal element realises (thesis, Table 3.1)."""

from collections.abc import Iterable

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import ports, special
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.holders import instance
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.sites import Sites
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import BASE_ROLE, ROLE_REFERENCES, Family
from sysmlc.ir import Edge

# To look a member of an enumeration up takes twice as long as to look these up.
_MAPPED = Verdict.MAPPED

PORT_ATTRIBUTES = ("direction", "multiplicity", "category")


def lower(context: Context, sites: Sites) -> None:
    """Draw the realizations: once each, and not again where the class realises the role.

    Classes are the first among the sites: instances need not repeat what they realise.
    """
    played = _Played()
    realizations: list[tuple[str, str]] = []
    for site in sites:
        if site.type is None:
            continue
        inherited, site.ppr = played.above(site)
        for role in _find_roles(context, site):
            if role in inherited:
                continue
            ppr, is_port = played.meaning(role)
            if ppr:
                _play(context, site, ppr, played)
            if is_port:
                _be_port(context, site)
            realizations.append((_client(context, site), role.id))
            if site.own is not None:
                played.add(site.own, role)
    for client, role_class in realizations:
        context.graph.connect(Edge.REALIZES, client, role_class)


class _Played:
    """The roles of classes: instances have them anyway."""

    def __init__(self) -> None:
        self._roles: dict[Type, set[Type]] = {}
        self._ppr: dict[Type, str] = {}
        self._above: dict[Type, tuple[set[Type], str]] = {}
        self._asked: set[Type] = set()
        self._meanings: dict[Type, tuple[str, bool]] = {}

    def meaning(self, role: Type) -> tuple[str, bool]:
        """Whether a role is that of a product, process or resource, and that of a port."""
        known = self._meanings.get(role)
        if known is None:
            is_port = role.conforms(*BASE_ROLE, "Port")
            known = self._meanings[role] = special.ppr(role), is_port
        return known

    def add(self, type: Type, role: Type) -> None:
        """The class plays the role."""
        self._roles.setdefault(type, set()).add(role)
        self._forget(type)

    def note_ppr(self, type: Type, ppr: str) -> None:
        """The class is a product, process or resource."""
        self._ppr.setdefault(type, ppr)
        self._forget(type)

    def above(self, site: Site) -> tuple[set[Type], str]:
        """What an internal element plays by its class; a class says its own again."""
        declared = site.declared
        is_class = site.own is not None and site.own.row == site.row and bool(site.own.path)
        if is_class or declared is None:
            return set(), ""
        known = self._above.get(declared)
        if known is None:
            chain = list(declared.chain())
            self._asked.update(chain)
            roles = {role for type in chain for role in self._roles.get(type, ())}
            ppr = next((self._ppr[type] for type in chain if type in self._ppr), "")
            known = self._above[declared] = roles, ppr
        return known

    def _forget(self, type: Type) -> None:
        if type in self._asked:
            self._above.clear()
            self._asked.clear()


def _be_port(context: Context, site: Site) -> None:
    """A port object of CAEX 2.15 (role Port): a part that says what an interface Port says."""
    if site.part and not site.is_known:
        told = ports.said_of(context, site.node)
        kept = {key: told[key] for key in PORT_ATTRIBUTES if key in told}
        context.graph.set(context.graph[site.part], subkind="port-object", **kept)


def _play(context: Context, site: Site, ppr: str, played: _Played) -> None:
    """Note that something is a product, process or resource."""
    site.ppr = ppr
    context.graph.set(context.graph[_client(context, site)], ppr=ppr)
    if site.own is not None:
        played.note_ppr(site.own, ppr)


def _client(context: Context, site: Site) -> str:
    if site.own is not None:
        return site.own.id
    if site.is_known or not site.part:
        return instance(context, site)
    return site.part


def _find_roles(context: Context, site: Site) -> Iterable[Type]:
    """Return the role classes that a site names, each once, in order."""
    document = site.document
    roles: dict[Type, None] = {}
    for row in site.roles:
        document.verdicts[row] = _MAPPED
        path = document.attributes[row].get(ROLE_REFERENCES[document.tags[row]], "").strip()
        role = context.type(path, Family.ROLE, document, document.node(row)) if path else None
        if role is not None:
            roles[role] = None
    return roles
