"""Whether a region is 1-safe where nothing forks or joins: one token is at one place at a time.

Most activities are such. What ``token_net`` finds in all markings of a Petri net is then what a
walk along the flows finds, without a net.
"""

from collections.abc import Iterator

from sysmlc.logic.activities.petri_net import Safety
from sysmlc.logic.activities.token_graph import Firing, TokenEdge, TokenGraph, TokenNode


def walk(graph: TokenGraph, region: str) -> Safety | None:
    """What a search of all markings finds; None where there may be more than one token.

    No flow may cross the border of the region or interrupt one.
    """
    starts = [edge for edge in graph.inside(region)[0] if edge.marked]
    members = graph.members(region)
    if len(starts) != 1 or not all(_keeps_one(graph, node) for node in members):
        return None
    at = list(_places(graph, starts[0]))
    firing = [(graph.node(edge.target), graph.outgoing(graph.node(edge.target))) for edge in at]
    fired = {node.id for node, _ in firing}
    finishes = any(node.firing is _END for node, _ in firing)
    # A token that nothing takes stays, and one that nothing gives on is gone.
    rests = any(not after and node.firing is not _END for node, after in firing)
    rests = rests or any(node.firing is _NEVER for node, _ in firing)
    dead = frozenset(node.id for node in members if _may_fire(graph, node)) - fired
    return Safety(dead=dead, finishes=finishes or rests, rests=rests)


def _keeps_one(graph: TokenGraph, node: TokenNode) -> bool:
    """Whether the node gives one token for one."""
    match node.firing:
        case Firing.END | Firing.NEVER:
            return True
        case Firing.ANY:
            return len(graph.outgoing(node)) < 2
        case Firing.CHOICE:
            return len(graph.incoming(node)) < 2
        case _:
            return len(graph.incoming(node)) < 2 and len(graph.outgoing(node)) < 2


def _places(graph: TokenGraph, start: TokenEdge) -> Iterator[TokenEdge]:
    """The edges that the token comes to; where a region ends it goes no further."""
    seen = {start.id}
    waiting = [start]
    for edge in waiting:
        yield edge
        node = graph.node(edge.target)
        if node.firing not in (_END, _NEVER):
            new = [after for after in graph.outgoing(node) if after.id not in seen]
            seen.update(after.id for after in new)
            waiting += new


def _may_fire(graph: TokenGraph, node: TokenNode) -> bool:
    """Whether the node has tokens to move; a sink only takes them."""
    is_sink = node.firing is Firing.ANY and not graph.outgoing(node)
    return bool(graph.incoming(node)) and node.firing is not _NEVER and not is_sink


_END, _NEVER = Firing.END, Firing.NEVER
"""Members by names of the module: in Python 3.11 those of a class take twice as long."""
