"""Bindings of a block's constraint properties: who is bound to whom, with the paths to both."""

from collections.abc import Iterator
from itertools import pairwise

from msgspec import Struct

from sysmlc.backends.plantuml.connections import Path, is_parametric, path_of
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import features, type_of

OWNERS = (Kind.CLASS, Kind.COMPONENT)
_DEEPEST = 4
_WIDEST = 1000
"""Steps from a block to a feature of its parts that a connector without a path can mean, and
the ways that are followed in each."""


class Binding(Struct, frozen=True):
    """One line of a parametric diagram; ``shows`` are the ids that it stands for."""

    source: Path
    target: Path
    shows: tuple[str, ...]

    @property
    def ends(self) -> tuple[Path, Path]:
        """Both ends."""
        return self.source, self.target


def usages(graph: Graph, block: Element) -> list[Element]:
    """Constraint properties that instances of the block have, inherited ones too."""
    return [one for one in features(graph, block) if one.role == "constraint property"]


def bindings(graph: Graph) -> dict[str, list[Binding]]:
    """Bindings at constraint parameters by the block in whose parametric diagram they stand.

    That is the owner of the connector. Papyrus before 1.0 put the connectors of a parametric
    diagram below any classifier, and wrote no paths: what leads to features of another block
    with constraint properties, to each in a single shortest way, stands there.
    """
    found: dict[str, list[Binding]] = {}
    homes = _homes(graph)
    for connector in graph.of_kind(Kind.CONNECTOR):
        if is_parametric(graph, connector):
            for block, paths in _placed(graph, connector, homes):
                found.setdefault(block, []).extend(_lines(graph, connector, paths))
    return found


def _homes(graph: Graph) -> dict[str, list[Element]]:
    """Blocks by the constraint blocks that their constraint properties are typed by."""
    found: dict[str, list[Element]] = {}
    for block in graph.of_kind(*OWNERS):
        types = (type_of(graph, one) for one in usages(graph, block))
        for id in dict.fromkeys(type_.id for type_ in types if type_ is not None):
            found.setdefault(id, []).append(block)
    return found


def _placed(
    graph: Graph, connector: Element, homes: dict[str, list[Element]]
) -> list[tuple[str, list[Path]]]:
    ends = graph.targets(connector, Edge.END)
    if _is_stray(graph, connector):
        owners = (role.owner for role in _roles(graph, connector) if role.owner in homes)
        blocks = dict.fromkeys(block for id in owners for block in homes[id or ""])
        ways = [(block.id, [_found(graph, block, end) for end in ends]) for block in blocks]
        known = [(id, [way for way in found if way is not None]) for id, found in ways]
        placed = [(id, paths) for id, paths in known if len(paths) == len(ends)]
        if placed:
            return placed
    own = [path for end in ends if (path := path_of(graph, end)) is not None]
    return [(connector.owner, own)] if connector.owner is not None else []


def _roles(graph: Graph, connector: Element) -> list[Element]:
    ends = graph.targets(connector, Edge.END)
    return [role for end in ends for role in graph.targets(end, Edge.ROLE)]


def _lines(graph: Graph, connector: Element, paths: list[Path]) -> Iterator[Binding]:
    shows = (connector.id, *(end.id for end in graph.targets(connector, Edge.END)))
    for one, other in pairwise(paths):
        yield Binding(one, other, shows)


def _is_stray(graph: Graph, connector: Element) -> bool:
    """Whether it has no paths and leads to what its owner does not have."""
    owner, ends = graph.owner(connector), graph.targets(connector, Edge.END)
    if owner is None or any(graph.targets(end, Edge.PATH) for end in ends):
        return False
    own = features(graph, owner)
    return any(role not in own for role in _roles(graph, connector))


def _found(graph: Graph, block: Element, end: Element) -> Path | None:
    """The one shortest way from the block to the role of the end."""
    role = graph.target(end, Edge.ROLE)
    level: list[tuple[Element, ...]] = [(one,) for one in features(graph, block)]
    for _ in range(_DEEPEST):
        ways = [way for way in level if way[-1] is role]
        if ways:
            return _as_path(ways[0]) if len(ways) == 1 else None
        level = [(*way, one) for way in level[:_WIDEST] for one in _below(graph, way)]
    return None


def _below(graph: Graph, way: tuple[Element, ...]) -> list[Element]:
    type_ = type_of(graph, way[-1])
    if type_ is None or way[-1].kind is not Kind.PROPERTY:
        return []
    return [one for one in features(graph, type_) if one not in way]


def _as_path(way: tuple[Element, ...]) -> Path:
    ids = tuple(one.id for one in way)
    if way[-1].role == "constraint parameter":
        return Path(ids[:-1], port=ids[-1])
    return Path(ids)
