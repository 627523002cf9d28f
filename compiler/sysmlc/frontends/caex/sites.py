"""Internal elements: parts of classes, and instances with the values that they give."""

from collections.abc import Iterator

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import groups, members, mirrors
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.holders import instance, own
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Edge, Element, Kind

_MEMBERS = frozenset({"Attribute", "ExternalInterface"})


class Sites:
    """All internal elements of a unit, found by their nodes."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._of: dict[Node, Site] = {}
        self._mirrors: list[Site] = []
        self._showing: list[Site] = []

    def __iter__(self) -> Iterator[Site]:
        return iter(self._of.values())

    def of(self, node: Node) -> Site | None:
        """The site of an internal element or class."""
        return self._of.get(node)

    # -- reading -------------------------------------------------------------------------------

    def lower_class(self, type: Type) -> None:
        """The internal elements of a class."""
        top = self._site(type.node, type.document, None)
        top.own, top.declared = type, type.base
        self._lower_below(top)

    def lower_hierarchy(self, node: Node, document: Document) -> None:
        """A hierarchy: a package with an instance for each internal element at its top."""
        package = self._context.add(
            Kind.PACKAGE,
            node,
            document,
            None,
            subkind="instance-hierarchy",
            version=node.text("Version"),
        )
        for child in node.of("InternalElement"):
            self._lower_top(child, document, package)

    def _lower_top(self, node: Node, document: Document, package: Element) -> None:
        site = self._site(node, document, None)
        site.instance = package.id
        kind = groups.kind_of(self._context, site)
        if kind is not None:
            groups.lower(self._context, site, kind)
            self._showing.append(site)
            return
        site.declared = self._declared(site)
        site.instance = self._context.add(Kind.INSTANCE, node, document, package.id).id
        self._type(site)
        self._lower_below(site)

    def _site(self, node: Node, document: Document, parent: Site | None) -> Site:
        site = self._of[node] = Site(node, document, parent)
        return site

    def _type(self, site: Site) -> None:
        """Give it a class of its own when it has none, and lower its members."""
        if site.is_mirror:
            self._mirrors.append(site)
            return
        if site.type is None:
            own(self._context, site)
        members.lower(self._context, site)

    def _lower_below(self, top: Site) -> None:
        waiting = [top]
        while waiting:
            site = waiting.pop()
            if not site.is_mirror:
                nodes = site.node.of("InternalElement")
                placed = (self._place(node, site) for node in nodes)
                waiting.extend(reversed([one for one in placed if one is not None]))

    def _place(self, node: Node, parent: Site) -> Site | None:
        site = self._site(node, parent.document, parent)
        kind = groups.kind_of(self._context, site)
        if kind is not None:
            groups.lower(self._context, site, kind)
            self._showing.append(site)
            return None
        site.declared = self._declared(site)
        known = None if site.is_mirror else self._known(node, parent)
        if known is None:
            self._add_part(site, parent)
        else:
            self._match(site, known)
        self._type(site)
        return site

    def _declared(self, site: Site) -> Type | None:
        path = site.node.attributes.get("RefBaseSystemUnitPath", "").strip()
        if not path:
            return None
        site.is_mirror = mirrors.is_mirror(self._context, site.node)
        if site.is_mirror:
            return None
        return self._context.type(path, Family.SYSTEM_UNIT, site.document, site.node)

    def _known(self, node: Node, parent: Site) -> Member | None:
        """The part of the class above that the element stands for, where it is an instance."""
        is_class = parent.own is not None and parent.node is parent.own.node
        if parent.parent is None and is_class and not parent.instance:
            return None
        return parent.declared.find("InternalElement", node.name) if parent.declared else None

    def _match(self, site: Site, known: Member) -> None:
        site.is_known = True
        site.part = known.id
        if known.type is not None and not _specialises(site.declared, known.type):
            site.declared = known.type
        site.node.verdict = Verdict.MAPPED
        if site.root.instance:
            instance(self._context, site)

    def _add_part(self, site: Site, parent: Site) -> None:
        owner = own(self._context, parent)
        element = self._context.add(
            Kind.PROPERTY,
            site.node,
            site.document,
            owner.id,
            role="reference" if site.is_mirror else "part",
            aggregation=None if site.is_mirror else "composite",
        )
        owner.members["InternalElement", site.node.name] = Member(
            element.id, site.declared, site.node
        )
        site.part = element.id
        inherited = owner.base.find("InternalElement", site.node.name) if owner.base else None
        if inherited is not None:
            self._context.graph.connect(Edge.REDEFINES, element.id, inherited.id)

    # -- at the end ----------------------------------------------------------------------------

    def finish(self) -> None:
        """Tie what had to wait: mirrors, what groups show, types that came late."""
        for site in self._mirrors:
            self._mirror(site)
        for site in self._showing:
            groups.show(self._context, site)
        for site in self:
            type = site.type
            if site.part and not site.is_known and type is not None:
                self._context.graph.connect(Edge.TYPED_BY, site.part, type.id)
            if site.instance and type is not None:
                self._context.graph.connect(Edge.INSTANCE_OF, site.instance, type.id)
            holder = site.instance or (site.part if not site.is_known else "")
            if site.interface_ids and holder:
                ids = tuple(site.interface_ids)
                self._context.graph.set(self._context.graph[holder], interface_ids=ids)

    def _mirror(self, site: Site) -> None:
        element = self._context.graph[site.instance or site.part]
        master = mirrors.draw(self._context, site.document, site.node, element)
        found = self.of(master) if master is not None else None
        site.declared = found.type if found else None
        if site.type is None and any(n.tag in _MEMBERS for n in site.node.children):
            own(self._context, site)
        if site.type is not None:
            members.lower(self._context, site)


def _specialises(type: Type | None, general: Type) -> bool:
    return type is not None and any(one is general for one in type.chain())
