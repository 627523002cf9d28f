"""A compile unit on its way into the graph: elements first, then what they refer to."""

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

from sysmlc.diagnostics import Place, Sink, Subject
from sysmlc.frontends.sysml import nodes, stubs
from sysmlc.frontends.sysml.naming import Names
from sysmlc.frontends.sysml.places import Home
from sysmlc.frontends.sysml.rules import NOT_IN_GRAPH
from sysmlc.frontends.sysml.verdicts import Verdicts
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind
from sysmlc.ir import Reference as Pending
from sysmlc.ir.query.activities import is_joined
from sysmlc.language.tree import Document, Node, Reference, Relation

if TYPE_CHECKING:
    from sysmlc.language.names import Model

Handler = Callable[["Lowering", Node, "Element | None"], None]
"""Adds what a node is to what its owner became."""
Work = Callable[[], None]


class Lowering(Verdicts):
    """The graph as far as it is made, and which node became which element."""

    # With more than 30 attributes in all each look at one takes longer (Python 3.11: 2 % in all).
    def __init__(
        self,
        homes: Sequence[Home],
        model: "Model",
        graph: Graph,
        sink: Sink,
        handlers: dict[str, Handler],
    ) -> None:
        super().__init__()
        self.model = model
        self.graph = graph
        self.sink = sink
        self.elements: dict[int, Element] = {}
        self.accepted: set[int] = set()
        """Identities of item definitions that are sent or accepted: signals."""
        self.flowing: set[int] = set()
        """Identities of features between which objects flow in actions."""
        self.made_for: dict[int, Element] = {}
        """Classes that are made for usages with members of their own, by the node's identity."""
        self.spans: dict[int, tuple[Element, Element]] = {}
        """Entry and exit of steps that are several nodes, by the identity of the step."""
        self._controls: dict[tuple[str, str], Element] = {}
        self.repeated: set[int] = set()
        """Identities of redefinitions that say nothing that is an element."""
        self.seen: set[int] = set()
        """Identities of nodes that were lowered, or that an element was made for."""
        self.skipped: set[int] = set()
        """Identities of members that are read with something else."""
        self._handlers = handlers
        self.homes = homes
        self._homes: dict[int, Home] = {}
        self._later: list[Work] = []
        self._last: deque[Work] = deque()
        self._brought: dict[str, Node] = {}
        self._generals: list[tuple[Element, Element]] = []
        self._waits = False
        self._scalars: dict[str, list[tuple[str, Kind]]] = {}
        self._names = Names()
        self._stubs: dict[str, str] = {}
        self._outer: dict[int, tuple[str, Kind]] = {}
        """Names and kinds of elements of the library that edges lead to."""

    # -- nodes ---------------------------------------------------------------------------------

    def lower(self, node: Node, owner: Element | None) -> None:
        """Lower a member of what ``owner`` is in the graph."""
        if id(node) in self.skipped:
            return
        self.seen.add(id(node))
        handler = self._handlers.get(node.kind)
        if handler is None:
            self.unsupported(node)
        else:
            handler(self, node, owner)

    def lower_all(self, found: Iterable[Node], owner: Element | None) -> None:
        """Lower several members, in order."""
        for node in found:
            self.lower(node, owner)

    def lower_texts(self, node: Node, owner: Element | None) -> None:
        """Lower what annotates a node, which became the owner of that."""
        for one in node.members:
            if one.kind in nodes.TEXTS:
                self.lower(one, owner)

    def settle_in(self, home: Home, found: Iterable[Node]) -> None:
        """Say of nodes that they stand in a document of the unit."""
        self._homes.update(dict.fromkeys(map(id, found), home))

    def document(self, node: Node) -> Document | None:
        """The document of the unit that the node stands in; None for one of the library."""
        home = self._homes.get(id(node))
        return None if home is None else home.document

    def target(self, node: Node, relation: Relation) -> Node | None:
        """What a relation of a node leads to, in the unit or in the library."""
        found = relation.reference.target
        return found if found is not None else self.model.target(node, relation)

    def element(self, node: Node | None) -> Element | None:
        """What the node became; a redefinition that says nothing is what it redefines."""
        if node is None:
            return None
        known = self.elements.get(id(node))
        if known is None and id(node) in self.repeated:
            return self.element(nodes.target(node, "Redefinition"))
        return known

    def later(self, work: Work) -> None:
        """Do something when all elements are there."""
        self._later.append(work)

    def last(self, work: Work) -> None:
        """Do something when all edges are there."""
        self._last.append(work)

    def finish(self) -> None:
        """Do all that waits for elements, in order."""
        self.work()
        while self._last:
            self._last.popleft()()
            if self._later:
                self.work()
        for source, general in self._generals if self._waits else ():
            self.graph.disconnect(Edge.SPECIALIZES, source, general)
            self.graph.pending.append(Pending(Edge.SPECIALIZES, source.id, general.id))

    def work(self) -> None:
        """Do what waits for elements, and what that brings with it."""
        while self._later:
            waiting, self._later = self._later, []
            for one in waiting:
                one()

    # -- elements ------------------------------------------------------------------------------

    def add(
        self, node: Node, kind: Kind, name: str, owner: Element | None, **attrs: AttrValue
    ) -> Element:
        """The element that the node is."""
        made = self.elements[id(node)] = self._bring(node, kind, name, owner, attrs)
        return made

    def make(
        self, node: Node, kind: Kind, name: str, owner: Element | None, **attrs: AttrValue
    ) -> Element:
        """One more element that the node brings with it, at its place."""
        return self._bring(node, kind, name, owner, attrs)

    def _bring(
        self,
        node: Node,
        kind: Kind,
        name: str,
        owner: Element | None,
        attrs: dict[str, AttrValue],
    ) -> Element:
        home = self._homes.get(id(node))
        source, ordinal = ("", -1) if home is None else (home.path, home.ordinal(node))
        id_ = self._names.give(kind, name, owner, source)
        above = None if owner is None else owner.id
        made = self.graph.add(Element(id_, kind, name, above, ordinal, source, _said(attrs)))
        self.seen.add(id(node))
        self._brought[made.id] = node
        return made

    def is_made(self, element: Element, node: Node) -> bool:
        """Whether an element is one of those that a node brought with it."""
        return self._brought.get(element.id) is node

    def below(self, owner: Element, kind: Kind, name: str) -> Element:
        """An element that nothing in the text stands for, at the place of its owner."""
        return self._new(owner, kind, name, owner)

    def beside(self, other: Element, kind: Kind, name: str) -> Element:
        """The same beside an element, with which it shares the owner."""
        return self._new(other, kind, name, self.graph.owner(other))

    def _new(self, at: Element, kind: Kind, name: str, owner: Element | None) -> Element:
        id_ = self._names.give(kind, name, owner, at.source)
        above = None if owner is None else owner.id
        return self.graph.add(Element(id_, kind, name, above, at.ordinal, at.source))

    def set(self, element: Element, **attrs: AttrValue) -> None:
        """Give attributes to an element; those that say nothing are left out."""
        given = _said(attrs)
        if given:
            self.graph.set(element, **given)

    # -- edges ---------------------------------------------------------------------------------

    def refer(self, edge: Edge, source: Element, found: Reference | None) -> None:
        """Let an edge lead to what a reference names, when all elements are there."""
        if found is not None:
            self.later(lambda: self.lead(edge, source, found.target))

    def lead(self, edge: Edge, source: Element, target: Node | None) -> None:
        """Let an edge lead to the element of a node, or to a stub of the library."""
        if target is None:
            self._unresolved(source, edge)
            return
        known = self.elements.get(id(target))
        if known is None and id(target) in self.repeated:
            known = self.element(target)
        if known is not None:
            if edge is Edge.SPECIALIZES:
                self._generals.append((source, known))
            self.graph.connect(edge, source, known)
        elif id(target) not in self._homes:
            self._outside(edge, source, target)
        else:
            self._lost(edge, source, target)

    def lead_all(self, edge: Edge, source: Element, targets: Iterable[Node]) -> None:
        """Let edges lead to the elements of several nodes."""
        for target in targets:
            self.lead(edge, source, target)

    def lead_to(self, edge: Edge, source: Element, name: str, kind: Kind) -> None:
        """Let an edge lead to an element of the library by its qualified name.

        Generalizations inside the unit that were stated later wait for it, to come behind it.
        """
        if edge is Edge.SPECIALIZES and not self._waits:
            self._waits = True
            self._generals.clear()
        target = self._stubs.get(name) or self._stub(kind, name)
        self.graph.pending.append(Pending(edge, source.id, target, kind, name))
        if edge is Edge.TYPED_BY and name in stubs.SCALARS:
            self._scalars.setdefault(source.id, []).append((name, kind))

    def share_types(self, known: Element, other: Element) -> None:
        """Give an element the types of another one, those of the library too."""
        for type_ in self.graph.targets(known, Edge.TYPED_BY):
            self.graph.connect(Edge.TYPED_BY, other, type_)
        for name, kind in self._scalars.get(known.id, ()):
            self.lead_to(Edge.TYPED_BY, other, name, kind)

    def is_scalar(self, element: Element) -> bool:
        """Whether a data type of the standard library types the element."""
        return element.id in self._scalars

    def _stub(self, kind: Kind, name: str) -> str:
        """Id of the element that stands for one of the standard library; href of a scalar."""
        found = self._stubs[name] = stubs.stand_in(self.graph, kind, name)
        return found

    def _outside(self, edge: Edge, source: Element, target: Node) -> None:
        known = self._outer.get(id(target))
        if known is None:
            known = self._outer[id(target)] = (nodes.path_of(target), stubs.kind_of(target))
        name, kind = known
        if not stubs.is_base(name):
            self.lead_to(edge, source, name, kind)

    def _unresolved(self, source: Element, edge: Edge) -> None:
        known = source.attrs.get("unresolved")
        names = known if isinstance(known, tuple) else ()
        if str(edge.value) not in names:
            self.graph.set(source, unresolved=(*names, str(edge.value)))

    def _lost(self, edge: Edge, source: Element, target: Node) -> None:
        self._unresolved(source, edge)
        name = nodes.path_of(target)
        subject, type_ = self.graph.subject(source), nodes.words(target.kind)
        self.sink.report(NOT_IN_GRAPH, subject, edge=str(edge.value), name=name, type=type_)

    # -- steps ---------------------------------------------------------------------------------

    def point(self, node: Node, *, is_target: bool) -> Element | None:
        """The node of an activity at which a step is entered, or the one at which it is left."""
        entry_and_exit = self.spans.get(id(node))
        if entry_and_exit is None:
            return self.elements.get(id(node))
        return entry_and_exit[0] if is_target else entry_and_exit[1]

    def control(self, owner: Element, name: str, node: Node | None = None) -> Element:
        """The start or the end of a behaviour; made when a succession needs it."""
        known = self._controls.get((owner.id, name))
        if known is None:
            known = self._made(node, Kind.CONTROL, name, owner)
            self._controls[owner.id, name] = known
            self.set(known, subkind="initial" if name == "start" else "final")
        return known

    def end_branches(self) -> None:
        """Say of each ``done`` whether it ends the behaviour or, as a flow final, one branch."""
        for (_, name), end in self._controls.items():
            if name == "done" and end.kind is Kind.CONTROL and not is_joined(self.graph, end):
                self.set(end, subkind="flow-final")

    def _made(self, node: Node | None, kind: Kind, name: str, owner: Element) -> Element:
        return self.make(node, kind, name, owner) if node else self.below(owner, kind, name)

    def vertex(self, region: Element, name: str, node: Node | None = None) -> Element:
        """The initial pseudostate or the final state of a region; made when it is needed."""
        known = self._controls.get((region.id, name))
        if known is None:
            is_start = name == "start"
            kind = Kind.PSEUDOSTATE if is_start else Kind.FINAL_STATE
            known = self._controls[region.id, name] = self._made(node, kind, name, region)
            self.set(known, subkind="initial" if is_start else "")
        return known

    def end_of(self, holder: Element, name: str) -> Element | None:
        """The start or the end of a behaviour or region, if something leads from or to it."""
        return self._controls.get((holder.id, name))

    @property
    def roots(self) -> list[Node]:
        """What holds the members at the top of each document of the unit."""
        return [one.document.root for one in self.homes]

    def id_of(self, name: str) -> str:
        """Id of the element with a qualified name, or the empty string."""
        return self._names.id_of(name)

    def subject(self, node: Node) -> Subject:
        """The node as the subject of a diagnostic."""
        home = self._homes.get(id(node))
        if home is None:
            return Subject(nodes.path_of(node))
        return Subject(nodes.path_of(node), place=Place(home.path, home.ordinal(node)))


def _said(attrs: dict[str, AttrValue]) -> dict[str, AttrValue]:
    """The attributes that say something: an empty sequence does, no text and no number do not."""
    if all(attrs.values()):
        return attrs
    return {key: value for key, value in attrs.items() if value or value == ()}
