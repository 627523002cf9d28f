"""Facets and groups: internal elements that refer to features of others (IEC 62714-1)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, Verdict, rule
from sysmlc.frontends.caex.component import Component, ensure_own_type
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.findings import Findings, qualified_name
from sysmlc.frontends.caex.identifiers import Identifiers
from sysmlc.frontends.caex.overrides import overrides_attribute
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import BASE_ROLE, ROLE_REFERENCES, Family
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.support.suggestions import did_you_mean

DESCRIBED_MIRROR = rule(
    "SM638",
    "described-mirror",
    Severity.WARNING,
    "the description of '{element}' is omitted: in '{holder}' it is a mirror of another element",
    help="describe the element that it shows, or the facet or group",
)

UNKNOWN_FACET = rule(
    "SM639",
    "group-of-unknown-facet",
    Severity.WARNING,
    "the group '{element}' refers to facets named '{facet}', but no facet has that name; {hint}",
)

_KINDS = {"Facet": Kind.FACET, "Group": Kind.GROUP}


def find_group_kind(context: Context, component: Component) -> Kind | None:
    """Return Facet or Group if the internal element has that role, by inheritance."""
    document = component.document
    for row in component.role_rows:
        path = document.attributes[row].get(ROLE_REFERENCES[document.tags[row]], "")
        kind = _find_kind_of_path(context, document, path)
        if kind is not None:
            return kind
    return None


def _find_kind_of_path(context: Context, document: Document, path: str) -> Kind | None:
    """Return Facet, Group or None for the path of a role; memoised, as plants have few roles."""
    if (document, path) in context.group_kinds:
        return context.group_kinds[document, path]
    role = context.look_up_type(path.strip(), Family.ROLE, document) if path.strip() else None
    kind = _find_kind_of_role(role) if isinstance(role, Type) else None
    context.group_kinds[document, path] = kind
    return kind


def _find_kind_of_role(role: Type) -> Kind | None:
    return next((kind for name, kind in _KINDS.items() if role.conforms_to(*BASE_ROLE, name)), None)


def lower_group(context: Context, component: Component, kind: Kind) -> None:
    """Add the Facet or Group; ``connect_content`` adds its references when all elements exist.

    Other content gets no verdict, so that the coverage reports it as not read.
    """
    node, document = component.node, component.document
    element = context.add_element(kind, node, document, _find_owner(context, component))
    component.part_id = element.id
    for role in map(document.node, component.role_rows):
        path = role.attributes.get(ROLE_REFERENCES[role.tag], "")
        if _find_kind_of_path(context, document, path) is kind:
            role.verdict = Verdict.MAPPED
            _add_realization(context, document, element, path.strip())
    for attribute in node.iter_children("Attribute"):
        if attribute.name == "AssociatedFacet":
            facet = (attribute.child_text("Value") or "").strip()
            context.graph.set(element, associated_facet=facet or None)
            attribute.verdict = Verdict.MAPPED


def _add_realization(context: Context, document: Document, element: Element, path: str) -> None:
    """Add the realization of a role that specialises Facet or Group.

    Facet and Group themselves need none: they determine the kind of the element."""
    role = context.find_resolved(path, Family.ROLE, document)
    if role is not None and role.path[:-1] != BASE_ROLE:
        context.graph.connect(Edge.REALIZES, element, role.id)


def _find_owner(context: Context, component: Component) -> str:
    parent = component.parent
    if parent is None:
        return component.instance_id
    is_in_group = (
        parent.type is None and parent.part_id and context.graph[parent.part_id].kind is Kind.GROUP
    )
    return parent.part_id if is_in_group else ensure_own_type(context, parent).id


def connect_content(context: Context, component: Component) -> None:
    """Connect a Facet to the features that it shows, a Group to the masters of its mirrors."""
    element = context.graph[component.part_id]
    if element.kind is Kind.FACET:
        pairs = _iter_shown_features(context, component)
    else:
        pairs = _iter_masters(context.ids, component)
    mirror_names = []
    for node, master in pairs:
        target = context.graph.get(master.element_id)
        if target is not None:
            node.verdict = _choose_verdict(context.findings, component, node, master)
            context.graph.connect(Edge.REFERENCES, element, target)
            id = component.document.ids[node.row]
            if id or node.name != target.name:
                mirror_names.append((target.id, node.name, id))
    if mirror_names:
        context.graph.set(element, mirrors=tuple(mirror_names))


def _iter_shown_features(context: Context, component: Component) -> Iterator[tuple[Node, Node]]:
    """Yield the features of a facet, each with the feature around the facet that it shows.

    A feature of a facet is a mirror, or in CAEX 2.15 a copy with the same name.
    """
    for node in component.node.iter_children("Attribute", "ExternalInterface"):
        if context.mirrors.is_mirror(node):
            master = context.mirrors.find_master(component.document, node)
        else:
            master = _find_copied_feature(context, component, node)
        if master is not None:
            node.mark_subtree()
            yield node, master


def _find_copied_feature(context: Context, component: Component, node: Node) -> Node | None:
    """Return the feature with this name of the facet's parent, unless the facet changes it."""
    parent = component.parent
    if parent is None or parent.type is None:
        return None
    member = parent.type.find_member(node.tag, node.name)
    if member is None:
        return None
    namesakes = (other for other in parent.node.iter_children(node.tag) if other.name == node.name)
    values = {None, member.node.child_text("Value")}
    values.update(other.child_text("Value") for other in namesakes)
    if node.child_text("Value") not in values:
        return None
    is_attribute = node.tag == "Attribute"
    if is_attribute and overrides_attribute(context.types, component.document, node, member):
        return None
    return member.node


def _iter_masters(ids: Identifiers, component: Component) -> Iterator[tuple[Node, Node]]:
    """Yield the internal elements of a group, each with the element that it names."""
    for node in component.node.iter_children("InternalElement"):
        path = node.attributes.get("RefBaseSystemUnitPath", "").strip()
        located = ids.find(path)
        if located is not None:
            yield node, located[1]


def _choose_verdict(findings: Findings, component: Component, node: Node, master: Node) -> Verdict:
    """Return approximated, and report it, for a description that the master does not have."""
    text = (node.child_text("Description") or "").strip()
    if not text or text == (master.child_text("Description") or "").strip():
        return Verdict.MAPPED
    facts = {"element": qualified_name(node), "holder": component.name}
    findings.report(DESCRIBED_MIRROR, component.document, node, **facts)
    return Verdict.APPROXIMATED


def report_unknown_facets(graph: Graph, findings: Findings, components: list[Component]) -> None:
    """Report groups that are associated with a facet that does not exist."""
    elements = [graph[component.part_id] for component in components]
    facets = sorted({element.name for element in elements if element.kind is Kind.FACET})
    for component, element in zip(components, elements, strict=True):
        facet = str(element.attrs.get("associated_facet", ""))
        if facet and facet not in facets:
            node = component.node
            facts = {"element": qualified_name(node), "facet": facet}
            facts["hint"] = did_you_mean(facet, facets)
            findings.report(UNKNOWN_FACET, component.document, node, **facts)
