"""Internal links: connectors between the ports of parts (thesis, Table 3.1)."""

from typing import NamedTuple

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import rules, special
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.sites import Sites
from sysmlc.ir import Edge, Element, Kind

SIDES = {"A": "RefPartnerSideA", "B": "RefPartnerSideB"}


class End(NamedTuple):
    """The port that a side of a link means, and the internal element that has it."""

    port: str
    site: Site


class Problem(NamedTuple):
    """Why a side leads nowhere; ``known`` is what it names all the same."""

    text: str
    known: str = ""


class Links:
    """The links of a unit."""

    def __init__(self, context: Context, sites: Sites) -> None:
        self._context = context
        self._sites = sites
        self._drawn: set[tuple[str, frozenset[tuple[str, ...]]]] = set()

    def lower(self, document: Document) -> None:
        """Add a connector for each link of a file; those of classes come first."""
        for row, tag in enumerate(document.tags):
            if tag == "InternalLink":
                self._link(document.node(row), document)

    def _link(self, node: Node, document: Document) -> None:
        node.verdict = Verdict.MAPPED
        holder = self._sites.of(node.parent) if node.parent else None
        ends = {side: self._end(node, document, side) for side in SIDES}
        found = [end for end in ends.values() if isinstance(end, End)]
        if holder is None or len(found) < 2:
            self._dependency(node, document, holder, ends)
        elif not self._is_of_class(holder, found):
            meanings = {self._context.special.get(end.port, "") for end in found}
            if meanings == {special.PPR} or meanings == {special.ORDER}:
                self._relation(node, document, holder, found, meanings.pop())
            else:
                self._connector(node, document, holder, found)

    def _end(self, node: Node, document: Document, side: str) -> End | Problem | None:
        text = node.attributes.get(SIDES[side], "").strip()
        if not text:
            self._context.report(rules.OPEN_LINK, document, node, element=node.name, side=side)
            return None
        found = self._found(text, document, node)
        if isinstance(found, Problem):
            self._context.report(
                rules.DANGLING_LINK,
                document,
                node,
                element=node.name,
                side=side,
                reference=text,
                problem=found.text,
            )
        return found

    def _found(self, text: str, document: Document, node: Node) -> End | Problem:
        """An interface by its id; by the id of its owner and its name; by a path."""
        direct = self._context.find(text, document)
        if direct is not None:
            self._context.tell_lenient(document, node, text)
            return self._of_node(direct[1])
        for at in (i for i, sign in enumerate(text) if sign == ":"):
            owner = self._context.find(text[:at], document) or self._by_path(text[:at])
            if owner is not None:
                self._context.tell_lenient(document, node, text[:at])
                return self._of_name(owner[1], text[at + 1 :])
        return Problem("no element has that id" if _is_id(text) else "it names no interface")

    def _by_path(self, path: str) -> tuple[Document, Node] | None:
        names = path.split("/")
        for document in self._context.documents:
            nodes = [n for n in document.root.children if n.name == names[0]]
            for name in names[1:]:
                nodes = [
                    n for above in nodes for n in above.of("InternalElement") if n.name == name
                ]
            if len(nodes) == 1:
                return document, nodes[0]
        return None

    def _of_node(self, node: Node) -> End | Problem:
        above = node.parent
        while above is not None and above.tag == "ExternalInterface":
            above = above.parent
        site = self._sites.of(above) if above is not None else None
        if node.tag == "ExternalInterface" and site is not None and node.element:
            return End(node.element, site)
        return Problem(f"that is no interface but '{node.name}'", node.element)

    def _of_name(self, owner: Node, name: str) -> End | Problem:
        for node in owner.of("ExternalInterface"):
            if node.name == name:
                return self._of_node(node)
        site = self._sites.of(owner)
        known = site.type.find("ExternalInterface", name) if site and site.type else None
        if site is not None and known is not None:
            return End(known.id, site)
        return Problem(f"'{owner.name}' has no interface '{name}'", owner.element)

    # -- connectors ----------------------------------------------------------------------------

    def _is_of_class(self, holder: Site, ends: list[End]) -> bool:
        """Whether the class that the element is an instance of has the link already."""
        if any(not _is_below(end.site, holder) for end in ends):
            return False
        key = _key(ends, holder)
        chain = holder.declared.chain() if holder.declared else ()
        return any((type.id, key) in self._drawn for type in chain)

    def _connector(self, node: Node, document: Document, holder: Site, ends: list[End]) -> None:
        top = holder.root
        owner = top.instance or (top.own.id if top.own else None)
        crosses = any(end.site.root is not top for end in ends)
        if crosses and owner is not None:
            owner = self._context.graph[owner].owner
        connector = self._context.add(Kind.CONNECTOR, node, document, owner)
        for side, end in zip(SIDES, ends, strict=True):
            self._add_end(connector, node, side, end, crosses)
        if not top.instance and owner is not None:
            self._drawn.add((owner, _key(ends, top)))

    def _add_end(self, connector: Element, node: Node, side: str, end: End, crosses: bool) -> None:
        graph = self._context.graph
        made = Element(
            f"{connector.id}#{side}",
            Kind.CONNECTOR_END,
            "",
            connector.id,
            node.ordinal,
            connector.source,
        )
        graph.add(made)
        graph.connect(Edge.END, connector.id, made.id)
        graph.connect(Edge.ROLE, made.id, end.port)
        if crosses and end.site.root.instance:
            graph.connect(Edge.PATH, made.id, end.site.root.instance)
        for part in end.site.parts_below(end.site.root):
            graph.connect(Edge.PATH, made.id, part)

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
        if not top.instance and owner is not None:
            self._drawn.add((owner, _key(ends, top)))

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


_DEPENDS = ("process", "resource", "product")
"""A process needs the resource that does it; both are there for a product."""


def _by_part(ends: list[End]) -> tuple[End, End]:
    ranks = {name: rank for rank, name in enumerate(_DEPENDS)}
    one, other = sorted(ends, key=lambda end: ranks.get(end.site.ppr, len(ranks)))
    return one, other


def _standing_for(site: Site) -> str:
    own = site.own.id if site.own is not None else ""
    return site.instance or site.part or own


def _key(ends: list[End], top: Site) -> frozenset[tuple[str, ...]]:
    return frozenset((*end.site.parts_below(top), end.port) for end in ends)


def _is_below(site: Site, top: Site) -> bool:
    one: Site | None = site
    while one is not None and one is not top:
        one = one.parent
    return one is top


def _is_id(text: str) -> bool:
    return len(text) >= 32 and " " not in text
