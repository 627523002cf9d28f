"""Internal elements: parts of classes, and instances with the values that they give."""

from collections.abc import Iterator

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import features
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import Family, value_of
from sysmlc.ir import AttrValue, Edge, Element, Kind


class Site:
    """One internal element, or the class at the top of some, and where it stands.

    ``declared`` is the class that it refers to; ``own`` the class made for what that one has
    not (for a class at the top: itself). ``part`` is the property that stands for it in the
    class above, ``instance`` the Instance that holds its values (empty while there are none).
    """

    __slots__ = (
        "declared",
        "document",
        "instance",
        "interface_ids",
        "is_known",
        "node",
        "own",
        "parent",
        "part",
        "root",
    )

    def __init__(self, node: Node, document: Document, parent: "Site | None") -> None:
        self.node = node
        self.document = document
        self.parent = parent
        self.root: Site = self if parent is None else parent.root
        self.declared: Type | None = None
        self.own: Type | None = None
        self.part = ""
        self.instance = ""
        self.is_known = False
        self.interface_ids: list[tuple[AttrValue, ...]] = []

    @property
    def type(self) -> Type | None:
        """What types it."""
        return self.own or self.declared

    def parts_below(self, top: "Site") -> list[str]:
        """Ids of the parts that lead from ``top`` down to it."""
        found = []
        site: Site | None = self
        while site is not None and site is not top:
            found.append(site.part)
            site = site.parent
        return found[::-1]


class Sites:
    """All internal elements of a unit, found by their nodes."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._of: dict[Node, Site] = {}

    def __iter__(self) -> Iterator[Site]:
        return iter(self._of.values())

    def of(self, node: Node) -> Site | None:
        """The site of an internal element or class."""
        return self._of.get(node)

    # -- reading -------------------------------------------------------------------------------

    def lower_class(self, type: Type) -> None:
        """The internal elements of a class."""
        top = Site(type.node, type.document, None)
        top.own, top.declared = type, type.base
        self._of[type.node] = top
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
        site = Site(node, document, None)
        self._of[node] = site
        site.declared = self._declared(node, document)
        site.instance = self._context.add(Kind.INSTANCE, node, document, package.id).id
        if site.declared is None:
            self.own(site)
        self._members(site)
        self._lower_below(site)

    def _lower_below(self, top: Site) -> None:
        waiting = [top]
        while waiting:
            site = waiting.pop()
            children = [self._place(node, site) for node in site.node.of("InternalElement")]
            waiting.extend(reversed(children))

    def _place(self, node: Node, parent: Site) -> Site:
        site = Site(node, parent.document, parent)
        self._of[node] = site
        site.declared = self._declared(node, site.document)
        known = self._known(node, parent)
        if known is None:
            self._add_part(site, parent)
        else:
            self._match(site, known)
        if site.type is None:
            self.own(site)
        self._members(site)
        return site

    def _declared(self, node: Node, document: Document) -> Type | None:
        path = node.attributes.get("RefBaseSystemUnitPath", "").strip()
        if not path or self._context.find(path) is not None:
            return None
        return self._context.type(path, Family.SYSTEM_UNIT, document, node)

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
            self.instance(site)

    def _add_part(self, site: Site, parent: Site) -> None:
        owner = self.own(parent)
        element = self._context.add(
            Kind.PROPERTY, site.node, site.document, owner.id, role="part", aggregation="composite"
        )
        site.part = element.id
        inherited = owner.base.find("InternalElement", site.node.name) if owner.base else None
        if inherited is not None:
            self._context.graph.connect(Edge.REDEFINES, element.id, inherited.id)

    def _members(self, site: Site) -> None:
        for child in site.node.children:
            if child.tag == "Attribute":
                self._attribute(site, child)
            elif child.tag == "ExternalInterface":
                self._interface(site, child)

    def _attribute(self, site: Site, node: Node) -> None:
        known = site.declared.find("Attribute", node.name) if site.declared else None
        if known is None:
            features.attribute(self._context, self.own(site), node, site.document)
            return
        waiting = [(node, known, "")]
        while waiting:
            one, member, slot = waiting.pop()
            one.verdict = Verdict.MAPPED
            slot = self._value(site, one, member) or slot
            for child in one.of("Attribute"):
                inner = member.type.find("Attribute", child.name) if member.type else None
                if inner is None:
                    features.attribute(self._context, self.own(site), child, site.document)
                else:
                    waiting.append((child, inner, slot))

    def _value(self, site: Site, node: Node, known: Member) -> str:
        """A slot for the value, unless it is the one that the class gives."""
        text = node.text("Value")
        if text is None or text == known.node.text("Value"):
            return ""
        owner = self.instance(site)
        data_type = node.attributes.get("AttributeDataType", "")
        slot = self._context.add(
            Kind.SLOT, node, site.document, owner, value=value_of(text, data_type)
        )
        self._context.graph.connect(Edge.INSTANCE_OF, slot.id, known.id)
        return slot.id

    def _interface(self, site: Site, node: Node) -> None:
        known = site.declared.find(node.tag, node.name) if site.declared else None
        if known is None:
            features.interface(self._context, self.own(site), node, site.document)
            return
        waiting = [(node, known)]
        while waiting:
            one, member = waiting.pop()
            one.verdict, one.element = Verdict.MAPPED, member.id
            for child in one.walk():
                child.verdict = child.verdict or Verdict.MAPPED
            id = one.attributes.get("ID")
            if id:
                site.interface_ids.append((member.id, id))
            for child in one.of("ExternalInterface"):
                inner = member.type.find(child.tag, child.name) if member.type else None
                if inner is not None:
                    waiting.append((child, inner))

    # -- what is made when it is needed --------------------------------------------------------

    def own(self, site: Site) -> Type:
        """The class for what the declared class has not."""
        if site.own is not None:
            return site.own
        above = site.parent
        graph = self._context.graph
        owner = self.own(above).id if above is not None else graph[site.instance].owner
        base = site.node.attributes.get("ID") or f"{owner}/{site.node.name}"
        id = self._context.free(f"{base}#class", site.node)
        made = Element(id, Kind.CLASS, site.node.name, owner, site.node.ordinal, site.document.name)
        made.attrs.update(role="block", subkind="internal-element")
        graph.add(made)
        site.own = Type(id, site.node, site.document, Family.SYSTEM_UNIT)
        site.own.base = site.declared
        if site.declared is not None:
            graph.connect(Edge.SPECIALIZES, id, site.declared.id)
        return site.own

    def instance(self, site: Site) -> str:
        """Id of the Instance that holds the values of an internal element."""
        waiting = []
        one: Site | None = site
        while one is not None and not one.instance and one.parent is not None:
            waiting.append(one)
            one = one.parent
        for below in reversed(waiting):
            self._add_instance(below)
        return site.instance or self.own(site).id

    def _add_instance(self, site: Site) -> None:
        above = site.parent
        owner = None if above is None else above.instance or self.own(above).id
        graph = self._context.graph
        id = self._context.id_of(site.node, site.document, owner) if site.is_known else ""
        id = id or self._context.free(f"{site.part}#values", site.node)
        made = Element(
            id, Kind.INSTANCE, site.node.name, owner, site.node.ordinal, site.document.name
        )
        made.attrs["subkind"] = "part"
        graph.add(made)
        graph.connect(Edge.REPRESENTS, id, site.part)
        site.instance = id
        if site.is_known:
            site.node.element = id

    # -- at the end ----------------------------------------------------------------------------

    def finish(self) -> None:
        """Say of what type parts and instances are: classes of their own may have come late."""
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


def _specialises(type: Type | None, general: Type) -> bool:
    return type is not None and any(one is general for one in type.chain())
