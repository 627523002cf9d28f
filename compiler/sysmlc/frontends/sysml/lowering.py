"""Lowering of a compile unit to the graph: elements first, then the edges between them.

Handlers add elements in the order of the text. Since a reference may lead to a later element, they
defer work: by ``defer_until_elements`` for edges to other elements, by ``defer_until_edges`` for
work that reads such edges. Work that must follow such work waits for the second round.
"""

from collections import deque
from collections.abc import Callable, Iterable
from functools import lru_cache

from sysmlc.diagnostics import Sink
from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.coverage import Verdicts
from sysmlc.frontends.sysml.elements import NodeElements
from sysmlc.frontends.sysml.library_edges import LibraryEdges
from sysmlc.frontends.sysml.rules import NOT_IN_GRAPH
from sysmlc.frontends.sysml.trees import Trees
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, list_items
from sysmlc.ir.element import derived_id
from sysmlc.language.tree import Node, Reference

Handler = Callable[["Lowering", Node, "Element | None"], object]
"""Lowers a node as a member of the element that its owner became."""
Work = Callable[[], None]


class WorkQueue:
    """Work that waits until elements or edges exist."""

    def __init__(self) -> None:
        self._until_elements: list[Work] = []
        self._until_edges: deque[Work] = deque()

    def defer_until_elements(self, work: Work) -> None:
        """Run *work* once all elements exist."""
        self._until_elements.append(work)

    def defer_until_edges(self, work: Work) -> None:
        """Run *work* once all edges exist."""
        self._until_edges.append(work)

    def defer_to_second_round(self, work: Work) -> None:
        """Run *work* once the work is done that now waits for edges or is deferred meanwhile."""
        self.defer_until_edges(lambda: self.defer_until_edges(work))

    def run_until_edges(self) -> None:
        """Run the work that waits for elements, also work that this adds."""
        while self._until_elements:
            batch, self._until_elements = self._until_elements, []
            for work in batch:
                work()

    def run(self) -> None:
        """Run all deferred work, in order."""
        self.run_until_edges()
        while self._until_edges:
            self._until_edges.popleft()()
            if self._until_elements:
                self.run_until_edges()


class Lowering:
    """Adds the elements and edges of nodes to the graph, by the handlers of their metaclasses."""

    def __init__(
        self, trees: Trees, graph: Graph, sink: Sink, handlers: dict[str, Handler]
    ) -> None:
        self.trees = trees
        self.graph = graph
        self.sink = sink
        self.elements = NodeElements()
        self.verdicts = Verdicts()
        self.queue = WorkQueue()
        self.library = LibraryEdges(graph)
        self.names = QualifiedNames(graph)
        self._handlers = handlers

    # -- nodes ---------------------------------------------------------------------------------

    def lower(self, node: Node, owner: Element | None) -> None:
        """Lower a member of the element *owner* by the handler of its metaclass."""
        if id(node) in self.verdicts.skipped:
            return
        self.verdicts.lowered.add(id(node))
        handler = self._handlers.get(node.kind)
        if handler is None:
            self.verdicts.mark_unsupported(node)
        else:
            handler(self, node, owner)

    def lower_all(self, members: Iterable[Node], owner: Element | None) -> None:
        """Lower several members, in order."""
        for node in members:
            self.lower(node, owner)

    def lower_annotations(self, node: Node, owner: Element | None) -> None:
        """Lower the annotations of a node as members of *owner*, the element of the node."""
        for member in node.members:
            if member.kind in nodes.ANNOTATIONS:
                self.lower(member, owner)

    # -- elements ------------------------------------------------------------------------------

    def add_element(
        self, node: Node, kind: Kind, name: str, owner: Element | None, **attrs: AttrValue
    ) -> Element:
        """Add an element and register it as the element of the node."""
        element = self.elements.own[id(node)] = self.add_derived(node, kind, name, owner, **attrs)
        return element

    def add_derived(
        self, node: Node, kind: Kind, name: str, owner: Element | None, **attrs: AttrValue
    ) -> Element:
        """Add a further element for the node, at its location."""
        source, ordinal = self.trees.source_of(node)
        id_ = self.names.add(kind, name, owner, source)
        owner_id = None if owner is None else owner.id
        attributes = _drop_empty(attrs)
        element = self.graph.add(Element(id_, kind, name, owner_id, ordinal, source, attributes))
        self.verdicts.lowered.add(id(node))
        self.elements.origins[element.id] = node
        return element

    def add_implied_child(self, owner: Element, kind: Kind, name: str) -> Element:
        """Add an element without a node, at the location of its owner."""
        return self._add_implied(owner, kind, name, owner)

    def add_implied_sibling(self, sibling: Element, kind: Kind, name: str) -> Element:
        """Add an element without a node, with the owner and location of *sibling*."""
        return self._add_implied(sibling, kind, name, self.graph.owner(sibling))

    def _add_implied(
        self, neighbor: Element, kind: Kind, name: str, owner: Element | None
    ) -> Element:
        source = neighbor.source
        id_ = self.names.add(kind, name, owner, source)
        owner_id = None if owner is None else owner.id
        return self.graph.add(Element(id_, kind, name, owner_id, neighbor.ordinal, source))

    def set_attributes(self, element: Element, **attrs: AttrValue) -> None:
        """Set attributes of an element, without those that have an empty value."""
        attributes = _drop_empty(attrs)
        if attributes:
            self.graph.set(element, **attributes)

    # -- edges ---------------------------------------------------------------------------------

    def connect_reference(self, edge: Edge, source: Element, reference: Reference | None) -> None:
        """Connect an element to the target of a reference, once all elements exist."""
        if reference is not None:
            self.defer_edges(edge, source, [reference.target])

    def defer_edges(self, edge: Edge, source: Element, targets: Iterable[Node | None]) -> None:
        """Connect an element to those of several nodes, once all elements exist."""
        self.queue.defer_until_elements(lambda: self.connect_nodes(edge, source, targets))

    def connect_node(self, edge: Edge, source: Element, target: Node | None) -> None:
        """Connect an element to that of a node, or to a stub if the node is in the library.

        The element records the kind of an edge whose target is not resolved.
        """
        if target is None:
            self._mark_unresolved(source, edge)
            return
        element = self.elements.find(target)
        if element is not None:
            if edge is Edge.SPECIALIZES:
                self.library.note_generalization(source, element)
            self.graph.connect(edge, source, element)
        elif self.trees.document_of(target) is None:
            self.library.connect_node(edge, source, target)
        else:
            self._report_unread_target(edge, source, target)

    def connect_nodes(self, edge: Edge, source: Element, targets: Iterable[Node | None]) -> None:
        """Connect an element to those of several nodes."""
        for target in targets:
            self.connect_node(edge, source, target)

    def _mark_unresolved(self, source: Element, edge: Edge) -> None:
        edges = list_items(source.attrs.get("unresolved"))
        if str(edge.value) not in edges:
            self.graph.set(source, unresolved=(*edges, str(edge.value)))

    def _report_unread_target(self, edge: Edge, source: Element, target: Node) -> None:
        self._mark_unresolved(source, edge)
        self.sink.report(
            NOT_IN_GRAPH,
            self.graph.subject(source),
            cause=f"unread {self._name_unread(target)}",
            name=nodes.qualified_name_of(target),
            type=nodes.add_article(nodes.spell_metaclass(target.kind)),
        )

    def _name_unread(self, target: Node) -> str:
        """Return the name of the outermost owner of a node that is not in the graph either."""
        outermost, owner = target, target.owner
        # The root of a document has no owner, and no element either.
        while owner is not None and owner.owner is not None and self.elements.find(owner) is None:
            outermost, owner = owner, owner.owner
        return nodes.qualified_name_of(outermost)


def _drop_empty(attrs: dict[str, AttrValue]) -> dict[str, AttrValue]:
    """Return the attributes without false and empty values; an empty sequence is a value."""
    if all(attrs.values()):
        return attrs
    return {key: value for key, value in attrs.items() if value or value == ()}


# -- qualified names -------------------------------------------------------------------------------


_NOTATION = "sysml"
"""Origin of all ids of this front end."""


class QualifiedNames:
    """Symbol table of the qualified names that elements of the unit have."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._names: dict[str, str] = {}
        """Qualified names by id."""
        self._used: dict[str, int] = {}
        """How many elements asked for a qualified name."""

    def add(self, kind: Kind, name: str, owner: Element | None, source: str) -> str:
        """Return the id of a new element and enter its qualified name.

        An element without a name is named by its kind. A name that is already used gets the kind
        appended, or the file in front at the root, and then a number.
        """
        prefix = "" if owner is None else f"{self._names[owner.id]}::"
        qualified_name = f"{prefix}{name}" if name else f"{prefix}<{kind}>"
        if qualified_name in self._used:
            is_member = bool(name and owner)
            qualified_name = self._make_unique(
                f"{qualified_name}<{kind}>" if is_member else f"{source}#{qualified_name}"
            )
        else:
            self._used[qualified_name] = 1
        # ``--emit uml`` keeps the ids: the unit may contain the text and the UML made from it.
        while _derive_id(qualified_name) in self._graph:
            qualified_name = self._make_unique(f"{source}#{qualified_name}")
        id_ = _derive_id(qualified_name)
        self._names[id_] = qualified_name
        return id_

    def _make_unique(self, qualified_name: str) -> str:
        """Return the name, with a number if another element has it."""
        number = self._used[qualified_name] = self._used.get(qualified_name, 0) + 1
        if number == 1:
            return qualified_name
        numbered = f"{qualified_name}#{number}"
        self._used[numbered] = 1
        return numbered

    def id_of(self, qualified_name: str) -> str:
        """Return the id of the element with a qualified name, or the empty string."""
        id_ = _derive_id(qualified_name)
        return id_ if id_ in self._names else ""


@lru_cache(maxsize=2**15)
def _derive_id(qualified_name: str) -> str:
    """Return the id for a qualified name; ``sysmlc watch`` derives the same ids at each edit."""
    return derived_id(_NOTATION, qualified_name)
