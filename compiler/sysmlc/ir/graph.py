"""The graph: elements, edges of each kind in both directions, and the only way to change them."""

from collections.abc import Iterable, Iterator, Sequence
from typing import TypeVar, cast

from sysmlc.diagnostics import Place, Subject
from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.reference import Reference

_T = TypeVar("_T")
_Index = dict[Edge, dict[str, list[str]]]


class Graph:
    """Typed property graph of one compile unit.

    Elements and edges keep the order in which they were added. ``pending`` holds the
    references that the pass ``resolve`` has still to turn into edges. What passes derive for
    back ends (recipes, contracts) is kept by type beside the elements.
    """

    def __init__(self) -> None:
        self._elements: dict[str, Element] = {}
        self._of_kind: dict[Kind, dict[str, None]] = {}
        self._out: _Index = {edge: {} for edge in Edge}
        self._in: _Index = {edge: {} for edge in Edge}
        self._derived: dict[type, tuple[object, ...]] = {}
        self.pending: list[Reference] = []

    # -- reading -------------------------------------------------------------------------------

    def __len__(self) -> int:
        return len(self._elements)

    def __contains__(self, id: str) -> bool:
        return id in self._elements

    def __getitem__(self, id: str) -> Element:
        return self._elements[id]

    def __iter__(self) -> Iterator[Element]:
        return iter(self._elements.values())

    def get(self, id: str | None) -> Element | None:
        """The element with this id, or None."""
        return None if id is None else self._elements.get(id)

    def of_kind(self, *kinds: Kind) -> list[Element]:
        """Elements of these kinds: kind by kind, each in the order of addition."""
        return [self._elements[id] for kind in kinds for id in self._of_kind.get(kind, ())]

    def roots(self) -> list[Element]:
        """Elements that nothing owns."""
        return [element for element in self if element.owner is None]

    def owned(self, element: Element) -> list[Element]:
        """What the element owns, in order."""
        return self.targets(element, Edge.OWNS)

    def owner(self, element: Element) -> Element | None:
        """What owns the element, or None."""
        return self.get(element.owner)

    def targets(self, element: Element, edge: Edge) -> list[Element]:
        """Where the element's edges of this kind lead, in order."""
        return [self._elements[id] for id in self._out[edge].get(element.id, ())]

    def sources(self, element: Element, edge: Edge) -> list[Element]:
        """Where the edges of this kind that reach the element come from, in order."""
        return [self._elements[id] for id in self._in[edge].get(element.id, ())]

    def target(self, element: Element, edge: Edge) -> Element | None:
        """Where the first edge of this kind leads, or None."""
        ids = self._out[edge].get(element.id)
        return self._elements[ids[0]] if ids else None

    def source(self, element: Element, edge: Edge) -> Element | None:
        """Where the first edge of this kind that reaches the element comes from, or None."""
        ids = self._in[edge].get(element.id)
        return self._elements[ids[0]] if ids else None

    def edges(self, *kinds: Edge) -> Iterator[tuple[Edge, str, str]]:
        """All edges of these kinds (of every kind when none is given) as (kind, from, to)."""
        for kind in kinds or tuple(Edge):
            for source, targets in self._out[kind].items():
                for target in targets:
                    yield kind, source, target

    def subtree(self, element: Element) -> Iterator[Element]:
        """The element and everything below it, owner before owned."""
        stack = [element]
        while stack:
            top = stack.pop()
            yield top
            stack.extend(reversed(self.owned(top)))

    def ancestors(self, element: Element) -> Iterator[Element]:
        """The owners of the element, nearest first."""
        above = self.owner(element)
        while above is not None:
            yield above
            above = self.owner(above)

    def qualified_name(self, element: Element) -> str:
        """Names from the root down, joined by ``::``; an element without a name shows its kind."""
        path = [element, *self.ancestors(element)]
        return "::".join(part.name or f"<{part.kind}>" for part in reversed(path))

    def subject(self, element: Element) -> Subject:
        """The element as the subject of a diagnostic, at the nearest place that is known."""
        return Subject(self.qualified_name(element), element.id, self._place(element))

    def _place(self, element: Element) -> Place | None:
        for candidate in (element, self._origin(element), *self.ancestors(element)):
            if candidate is not None and candidate.source:
                return Place(candidate.source, candidate.ordinal)
        return None

    def _origin(self, element: Element) -> Element | None:
        origin = element.attrs.get("origin")
        return self.get(origin) if isinstance(origin, str) else None

    # -- changing ------------------------------------------------------------------------------

    def add(self, element: Element) -> Element:
        """Add an element, below its owner when it has one.

        Raises ValueError when the id is taken or empty, KeyError when the owner is not there.
        """
        if not element.id or element.id in self._elements:
            raise ValueError(f"id {element.id!r} is empty or taken")
        if element.owner is not None and element.owner not in self._elements:
            raise KeyError(element.owner)
        self._elements[element.id] = element
        self._of_kind.setdefault(element.kind, {})[element.id] = None
        if element.owner is not None:
            self._append(Edge.OWNS, element.owner, element.id)
        return element

    def connect(self, edge: Edge, source: Element | str, target: Element | str) -> None:
        """Add an edge unless it is there. Use ``move`` for ownership."""
        if edge is Edge.OWNS:
            raise ValueError("ownership is changed by move()")
        self._link(edge, self._id(source), self._id(target))

    def disconnect(self, edge: Edge, source: Element | str, target: Element | str) -> None:
        """Remove an edge if it is there. Use ``move`` for ownership."""
        if edge is Edge.OWNS:
            raise ValueError("ownership is changed by move()")
        self._unlink(edge, self._id(source), self._id(target))

    def replace_targets(self, edge: Edge, source: Element, targets: Iterable[Element]) -> None:
        """Make ``targets`` the only and ordered targets of the element's edges of this kind."""
        for old in self.targets(source, edge):
            self.disconnect(edge, source, old)
        for new in targets:
            self.connect(edge, source, new)

    def move(self, element: Element, owner: Element | None) -> None:
        """Give the element another owner, or none."""
        if owner is not None and any(a is element for a in (owner, *self.ancestors(owner))):
            raise ValueError(f"{element!r} cannot own itself")
        if element.owner is not None:
            self._unlink(Edge.OWNS, element.owner, element.id)
        element.owner = None if owner is None else owner.id
        if owner is not None:
            self._link(Edge.OWNS, owner.id, element.id)

    def remove(self, element: Element) -> None:
        """Remove the element, what it owns, and all their edges."""
        for doomed in reversed(list(self.subtree(element))):
            self._cut(doomed.id)
            del self._elements[doomed.id]
            del self._of_kind[doomed.kind][doomed.id]

    def rename(self, element: Element, name: str) -> None:
        """Give the element another name."""
        element.name = name

    def set(self, element: Element, **attrs: AttrValue) -> None:
        """Set attributes; ``_`` in a keyword is kept. None removes the attribute."""
        for key, value in attrs.items():
            if value is None:
                element.attrs.pop(key, None)
            else:
                element.attrs[key] = value

    def refer(self, reference: Reference) -> None:
        """Leave a reference for the pass ``resolve``."""
        self.pending.append(reference)

    # -- derived values ------------------------------------------------------------------------

    def store(self, type_: type[_T], values: Iterable[_T]) -> None:
        """Keep derived values (recipes, contracts, token graphs), replacing earlier ones."""
        self._derived[type_] = tuple(values)

    def derived(self, type_: type[_T]) -> Sequence[_T]:
        """The derived values of a type, in the order in which the pass stored them."""
        return cast("Sequence[_T]", self._derived.get(type_, ()))

    # -- inside --------------------------------------------------------------------------------

    def _id(self, element: Element | str) -> str:
        id = element if isinstance(element, str) else element.id
        if id not in self._elements:
            raise KeyError(id)
        return id

    def _link(self, edge: Edge, source: str, target: str) -> None:
        if target not in self._out[edge].get(source, ()):
            self._append(edge, source, target)

    def _append(self, edge: Edge, source: str, target: str) -> None:
        self._out[edge].setdefault(source, []).append(target)
        self._in[edge].setdefault(target, []).append(source)

    def _unlink(self, edge: Edge, source: str, target: str) -> None:
        if target not in self._out[edge].get(source, ()):
            return
        _drop(self._out[edge], source, target)
        _drop(self._in[edge], target, source)

    def _cut(self, id: str) -> None:
        for edge in Edge:
            for target in tuple(self._out[edge].get(id, ())):
                self._unlink(edge, id, target)
            for source in tuple(self._in[edge].get(id, ())):
                self._unlink(edge, source, id)


def _drop(index: dict[str, list[str]], key: str, value: str) -> None:
    values = index[key]
    values.remove(value)
    if not values:
        del index[key]
