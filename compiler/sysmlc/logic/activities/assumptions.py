"""What the contract of an activity assumes of the environment.

A loop whose exit depends on the environment gets the assumption
``GF(!inside | at the decision & exit guard)``. The plain ``GF(exit guard)`` would not do: the guard
could be true only while the token is elsewhere in the loop.
"""

from collections.abc import Iterator

from sysmlc.logic import formula as f
from sysmlc.logic.activities.loops import Loop, loops
from sysmlc.logic.activities.step_formulas import Game, at
from sysmlc.logic.activities.token_graph import Duration, Firing, NodeKind, TokenNode
from sysmlc.logic.contract import Class, Conjunct


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
