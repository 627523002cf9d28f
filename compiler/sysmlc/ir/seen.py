"""What was made of elements of the last graph, used again where they are as they were.

A process that stays compiles nearly the same graph again and again.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TypeVar, cast

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge
from sysmlc.ir.noting import Noting, Parts
from sysmlc.ir.reads import Reads, Value, during
from sysmlc.ir.rows import Row, Rows
from sysmlc.values import dataclass

_T = TypeVar("_T")


@dataclass(frozen=True, slots=True)
class _Made:
    """What was made of what was ``given`` and of these parts of a graph.

    ``literals`` are those that were asked for.
    """

    given: object
    asked: Parts
    literals: tuple[Value, ...]
    value: object

    def ask(self, reads: Reads) -> None:
        """Note that who is at work has asked for the literals."""
        for value in self.literals:
            reads.readers[value][reads.reader] = None


class Seen:
    """A graph as it is at one time, and what is made of its elements while it stays so.

    ``changed`` is all that is not as it was in the graph before: elements that are new or gone,
    or have another kind, name, owner, source, attribute or literal, and those with other
    neighbours. Ordinals are not compared.
    """

    def __init__(self, graph: Graph, rows: Rows, before: "Seen | None") -> None:
        self._state = _state(graph)
        self._rows = rows
        self._literals: dict[str, list[Value]] = {}
        for one in () if graph.reads is None else graph.reads.literals:
            self._literals.setdefault(one.id, []).append((one.id, one.key))
        self._made: dict[str, _Made] = {}
        self._before = {} if before is None else before._made
        self.indexes: dict[str, Mapping[str, list[Element]]] = {}
        """Elements of the whole graph by some name (``ir.asking``)."""
        self.changed = Parts() if before is None else self._changed(before)

    def _changed(self, before: "Seen") -> Parts:
        changed = Parts()
        changed.ids.update(_other_elements(before._rows[0], self._rows[0]))
        changed.ids.update(_other_values(before._literals, self._literals))
        for edge in Edge:
            old, new = (rows[1].get(edge, ([], [])) for rows in (before._rows, self._rows))
            if old[0] != new[0]:
                changed.forwards[edge].update(_other_values(dict(old[0]), dict(new[0])))
            if old[1] != new[1]:
                changed.backwards[edge].update(_other_values(dict(old[1]), dict(new[1])))
        return changed

    def is_of(self, graph: Graph) -> bool:
        """Whether the graph was not changed since."""
        return self._state == _state(graph)

    def known(self, reader: str, given: object) -> _Made | None:
        """What was made of the graph before, if all that it was made of is as it was."""
        found = self._before.get(reader)
        if found is None or found.given != given or self.changed.meet(found.asked):
            return None
        self._made[reader] = found
        return found

    def keep(self, reader: str, given: object, noting: Noting, value: object) -> None:
        """Remember what the reader made of the elements that were noted."""
        literals = tuple(self._asked(reader, noting))
        self._made[reader] = _Made(given, noting.asked, literals, value)

    def _asked(self, reader: str, noting: Noting) -> Iterator[Value]:
        for id in noting.asked.ids & self._literals.keys():
            for value in self._literals[id]:
                if noting.reads is not None and reader in noting.reads.readers[value]:
                    yield value


_LAST: dict[str, Seen] = {}
"""The last graphs of this process, by their first element: units may be compiled in turn."""
_UNITS = 8


def see(graph: Graph, rows: Rows) -> None:
    """Begin to remember what is made of a graph, of which these are the rows."""
    unit = next(iter(graph)).id
    graph.seen = Seen(graph, rows, _LAST.pop(unit, None))
    _LAST[unit] = graph.seen
    while len(_LAST) > _UNITS:
        del _LAST[next(iter(_LAST))]


def again(
    graph: Graph, about: str, given: object, make: Callable[[Graph], Iterable[_T]]
) -> tuple[_T, ...]:
    """Someone's work on one element (``during``), or what came of it for the graph before.

    What comes of it depends on nothing but on what ``make`` asks the graph that it is handed, and
    on what is ``given``, which is of texts. Who asked for literals then has asked for them now.
    """
    seen, reads = graph.seen, graph.reads
    with during(graph, about):
        if seen is None or reads is None or not seen.is_of(graph):
            return tuple(make(graph))
        found = seen.known(reads.reader, given)
        if found is None:
            return _made(graph, seen, reads.reader, given, make)
        found.ask(reads)
        return cast("tuple[_T, ...]", found.value)


def _made(
    graph: Graph, seen: Seen, reader: str, given: object, make: Callable[[Graph], Iterable[_T]]
) -> tuple[_T, ...]:
    noting = Noting(graph)
    value = tuple(make(noting))
    if noting.is_partial:
        seen.keep(reader, given, noting, value)
    return value


def _state(graph: Graph) -> tuple[int, int]:
    return len(graph), graph.changes


def _other_elements(old: Iterable[Row], new: Iterable[Row]) -> Iterator[str]:
    known = {row[0]: row for row in old}
    for row in new:
        before = known.pop(row[0], None)
        if before is None or not _is_alike(before, row):
            yield row[0]
    yield from known


def _is_alike(one: Row, other: Row) -> bool:
    """Whether both are the same but for their ordinals."""
    if one != other and (one[:4] != other[:4] or one[5:] != other[5:]):
        return False
    # 1, 1.0 and True are equal, but not the same.
    return not one[6] or repr(one[6]) == repr(other[6])


def _other_values(old: Mapping[str, object], new: Mapping[str, object]) -> Iterator[str]:
    return (id for id in {**old, **new} if old.get(id) != new.get(id))
