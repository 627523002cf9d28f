"""The graph: elements, edges of each kind in both directions, and the only way to change them."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import TypeVar, cast

from sysmlc.diagnostics import Place, Subject
from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.neighbours import (
    MANY,
    Index,
    drop,
    every,
    first,
    put,
    put_each_new,
    put_new,
    together,
)
from sysmlc.ir.reference import End, Reference, References
from sysmlc.ir.shared import NOTHING, Shared
from sysmlc.ir.tables import large_table

_T = TypeVar("_T")


class Graph:
    """Typed property graph of one compile unit.

    Elements and edges keep the order in which they were added. ``pending`` holds the
    references that the pass ``resolve`` has still to turn into edges. What passes derive for
    back ends (recipes, contracts) is kept by type beside the elements.
    """

    def __init__(self) -> None:
        self._elements: dict[str, Element] = large_table()
        self._of_kind: dict[Kind, list[Element]] = {}
        self._fresh: list[Element] = []
        self._stale: set[Kind] = set()
        self._out: dict[Edge, Index] = {edge: large_table() for edge in Edge}
        self._owned = self._out[Edge.OWNS]
        self._in: dict[Edge, Index] = {}
        self._drawn: dict[Edge, list[Element]] = {edge: [] for edge in Edge}
        self._derived: dict[type, tuple[object, ...]] = {}
        self.pending = References()

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

    def find_all(self, ends: Iterable[End]) -> list[Element | None]:
        """The elements with these ids, None for each that is not there."""
        get = self._elements.get
        return [get(end) if isinstance(end, str) else end for end in ends]

    def of_kind(self, *kinds: Kind) -> list[Element]:
        """Elements of these kinds: kind by kind, each in the order of addition."""
        if self._fresh or self._stale:
            self._index_kinds()
        if len(kinds) == 1:
            return self._of_kind.get(kinds[0], [])[:]
        return [element for kind in kinds for element in self._of_kind.get(kind, ())]

    def roots(self) -> list[Element]:
        """Elements that nothing owns."""
        return [element for element in self if element.owner is None]

    def owned(self, element: Element) -> list[Element]:
        """What the element owns, in order."""
        return every(self._owned, element.id)

    def owner(self, element: Element) -> Element | None:
        """What owns the element, or None."""
        return self.get(element.owner)

    def targets(self, element: Element, edge: Edge) -> list[Element]:
        """Where the element's edges of this kind lead, in order."""
        return every(self._out[edge], element.id)

    def sources(self, element: Element, edge: Edge) -> list[Element]:
        """Where the edges of this kind that reach the element come from, in order."""
        if edge is Edge.OWNS:
            owner = self.owner(element)
            return [] if owner is None else [owner]
        return every(self._incoming(edge), element.id)

    def target(self, element: Element, edge: Edge) -> Element | None:
        """Where the first edge of this kind leads, or None."""
        return first(self._out[edge], element.id)

    def source(self, element: Element, edge: Edge) -> Element | None:
        """Where the first edge of this kind that reaches the element comes from, or None."""
        if edge is Edge.OWNS:
            return self.owner(element)
        return first(self._incoming(edge), element.id)

    def has_several(self, edge: Edge) -> bool:
        """Whether any element has more than one edge of this kind."""
        return not {Element}.issuperset(map(type, self._out[edge].values()))

    def edges(self, *kinds: Edge) -> Iterator[tuple[Edge, str, str]]:
        """All edges of these kinds (of every kind when none is given) as (kind, from, to)."""
        for kind in kinds or tuple(Edge):
            for source in self._out[kind]:
                for target in every(self._out[kind], source):
                    yield kind, source, target.id

    def subtree(self, element: Element) -> Iterator[Element]:
        """The element and everything below it, owner before owned."""
        owned, stack = self._owned, [element]
        while stack:
            top = stack.pop()
            yield top
            below = owned.get(top.id)
            if below is None:
                continue
            if isinstance(below, Element):
                stack.append(below)
            else:
                stack.extend(reversed(below))

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
        self._fresh.append(element)
        if element.owner is not None:
            put(self._out[Edge.OWNS], element.owner, element)
        return element

    def new(
        self,
        id: str,
        kind: Kind,
        name: str,
        owner: str | None,
        ordinal: int,
        source: str,
        attrs: dict[str, AttrValue] = NOTHING,
    ) -> Element | None:
        """Add a new element below an owner that is there; None when the id is empty or taken.

        The way for front ends that make hundreds of thousands of elements: ``attrs`` are taken
        over, and are ``Shared`` where several elements have them.
        """
        made = _bare(Element)
        if not id or self._elements.setdefault(id, made) is not made:
            return None
        # What Element() does; its call would cost more than all of this.
        made.id = id
        made.kind = kind
        made.name = name
        made.owner = owner
        made.ordinal = ordinal
        made.source = source
        made.attrs = attrs
        self._fresh.append(made)
        if owner is not None:
            owned = self._owned
            known = owned.get(owner)
            if known is None:
                owned[owner] = made
            elif isinstance(known, list) and len(known) < MANY:
                known.append(made)
            elif isinstance(known, Element):
                owned[owner] = [known, made]
            else:
                put_new(owned, owner, made)
        return made

    def connect(self, edge: Edge, source: Element | str, target: Element | str) -> None:
        """Add an edge unless it is there. Use ``move`` for ownership."""
        if edge is Edge.OWNS:
            raise ValueError("ownership is changed by move()")
        known = self._elements
        start = known[source if isinstance(source, str) else source.id]
        self._link(edge, start, known[target if isinstance(target, str) else target.id])

    def connect_new(self, edge: Edge, source: Element, target: Element) -> None:
        """Add an edge that cannot be there, for one end was made just now. Not for ownership."""
        put_new(self._out[edge], source.id, target)
        if edge in self._drawn:
            self._drawn[edge] += (source, target)
        else:
            put_new(self._in[edge], target.id, source)

    def connect_fan(self, edge: Edge, source: Element, targets: list[Element]) -> None:
        """Add all edges of a kind of an element that was made just now; the list is taken over."""
        if not targets:
            return
        self._out[edge][source.id] = together(targets)
        drawn = self._drawn.get(edge)
        for target in targets:
            if drawn is None:
                put_new(self._in[edge], target.id, source)
            else:
                drawn += (source, target)

    def connect_all(
        self, edges: Iterable[Edge], sources: Iterable[End], targets: Iterable[Element | None]
    ) -> None:
        """Add many edges; those without a target, or from an element that is not there, are not."""
        last: Edge | None = None
        for edge, source, target in zip(edges, self.find_all(sources), targets, strict=True):
            if source is None or target is None:
                continue
            if edge is not last:
                last, out, drawn = edge, self._out[edge], self._drawn.get(edge)
            if drawn is None or source.id in out:
                self._link(edge, source, target)
            else:
                out[source.id] = target
                drawn += (source, target)

    def connect_each(
        self, edge: Edge, sources: Sequence[Element | None], targets: Sequence[Element | None]
    ) -> None:
        """Add edges of one kind; those without source or target are not added."""
        out, drawn = self._out[edge], self._drawn.get(edge)
        if drawn is not None and put_each_new(out, sources, targets):
            ends = cast("Iterable[tuple[Element, Element]]", zip(sources, targets, strict=True))
            drawn += chain.from_iterable(ends)
            return
        for source, target in zip(sources, targets, strict=True):
            if source is None or target is None:
                continue
            known = None if drawn is None else out.setdefault(source.id, target)
            if drawn is None or not (known is target or isinstance(known, Element)):
                self._link(edge, source, target)
                continue
            # An edge that is there already may be noted twice: the way back has it once.
            drawn += (source, target)
            if known is not target:
                out[source.id] = [known, target]

    def disconnect(self, edge: Edge, source: Element | str, target: Element | str) -> None:
        """Remove an edge if it is there. Use ``move`` for ownership."""
        if edge is Edge.OWNS:
            raise ValueError("ownership is changed by move()")
        self._unlink(edge, self._known(source), self._known(target))

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
            drop(self._out[Edge.OWNS], element.owner, element)
        element.owner = None if owner is None else owner.id
        if owner is not None:
            put(self._out[Edge.OWNS], owner.id, element)

    def remove(self, element: Element) -> None:
        """Remove the element, what it owns, and all their edges."""
        self.pending.forget_elements()
        for doomed in reversed(list(self.subtree(element))):
            self._cut(doomed)
            del self._elements[doomed.id]
            self._stale.add(doomed.kind)

    def rename(self, element: Element, name: str) -> None:
        """Give the element another name."""
        element.name = name

    def set(self, element: Element, **attrs: AttrValue) -> None:
        """Set attributes; ``_`` in a keyword is kept. None removes the attribute."""
        if isinstance(element.attrs, Shared):
            element.attrs = {**element.attrs}
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

    def has_derived(self, module: str) -> bool:
        """Whether there are derived values of a type of this module, which need not be imported."""
        return any(type_.__module__ == module for type_, values in self._derived.items() if values)

    # -- inside --------------------------------------------------------------------------------

    def _known(self, element: Element | str) -> Element:
        return self._elements[element if isinstance(element, str) else element.id]

    def _index_kinds(self) -> None:
        add = {kind: elements.append for kind, elements in self._of_kind.items()}
        for element in self._fresh:
            kind = element.kind
            if kind in add:
                add[kind](element)
            else:
                self._of_kind[kind] = [element]
                add[kind] = self._of_kind[kind].append
        self._fresh.clear()
        for kind in self._stale:
            left = self._of_kind.get(kind, [])
            self._of_kind[kind] = [e for e in left if self._elements.get(e.id) is e]
        self._stale.clear()

    def _incoming(self, edge: Edge) -> Index:
        """The way back, made when it is asked for first: many kinds are only followed forwards."""
        known = self._in.get(edge)
        if known is None:
            known = self._in[edge] = large_table()
            ends = iter(self._drawn.pop(edge))
            for source, target in zip(ends, ends, strict=True):
                put(known, target.id, source)
        return known

    def _link(self, edge: Edge, source: Element, target: Element) -> None:
        if not put(self._out[edge], source.id, target):
            return
        known = self._in.get(edge)
        if known is None:
            self._drawn[edge] += (source, target)
        else:
            put(known, target.id, source)

    def _unlink(self, edge: Edge, source: Element, target: Element) -> None:
        if drop(self._out[edge], source.id, target):
            drop(self._incoming(edge), target.id, source)

    def _cut(self, element: Element) -> None:
        if element.owner is not None:
            drop(self._out[Edge.OWNS], element.owner, element)
        for edge in _DRAWN:
            if self._out[edge]:
                for target in self.targets(element, edge):
                    self._unlink(edge, element, target)
                for source in self.sources(element, edge):
                    self._unlink(edge, source, element)


_bare = object.__new__

_DRAWN = tuple(edge for edge in Edge if edge is not Edge.OWNS)
