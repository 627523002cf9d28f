"""Search of a token graph for a second token on a flow, and reduction of large token graphs.

Most activities are 1-safe in any order of moves, which ``petri_net`` proves fast. For the others,
``reachability`` explores all synchronous steps. They may be 1-safe only because all nodes move in
the same step, so that a flow is empty again before its next token arrives.
"""

from collections.abc import Callable, Iterator
from functools import lru_cache

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.activities import petri_net as token_net
from sysmlc.logic.activities import reachability as token_search
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import (
    ACTIVITY_REGION,
    Firing,
    NodeKind,
    TokenEdge,
    TokenNode,
)
from sysmlc.logic.identifiers import Names

_MIN_NAMED_SIZE = 50
"""A condition gets a name if its size times its uses reaches this number, else formulas explode."""
_CACHE_SIZE = 256
"""Size of the caches: a process that compiles again reuses the results of unedited activities."""


class SafetyResult(Struct, frozen=True):
    """Result of the search for a second token.

    ``unsafe`` is the id of an edge or node with two tokens, or empty. ``is_complete`` is false if
    the limit was reached. ``dead`` are the ids of nodes that never move, ``queues`` of actions that
    may receive tokens while they run, and ``rests`` of regions that can be complete without a token
    at a final node. ``finishes`` is false if no run can end.
    """

    unsafe: str = ""
    is_complete: bool = True
    dead: frozenset[str] = frozenset()
    queues: frozenset[str] = frozenset()
    rests: frozenset[str] = frozenset()
    finishes: bool = True


@lru_cache(_CACHE_SIZE)
def search(tokens: TokenGraph, limit: int) -> SafetyResult:
    """Search for a second token in at most *limit* states."""
    # The search of single regions is cheap, but it may report a second token that no synchronous
    # step creates, and it cannot follow tokens across borders (docs/decisions/0013).
    unordered = None if _is_coupled(tokens) else _search_regions(tokens, limit)
    if unordered is not None and unordered.is_complete and not unordered.unsafe:
        return unordered
    exact = _search_steps(tokens, limit)
    return exact if exact.is_complete or unordered is None else unordered


def apply_result(tokens: TokenGraph, result: SafetyResult) -> TokenGraph:
    """Return the token graph with the result of the search."""
    nodes = (
        replace(node, queues=True) if node.id in result.queues else node for node in tokens.nodes
    )
    return replace(tokens, nodes=tuple(nodes), rests=result.rests, finishes=result.finishes)


@lru_cache(_CACHE_SIZE)
def collapse_if_safe(tokens: TokenGraph, limit: int) -> TokenGraph:
    """Return the reduced graph, or *tokens* if the reduced graph is not shown to be 1-safe."""
    reduced = collapse(tokens)
    result = search(reduced, limit)
    return tokens if result.unsafe or not result.is_complete else apply_result(reduced, result)


def name_conditions(tokens: TokenGraph, names: Names) -> TokenGraph:
    """Return the graph with variables for long conditions that many formulas would repeat."""
    conditions = (
        (region, names.new(_name_idle_condition(tokens, region)))
        for region in tokens.regions()
        if tokens.can_rest(region)
        and _count_places(tokens, region) * _count_uses(tokens, region) >= _MIN_NAMED_SIZE
    )
    arrivals = ((edge.id, names.new(f"to_{edge.variable}")) for edge in _find_long_ways(tokens))
    return replace(tokens, named_conditions=(*conditions, *arrivals))


def _find_long_ways(tokens: TokenGraph) -> Iterator[TokenEdge]:
    """Yield edges that get their tokens from so many places that a variable stands for it.

    Without variables, the condition at the end of n forks that joins follow would have 2^n parts.
    """
    sizes: dict[str, int] = {}
    for edge in tokens.passing_edges:
        incoming = tokens.incoming(tokens.node(edge.source))
        sizes[edge.id] = 1 + sum(sizes.get(before.id, 1) for before in incoming)
        if sizes[edge.id] >= _MIN_NAMED_SIZE:
            sizes[edge.id] = 1
            yield edge


def _name_idle_condition(tokens: TokenGraph, region: str) -> str:
    if region == ACTIVITY_REGION:
        return "over"
    return f"over_{tokens.node(region).run.removeprefix('run_')}"


def _count_places(tokens: TokenGraph, region: str) -> int:
    edges, workers = tokens.inside(region)
    return len(edges) + len(workers)


def _count_uses(tokens: TokenGraph, region: str) -> int:
    """Count the edges and executable nodes of the region and of the regions inside it."""
    _, workers = tokens.inside(region)
    nested = (node.id for node in workers if node.kind is NodeKind.STRUCTURED)
    return _count_places(tokens, region) + sum(_count_uses(tokens, inner) for inner in nested)


def _is_coupled(tokens: TokenGraph) -> bool:
    """Whether regions depend on each other, so that they cannot be searched separately."""
    return any(
        edge.keeps
        or edge.interrupts
        or edge.listens
        or tokens.enters(edge)
        or tokens.node(edge.source).region != edge.region
        for edge in tokens.edges
    )


def _search_regions(tokens: TokenGraph, limit: int) -> SafetyResult:
    results = {region: token_net.check_safety(tokens, region, limit) for region in tokens.regions()}
    return SafetyResult(
        next((safety.unsafe for safety in results.values() if safety.unsafe), ""),
        all(safety.is_complete for safety in results.values()),
        frozenset(id for safety in results.values() for id in safety.dead),
        rests=frozenset(region for region, safety in results.items() if safety.rests),
        finishes=results[ACTIVITY_REGION].finishes,
    )


def _search_steps(tokens: TokenGraph, limit: int) -> SafetyResult:

    explored = token_search.explore_states(tokens, limit)
    moving = {node.id for node in tokens.nodes if node.firing is not Firing.NEVER}
    return SafetyResult(
        explored.unsafe,
        explored.is_complete,
        frozenset(moving - explored.fired),
        frozenset(explored.queues),
        frozenset(explored.rests),
        explored.finishes,
    )


_SYNCHRONISING = (Firing.ALL, Firing.WORK)
_MERGING = (Firing.ANY, Firing.END)


def collapse(graph: TokenGraph) -> TokenGraph:
    """Return the graph without nodes that only pass tokens on.

    The result preserves actions, decisions with guards and structured nodes, and their order.
    Removed are nodes with one incoming and one outgoing edge, forks after and joins before nodes
    that fork and join by themselves, and merges before merges and final nodes. The ``origins`` of a
    remaining edge are the flows and nodes that it replaces. Tokens arrive earlier, but never in
    another order.
    """
    rules: tuple[Callable[[TokenGraph, TokenNode], TokenGraph | None], ...] = (
        _remove_pass_through,
        _remove_fork,
        _remove_join,
        _remove_merge,
    )
    # A removal may make a neighbour removable, so that the rules are applied up to a fixpoint.
    has_changed = True
    while has_changed:
        has_changed = False
        for id in [node.id for node in graph.nodes if _is_removable(graph, node)]:
            reduced = next(filter(None, (rule(graph, graph.node(id)) for rule in rules)), None)
            if reduced is not None:
                graph, has_changed = reduced, True
    return graph


def _is_removable(graph: TokenGraph, node: TokenNode) -> bool:
    """Whether the node only passes tokens on inside its region, and nothing interrupts them."""
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


def _remove_pass_through(graph: TokenGraph, node: TokenNode) -> TokenGraph | None:
    incoming, outgoing = graph.incoming(node), graph.outgoing(node)
    if len(incoming) != 1 or len(outgoing) != 1:
        return None
    (before,), (after,) = incoming, outgoing
    return _remove_node(graph, node, {before.id: _combine(before, node, after)}, after)


def _remove_fork(graph: TokenGraph, node: TokenNode) -> TokenGraph | None:
    incoming, outgoing = graph.incoming(node), graph.outgoing(node)
    if node.firing is not Firing.ALL or len(incoming) != 1 or not outgoing:
        return None
    before = incoming[0]
    if graph.node(before.source).firing not in _SYNCHRONISING or before.marked:
        return None
    edges = {after.id: _combine(before, node, after, identity=after) for after in outgoing}
    return _remove_node(graph, node, edges, before)


def _remove_join(graph: TokenGraph, node: TokenNode) -> TokenGraph | None:
    incoming, outgoing = graph.incoming(node), graph.outgoing(node)
    if node.firing is not Firing.ALL or len(outgoing) != 1 or not incoming:
        return None
    after = outgoing[0]
    if graph.node(after.target).firing not in _SYNCHRONISING or after.marked:
        return None
    edges = {before.id: _combine(before, node, after) for before in incoming}
    return _remove_node(graph, node, edges, after)


def _remove_merge(graph: TokenGraph, node: TokenNode) -> TokenGraph | None:
    incoming, outgoing = graph.incoming(node), graph.outgoing(node)
    if node.firing is not Firing.ANY or len(outgoing) != 1 or not incoming:
        return None
    after = outgoing[0]
    if graph.node(after.target).firing not in _MERGING or after.marked or after.target == node.id:
        return None
    edges = {before.id: _combine(before, node, after) for before in incoming}
    return _remove_node(graph, node, edges, after)


def _combine(
    before: TokenEdge, node: TokenNode, after: TokenEdge, identity: TokenEdge | None = None
) -> TokenEdge:
    """Return one edge that replaces two; it has the id of *identity*, or else of *before*."""
    base = identity or before
    return replace(
        base,
        source=before.source,
        target=after.target,
        origins=tuple(dict.fromkeys([*before.origins, node.origin, *after.origins])),
        marked=before.marked or after.marked,
        guard=before.guard,
        label=_combine_labels(before, after),
    )


def _combine_labels(before: TokenEdge, after: TokenEdge) -> str:
    start, _, end = before.label.rpartition(" to "), "", after.label.rpartition(" to ")
    return f"{start[0]} to {end[2]}" if start[0] and end[0] else before.label


def _remove_node(
    graph: TokenGraph, node: TokenNode, replacements: dict[str, TokenEdge], removed: TokenEdge
) -> TokenGraph | None:
    """Return the graph without the node and the edge *removed*, with the replaced edges.

    The result is None if the node is on a loop that would lose an edge.
    """
    if removed.id in replacements or any(
        edge.source == edge.target == node.id for edge in replacements.values()
    ):
        return None
    if any(node.id in (edge.source, edge.target) for edge in replacements.values()):
        return None
    edges = tuple(replacements.get(edge.id, edge) for edge in graph.edges if edge is not removed)
    return replace(graph, nodes=tuple(n for n in graph.nodes if n is not node), edges=edges)
