"""Facets and groups: internal elements that only show others (AutomationML, IEC 62714-1)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import mirrors
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.holders import own
from sysmlc.frontends.caex.libraries import mark
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import BASE_ROLE, ROLE_REFERENCES, Family
from sysmlc.ir import Edge, Kind

_KINDS = {"Facet": Kind.FACET, "Group": Kind.GROUP}


def kind_of(context: Context, site: Site) -> Kind | None:
    """Facet or Group when the element plays that role, by inheritance and never by name."""
    document = site.document
    for row in site.roles:
        path = document.attributes[row].get(ROLE_REFERENCES[document.tags[row]], "")
        key = (document, path)
        kind = context.shown[key] if key in context.shown else _look_up(context, document, path)
        if kind is not None:
            return kind
    return None


def _look_up(context: Context, document: Document, path: str) -> Kind | None:
    role = context.look_up(path.strip(), Family.ROLE, document) if path.strip() else None
    kind = context.shown[document, path] = _kind_of(role) if isinstance(role, Type) else None
    return kind


def _kind_of(role: Type) -> Kind | None:
    return next((kind for name, kind in _KINDS.items() if role.conforms(*BASE_ROLE, name)), None)


def roles_of(context: Context, site: Site) -> Iterator[Type]:
    """The role classes that an internal element names and that are known."""
    document = site.document
    for row in site.roles:
        path = document.attributes[row].get(ROLE_REFERENCES[document.tags[row]], "").strip()
        found = context.look_up(path, Family.ROLE, site.document) if path else None
        if isinstance(found, Type):
            yield found


def lower(context: Context, site: Site, kind: Kind) -> None:
    """Add the Facet or Group; what it shows is known when everything is placed.

    What it has beside that is left without a verdict, and told as not read.
    """
    element = context.add(kind, site.node, site.document, _owner(context, site))
    site.part = element.id
    for role in map(site.document.node, site.roles):
        path = role.attributes.get(ROLE_REFERENCES[role.tag], "")
        if context.shown.get((site.document, path)) is kind:
            role.verdict = Verdict.MAPPED
    for node in site.node.of("Attribute"):
        if node.name == "AssociatedFacet":
            context.graph.set(element, associated_facet=node.text("Value") or None)
            node.verdict = Verdict.MAPPED


def _owner(context: Context, site: Site) -> str:
    above = site.parent
    if above is None:
        return site.instance
    is_group = above.type is None and above.part and context.graph[above.part].kind is Kind.GROUP
    return above.part if is_group else own(context, above).id


def show(context: Context, site: Site) -> None:
    """Draw the references of a Facet to features, of a Group to the masters of its mirrors."""
    element = context.graph[site.part]
    shown = _features if element.kind is Kind.FACET else _masters
    for target in dict.fromkeys(shown(context, site)):
        if target in context.graph:
            context.graph.connect(Edge.REFERENCES, element, target)


def _features(context: Context, site: Site) -> Iterator[str]:
    """Features of the element around a facet: mirrored, or of the same name."""
    for node in site.node.of("Attribute", "ExternalInterface"):
        if mirrors.is_mirror(context, node):
            master = mirrors.master(context, site.document, node)
            target = master.element if master is not None else ""
        else:
            target = _of_the_name(site, node)
        if target:
            mark(node)
            yield target


def _of_the_name(site: Site, node: Node) -> str:
    """The feature of the name, unless the facet gives it another value."""
    above = site.parent
    known = above.type.find(node.tag, node.name) if above is not None and above.type else None
    if above is None or known is None:
        return ""
    beside = (one for one in above.node.of(node.tag) if one.name == node.name)
    said = {None, known.node.text("Value"), *(one.text("Value") for one in beside)}
    return known.id if node.text("Value") in said else ""


def _masters(context: Context, site: Site) -> Iterator[str]:
    for node in site.node.of("InternalElement"):
        found = context.find(node.attributes.get("RefBaseSystemUnitPath", "").strip())
        if found is not None and found[1].element:
            node.verdict = Verdict.MAPPED
            yield found[1].element
