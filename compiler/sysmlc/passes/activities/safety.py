"""The search for a second token: in any order of moves where that is enough, else step by step.

Most activities are 1-safe in whatever order their nodes move, which is found fast (``token_net``).
The others are played in all ways (``token_search``): the game moves everything at once, so that a
flow may be empty again before the next token comes.
"""

from functools import lru_cache

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic.activities import net_safety as token_net
from sysmlc.logic.activities.token_graph import ACTIVITY_REGION, Firing, NodeKind, TokenGraph
from sysmlc.logic.names import Names
from sysmlc.passes.activities.collapse import collapse
from sysmlc.values import dataclass, replace

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
    from sysmlc.logic.activities import reachability as token_search

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
