"""Relational products over partitioned relations, with early quantification.

``Product`` computes ``exist bits: start & part & part ...`` and quantifies each bit as soon as no
remaining part depends on it.
"""

from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

from msgspec import Struct

from sysmlc.synthesis.bdd.manager import Manager, Node

MAX_CLUSTER_NODES = 2_000
"""Nodes up to which parts over the same quantified bits are conjoined beforehand."""
MAX_JOINED_STAGE_NODES = 500
"""Nodes up to which neighbouring stages are conjoined, whatever their bits: the overhead of an
operation exceeds the time for so few nodes."""


@dataclass(slots=True)
class _Cluster:
    """A conjunction of parts of the relation."""

    node: Node
    support: frozenset[str]
    """The quantified bits that the node depends on."""


class _Stage(Struct, frozen=True):
    """A step of a product: conjoin the node, then quantify bits that no later stage reads."""

    node: Node
    last_bits: frozenset[str]
    """The quantified bits that no later stage reads."""


class Product:
    """The operator ``exist bits: start & part & part ...``, prepared for many values of start."""

    def __init__(
        self,
        manager: Manager,
        parts: Iterable[Node],
        bits: Collection[str],
        limit: int = MAX_CLUSTER_NODES,
    ) -> None:
        """Conjoin parts up to *limit* nodes and determine the order of the stages."""
        self.manager = manager
        self._bits = frozenset(bits)
        clusters = _build_clusters(manager, parts, self._bits, limit)
        unread_bits = self._bits.difference(*(cluster.support for cluster in clusters))
        self._stages = tuple(_join_small_stages(_order_stages(clusters), unread_bits))
        self._unread_bits = frozenset() if self._stages else unread_bits

    def __call__(self, start: Node) -> Node:
        """Return the product with *start*."""
        manager = self.manager
        result = manager.exist(self._unread_bits, start)
        for stage in self._stages:
            if result == manager.false:
                break
            result = manager.and_exist(result, stage.node, stage.last_bits)
            manager.check()
        return result


def _build_clusters(
    manager: Manager, parts: Iterable[Node], bits: frozenset[str], limit: int
) -> list[_Cluster]:
    """Conjoin parts over the same quantified bits, then parts over subsets of these bits."""
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
    """Return a partitioned conjunction with pieces of at most *limit* nodes.

    Neighbours are conjoined first. A member that is larger than *limit* is a piece by itself.
    """
    pieces: list[Node] = []
    for member in members:
        conjunction = _conjoin_within(pieces[-1], member, limit) if pieces else None
        if conjunction is None:
            pieces.append(member)
        else:
            pieces[-1] = conjunction
    if 1 < len(pieces) < len(members):
        return join_conjuncts(manager, pieces, limit)
    return pieces


def _absorb_clusters(clusters: list[_Cluster], limit: int) -> list[_Cluster]:
    """Conjoin each cluster with one that has all its bits, unless the result is too large."""
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
        conjunction = None
        if host is not None and cluster.support:
            conjunction = _conjoin_within(host.node, cluster.node, limit)
        if host is None or conjunction is None:
            result.append(cluster)
        else:
            host.node = conjunction
    return result


def _conjoin_within(left: Node, right: Node, limit: int) -> Node | None:
    """Return the conjunction, or None if it or one of the nodes is larger than *limit*.

    Nodes above the limit are not tried: with 23,000 and 750 nodes, one had 3.7 million.
    """
    if max(len(left), len(right)) > limit:
        return None
    conjunction = left & right
    return conjunction if len(conjunction) <= limit else None


def _order_stages(clusters: Sequence[_Cluster]) -> Iterable[_Stage]:
    """Order the clusters such that bits can be quantified early; those without bits come last.

    A greedy choice: next is the cluster with the most bits that no other remaining cluster reads.
    """
    remaining = list(clusters)
    readers = Counter(bit for cluster in clusters for bit in cluster.support)
    while remaining:
        best = max(
            remaining,
            key=lambda cluster: (
                sum(readers[bit] == 1 for bit in cluster.support),
                -len(cluster.support),
            ),
        )
        # A cluster without quantified bits lets no bit die; it waits until the product is small.
        if not best.support:
            best = next((cluster for cluster in remaining if cluster.support), best)
        remaining.remove(best)
        readers.subtract(best.support)
        yield _Stage(best.node, frozenset(bit for bit in best.support if not readers[bit]))


def _join_small_stages(stages: Iterable[_Stage], unread_bits: frozenset[str]) -> Iterable[_Stage]:
    """Conjoin small neighbours; the first stage also quantifies the bits that no stage reads."""
    joined_stages: list[_Stage] = []
    for stage in stages:
        last = joined_stages[-1] if joined_stages else None
        if last is not None and len(last.node) + len(stage.node) <= MAX_JOINED_STAGE_NODES:
            conjunction = last.node & stage.node
            if len(conjunction) <= MAX_JOINED_STAGE_NODES:
                joined_stages[-1] = _Stage(conjunction, last.last_bits | stage.last_bits)
                continue
        joined_stages.append(stage)
    first = [_Stage(stage.node, stage.last_bits | unread_bits) for stage in joined_stages[:1]]
    return first + joined_stages[1:]
