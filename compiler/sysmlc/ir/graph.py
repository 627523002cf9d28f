"""The graph: elements, edges of each kind in both directions, and the only way to change them.

The neighbours of an element along edges of one kind keep the order of addition. Most elements have
one neighbour and a few have thousands. A set for each element would need more memory than the
elements themselves.
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, TypeVar, cast

from sysmlc.diagnostics import Place, Subject
from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.pending import Reference

if TYPE_CHECKING:
    from networkx import DiGraph


_T = TypeVar("_T")


class Graph:
    """Typed property graph of one compile unit.

    Elements and edges keep the order in which they were added. ``pending`` holds the references
    that the pass ``resolve`` turns into edges. Results of analyses (recipes, contracts) are stored
    by type beside the elements.
    """

    def __init__(self) -> None:
        self._elements: dict[str, Element] = {}
        self._by_kind: dict[Kind, dict[str, Element]] = {kind: {} for kind in Kind}
        self._targets: dict[Edge, Index] = {edge: {} for edge in Edge}
        # Ownership is missing here: each element has the id of its owner.
        self._sources: dict[Edge, Index] = {edge: {} for edge in _BARE_EDGES}
        self._owned = self._targets[Edge.OWNS]
        self._derived: dict[type, tuple[object, ...]] = {}
        self.pending: list[Reference] = []
        self.revision = 0
        """Number of changes of elements and edges so far; derived values do not count."""
        self.analysed: dict[str, tuple[object, ...]] = {}
        """For each analysis whose result is stored, what the result depends on."""

    # -- elements ------------------------------------------------------------------------------

    def __len__(self) -> int:
        return len(self._elements)

    def __contains__(self, id: str) -> bool:
        return id in self._elements

    def __getitem__(self, name: str) -> Element:
        """Return the element with an id, else the first with a qualified name. Raises KeyError."""
        element = self._elements.get(name) or self.find(name)
        if element is None:
            raise KeyError(name)
        return element

    def find(self, name: str) -> Element | None:
        """Return the first element with a qualified name such as ``Plant::Gate``, or None."""
        last_name = name.rpartition("::")[2]
        candidates = (element for element in self if element.name == last_name)
        return next((e for e in candidates if self.qualified_name(e) == name), None)

    def __iter__(self) -> Iterator[Element]:
        return iter(self._elements.values())

    def get(self, id: str | None) -> Element | None:
        """Return the element with this id, or None."""
        return None if id is None else self._elements.get(id)

    def of_kind(self, *kinds: Kind) -> list[Element]:
        """Return the elements of these kinds: kind by kind, each in order of addition."""
        return [element for kind in kinds for element in self._by_kind[kind].values()]

    def roots(self) -> list[Element]:
        """Return the elements without an owner."""
        return [element for element in self if element.owner is None]

    def owned(self, element: Element) -> list[Element]:
        """Return the elements that *element* owns, in order."""
        return list_neighbours(self._owned, element.id)

    def owner(self, element: Element) -> Element | None:
        """Return the owner of *element*, or None."""
        return self.get(element.owner)

    def subtree(self, element: Element) -> Iterator[Element]:
        """Iterate over *element* and everything below it, owners before owned elements."""
        stack = [element]
        while stack:
            owner = stack.pop()
            yield owner
            if owner.id in self._owned:
                stack.extend(reversed(self.owned(owner)))

    def ancestors(self, element: Element) -> Iterator[Element]:
        """Iterate over the owners of *element*, nearest first."""
        ancestor = self.owner(element)
        while ancestor is not None:
            yield ancestor
            ancestor = self.owner(ancestor)

    # -- edges ---------------------------------------------------------------------------------

    def targets(self, element: Element, edge: Edge) -> list[Element]:
        """Return the targets of the edges of this kind that leave *element*, in order."""
        return list_neighbours(self._targets[edge], element.id)

    def sources(self, element: Element, edge: Edge) -> list[Element]:
        """Return the sources of the edges of this kind that reach *element*, in order."""
        if edge is Edge.OWNS:
            owner = self.owner(element)
            return [] if owner is None else [owner]
        return list_neighbours(self._sources[edge], element.id)

    def target(self, element: Element, edge: Edge) -> Element | None:
        """Return the target of the first edge of this kind that leaves *element*, or None."""
        return first_neighbour(self._targets[edge], element.id)

    def source(self, element: Element, edge: Edge) -> Element | None:
        """Return the source of the first edge of this kind that reaches *element*, or None."""
        if edge is Edge.OWNS:
            return self.owner(element)
        return first_neighbour(self._sources[edge], element.id)

    def edges(self, *kinds: Edge) -> Iterator[tuple[Edge, str, str]]:
        """Iterate over edges of these kinds (all by default) as (kind, source id, target id)."""
        for kind in kinds or tuple(Edge):
            for source in self._targets[kind]:
                for target in list_neighbours(self._targets[kind], source):
                    yield kind, source, target.id

    def to_networkx(self, *kinds: Edge) -> "DiGraph[str]":
        """Return a networkx graph of the edges of these kinds (all by default) and their ends.

        Nodes are ids, with the attributes ``kind`` and ``name``. Where edges of several kinds
        connect two elements, the attribute ``kind`` of the edge is the last of them.
        """
        from networkx import DiGraph

        view: DiGraph[str] = DiGraph()
        for kind, source, target in self.edges(*kinds):
            for id in (source, target):
                view.add_node(id, kind=self[id].kind, name=self[id].name)
            view.add_edge(source, target, kind=kind)
        return view

    # -- names and positions -------------------------------------------------------------------

    def qualified_name(self, element: Element) -> str:
        """Return the names from the root down, joined by ``::``; an absent name is ``<Kind>``."""
        path = [element, *self.ancestors(element)]
        return "::".join(part.name or f"<{part.kind}>" for part in reversed(path))

    def subject(self, element: Element) -> Subject:
        """Return *element* as the subject of a diagnostic.

        An element without a position takes that of its origin or of its nearest owner with one.
        """
        return Subject(self.qualified_name(element), element.id, self._place(element))

    def _place(self, element: Element) -> Place | None:
        for candidate in (element, self._origin(element), *self.ancestors(element)):
            if candidate is not None and candidate.source:
                return Place(candidate.source, candidate.ordinal)
        return None

    def _origin(self, element: Element) -> Element | None:
        origin = element.attrs.get("origin")
        return self.get(origin) if isinstance(origin, str) else None

    # -- changes of elements -------------------------------------------------------------------

    def add(self, element: Element) -> Element:
        """Add an element, below its owner when it has one. Return the element.

        Raise ValueError when the id is empty or in use, KeyError when the owner does not exist.
        """
        id, owner = element.id, element.owner
        if not id or id in self._elements:
            raise ValueError(f"id {id!r} is empty or taken")
        if owner is not None:
            if owner not in self._elements:
                raise KeyError(owner)
            add_neighbour(self._owned, owner, element)
        self._elements[id] = element
        self._by_kind[element.kind][id] = element
        self.revision += 1
        return element

    def move(self, element: Element, owner: Element | None) -> None:
        """Give *element* another owner, or none. Raise ValueError for a cycle of owners."""
        if owner is not None and any(a is element for a in (owner, *self.ancestors(owner))):
            raise ValueError(f"{element!r} cannot own itself")
        if element.owner is not None:
            remove_neighbour(self._owned, element.owner, element)
        element.owner = None if owner is None else owner.id
        self.revision += 1
        if owner is not None:
            add_neighbour(self._owned, owner.id, element)

    def remove(self, element: Element) -> None:
        """Remove *element*, everything below it, and all their edges."""
        self.revision += 1
        for removed in reversed(list(self.subtree(element))):
            self._isolate(removed)
            del self._elements[removed.id]
            del self._by_kind[removed.kind][removed.id]

    def rename(self, element: Element, name: str) -> None:
        """Give *element* another name."""
        element.name = name
        self.revision += 1

    def set(self, element: Element, **attrs: AttrValue) -> None:
        """Set attributes of *element*; the value None removes the attribute."""
        self.revision += 1
        for key, value in attrs.items():
            if value is None:
                element.attrs.pop(key, None)
            else:
                element.attrs[key] = value

    # -- changes of edges ----------------------------------------------------------------------

    def connect(self, edge: Edge, source: Element | str, target: Element | str) -> None:
        """Add an edge unless the graph has it. Ownership is changed by ``move``.

        Raise KeyError when an end is not in the graph.
        """
        if edge is Edge.OWNS:
            raise ValueError("ownership is changed by move()")
        elements = self._elements
        start = elements[source if isinstance(source, str) else source.id]
        end = elements[target if isinstance(target, str) else target.id]
        if add_neighbour(self._targets[edge], start.id, end):
            self.revision += 1
            add_neighbour(self._sources[edge], end.id, start)

    def disconnect(self, edge: Edge, source: Element | str, target: Element | str) -> None:
        """Remove an edge if the graph has it. Ownership is changed by ``move``."""
        if edge is Edge.OWNS:
            raise ValueError("ownership is changed by move()")
        self._unlink(edge, self._find(source), self._find(target))

    def replace_targets(self, edge: Edge, source: Element, targets: Iterable[Element]) -> None:
        """Make *targets*, in this order, the only targets of the edges that leave *source*."""
        for target in self.targets(source, edge):
            self.disconnect(edge, source, target)
        for target in targets:
            self.connect(edge, source, target)

    def _find(self, end: Element | str) -> Element:
        return self._elements[end if isinstance(end, str) else end.id]

    def _unlink(self, edge: Edge, source: Element, target: Element) -> None:
        if remove_neighbour(self._targets[edge], source.id, target):
            self.revision += 1
            remove_neighbour(self._sources[edge], target.id, source)

    def _isolate(self, element: Element) -> None:
        """Remove all edges of *element*."""
        if element.owner is not None:
            remove_neighbour(self._owned, element.owner, element)
        for edge in _BARE_EDGES:
            for target in self.targets(element, edge):
                self._unlink(edge, element, target)
            for source in self.sources(element, edge):
                self._unlink(edge, source, element)

    # -- derived values ------------------------------------------------------------------------

    def store(self, type_: type[_T], values: Iterable[_T]) -> None:
        """Store derived values (recipes, contracts, token graphs); they replace earlier ones."""
        self._derived[type_] = tuple(values)

    def derived(self, type_: type[_T]) -> Sequence[_T]:
        """Return the derived values of a type, in the order in which a pass stored them."""
        return cast("Sequence[_T]", self._derived.get(type_, ()))


_BARE_EDGES = tuple(edge for edge in Edge if edge is not Edge.OWNS)


# -- neighbours --------------------------------------------------------------------------------

Neighbours = Element | list[Element] | dict[Element, None]
"""A single neighbour itself, several as a list, many as a dict."""

Index = dict[str, Neighbours]
"""Neighbours by the id of an element. An element without neighbours has no entry."""

_LONGEST_LIST = 16
"""Longer lists become dicts, because search and removal in a list take linear time."""


def add_neighbour(index: Index, id: str, neighbour: Element) -> bool:
    """Add a neighbour of the element *id*. Return False when the index has it already."""
    neighbours = index.get(id)
    if neighbours is None:
        index[id] = neighbour
    elif isinstance(neighbours, Element):
        if neighbours is neighbour:
            return False
        index[id] = [neighbours, neighbour]
    elif neighbour in neighbours:
        return False
    elif isinstance(neighbours, dict):
        neighbours[neighbour] = None
    elif len(neighbours) < _LONGEST_LIST:
        neighbours.append(neighbour)
    else:
        index[id] = dict.fromkeys((*neighbours, neighbour))
    return True


def remove_neighbour(index: Index, id: str, neighbour: Element) -> bool:
    """Remove a neighbour of the element *id*. Return False when the index does not have it."""
    neighbours = index.get(id)
    if neighbours is None:
        return False
    if isinstance(neighbours, Element):
        if neighbours is not neighbour:
            return False
        del index[id]
        return True
    if neighbour not in neighbours:
        return False
    if isinstance(neighbours, dict):
        del neighbours[neighbour]
    else:
        neighbours.remove(neighbour)
    if not neighbours:
        del index[id]
    return True


def list_neighbours(index: Index, id: str) -> list[Element]:
    """Return all neighbours of the element *id*."""
    neighbours = index.get(id)
    if neighbours is None:
        return []
    return [neighbours] if isinstance(neighbours, Element) else list(neighbours)


def first_neighbour(index: Index, id: str) -> Element | None:
    """Return the neighbour of the element *id* that was added first, or None."""
    neighbours = index.get(id)
    if neighbours is None or isinstance(neighbours, Element):
        return neighbours
    return next(iter(neighbours))
