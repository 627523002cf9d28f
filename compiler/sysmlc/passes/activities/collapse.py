"""Fewer edges for large activities: control nodes that only pass tokens on are taken out.

Kept are all actions, decisions with guards, structured nodes and the order of all of them; what
goes are nodes with one edge in and one out, forks after and joins before what can fork and join
by itself, and merges before merges and final nodes. The remaining edge lists in ``origins`` the
flows and nodes that it stands for. Tokens arrive earlier, never in another order.
"""

from collections.abc import Callable

from msgspec.structs import replace

from sysmlc.logic.activities.token_graph import Firing, TokenEdge, TokenGraph, TokenNode

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
