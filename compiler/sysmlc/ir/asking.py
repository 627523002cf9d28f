"""A graph that notes also what is asked about more than single elements, and tells the answers."""

from collections.abc import Callable, Iterable, Mapping
from typing import Protocol

from sysmlc.diagnostics import Subject
from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Kind
from sysmlc.ir.noting import Noting
from sysmlc.values import dataclass

Named = Mapping[str, list[Element]]
"""Elements by some name."""


class Question(Protocol):
    """What is asked of a graph; the answer says nothing about places."""

    def answer(self, graph: Graph) -> object: ...


@dataclass(frozen=True, slots=True)
class _OfKinds:
    """Which elements are of these kinds."""

    kinds: tuple[Kind, ...]

    def answer(self, graph: Graph) -> object:
        return _ids(graph.of_kind(*self.kinds))


@dataclass(frozen=True, slots=True)
class _Roots:
    """Which elements nobody owns."""

    def answer(self, graph: Graph) -> object:
        return _ids(graph.roots())


@dataclass(frozen=True, slots=True)
class _Order:
    """Which of these elements stand before which, and which at one place."""

    ids: tuple[str, ...]

    def answer(self, graph: Graph) -> object:
        found = [graph[id].ordinal for id in self.ids]
        ranks = {ordinal: rank for rank, ordinal in enumerate(sorted({*found}))}
        return [ranks[one] for one in found]


@dataclass(frozen=True, slots=True)
class _Entry:
    """Which elements have a name in an index; None where nobody made the index."""

    index: str
    name: str

    def answer(self, graph: Graph) -> object:
        known = None if graph.seen is None else graph.seen.indexes.get(self.index)
        return None if known is None else _ids(known.get(self.name, ()))


def _ids(found: Iterable[Element]) -> list[str]:
    return [one.id for one in found]


class Asking(Noting):
    """Notes such questions, too. Who asks for a subject tells about it, and will tell it again."""

    def __init__(self, graph: Graph) -> None:
        super().__init__(graph)
        self._whole = graph
        self._questions: dict[Question, None] = {}

    def of_kind(self, *kinds: Kind) -> list[Element]:
        self._questions[_OfKinds(kinds)] = None
        return self._met(self._whole.of_kind(*kinds))

    def roots(self) -> list[Element]:
        self._questions[_Roots()] = None
        return self._met(self._whole.roots())

    def ordinals(self, elements: Iterable[Element]) -> list[int]:
        found = self._met(list(elements))
        self._questions[_Order(tuple(_ids(found)))] = None
        return self._whole.ordinals(found)

    def entry(self, index: str, name: str, found: list[Element]) -> None:
        """Note that these elements have the name in an index."""
        self._met(found)
        self._questions[_Entry(index, name)] = None

    def subject(self, element: Element) -> Subject:
        self._met([element])
        return Graph.subject(self, element)

    def _met(self, found: list[Element]) -> list[Element]:
        self.asked.ids.update(_ids(found))
        return found

    def answers(self) -> tuple[tuple[Question, object], ...]:
        """What was asked about more than single elements."""
        return tuple((one, one.answer(self._whole)) for one in self._questions)


def indexed(graph: Graph, index: str, make: Callable[[Graph], Named]) -> Named:
    """Elements of the whole graph by some name, found once; see ``look_up``."""
    seen = graph.seen
    if seen is None or not seen.is_of(graph):
        return make(graph)
    if index not in seen.indexes:
        seen.indexes[index] = make(graph)
    return seen.indexes[index]


def look_up(graph: Graph, index: str, known: Named, name: str) -> list[Element]:
    """Elements of a name in an index, for who sees this graph."""
    found = known.get(name, [])
    if isinstance(graph, Asking):
        graph.entry(index, name, found)
    return found
