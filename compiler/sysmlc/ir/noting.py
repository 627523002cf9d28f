"""A graph that notes what is asked of it."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from operator import attrgetter
from typing import TypeVar

from sysmlc.diagnostics import Subject
from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.neighbours import Index, every, first
from sysmlc.ir.reads import Value
from sysmlc.ir.reference import End

_T = TypeVar("_T")
_ID = attrgetter("id")
_OWNS = Edge.OWNS


class Parts:
    """Some of a graph: elements for themselves, and neighbours by edges of one kind.

    ``ids`` are those of elements, or of what is not there; ``forwards`` and ``backwards`` those of
    elements whose neighbours are meant, and what these neighbours are like.
    """

    __slots__ = ("_every", "backwards", "forwards", "ids")

    def __init__(self) -> None:
        self.ids: set[str] = set()
        self.forwards: dict[Edge, set[str]] = defaultdict(set)
        self.backwards: dict[Edge, set[str]] = defaultdict(set)
        self._every: set[str] | None = None

    def meet(self, others: "Parts") -> bool:
        """Whether anything is in both. Nothing may come to them any more."""
        return not self._every_id().isdisjoint(others._every_id()) and (
            not self.ids.isdisjoint(others.ids)
            or _meet(self.forwards, others.forwards)
            or _meet(self.backwards, others.backwards)
        )

    def _every_id(self) -> set[str]:
        if self._every is None:
            self._every = self.ids.union(*self.forwards.values(), *self.backwards.values())
        return self._every


def _meet(one: Mapping[Edge, set[str]], other: Mapping[Edge, set[str]]) -> bool:
    return any(not ids.isdisjoint(other.get(edge, ())) for edge, ids in one.items())


class Noting(Graph):
    """The same graph, which notes what it is asked for. Nobody may change it.

    ``asked`` is all that depends on the graph in what is made with this one alone, if it
    ``is_partial``: nobody asked for every element, for what was derived, or for a place.
    """

    def __init__(self, graph: Graph) -> None:
        vars(self).update(vars(graph))
        self.seen = None
        self.asked = Parts()
        self.is_partial = True
        self.literals: dict[tuple[Value, str], None] = {}
        """Literals that were asked for while it is there, and by whom."""
        if graph.reads is not None:
            graph.reads.latest = self.literals

    # -- some elements -------------------------------------------------------------------------

    def __contains__(self, id: str) -> bool:
        self.asked.ids.add(id)
        return super().__contains__(id)

    def __getitem__(self, id: str) -> Element:
        self.asked.ids.add(id)
        return super().__getitem__(id)

    def get(self, id: str | None) -> Element | None:
        if id is not None:
            self.asked.ids.add(id)
        return super().get(id)

    def find_all(self, ends: Iterable[End]) -> list[Element | None]:
        return [self.get(end if isinstance(end, str) else end.id) for end in ends]

    def owned(self, element: Element) -> list[Element]:
        self.asked.forwards[_OWNS].add(element.id)
        return every(self._owned, element.id)

    def targets(self, element: Element, edge: Edge) -> list[Element]:
        self.asked.forwards[edge].add(element.id)
        return every(self._out[edge], element.id)

    def sources(self, element: Element, edge: Edge) -> list[Element]:
        self.asked.backwards[edge].add(element.id)
        return super().sources(element, edge)

    def target(self, element: Element, edge: Edge) -> Element | None:
        self.asked.forwards[edge].add(element.id)
        return first(self._out[edge], element.id)

    def source(self, element: Element, edge: Edge) -> Element | None:
        self.asked.backwards[edge].add(element.id)
        return super().source(element, edge)

    def subtree(self, element: Element) -> Iterator[Element]:
        found = list(super().subtree(element))
        self.asked.forwards[_OWNS].update(map(_ID, found))
        return iter(found)

    # -- all of the graph ----------------------------------------------------------------------

    def __len__(self) -> int:
        self.is_partial = False
        return super().__len__()

    def __iter__(self) -> Iterator[Element]:
        self.is_partial = False
        return super().__iter__()

    def of_kind(self, *kinds: Kind) -> list[Element]:
        self.is_partial = False
        return super().of_kind(*kinds)

    def has_several(self, edge: Edge) -> bool:
        self.is_partial = False
        return super().has_several(edge)

    def edges(self, *kinds: Edge) -> Iterator[tuple[Edge, str, str]]:
        self.is_partial = False
        return super().edges(*kinds)

    def ordinals(self, elements: Iterable[Element]) -> list[int]:
        self.is_partial = False
        return super().ordinals(elements)

    def subject(self, element: Element) -> Subject:
        self.is_partial = False
        return super().subject(element)

    def derived(self, type_: type[_T]) -> Sequence[_T]:
        self.is_partial = False
        return super().derived(type_)

    def has_derived(self, module: str) -> bool:
        self.is_partial = False
        return super().has_derived(module)

    def index(self, edge: Edge, *, backwards: bool = False) -> Index:
        self.is_partial = False
        return super().index(edge, backwards=backwards)
