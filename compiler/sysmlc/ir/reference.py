"""References as a front end found them, before they are edges."""

from bisect import bisect
from collections.abc import Collection, Iterator
from itertools import chain, compress
from typing import NamedTuple

from sysmlc.ir.element import Element
from sysmlc.ir.kinds import Edge, Kind

End = Element | str
"""One end of a reference: an element that is in the graph, or an id or href."""


class Reference(NamedTuple):
    """An edge whose target is still to be found.

    ``target`` is an id of the graph, or an ``href`` (``file#id``) to another file. ``kind``
    and ``name`` are what the source says about an external target: they make the stub that
    stands for it when the file is not part of the compile unit. ``ordinal`` is the place of
    the reference in its file, -1 when it is the owner's.
    """

    edge: Edge
    source: str
    target: str
    kind: Kind = Kind.CLASS
    name: str = ""
    ordinal: int = -1


class References:
    """References in the order in which they were found, as columns.

    A large model has as many references as elements, and next to none says more than edge,
    source and target: a tuple for each would cost more than the edge that comes of it. Ends
    are elements where they are known, for to look for an id in a large graph costs as much.
    """

    __slots__ = ("edges", "ordinals", "said", "sources", "targets")

    def __init__(
        self,
        edges: list[Edge] | None = None,
        sources: list[End] | None = None,
        targets: list[End] | None = None,
        ordinals: list[int] | None = None,
    ) -> None:
        """References of these columns, which are taken over."""
        self.edges = [] if edges is None else edges
        self.sources = [] if sources is None else sources
        self.targets = [] if targets is None else targets
        self.ordinals = [] if ordinals is None else ordinals
        self.said: dict[int, tuple[Kind, str]] = {}
        """What is known of external targets, by the number of the reference."""

    def __len__(self) -> int:
        return len(self.edges)

    def __iter__(self) -> Iterator[Reference]:
        return map(self.__getitem__, range(len(self.edges)))

    def __getitem__(self, number: int) -> Reference:
        kind, name = self.said.get(number, (Kind.CLASS, ""))
        ordinal = self.ordinals[number]
        source, target = id_of(self.sources[number]), id_of(self.targets[number])
        return Reference(self.edges[number], source, target, kind, name, ordinal)

    def append(self, reference: Reference) -> None:
        """Add a reference."""
        edge, source, target, kind, name, ordinal = reference
        if name or kind is not Kind.CLASS:
            self.said[len(self.edges)] = (kind, name)
        self.edges.append(edge)
        self.sources.append(source)
        self.targets.append(target)
        self.ordinals.append(ordinal)

    def add(
        self, edge: Edge, source: End, target: str, kind: Kind, name: str, ordinal: int = -1
    ) -> None:
        """Add a reference to an external target, of which kind and name are said."""
        self.said[len(self.edges)] = (kind, name)
        self.edges.append(edge)
        self.sources.append(source)
        self.targets.append(target)
        self.ordinals.append(ordinal)

    def __setitem__(self, number: int, reference: Reference) -> None:
        edge, source, target, kind, name, ordinal = reference
        if name or kind is not Kind.CLASS:
            self.said[number] = (kind, name)
        self.edges[number], self.ordinals[number] = edge, ordinal
        self.sources[number], self.targets[number] = source, target

    def _take(self, others: "References") -> None:
        self.edges, self.sources = others.edges, others.sources
        self.targets, self.ordinals = others.targets, others.ordinals
        self.said = others.said

    def turn(self, number: int) -> None:
        """Let the reference lead from its target to its source."""
        sources, targets = self.sources, self.targets
        sources[number], targets[number] = targets[number], sources[number]

    def extend(self, others: "References", without: Collection[int] = ()) -> None:
        """Add all others but those with the numbers ``without``; the others may be taken over."""
        if not self.edges and not without:
            self._take(others)
            return
        lost, start = sorted(without), len(self.edges)
        for number, said in others.said.items():
            if number not in without:
                self.said[start + number - bisect(lost, number)] = said
        is_kept = bytearray(b"\1") * len(others)
        for number in lost:
            is_kept[number] = 0
        self.edges += compress(others.edges, is_kept)
        self.sources += compress(others.sources, is_kept)
        self.targets += compress(others.targets, is_kept)
        self.ordinals += compress(others.ordinals, is_kept)

    def forget_elements(self) -> None:
        """Know all ends by their ids alone: elements may leave the graph."""
        if not {str}.issuperset(map(type, chain(self.sources, self.targets))):
            self.sources = list(map(id_of, self.sources))
            self.targets = list(map(id_of, self.targets))

    def clear(self) -> None:
        """Forget all references."""
        for column in (self.edges, self.sources, self.targets, self.ordinals, self.said):
            column.clear()


def id_of(end: End) -> str:
    """The id, or href, of an end."""
    return end if isinstance(end, str) else end.id
