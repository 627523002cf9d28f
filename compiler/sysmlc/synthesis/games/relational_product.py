"""Relational products over partitioned relations, with early quantification.

``Product`` computes ``exist bits: start & all parts`` and quantifies each bit as early as possible.
``successor_product`` leads to next states; the predecessors of a game are in ``arena``.
"""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

from msgspec import Struct

from sysmlc.synthesis.bdd.manager import Manager, Node
from sysmlc.synthesis.games.game import Game

MAX_CLUSTER_NODES = 2_000
"""Nodes up to which parts over the same bits are joined beforehand."""
MAX_JOINED_STAGE_NODES = 500
"""Nodes up to which neighbouring stages are joined, whatever their bits: starting an operation
takes longer than traversing them."""


@dataclass(slots=True)
class _Cluster:
    node: Node
    support: frozenset[str]
    """The quantified bits that the node depends on."""


class _Stage(Struct, frozen=True):
    """A part of the relation, and the bits that are quantified as soon as it is joined."""

    node: Node
    dying: frozenset[str]


class Product:
    """``exist bits: start & part & part ...`` for many starts."""

    def __init__(
        self,
        manager: Manager,
        parts: Iterable[Node],
        bits: Collection[str],
        limit: int = MAX_CLUSTER_NODES,
    ) -> None:
        """Join parts up to *limit* nodes and determine their order."""
        self.manager = manager
        self._bits = frozenset(bits)
        clusters = _build_clusters(manager, parts, self._bits, limit)
        unused = self._bits.difference(*(cluster.support for cluster in clusters))
        self._stages = tuple(_join_small_stages(_order_stages(clusters), unused))
        self._alone = frozenset() if self._stages else unused

    def __call__(self, start: Node) -> Node:
        """Return the product with *start*."""
        manager = self.manager
        result = manager.exist(self._alone, start)
        for stage in self._stages:
            if result == manager.false:
                break
            result = manager.and_exist(result, stage.node, stage.dying)
            manager.check()
        return result


def _build_clusters(
    manager: Manager, parts: Iterable[Node], bits: frozenset[str], limit: int
) -> list[_Cluster]:
    """Join parts over the same quantified bits, then parts over subsets of them."""
    groups: dict[frozenset[str], list[Node]] = {}
    for part in parts:
        groups.setdefault(manager.support(part) & bits, []).append(part)
    clusters = [
        _Cluster(node, support)
        for support, members in groups.items()
        for node in join_conjuncts(manager, members, limit)
    ]
    return _absorb_clusters(clusters, limit)


def join_conjuncts(
    manager: Manager, members: Sequence[Node], limit: int = MAX_CLUSTER_NODES
) -> list[Node]:
    """Return the conjunction in pieces of at most *limit* nodes; neighbours are joined first."""
    pieces: list[Node] = []
    for member in members:
        conjunction = pieces[-1] & member if pieces else member
        if pieces and len(conjunction) <= limit:
            pieces[-1] = conjunction
        else:
            pieces.append(member)
    if 1 < len(pieces) < len(members):
        return join_conjuncts(manager, pieces, limit)
    return pieces


def _absorb_clusters(clusters: list[_Cluster], limit: int) -> list[_Cluster]:
    """Join a cluster to another one that has all its bits, unless it becomes too large."""
    result: list[_Cluster] = []
    for cluster in sorted(clusters, key=lambda cluster: -len(cluster.support)):
        host = next(
            (
                host_candidate
                for host_candidate in result
                if cluster.support <= host_candidate.support
            ),
            None,
        )
        conjunction = None if host is None or not cluster.support else host.node & cluster.node
        if host is not None and conjunction is not None and len(conjunction) <= limit:
            host.node = conjunction
        else:
            result.append(cluster)
    return result


def _order_stages(clusters: Sequence[_Cluster]) -> Iterable[_Stage]:
    """Order the clusters such that bits die early; clusters without bits come last."""
    remaining = list(clusters)
    while remaining:
        best = max(
            remaining,
            key=lambda cluster: (_count_dying_bits(cluster, remaining), -len(cluster.support)),
        )
        # A cluster without quantified bits lets no bit die; it waits until the product is small.
        if not best.support:
            best = next((cluster for cluster in remaining if cluster.support), best)
        remaining.remove(best)
        alive = frozenset().union(*(cluster.support for cluster in remaining))
        yield _Stage(best.node, best.support - alive)


def _join_small_stages(stages: Iterable[_Stage], first: frozenset[str]) -> Iterable[_Stage]:
    """Join small neighbours; the first stage also quantifies the bits of no stage."""
    joined_stages: list[_Stage] = []
    for stage in stages:
        conjunction = (
            joined_stages[-1].node & stage.node
            if joined_stages and _can_join(joined_stages[-1], stage)
            else None
        )
        if conjunction is not None and len(conjunction) <= MAX_JOINED_STAGE_NODES:
            joined_stages[-1] = _Stage(conjunction, joined_stages[-1].dying | stage.dying)
        else:
            joined_stages.append(stage)
    return [_Stage(stage.node, stage.dying | first) for stage in joined_stages[:1]] + joined_stages[
        1:
    ]


def _can_join(left: _Stage, right: _Stage) -> bool:
    return len(left.node) + len(right.node) <= MAX_JOINED_STAGE_NODES


def _count_dying_bits(cluster: _Cluster, remaining: Sequence[_Cluster]) -> int:
    other_bits = frozenset().union(*(other.support for other in remaining if other is not cluster))
    return len(cluster.support - other_bits)


def successor_product(game: Game) -> Product:
    """Return the product from states to their possible next states, primed
    (``Symbols.unprime``).
    """
    parts = [part.node for part in (*game.assumptions, *game.guarantees)]
    return Product(game.manager, parts, (*game.inputs, *game.outputs))
