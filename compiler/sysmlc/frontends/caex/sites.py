"""Internal elements: parts of classes, and instances with the values that they give."""

from collections.abc import Iterator

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import groups, members, mirrors
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.holders import instance, own
from sysmlc.frontends.caex.site import NO_IDS, NO_ROWS, Site
from sysmlc.frontends.caex.types import Member, Type, member
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind

# To look a member of an enumeration up takes twice as long as to look these up.
_MAPPED = Verdict.MAPPED
_PROPERTY = Kind.PROPERTY
_SYSTEM_UNIT = Family.SYSTEM_UNIT

_REFERENCE: dict[str, AttrValue] = {"role": "reference"}
_PART: dict[str, AttrValue] = {"role": "part", "aggregation": "composite"}

_MEMBERS = frozenset({"Attribute", "ExternalInterface"})


class Sites:
    """All internal elements of a unit, found by their nodes."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._all: list[Site] = []
        self._rows: dict[Document, list[Site | None]] = {}
        self._mirrors: list[Site] = []
        self._showing: list[Site] = []

    def __iter__(self) -> Iterator[Site]:
        return iter(self._all)

    def of(self, node: Node) -> Site | None:
        """The site of an internal element or class."""
        return self.rows(node.document)[node.row]

    def rows(self, document: Document) -> list[Site | None]:
        """The sites of a file by their rows; None for all others."""
        known = self._rows.get(document)
        if known is None:
            known = self._rows[document] = [None] * len(document.tags)
        return known

    # -- reading -------------------------------------------------------------------------------

    def lower_class(self, type: Type) -> None:
        """The internal elements of a class."""
        top = self._site(type.document, type.row, None)
        top.own, top.declared = type, type.base
        self._lower_below(top)

    def lower_hierarchies(self, document: Document) -> None:
        """All hierarchies of a file."""
        for node in document.root.of("InstanceHierarchy"):
            self._lower_hierarchy(node, document)

    def _lower_hierarchy(self, node: Node, document: Document) -> None:
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
        site = self._site(document, node.row, None)
        site.instance = package.id
        if self._shows(site):
            return
        site.declared = self._declared(site)
        made = self._context.add(Kind.INSTANCE, node, document, package.id)
        site.instance, site.instance_made = made.id, made
        self._type(site)
        self._lower_below(site)

    def _site(self, document: Document, row: int, parent: Site | None) -> Site:
        site = self.rows(document)[row] = Site(document, row, parent)
        self._all.append(site)
        return site

    def _shows(self, site: Site) -> bool:
        """Whether the element is a facet or a group: it is no part, and shows others."""
        kind = groups.kind_of(self._context, site)
        if kind is None:
            return False
        groups.lower(self._context, site, kind)
        self._showing.append(site)
        for row in site.inner if kind is Kind.GROUP else ():
            if groups.kind_of(self._context, Site(site.document, row, site)) is Kind.GROUP:
                self._shows(self._site(site.document, row, site))
        return True

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
            if site.inner and not site.is_mirror:
                placed = [self._place(row, site) for row in site.inner]
                site.inner = NO_ROWS
                waiting += [one for one in reversed(placed) if one is not None]

    def _place(self, row: int, parent: Site) -> Site | None:
        site = self._site(parent.document, row, parent)
        if site.roles and self._shows(site):
            return None
        site.declared = self._declared(site)
        known = None if site.is_mirror else self._known(site, parent)
        if known is None or _is_another(site, known):
            self._add_part(site, parent)
        else:
            self._match(site, known)
        self._type(site)
        return site

    def _declared(self, site: Site) -> Type | None:
        path = site.document.attributes[site.row].get("RefBaseSystemUnitPath", "").strip()
        if not path:
            return None
        context, document = self._context, site.document
        found = context.known(path, _SYSTEM_UNIT, document)
        if found is not None:
            return found
        site.is_mirror = mirrors.is_reference(context, path)
        return None if site.is_mirror else context.type(path, _SYSTEM_UNIT, document, site.node)

    def _known(self, site: Site, parent: Site) -> Member | None:
        """The part of the class above that the element stands for, where it is an instance."""
        declared = parent.declared
        if declared is None:
            return None
        is_class = parent.own is not None and parent.row == parent.own.row
        if parent.parent is None and is_class and not parent.instance:
            return None
        return declared.find("InternalElement", site.name)

    def _match(self, site: Site, known: Member) -> None:
        site.is_known = True
        site.part = known.id
        type, stated = known.type, site.declared
        if type is not None and type is not stated and not _specialises(stated, type):
            site.declared = type
        site.document.verdicts[site.row] = _MAPPED
        instance(self._context, site)

    def _add_part(self, site: Site, parent: Site) -> None:
        owner = own(self._context, parent)
        attrs = _REFERENCE if site.is_mirror else _PART
        element = self._context.add_at(_PROPERTY, site.document, site.row, owner.id, attrs=attrs)
        key = ("InternalElement", site.name)
        inherited = owner.base.find(*key) if owner.base else None
        owner.members[key] = member((element.id, site.declared, site.document, site.row))
        site.part, site.part_made = element.id, element
        if inherited is not None:
            self._context.graph.connect(Edge.REDEFINES, element.id, inherited.id)

    # -- at the end ----------------------------------------------------------------------------

    def finish(self) -> None:
        """Tie what had to wait: mirrors, what groups show, types that came late."""
        for site in self._mirrors:
            self._mirror(site)
        for site in self._showing:
            groups.show(self._context, site)
        groups.report_facets(self._context, self._showing)
        self._tie()

    def _tie(self) -> None:
        """Tie the elements of each site to its type, and let one of them have its IDs."""
        graph, types = self._context.graph, _Elements(self._context.graph)
        for site in self._all:
            type = types[site.own or site.declared]
            one = self.instance(site) if site.instance else None
            other = self.part(site) if site.part and not site.is_known else None
            if type is not None and one is not None:
                graph.connect(Edge.INSTANCE_OF, one, type)
            if type is not None and other is not None:
                graph.connect(Edge.TYPED_BY, other, type)
            holder = one or other
            if site.interface_ids and holder is not None:
                graph.set(holder, interface_ids=tuple(site.interface_ids))
                site.interface_ids = NO_IDS

    def part(self, site: Site) -> Element | None:
        """The part that stands for an internal element in the class above."""
        made = site.part_made
        return made if made and made.id == site.part else self._context.graph.get(site.part)

    def instance(self, site: Site) -> Element | None:
        """The Instance that holds its values."""
        made = site.instance_made
        return made if made and made.id == site.instance else self._context.graph.get(site.instance)

    def _mirror(self, site: Site) -> None:
        element = self._context.graph[site.instance or site.part]
        master = mirrors.draw(self._context, site.document, site.node, element)
        found = self.of(master) if master is not None else None
        site.declared = found.type if found else None
        if site.type is None and any(n.tag in _MEMBERS for n in site.node.children):
            own(self._context, site)
        if site.type is not None:
            members.lower(self._context, site)


class _Elements(dict[Type | None, Element | None]):
    """Elements of types."""

    def __init__(self, graph: Graph) -> None:
        super().__init__()
        self._graph = graph

    def __missing__(self, type: Type | None) -> Element | None:
        found = self[type] = None if type is None else self._graph.get(type.id)
        return found


def _is_another(site: Site, known: Member) -> bool:
    """Whether an instance says that something else is in the place of a part of its class."""
    stated, type = site.declared, known.type
    if stated is None or type is None or stated is type:
        return False
    return not (_specialises(stated, type) or _specialises(type, stated))


def _specialises(type: Type | None, general: Type) -> bool:
    """Whether the type is the general one, or inherits from it."""
    return type is not None and any(one is general for one in type.chain())
