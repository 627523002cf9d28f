"""Steps over relations in parts: conjunction and quantification, each bit as early as it can go.

``Product`` is the general one (``exist bits: start & all parts``), ``successors`` the one that
leads to next states; the predecessors of a game are in ``arena``.
"""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

from msgspec import Struct

from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.games.game import Game

CLUSTER = 2_000
"""Nodes up to which parts about the same bits are joined once and for all."""
SMALL = 500
"""Nodes up to which neighbours in the order are joined, whatever they speak of: to begin an
operation takes longer than to go through them."""


@dataclass(slots=True)
class _Cluster:
    node: Node
    support: frozenset[str]
    """The bits to be quantified that it speaks of."""


class _Stage(Struct, frozen=True):
    """A part of the relation, and the bits that can go as soon as it is joined."""

    node: Node
    dying: frozenset[str]


class Product:
    """``exist bits: start & part & part ...`` for many starts."""

    def __init__(
        self, manager: Manager, parts: Iterable[Node], bits: Collection[str], limit: int = CLUSTER
    ) -> None:
        """Join small parts up to ``limit`` nodes and settle their order."""
        self.manager = manager
        self._bits = frozenset(bits)
        clusters = _clustered(manager, parts, self._bits, limit)
        first = self._bits.difference(*(one.support for one in clusters))
        self._stages = tuple(_thinned(_staged(clusters), first))
        self._alone = frozenset() if self._stages else first

    def __call__(self, start: Node) -> Node:
        """The product with this start."""
        manager = self.manager
        found = manager.exist(self._alone, start)
        for stage in self._stages:
            if found == manager.false:
                break
            found = manager.and_exist(found, stage.node, stage.dying)
            manager.check()
        return found


def _clustered(
    manager: Manager, parts: Iterable[Node], bits: frozenset[str], limit: int
) -> list[_Cluster]:
    """Parts joined with those that speak of the same bits, then with those that speak of more."""
    groups: dict[frozenset[str], list[Node]] = {}
    for part in parts:
        groups.setdefault(manager.support(part) & bits, []).append(part)
    clusters = [
        _Cluster(node, support)
        for support, members in groups.items()
        for node in joined(manager, members, limit)
    ]
    return _absorbed(clusters, limit)


def joined(manager: Manager, members: Sequence[Node], limit: int = CLUSTER) -> list[Node]:
    """The conjunction, in pieces when it is large; neighbours are joined first."""
    found: list[Node] = []
    for member in members:
        both = found[-1] & member if found else member
        if found and len(both) <= limit:
            found[-1] = both
        else:
            found.append(member)
    if 1 < len(found) < len(members):
        return joined(manager, found, limit)
    return found


def _absorbed(clusters: list[_Cluster], limit: int) -> list[_Cluster]:
    """Clusters whose bits another one has are joined to it while they stay small."""
    kept: list[_Cluster] = []
    for one in sorted(clusters, key=lambda cluster: -len(cluster.support)):
        home = next((other for other in kept if one.support <= other.support), None)
        both = None if home is None or not one.support else home.node & one.node
        if home is not None and both is not None and len(both) <= limit:
            home.node = both
        else:
            kept.append(one)
    return kept


def _staged(clusters: Sequence[_Cluster]) -> Iterable[_Stage]:
    """The clusters in an order in which bits die soon; what has no bits comes last."""
    rest = list(clusters)
    while rest:
        chosen = max(rest, key=lambda one: (_dying(one, rest), -len(one.support)))
        if not chosen.support:
            chosen = next((one for one in rest if one.support), chosen)
        rest.remove(chosen)
        alive = frozenset().union(*(one.support for one in rest))
        yield _Stage(chosen.node, chosen.support - alive)


def _thinned(stages: Iterable[_Stage], first: frozenset[str]) -> Iterable[_Stage]:
    """Stages with small neighbours joined; the first one lets go of what no stage speaks of."""
    found: list[_Stage] = []
    for one in stages:
        both = found[-1].node & one.node if found and _are_small(found[-1], one) else None
        if both is not None and len(both) <= SMALL:
            found[-1] = _Stage(both, found[-1].dying | one.dying)
        else:
            found.append(one)
    return [_Stage(one.node, one.dying | first) for one in found[:1]] + found[1:]


def _are_small(one: _Stage, other: _Stage) -> bool:
    return len(one.node) + len(other.node) <= SMALL


def _dying(one: _Cluster, rest: Sequence[_Cluster]) -> int:
    others = frozenset().union(*(other.support for other in rest if other is not one))
    return len(one.support - others)


def successors(game: Game) -> Product:
    """Product that takes states to their possible next ones, primed (see ``Symbols.unprime``)."""
    parts = [part.node for part in (*game.assumptions, *game.guarantees)]
    return Product(game.manager, parts, (*game.inputs, *game.outputs))
