"""What was made of elements of the last graph, used again where they are as they were.

A process that stays compiles nearly the same graph again and again.
"""

import marshal
from collections.abc import Callable, Iterable, Mapping
from typing import TypeVar, cast

from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge
from sysmlc.ir.noting import Noting, Parts
from sysmlc.ir.reads import Reads, Value, during
from sysmlc.ir.rows import Ends, Row, Rows
from sysmlc.values import dataclass

_T = TypeVar("_T")
_PLAIN = 2
"""The last format of ``marshal`` in which equal values are equal bytes."""


@dataclass(frozen=True, slots=True)
class _Made:
    """What was made of what was ``given`` and of these parts of a graph.

    ``literals`` are those that were asked for, and by whom.
    """

    given: object
    asked: Parts
    literals: tuple[tuple[Value, str], ...]
    value: object

    def ask(self, reads: Reads) -> None:
        """Note that the literals were asked for."""
        for value, reader in self.literals:
            reads.readers[value][reader] = None


class Seen:
    """A graph as it is at one time, and what is made of its elements while it stays so.

    ``changed`` is all that is not as it was in the graph before: elements that are new or gone,
    or have another kind, name, owner, source, attribute or literal, and those with other
    neighbours. Ordinals are not compared.
    """

    def __init__(self, graph: Graph, rows: Rows, before: "Seen | None") -> None:
        self._state = _state(graph)
        self._elements = _elements(rows[0])
        self._edges = rows[1]
        self._literals: dict[str, list[str]] = {}
        for one in () if graph.reads is None else graph.reads.literals:
            self._literals.setdefault(one.id, []).append(one.key)
        self._made: dict[str, _Made] = {}
        self._before = {} if before is None else before._made
        self.indexes: dict[str, Mapping[str, list[Element]]] = {}
        """Elements of the whole graph by some name (``ir.asking``)."""
        self.changed = Parts() if before is None else self._changed(before)

    def _changed(self, before: "Seen") -> Parts:
        changed = Parts()
        changed.ids.update(_others(before._elements, self._elements.items()))
        changed.ids.update(_others(before._literals, self._literals.items()))
        for edge in Edge:
            old, new = (one._edges.get(edge, ([], [])) for one in (before, self))
            for parts, ends, now in zip(
                (changed.forwards, changed.backwards), old, new, strict=True
            ):
                found = [] if ends == now else _others(ends, now)
                found += _beside(changed.ids, ends)
                if found:
                    parts[edge] = set(found)
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
        self._made[reader] = _Made(given, noting.asked, tuple(noting.literals), value)


_LAST: dict[str, Seen | None] = {}
"""The last graphs of this process, by their first element: units may be compiled in turn. None
for one of which nothing was noted.
"""
_UNITS = 8
_stays = False


def stay() -> None:
    """From now on remember the first graph of a unit, too: this process will see it edited."""
    global _stays
    _stays = True


def see(graph: Graph, rows: Rows) -> None:
    """Begin to remember what is made of a graph, of which these are the rows.

    Nothing is remembered if a plug-in gave an element an attribute that is no plain value.
    """
    unit = next(iter(graph)).id
    before = _LAST.pop(unit, None)
    try:
        graph.seen = Seen(graph, rows, before)
    except ValueError:
        return
    _keep(unit, graph.seen)


def see_again(graph: Graph, rows: Rows) -> None:
    """Begin to remember, unless it is the first graph of its unit in a process that may end then.

    Most processes compile a unit once, and to note what is asked for takes 4 % of that.
    """
    unit = next(iter(graph)).id
    if _stays or unit in _LAST:
        see(graph, rows)
    else:
        _keep(unit, None)


def _keep(unit: str, seen: Seen | None) -> None:
    _LAST[unit] = seen
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


def _elements(rows: Iterable[Row]) -> dict[str, bytes]:
    """All that an element says but its ordinal; as bytes 1, 1.0 and True are not the same."""
    written = marshal.dumps
    return {
        id: written((kind, name, owner, source, attrs), _PLAIN)
        for id, kind, name, owner, _, source, attrs in rows
    }


def _others(
    old: Mapping[str, object] | Iterable[tuple[str, object]], new: Iterable[tuple[str, object]]
) -> list[str]:
    """The keys that have another value, or are in one of both only."""
    known = dict(old)
    return [*(key for key, value in new if known.pop(key, None) != value), *known]


def _beside(ids: set[str], ends: Ends) -> list[str]:
    """Elements that have a neighbour among these."""
    return [id for id, near in ends if not ids.isdisjoint(near)]
