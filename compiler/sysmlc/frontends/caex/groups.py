"""Facets and groups: internal elements that only show others (AutomationML, IEC 62714-1)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, Verdict, rule
from sysmlc.frontends.caex import mirrors
from sysmlc.frontends.caex.context import Context, path_of
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.holders import own
from sysmlc.frontends.caex.libraries import mark
from sysmlc.frontends.caex.sameness import says_more
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import BASE_ROLE, ROLE_REFERENCES, Family
from sysmlc.ir import Edge, Element, Kind
from sysmlc.support.suggestions import did_you_mean

DESCRIBED_MIRROR = rule(
    "SM638",
    "described-mirror",
    Severity.WARNING,
    "the description of '{element}' is left out: in '{holder}' it only shows another element",
    help="describe the element that it shows, or the facet or group",
)

UNKNOWN_FACET = rule(
    "SM639",
    "group-of-unknown-facet",
    Severity.WARNING,
    "the group '{element}' is for facets called '{facet}', and none is; {hint}",
)

_KINDS = {"Facet": Kind.FACET, "Group": Kind.GROUP}


def kind_of(context: Context, site: Site) -> Kind | None:
    """Facet or Group when the element plays that role, by inheritance and never by name."""
    document = site.document
    for row in site.roles:
        path = document.attributes[row].get(ROLE_REFERENCES[document.tags[row]], "")
        kind = _look_up(context, document, path)
        if kind is not None:
            return kind
    return None


def _look_up(context: Context, document: Document, path: str) -> Kind | None:
    if (document, path) in context.shown:
        return context.shown[document, path]
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
        if _look_up(context, site.document, path) is kind:
            role.verdict = Verdict.MAPPED
            _realize(context, site, element, path.strip())
    for node in site.node.of("Attribute"):
        if node.name == "AssociatedFacet":
            context.graph.set(element, associated_facet=(node.text("Value") or "").strip() or None)
            node.verdict = Verdict.MAPPED


def _realize(context: Context, site: Site, element: Element, path: str) -> None:
    """A role that specialises Facet or Group is one that it plays; these two say its kind."""
    role = context.known(path, Family.ROLE, site.document)
    if role is not None and role.path[:-1] != BASE_ROLE:
        context.graph.connect(Edge.REALIZES, element, role.id)


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
    called = []
    for node, master in shown(context, site):
        one = context.graph.get(master.element)
        if one is not None:
            node.verdict = _verdict(context, site, node, master)
            context.graph.connect(Edge.REFERENCES, element, one)
            id = site.document.ids[node.row]
            if id or node.name != one.name:
                called.append((one.id, node.name, id))
    if called:
        context.graph.set(element, mirrors=tuple(called))


def report_facets(context: Context, sites: list[Site]) -> None:
    """Tell of groups that are for a facet that there is not."""
    elements = [context.graph[site.part] for site in sites]
    facets = sorted({one.name for one in elements if one.kind is Kind.FACET})
    for site, element in zip(sites, elements, strict=True):
        facet = str(element.attrs.get("associated_facet", ""))
        if facet and facet not in facets:
            facts = {"element": path_of(site.node), "facet": facet}
            hint = did_you_mean(facet, facets)
            context.report(UNKNOWN_FACET, site.document, site.node, hint=hint, **facts)


def _verdict(context: Context, site: Site, node: Node, master: Node) -> Verdict:
    """Approximated, and told, where a mirror describes what its master does not."""
    text = (node.text("Description") or "").strip()
    if not text or text == (master.text("Description") or "").strip():
        return Verdict.MAPPED
    facts = {"element": path_of(node), "holder": site.name}
    context.report(DESCRIBED_MIRROR, site.document, node, **facts)
    return Verdict.APPROXIMATED


def _features(context: Context, site: Site) -> Iterator[tuple[Node, Node]]:
    """Features of the element around a facet, with what shows them: mirrored, or of its name."""
    for node in site.node.of("Attribute", "ExternalInterface"):
        if mirrors.is_mirror(context, node):
            master = mirrors.master(context, site.document, node)
        else:
            master = _of_the_name(context, site, node)
        if master is not None:
            mark(node)
            yield node, master


def _of_the_name(context: Context, site: Site, node: Node) -> Node | None:
    """The feature of the name, unless the facet says something else of it."""
    above = site.parent
    known = above.type.find(node.tag, node.name) if above is not None and above.type else None
    if above is None or known is None:
        return None
    beside = (one for one in above.node.of(node.tag) if one.name == node.name)
    said = {None, known.node.text("Value"), *(one.text("Value") for one in beside)}
    if node.text("Value") not in said:
        return None
    if node.tag == "Attribute" and says_more(context.types, site.document, node, known):
        return None
    return known.node


def _masters(context: Context, site: Site) -> Iterator[tuple[Node, Node]]:
    for node in site.node.of("InternalElement"):
        found = context.find(node.attributes.get("RefBaseSystemUnitPath", "").strip())
        if found is not None:
            yield node, found[1]
