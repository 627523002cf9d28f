"""The search for a second token: in any order of moves where that is enough, else step by step.

Most activities are 1-safe in whatever order their nodes move, which is found fast (``token_net``).
The others are played in all ways (``token_search``): the game moves everything at once, so that a
flow may be empty again before the next token comes.
"""

from collections.abc import Callable
from functools import lru_cache

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.activities import net_safety as token_net
from sysmlc.logic.activities import reachability as token_search
from sysmlc.logic.activities.token_graph import (
    ACTIVITY_REGION,
    Firing,
    NodeKind,
    TokenEdge,
    TokenGraph,
    TokenNode,
)
from sysmlc.logic.names import Names

_NAMED_FROM = 50
"""The parts of a condition times its uses; from here on it gets a name."""
_REMEMBERED = 256
"""Answers that are kept: a process that compiles again finds those of what was not edited."""


class Found(Struct, frozen=True):
    """What is known of a token graph; ``unsafe`` is the id of an edge or a node."""

    unsafe: str = ""
    is_complete: bool = True
    dead: frozenset[str] = frozenset()
    queues: frozenset[str] = frozenset()
    rests: frozenset[str] = frozenset()
    finishes: bool = True


@lru_cache(_REMEMBERED)
def search(tokens: TokenGraph, limit: int) -> Found:
    """Look for a second token in at most ``limit`` states."""
    quick = None if _is_coupled(tokens) else _in_any_order(tokens, limit)
    if quick is not None and quick.is_complete and not quick.unsafe:
        return quick
    exact = _step_by_step(tokens, limit)
    return exact if exact.is_complete or quick is None else quick


def noted(tokens: TokenGraph, found: Found) -> TokenGraph:
    """The graph with what was found."""
    nodes = (
        replace(node, queues=True) if node.id in found.queues else node for node in tokens.nodes
    )
    return replace(tokens, nodes=tuple(nodes), rests=found.rests, finishes=found.finishes)


@lru_cache(_REMEMBERED)
def collapsed(tokens: TokenGraph, limit: int) -> TokenGraph:
    """The graph without nodes that only pass tokens on, unless it needs them to be 1-safe."""
    small = collapse(tokens)
    found = search(small, limit)
    return tokens if found.unsafe or not found.is_complete else noted(small, found)


def named(tokens: TokenGraph, names: Names) -> TokenGraph:
    """The graph with names for the conditions that many formulas would repeat."""
    quiets = (
        (region, names.new(_quiet_name(tokens, region)))
        for region in tokens.regions()
        if tokens.can_rest(region) and _size(tokens, region) * _uses(tokens, region) >= _NAMED_FROM
    )
    return replace(tokens, quiets=tuple(quiets))


def _quiet_name(tokens: TokenGraph, region: str) -> str:
    if region == ACTIVITY_REGION:
        return "over"
    return f"over_{tokens.node(region).run.removeprefix('run_')}"


def _size(tokens: TokenGraph, region: str) -> int:
    edges, workers = tokens.inside(region)
    return len(edges) + len(workers)


def _uses(tokens: TokenGraph, region: str) -> int:
    """The edges and running nodes in the region and in those inside it."""
    _, workers = tokens.inside(region)
    inner = (node.id for node in workers if node.kind is NodeKind.STRUCTURED)
    return _size(tokens, region) + sum(_uses(tokens, one) for one in inner)


def _is_coupled(tokens: TokenGraph) -> bool:
    """Whether regions can't be looked at one by one, or two flows interrupt one at once."""
    return any(
        edge.keeps
        or edge.interrupts
        or edge.listens
        or tokens.enters(edge)
        or tokens.node(edge.source).region != edge.region
        for edge in tokens.edges
    )


def _in_any_order(tokens: TokenGraph, limit: int) -> Found:
    found = {region: token_net.check(tokens, region, limit) for region in tokens.regions()}
    return Found(
        next((safety.unsafe for safety in found.values() if safety.unsafe), ""),
        all(safety.is_complete for safety in found.values()),
        frozenset(id for safety in found.values() for id in safety.dead),
        rests=frozenset(region for region, safety in found.items() if safety.rests),
        finishes=found[ACTIVITY_REGION].finishes,
    )


def _step_by_step(tokens: TokenGraph, limit: int) -> Found:

    reached = token_search.explore(tokens, limit)
    moving = {node.id for node in tokens.nodes if node.firing is not Firing.NEVER}
    return Found(
        reached.unsafe,
        reached.is_complete,
        frozenset(moving - reached.fired),
        frozenset(reached.queues),
        frozenset(reached.rests),
        reached.finishes,
    )


_ALL_OUT = (Firing.ALL, Firing.WORK)
_ANY_IN = (Firing.ANY, Firing.END)


def collapse(graph: TokenGraph) -> TokenGraph:
    """The graph without nodes that only pass tokens on."""
    rules: tuple[Callable[[TokenGraph, TokenNode], TokenGraph | None], ...] = (
        _pass_through,
        _fork_at_source,
        _join_at_target,
        _merge_at_target,
    )
    has_changed = True
    while has_changed:
        has_changed = False
        for id in [node.id for node in graph.nodes if _is_plain(graph, node)]:
            made = next(filter(None, (rule(graph, graph.node(id)) for rule in rules)), None)
            if made is not None:
                graph, has_changed = made, True
    return graph


def _is_plain(graph: TokenGraph, node: TokenNode) -> bool:
    """It only moves tokens inside its region, and no interruption depends on where they are."""
    edges = [*graph.incoming(node), *graph.outgoing(node)]
    is_interruptible = any(node.id in region.nodes for region in graph.interruptibles)
    is_inside = all(
        not edge.keeps
        and graph.node(edge.source).region == edge.region == graph.node(edge.target).region
        for edge in edges
    )
    has_guard = any(edge.guard for edge in graph.outgoing(node))
    passes = node.firing in (Firing.ALL, Firing.ANY, Firing.CHOICE)
    return (
        passes
        and is_inside
        and not has_guard
        and not is_interruptible
        and not any(e.interrupts for e in edges)
    )


def _pass_through(graph: TokenGraph, node: TokenNode) -> TokenGraph | None:
    incoming, outgoing = graph.incoming(node), graph.outgoing(node)
    if len(incoming) != 1 or len(outgoing) != 1:
        return None
    (before,), (after,) = incoming, outgoing
    return _without(graph, node, {before.id: _joined(before, node, after)}, after)


def _fork_at_source(graph: TokenGraph, node: TokenNode) -> TokenGraph | None:
    incoming, outgoing = graph.incoming(node), graph.outgoing(node)
    if node.firing is not Firing.ALL or len(incoming) != 1 or not outgoing:
        return None
    before = incoming[0]
    if graph.node(before.source).firing not in _ALL_OUT or before.marked:
        return None
    made = {after.id: _joined(before, node, after, keep=after) for after in outgoing}
    return _without(graph, node, made, before)


def _join_at_target(graph: TokenGraph, node: TokenNode) -> TokenGraph | None:
    incoming, outgoing = graph.incoming(node), graph.outgoing(node)
    if node.firing is not Firing.ALL or len(outgoing) != 1 or not incoming:
        return None
    after = outgoing[0]
    if graph.node(after.target).firing not in _ALL_OUT or after.marked:
        return None
    made = {before.id: _joined(before, node, after) for before in incoming}
    return _without(graph, node, made, after)


def _merge_at_target(graph: TokenGraph, node: TokenNode) -> TokenGraph | None:
    incoming, outgoing = graph.incoming(node), graph.outgoing(node)
    if node.firing is not Firing.ANY or len(outgoing) != 1 or not incoming:
        return None
    after = outgoing[0]
    if graph.node(after.target).firing not in _ANY_IN or after.marked or after.target == node.id:
        return None
    made = {before.id: _joined(before, node, after) for before in incoming}
    return _without(graph, node, made, after)


def _joined(
    before: TokenEdge, node: TokenNode, after: TokenEdge, keep: TokenEdge | None = None
) -> TokenEdge:
    kept = keep or before
    return replace(
        kept,
        source=before.source,
        target=after.target,
        origins=tuple(dict.fromkeys([*before.origins, node.origin, *after.origins])),
        marked=before.marked or after.marked,
        guard=before.guard,
        label=_label(before, after),
    )


def _label(before: TokenEdge, after: TokenEdge) -> str:
    start, _, end = before.label.rpartition(" to "), "", after.label.rpartition(" to ")
    return f"{start[0]} to {end[2]}" if start[0] and end[0] else before.label


def _without(
    graph: TokenGraph, node: TokenNode, made: dict[str, TokenEdge], doomed: TokenEdge
) -> TokenGraph | None:
    """The graph with new edges and without the node; None when an edge would be lost in a loop."""
    if doomed.id in made or any(edge.source == edge.target == node.id for edge in made.values()):
        return None
    if any(node.id in (edge.source, edge.target) for edge in made.values()):
        return None
    edges = tuple(made.get(edge.id, edge) for edge in graph.edges if edge is not doomed)
    return replace(graph, nodes=tuple(n for n in graph.nodes if n is not node), edges=edges)
