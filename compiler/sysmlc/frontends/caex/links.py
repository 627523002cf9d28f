"""Internal links: connectors between the ports of parts (thesis, Table 3.1)."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import special
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.sides import SIDES, End, Problem, Sides
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.sites import Sites
from sysmlc.frontends.caex.types import Type
from sysmlc.ir import Edge, Element, Kind

_Ends = frozenset[tuple[str, ...]]
"""Ends of a link as the parts and the port that lead there."""


# To look a member of an enumeration up takes twice as long as to look these up.
_MAPPED = Verdict.MAPPED
_CONNECTOR = Kind.CONNECTOR
_CONNECTOR_END = Kind.CONNECTOR_END
_END = Edge.END
_PATH = Edge.PATH


class Links:
    """The links of a unit."""

    def __init__(self, context: Context, sites: Sites) -> None:
        self._context = context
        self._sites = sites
        self._sides = Sides(context, sites)
        self._drawn: set[tuple[str, _Ends]] = set()
        """Owners of links of classes, with the ends."""
        self._drawing: set[str] = set()
        """Ids of the classes with links of their own."""
        self._drawing_above: dict[Type, list[str]] = {}
        """Those among the classes that a class is or specialises."""
        self._steps: dict[Site, list[Element]] = {}
        self._ends: list[Element] = []
        self._ports: list[Element] = []
        """Ends of connectors, and what they are ends at."""

    def lower(self) -> None:
        """Add a connector for each link; those of classes first, as instances repeat them."""
        for are_instances in (False, True):
            for document in self._context.documents:
                for row in document.children(0):
                    if (document.tags[row] == "InstanceHierarchy") is are_instances:
                        self._lower_below(row, document)
        for end, port in zip(self._ends, self._ports, strict=True):
            self._context.graph.connect(Edge.ROLE, end, port)

    def _lower_below(self, top: int, document: Document) -> None:
        sites, direct = self._sites.rows(document), self._sides.direct
        for row in document.tagged("InternalLink", top, document.ends[top]):
            document.verdicts[row] = _MAPPED
            holder, values = sites[document.parents[row]], document.attributes[row]
            one = direct(values.get("RefPartnerSideA", ""))
            other = direct(values.get("RefPartnerSideB", ""))
            if holder is None or one is None or other is None:
                self._general(document.node(row), document, holder)
            else:
                self._between(row, document, holder, [one, other])

    def _general(self, node: Node, document: Document, holder: Site | None) -> None:
        """A link whose sides are not both IDs of interfaces."""
        ends = {side: self._sides.end(node, document, side) for side in SIDES}
        found = [end for end in ends.values() if isinstance(end, End)]
        if holder is None or len(found) < len(ends):
            self._dependency(node, document, holder, ends)
        else:
            self._between(node.row, document, holder, found)

    def _between(self, row: int, document: Document, holder: Site, ends: list[End]) -> None:
        if self._is_of_class(holder, ends):
            return
        known = self._context.special
        meaning = known.get(ends[0].port, "")
        if meaning in _RELATIONS and known.get(ends[1].port, "") == meaning:
            self._relation(document.node(row), document, holder, ends, meaning)
        else:
            self._connector(row, document, holder, ends)

    # -- connectors ----------------------------------------------------------------------------

    def _is_of_class(self, holder: Site, ends: list[End]) -> bool:
        """Whether the class that the element is an instance of has the link already."""
        declared = holder.declared
        if declared is None or not self._drawing:
            return False
        types = self._drawing_above.get(declared)
        if types is None:
            types = [type.id for type in declared.chain() if type.id in self._drawing]
            self._drawing_above[declared] = types
        key = _key(ends, holder) if types else None
        if key is not None:
            for id in types:
                if (id, key) in self._drawn:
                    return True
        return False

    def _connector(self, row: int, document: Document, holder: Site, ends: list[End]) -> None:
        top = holder.root
        owner = top.instance or (top.own.id if top.own else None)
        crosses = ends[0].site.root is not top or ends[1].site.root is not top
        if crosses and owner is not None:
            owner = self._context.graph[owner].owner
        connector = self._context.add_at(_CONNECTOR, document, row, owner)
        self._add_ends(connector, ends, crosses)
        if not top.instance:
            self._note(top, owner, ends)

    def _note(self, top: Site, owner: str | None, ends: list[End]) -> None:
        """Remember the link of a class: its instances repeat it."""
        key = _key(ends, top) if not top.instance and owner is not None else None
        if key is not None and owner is not None:
            self._drawn.add((owner, key))
            self._drawing.add(owner)
            self._drawing_above.clear()

    def _add_ends(self, connector: Element, ends: list[End], crosses: bool) -> None:
        graph, above = self._context.graph, connector.id
        source, ordinal = connector.source, connector.ordinal
        halves: list[Element] = []
        for side, (port, site) in zip(SIDES, ends, strict=True):
            id = f"{above}#{side}"
            if id in graph:
                id = f"{id}~{ordinal}"
            made = graph.add(Element(id, _CONNECTOR_END, "", above, ordinal, source))
            halves.append(made)
            self._ports.append(graph[port])
            steps, has_top = self._steps_to(site), bool(site.root.instance)
            for step in steps[1 if has_top and not crosses else 0 :]:
                graph.connect(_PATH, made, step)
        self._ends += halves
        for half in halves:
            graph.connect(_END, connector, half)

    def _steps_to(self, site: Site) -> list[Element]:
        """The Instance at the top (if any), and the parts that lead down to an element."""
        known = self._steps.get(site)
        if known is None:
            above = [] if site.parent is None else self._steps_to(site.parent)
            step = self._sites.instance(site) if site.parent is None else self._sites.part(site)
            known = above if step is None or step in above else [*above, step]
            self._steps[site] = known
        return known

    def _relation(
        self, node: Node, document: Document, holder: Site, ends: list[End], meaning: str
    ) -> None:
        """Who does what with what, or what follows on what: no wire, but a dependency."""
        graph, top = self._context.graph, holder.root
        owner = top.instance or (top.own.id if top.own else None)
        subkind = special.PPR if meaning == special.PPR else "succession"
        made = self._context.add(Kind.DEPENDENCY, node, document, owner, subkind=subkind)
        first, second = self._in_order(ends) if meaning == special.ORDER else _by_part(ends)
        graph.set(made, ports=(first.port, second.port))
        if {first.site.ppr, second.site.ppr} == {"process", "resource"}:
            graph.set(made, role="allocate")
        graph.connect(Edge.CLIENT, made.id, _standing_for(first.site))
        graph.connect(Edge.SUPPLIER, made.id, _standing_for(second.site))
        self._note(top, owner, ends)

    def _in_order(self, ends: list[End]) -> tuple[End, End]:
        """The later one first, as it depends on the earlier: that one has the way out."""
        one, other = ends
        ways = [self._context.graph[end.port].attrs.get("direction") for end in ends]
        return (one, other) if ways[1] == "out" or ways[0] == "in" else (other, one)

    def _dependency(
        self,
        node: Node,
        document: Document,
        holder: Site | None,
        ends: dict[str, End | Problem | None],
    ) -> None:
        known = [e.port if isinstance(e, End) else e.known for e in ends.values() if e]
        known = [id for id in known if id and id in self._context.graph]
        top = holder.root if holder else None
        owner = (top.instance or (top.own.id if top.own else None)) if top else None
        made = self._context.add(Kind.DEPENDENCY, node, document, owner, subkind="internal-link")
        made.attrs["sides"] = tuple(node.attributes.get(side, "") for side in SIDES.values())
        for edge, id in zip((Edge.CLIENT, Edge.SUPPLIER), known, strict=False):
            self._context.graph.connect(edge, made.id, id)


_RELATIONS = (special.PPR, special.ORDER)
"""Meanings of interfaces whose links are no wires."""

_DEPENDS = ("process", "resource", "product")
"""A process needs the resource that does it; both are there for a product."""


def _by_part(ends: list[End]) -> tuple[End, End]:
    ranks = {name: rank for rank, name in enumerate(_DEPENDS)}
    one, other = sorted(ends, key=lambda end: ranks.get(end.site.ppr, len(ranks)))
    return one, other


def _standing_for(site: Site) -> str:
    own = site.own.id if site.own is not None else ""
    return site.instance or site.part or own


def _key(ends: list[End], top: Site) -> _Ends | None:
    """The ends as seen from above; None when one of them is elsewhere."""
    one, other = _way(ends[0], top), _way(ends[1], top)
    return None if one is None or other is None else frozenset((one, other))


def _way(end: End, top: Site) -> tuple[str, ...] | None:
    """The parts and the port that lead to an end; most ends are in a part, or at the top."""
    site = end.site
    if site.parent is top:
        return site.part, end.port
    if site is top:
        return (end.port,)
    parts = site.parts_below(top)
    return None if parts is None else (*parts, end.port)
