"""Loops of token graphs that the environment decides, each with the edges that lead out of it."""

from collections.abc import Collection, Iterator

from msgspec import Struct

from sysmlc.ir.algorithms import strongly_connected_components
from sysmlc.logic import formula as f
from sysmlc.logic.activities.step_formulas import Game, at
from sysmlc.logic.activities.token_graph import (
    ACTIVITY_REGION,
    Duration,
    Firing,
    NodeKind,
    TokenEdge,
    TokenGraph,
    TokenNode,
)
from sysmlc.logic.contract import Class, Conjunct
from sysmlc.logic.formula import Const


class Loop(Struct, frozen=True):
    """Nodes (ids, in the order of the graph) that reach each other, and the exits."""

    nodes: tuple[str, ...]
    exits: tuple[TokenEdge, ...]


def loops(graph: TokenGraph) -> list[Loop]:
    """Loops with at least one exit that the environment opens, outer before inner.

    A loop is a strongly connected component; inner loops are the components that are left
    when the decisions with exits are taken out.
    """
    return list(_loops(graph, [node.id for node in graph.nodes]))


def endless_entries(graph: TokenGraph) -> list[TokenNode]:
    """Where loops without an exit are entered: they are gone through again and again."""
    heads = (_entry(graph, part) for part in _components(graph, [n.id for n in graph.nodes]))
    return [head for head in heads if head is not None]


def _entry(graph: TokenGraph, component: Collection[str]) -> TokenNode | None:
    if any(_is_exit(graph, edge, component) for edge in graph.edges):
        return None
    nodes = [graph.node(id) for id in component]
    entered = [n for n in nodes if any(_enters(e, component) for e in graph.incoming(n))]
    return next(iter(entered), nodes[0])


def _enters(edge: TokenEdge, component: Collection[str]) -> bool:
    return edge.source not in component or edge.marked


def _loops(graph: TokenGraph, nodes: Collection[str]) -> Iterator[Loop]:
    for component in _components(graph, nodes):
        inside = frozenset(component)
        exits = [edge for edge in graph.edges if _is_exit(graph, edge, inside)]
        if any(_is_decided_outside(graph, one) for one in exits):
            yield Loop(component, tuple(exits))
        deciders = {edge.source for edge in exits}
        if deciders:
            yield from _loops(graph, [node for node in component if node not in deciders])


def _components(graph: TokenGraph, nodes: Collection[str]) -> list[tuple[str, ...]]:
    kept = frozenset(nodes)
    steps = [*((edge.source, edge.target) for edge in graph.edges), *_starts(graph)]
    following: dict[str, dict[str, None]] = {id: {} for id in nodes}
    for source, target in steps:
        if source in kept and target in kept:
            following[source][target] = None
    order = {node.id: place for place, node in enumerate(graph.nodes)}
    found = [
        tuple(sorted(part, key=order.__getitem__))
        for part in strongly_connected_components(following)
        if len(part) > 1 or part[0] in following[part[0]]
    ]
    return sorted(found, key=lambda part: order[part[0]])


def _starts(graph: TokenGraph) -> Iterator[tuple[str, str]]:
    """A structured node leads to what starts in it: flows may leave from there."""
    for edge in graph.edges:
        if edge.marked and edge.region != ACTIVITY_REGION:
            yield edge.region, edge.target


def _is_exit(graph: TokenGraph, edge: TokenEdge, component: Collection[str]) -> bool:
    if edge.source not in component or edge.target in component:
        return False
    return graph.node(edge.source).firing is Firing.CHOICE


def _is_decided_outside(graph: TokenGraph, edge: TokenEdge) -> bool:
    """Whether the environment opens the branch, by its own guard or by those of the others."""
    guard = edge.guard
    if guard is None or isinstance(guard.condition, Const):
        return False
    if guard.condition is not None:
        return graph.is_decided_outside(guard.condition)
    others = (one.guard for one in graph.outgoing(graph.node(edge.source)))
    stated = [one.condition for one in others if one is not None and one.condition is not None]
    return not stated or not all(map(graph.is_own, stated))


def assumptions(game: Game) -> Iterator[Conjunct]:
    """Actions end, some guard holds wherever a token waits for one, and loops are left."""
    for node in game.graph.workers():
        if node.kind is NodeKind.ACTION and node.duration is Duration.TIMED and node.done:
            if game.graph.is_own(node.done):
                continue
            ended = f.either(f.negate(f.var(node.run)), node.done)
            text = f"Whenever {node.label} runs, the environment ends it sooner or later."
            yield Conjunct(ended, Class.LIVENESS, node.origin, text)
    for node in game.graph.nodes:
        yield from _answers(game, node)
    for loop in loops(game.graph):
        yield from _exits(game, loop)


def _answers(game: Game, node: TokenNode) -> Iterator[Conjunct]:
    """A decision without an open branch keeps its token: one has to open sooner or later."""
    branches = game.graph.outgoing(node)
    if node.firing is not Firing.CHOICE or not branches or node.exhaustive:
        return
    opened = f.either(*map(game.opened, branches))
    if game.graph.is_own(opened):
        return
    answer = f.either(f.negate(game.waits(node)), opened)
    text = f"Whenever a token waits at {node.label}, one of its guards holds sooner or later."
    yield Conjunct(answer, Class.LIVENESS, node.origin, text)


def _exits(game: Game, loop: Loop) -> Iterator[Conjunct]:
    graph = game.graph
    leaves = f.either(
        *(f.both(game.waits(graph.node(edge.source)), game.opened(edge)) for edge in loop.exits)
    )
    nodes_in = frozenset(loop.nodes)
    between = (e for e in graph.edges if e.source in nodes_in and e.target in nodes_in)
    inside = [at(e) for e in between if not e.keeps]
    inside += [f.var(n.run) for n in graph.workers() if n.id in nodes_in]
    nodes = [graph.node(edge.source) for edge in loop.exits]
    names = " or ".join(dict.fromkeys(node.label for node in nodes))
    guards = " or ".join(dict.fromkeys(e.guard.text for e in loop.exits if e.guard))
    text = (
        f"The loop through {names} is left sooner or later: whenever it goes on, "
        f"{guards} holds there at last."
    )
    left = f.either(f.both(*map(f.negate, inside)), leaves)
    yield Conjunct(left, Class.LIVENESS, nodes[0].origin, text)
