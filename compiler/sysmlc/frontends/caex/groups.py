"""Facets and groups: internal elements that only show others (AutomationML, IEC 62714-1)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.holders import own
from sysmlc.frontends.caex.libraries import mark
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import BASE_ROLE, ROLE_REFERENCES, Family
from sysmlc.ir import Edge, Element, Kind

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
    """Add the Facet or Group; what it shows is known when everything is placed."""
    above = site.parent
    owner = own(context, above).id if above else site.instance
    element = context.add(kind, site.node, site.document, owner)
    site.part = element.id
    mark(site.node)
    site.node.element = element.id
    for node in site.node.of("Attribute"):
        if node.name == "AssociatedFacet":
            context.graph.set(element, associated_facet=node.text("Value") or None)


def show(context: Context, site: Site) -> None:
    """Draw the references of a Facet to features, of a Group to the masters of its mirrors."""
    element = context.graph[site.part]
    for target in dict.fromkeys(_shown(context, site, element)):
        if target in context.graph:
            context.graph.connect(Edge.REFERENCES, element, target)


def _shown(context: Context, site: Site, element: Element) -> Iterator[str]:
    above = site.parent.type if site.parent else None
    for node in site.node.children:
        if node.tag in ("Attribute", "ExternalInterface") and above is not None:
            known = above.find(node.tag, node.name)
            if known is not None and element.kind is Kind.FACET:
                yield known.id
        elif node.tag == "InternalElement":
            yield from _master(context, node)


def _master(context: Context, node: Node) -> Iterator[str]:
    found = context.find(node.attributes.get("RefBaseSystemUnitPath", "").strip())
    if found is not None and found[1].element:
        node.verdict = Verdict.MAPPED
        yield found[1].element
