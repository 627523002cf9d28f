"""Lowering of a compile unit to the graph: elements first, then the edges between them.

Handlers add elements in the order of the text. Since a reference may lead to a later element, they
defer work: by ``defer_until_elements`` for edges to other elements, by ``defer_until_edges`` for
work that reads such edges. Work that must follow other deferred work is deferred twice.
"""

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.frontends.sysml import libraries, nodes
from sysmlc.frontends.sysml.coverage import Verdicts
from sysmlc.frontends.sysml.rules import NOT_IN_GRAPH
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, list_items
from sysmlc.ir import Reference as Pending
from sysmlc.ir.element import derived_id
from sysmlc.ir.query.activities import is_joined
from sysmlc.language.tree import Document, Node, Reference, Relation

if TYPE_CHECKING:
    from sysmlc.language.names import Model

Handler = Callable[["Lowering", Node, "Element | None"], object]
"""Lowers a node as a member of the element that its owner became."""
Work = Callable[[], None]


class Lowering(Verdicts):
    """State of the lowering: the graph so far, and which node became which element.

    Tables whose keys are integers use identities of nodes.
    """

    def __init__(
        self,
        documents: Sequence[Document],
        model: "Model",
        graph: Graph,
        sink: Sink,
        handlers: dict[str, Handler],
    ) -> None:
        super().__init__()
        self.documents = documents
        self.model = model
        self.graph = graph
        self.sink = sink
        self._handlers = handlers
        self._documents: dict[int, Document] = {}
        self.elements: dict[int, Element] = {}
        """The element that a node is."""
        self.usage_classes: dict[int, Element] = {}
        """Classes that are added for usages with members of their own."""
        self.spans: dict[int, tuple[Element, Element]] = {}
        """Entry and exit of steps that become several nodes of an activity."""
        self.signals: set[int] = set()
        """Item definitions that are sent or accepted."""
        self.flow_features: set[int] = set()
        """Features at which flows start or end."""
        self.redundant: set[int] = set()
        """Redefinitions that add nothing to the feature that they redefine."""
        self.lowered: set[int] = set()
        """Nodes that were lowered, or for which an element was added."""
        self.skipped: set[int] = set()
        """Members that a handler reads together with their owner."""
        self._until_elements: list[Work] = []
        self._until_edges: deque[Work] = deque()
        self._origins: dict[str, Node] = {}
        """The node for which an element was added, by the element's id."""
        self._names = QualifiedNames(self.graph)
        self._starts_and_ends: dict[tuple[str, str], Element] = {}
        """Elements for ``start`` and ``done`` by the id of the behaviour or region."""
        self._generalizations: list[tuple[Element, Element]] = []
        self._has_pending_general = False
        self._library_types: dict[str, list[tuple[str, Kind]]] = {}
        """Names and kinds of scalar types from the library, by the id of the typed element."""
        self._stubs: dict[str, str] = {}
        self._library_names: dict[int, tuple[str, Kind]] = {}
        """Names and kinds of elements of the library that edges lead to."""

    # -- nodes ---------------------------------------------------------------------------------

    def lower(self, node: Node, owner: Element | None) -> None:
        """Lower a member of the element *owner* by the handler of its metaclass."""
        if id(node) in self.skipped:
            return
        self.lowered.add(id(node))
        handler = self._handlers.get(node.kind)
        if handler is None:
            self.mark_unsupported(node)
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

    def assign_document(self, document: Document, members: Iterable[Node]) -> None:
        """Record that nodes belong to a document of the unit."""
        self._documents.update(dict.fromkeys(map(id, members), document))

    def document_of(self, node: Node) -> Document | None:
        """Return the document of the unit that contains the node; None for the library."""
        return self._documents.get(id(node))

    @property
    def roots(self) -> list[Node]:
        """The root namespaces of the documents of the unit."""
        return [document.root for document in self.documents]

    def resolve(self, node: Node, relation: Relation) -> Node | None:
        """Return the target of a relation of a node, in the unit or in the library."""
        target = relation.reference.target
        return target if target is not None else self.model.target(node, relation)

    def element_of(self, node: Node | None) -> Element | None:
        """Return the element of the node, or of what it redefines if it is redundant."""
        if node is None:
            return None
        element = self.elements.get(id(node))
        if element is None and id(node) in self.redundant:
            return self.element_of(nodes.find_target(node, "Redefinition"))
        return element

    def id_of_node(self, node: Node) -> str:
        """Return the id of the element of the node, or the empty string."""
        element = self.element_of(node)
        return "" if element is None else element.id

    def subject_of(self, node: Node) -> Subject:
        """Return the node as the subject of a diagnostic."""
        document = self._documents.get(id(node))
        name = nodes.qualified_name_of(node)
        if document is None:
            return Subject(name)
        return Subject(name, place=Place(document.path, document.ordinal_of(node)))

    def is_misplaced(self, node: Node) -> bool:
        """Whether the parser reported that the node is not allowed in its owner (SM195)."""
        document = self._documents.get(id(node))
        if document is None:
            return False
        place = Place(document.path, offset=document.byte_offsets.byte_of(node.start))
        return self.sink.has_reported(("SM195",), place)

    # -- order of work -------------------------------------------------------------------------

    def defer_until_elements(self, work: Work) -> None:
        """Run *work* once all elements exist."""
        self._until_elements.append(work)

    def defer_until_edges(self, work: Work) -> None:
        """Run *work* once all edges exist."""
        self._until_edges.append(work)

    def run_deferred(self) -> None:
        """Run the work that waits for elements, also work that this adds."""
        while self._until_elements:
            batch, self._until_elements = self._until_elements, []
            for work in batch:
                work()

    def finish(self) -> None:
        """Run all deferred work, in order."""
        self.run_deferred()
        while self._until_edges:
            self._until_edges.popleft()()
            if self._until_elements:
                self.run_deferred()
        # Edges to stubs are pending until the pass `resolve`. Generalizations stated after one of
        # them become pending too, so that their order stays that of the text.
        if not self._has_pending_general:
            return
        for source, general in self._generalizations:
            self.graph.disconnect(Edge.SPECIALIZES, source, general)
            self.graph.pending.append(Pending(Edge.SPECIALIZES, source.id, general.id))

    # -- elements ------------------------------------------------------------------------------

    def add_element(
        self, node: Node, kind: Kind, name: str, owner: Element | None, **attrs: AttrValue
    ) -> Element:
        """Add an element and register it as the element of the node."""
        element = self.elements[id(node)] = self.add_derived(node, kind, name, owner, **attrs)
        return element

    def add_derived(
        self, node: Node, kind: Kind, name: str, owner: Element | None, **attrs: AttrValue
    ) -> Element:
        """Add a further element for the node, at its location."""
        document = self._documents.get(id(node))
        source, ordinal = "", -1
        if document is not None:
            source, ordinal = document.path, document.ordinal_of(node)
        id_ = self._names.add(kind, name, owner, source)
        owner_id = None if owner is None else owner.id
        attributes = _drop_empty(attrs)
        element = self.graph.add(Element(id_, kind, name, owner_id, ordinal, source, attributes))
        self.lowered.add(id(node))
        self._origins[element.id] = node
        return element

    def origin_of(self, element: Element) -> Node | None:
        """Return the node for which an element was added."""
        return self._origins.get(element.id)

    def text_name_of(self, element: Element) -> str:
        """Return the name that an element has in the text; metadata may give it another one."""
        node = self._origins.get(element.id)
        return element.name if node is None else nodes.name_of(node)

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
        id_ = self._names.add(kind, name, owner, source)
        owner_id = None if owner is None else owner.id
        return self.graph.add(Element(id_, kind, name, owner_id, neighbor.ordinal, source))

    def set_attributes(self, element: Element, **attrs: AttrValue) -> None:
        """Set attributes of an element, without those that have an empty value."""
        attributes = _drop_empty(attrs)
        if attributes:
            self.graph.set(element, **attributes)

    def id_of(self, qualified_name: str) -> str:
        """Return the id of the element with a qualified name, or the empty string."""
        return self._names.id_of(qualified_name)

    # -- edges ---------------------------------------------------------------------------------

    def connect_reference(self, edge: Edge, source: Element, reference: Reference | None) -> None:
        """Connect an element to the target of a reference, once all elements exist."""
        if reference is not None:
            self.defer_until_elements(lambda: self.connect_node(edge, source, reference.target))

    def connect_node(self, edge: Edge, source: Element, target: Node | None) -> None:
        """Connect an element to that of a node, or to a stub if the node is in the library.

        The element records the kind of an edge whose target is not resolved.
        """
        if target is None:
            self._mark_unresolved(source, edge)
            return
        element = self.element_of(target)
        if element is not None:
            if edge is Edge.SPECIALIZES:
                self._generalizations.append((source, element))
            self.graph.connect(edge, source, element)
        elif id(target) not in self._documents:
            self._connect_library_node(edge, source, target)
        else:
            self._report_unread_target(edge, source, target)

    def connect_nodes(self, edge: Edge, source: Element, targets: Iterable[Node]) -> None:
        """Connect an element to those of several nodes."""
        for target in targets:
            self.connect_node(edge, source, target)

    def connect_library_element(self, edge: Edge, source: Element, name: str, kind: Kind) -> None:
        """Connect an element to an element of the library, given its qualified name."""
        if edge is Edge.SPECIALIZES and not self._has_pending_general:
            self._has_pending_general = True
            self._generalizations.clear()
        if name not in self._stubs:
            self._stubs[name] = libraries.ensure_stub(self.graph, kind, name)
        self.graph.pending.append(Pending(edge, source.id, self._stubs[name], kind, name))
        if edge is Edge.TYPED_BY and name in libraries.SCALARS:
            self._library_types.setdefault(source.id, []).append((name, kind))

    def copy_types(self, source: Element, target: Element) -> None:
        """Type *target* by the types of *source*, including those of the library."""
        for type_ in self.graph.targets(source, Edge.TYPED_BY):
            self.graph.connect(Edge.TYPED_BY, target, type_)
        for name, kind in self._library_types.get(source.id, ()):
            self.connect_library_element(Edge.TYPED_BY, target, name, kind)

    def has_scalar_type(self, element: Element) -> bool:
        """Whether a scalar type of the standard library types the element."""
        return element.id in self._library_types

    def _connect_library_node(self, edge: Edge, source: Element, target: Node) -> None:
        if id(target) not in self._library_names:
            name_and_kind = (nodes.qualified_name_of(target), libraries.stub_kind_of(target))
            self._library_names[id(target)] = name_and_kind
        name, kind = self._library_names[id(target)]
        if not libraries.is_base(name):
            self.connect_library_element(edge, source, name, kind)

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
        while owner is not None and owner.owner is not None and self.element_of(owner) is None:
            outermost, owner = owner, owner.owner
        return nodes.qualified_name_of(outermost)

    def ensure_parameter_node(self, parameter: Element) -> Element:
        """Return the activity parameter node of a parameter; add it if it is new."""
        for source in self.graph.sources(parameter, Edge.REFERENCES):
            if source.kind is Kind.ACTIVITY_PARAMETER:
                return source
        node = self.add_implied_sibling(parameter, Kind.ACTIVITY_PARAMETER, parameter.name)
        direction = str(parameter.attrs.get("direction", "in"))
        self.set_attributes(node, direction="out" if direction == "return" else direction)
        self.graph.connect(Edge.REFERENCES, node, parameter)
        self.copy_types(parameter, node)
        return node

    # -- starts and ends of behaviours ---------------------------------------------------------

    def flow_node_of(self, step: Node, *, is_target: bool) -> Element | None:
        """Return the node at which flows enter a step (*is_target*), or at which they leave it."""
        entry_and_exit = self.spans.get(id(step))
        if entry_and_exit is None:
            return self.elements.get(id(step))
        return entry_and_exit[0] if is_target else entry_and_exit[1]

    def ensure_control_node(self, owner: Element, name: str, node: Node | None = None) -> Element:
        """Return the ``start`` or ``done`` of a behaviour; add it if it is new."""
        control_node = self.find_start_or_done(owner, name)
        if control_node is None:
            subkind = "initial" if name == "start" else "final"
            control_node = self._add_start_or_done(node, Kind.CONTROL, name, owner, subkind)
        return control_node

    def ensure_vertex(self, region: Element, name: str, node: Node | None = None) -> Element:
        """Return the initial pseudostate or the final state of a region; add it if it is new."""
        vertex = self.find_start_or_done(region, name)
        if vertex is None:
            is_start = name == "start"
            kind = Kind.PSEUDOSTATE if is_start else Kind.FINAL_STATE
            subkind = "initial" if is_start else ""
            vertex = self._add_start_or_done(node, kind, name, region, subkind)
        return vertex

    def find_start_or_done(self, owner: Element, name: str) -> Element | None:
        """Return the element for ``start`` or ``done`` of a behaviour or region, if it exists."""
        return self._starts_and_ends.get((owner.id, name))

    def _add_start_or_done(
        self, node: Node | None, kind: Kind, name: str, owner: Element, subkind: str
    ) -> Element:
        """Add an element for ``start`` or ``done``; *node*, which names it, gives the location."""
        if node is None:
            element = self.add_implied_child(owner, kind, name)
        else:
            element = self.add_derived(node, kind, name, owner)
        self._starts_and_ends[owner.id, name] = element
        self.set_attributes(element, subkind=subkind)
        return element

    def mark_flow_finals(self) -> None:
        """Mark each ``done`` that ends one of several concurrent branches as a flow final node."""
        for (_, name), end in self._starts_and_ends.items():
            if name == "done" and end.kind is Kind.CONTROL and not is_joined(self.graph, end):
                self.set_attributes(end, subkind="flow-final")


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
