"""The token game as formulas about the present step: what moves, what is complete, what ends.

These are the parts that the conjuncts of an activity's contract are put together from.
"""

from collections.abc import Iterator
from functools import cached_property

from sysmlc.logic import formula as f
from sysmlc.logic.activities.concurrency import Together
from sysmlc.logic.activities.token_graph import (
    ACTIVITY_REGION,
    Duration,
    Firing,
    Interruptible,
    NodeKind,
    TokenEdge,
    TokenGraph,
    TokenNode,
)
from sysmlc.logic.formula import Formula


def at(edge: TokenEdge) -> Formula:
    """The edge holds a token."""
    return f.var(edge.variable)


def is_else(edge: TokenEdge) -> bool:
    """Whether the edge is open when no other branch is."""
    return edge.guard is not None and edge.guard.condition is None


class Game:
    """The conditions of one token graph; those of regions are put together once."""

    def __init__(self, graph: TokenGraph) -> None:
        self.graph = graph
        self._quiets = dict(graph.quiets)
        self._complete: dict[str, Formula] = {}
        self._interrupted: dict[str, Formula] = {}
        self._endings: dict[str, Formula] = {}

    @cached_property
    def together(self) -> Together:
        """What may have tokens at the same time."""
        return Together(self.graph)

    # -- nodes -----------------------------------------------------------------------------

    def waits(self, node: TokenNode) -> Formula:
        """A token is on every incoming edge."""
        incoming = self.graph.incoming(node)
        return f.both(*map(at, incoming)) if incoming else f.FALSE

    def starts(self, node: TokenNode) -> Formula:
        """An action takes its tokens, unless its region ends."""
        return f.both(self.waits(node), self.is_free(node), self.lives(node))

    def is_free(self, node: TokenNode) -> Formula:
        """The node takes tokens: it does not run, as far as that is not clear anyway."""
        return f.negate(f.var(node.run)) if node.queues else f.TRUE

    def lives(self, node: TokenNode) -> Formula:
        """The region of the node runs, as far as its tokens do not say so."""
        if node.region == ACTIVITY_REGION or not self.graph.reaches_in(node):
            return f.TRUE
        return f.var(self.graph.node(node.region).run)

    def done(self, node: TokenNode) -> Formula:
        """A running node is done."""
        if node.kind is NodeKind.STRUCTURED:
            return self.complete(node.id)
        if node.duration is Duration.PULSE or node.done is None:
            return f.TRUE
        return node.done

    def finishes(self, node: TokenNode) -> Formula:
        """A running node is done, and nothing around it ends before it counts."""
        going = f.both(f.var(node.run), self.done(node), self.lives(node))
        return f.both(going, f.negate(self.ended(node.region)))

    def choosers(self) -> list[TokenNode]:
        """Decisions with several branches that may be open at the same time."""
        return [n for n in self.graph.nodes if _may_choose(self.graph.outgoing(n), n)]

    def is_chosen(self, edge: TokenEdge) -> bool:
        """Whether the edge is a branch of such a decision."""
        source = self.graph.node(edge.source)
        return _may_choose(self.graph.outgoing(source), source)

    # -- complete regions ------------------------------------------------------------------

    def complete(self, region: str) -> Formula:
        """The region is complete, by name where it has one."""
        name = self._quiets.get(region)
        return f.var(name) if name else self.completion(region)

    def completion(self, region: str) -> Formula:
        """A token is at a final node of the region, or nothing in the region can move."""
        if region not in self._complete:
            self._complete[region] = self._completion(region)
        return self._complete[region]

    def _completion(self, region: str) -> Formula:
        at_final = map(at, self.graph.ends(region))
        if not self.graph.can_rest(region):
            return f.either(*at_final)
        moving = [part for node in self.graph.members(region) for part in self._activity(node)]
        return f.either(*at_final, f.both(*map(f.negate, moving)))

    def _activity(self, node: TokenNode) -> Iterator[Formula]:
        """What makes the node a reason not to end its region."""
        if node.firing in (Firing.ANY, Firing.END):
            yield from map(at, self.graph.incoming(node))
        elif node.firing is not Firing.NEVER and self.graph.incoming(node):
            yield f.both(*map(at, self.graph.triggers(node)))
        if node.firing is Firing.WORK:
            yield f.var(node.run)

    def _ended(self, inner: str, outer: str) -> Formula:
        """A region ends from ``inner`` up to, not including, ``outer``."""
        if inner == outer:
            return f.FALSE
        return f.either(*map(self._ends, self.graph.between(inner, outer)))

    def _ends(self, around: TokenNode) -> Formula:
        return f.both(f.var(around.run), self.complete(around.id))

    # -- edges -----------------------------------------------------------------------------

    def opened(self, edge: TokenEdge) -> Formula:
        """The guard of the edge, with else as none of the other guards."""
        guard = edge.guard
        if guard is None:
            return f.TRUE
        if guard.condition is not None:
            return guard.condition
        siblings = self.graph.outgoing(self.graph.node(edge.source))
        return f.both(*(f.negate(self.opened(s)) for s in siblings if not is_else(s)))

    def given(self, edge: TokenEdge) -> Formula:
        """The source of the edge gives it a token (or may, when the decision has a choice)."""
        source = self.graph.node(edge.source)
        alive = f.negate(self._ended(source.region, edge.region))
        return f.both(self._fires_into(source, edge), self.lives(source), alive)

    def _fires_into(self, source: TokenNode, edge: TokenEdge) -> Formula:
        match source.firing:
            case Firing.ANY:
                return f.either(*map(at, self.graph.incoming(source)))
            case Firing.ALL:
                return self.waits(source)
            case Firing.CHOICE:
                return f.both(self.waits(source), self.opened(edge))
            case Firing.WORK:
                return f.both(f.var(source.run), self.done(source))
            case _:
                return f.FALSE

    def taken(self, edge: TokenEdge) -> Formula:
        """The target of the edge takes a token that is on it."""
        target = self.graph.node(edge.target)
        if edge.keeps:
            return f.FALSE
        alive = f.negate(self._ended(target.region, edge.region))
        return f.both(self._takes_from(target, edge), self.lives(target), alive)

    def _takes_from(self, target: TokenNode, edge: TokenEdge) -> Formula:
        match target.firing:
            case Firing.ANY | Firing.END:
                return f.TRUE
            case Firing.NEVER:
                return f.FALSE
            case Firing.CHOICE:
                return f.both(self._others(edge), self.decides(target))
            case _:
                return f.both(self._others(edge), self.is_free(target))

    def decides(self, node: TokenNode) -> Formula:
        """Some branch of the decision is open, as far as that is not clear anyway."""
        branches = self.graph.outgoing(node)
        if node.exhaustive or not branches:
            return f.TRUE
        return f.either(*map(self.opened, branches))

    def _others(self, edge: TokenEdge) -> Formula:
        """A token is on every other edge into the same node."""
        incoming = self.graph.incoming(self.graph.node(edge.target))
        return f.both(*(at(other) for other in incoming if other is not edge))

    def heard(self, edge: TokenEdge) -> Formula:
        """A token enters the region that the edge listens to, and its target does not wait yet."""
        if not edge.listens:
            return f.FALSE
        target = self.graph.node(edge.target)
        coming = (f.both(at(one), self.taken(one)) for one in self.graph.entering(edge.listens))
        is_idle = f.both(f.negate(at(edge)), f.negate(f.var(target.run)))
        around = self.graph.regions_around(edge.region)
        return f.both(f.either(*coming), is_idle, *(f.var(one.run) for one in around))

    def kept(self, edge: TokenEdge) -> Formula:
        """The edge holds a token that stays on it."""
        return f.both(at(edge), f.negate(self.taken(edge)))

    def arrives(self, edge: TokenEdge) -> Formula:
        """The edge gets a token; for a branch that is chosen this is seen in the next step."""
        if not self.is_chosen(edge):
            return self.given(edge)
        return f.both(self.given(edge), f.primed(at(edge)), f.negate(self.kept(edge)))

    # -- ends of regions -------------------------------------------------------------------

    def cleared(self, region: str, members: set[str]) -> Formula:
        """Something ends the region or interrupts what ``members`` (node ids) are in."""
        return f.either(self.ended(region), *self.interruptions(region, members))

    def ended(self, region: str) -> Formula:
        """The region, or one around it, ends."""
        if region not in self._endings:
            around = map(self._ends, self.graph.regions_around(region))
            self._endings[region] = f.either(self.complete(ACTIVITY_REGION), *around)
        return self._endings[region]

    def interruptions(self, region: str, members: set[str]) -> Iterator[Formula]:
        """Interruptions of what ``members`` of a region are in."""
        if not self.graph.interruptibles:
            return
        around = {node.id for node in self.graph.regions_around(region)}
        for interruptible in self.graph.interruptibles:
            nodes = frozenset(interruptible.nodes)
            if members <= nodes or around & nodes:
                yield self._interruption(interruptible)

    def _interruption(self, interruptible: Interruptible) -> Formula:
        """A token enters an interrupting edge of the region."""
        if interruptible.id not in self._interrupted:
            entering = [e for e in self.graph.edges if e.interrupts == interruptible.id]
            self._interrupted[interruptible.id] = f.either(*map(self.arrives, entering))
        return self._interrupted[interruptible.id]

    def begins(self, region: str) -> Formula:
        """The region starts in the next step."""
        if region == ACTIVITY_REGION:
            return self.complete(region)
        node = self.graph.node(region)
        return f.both(self.starts(node), f.negate(self.cleared(node.region, {node.id})))


def _may_choose(branches: list[TokenEdge], node: TokenNode) -> bool:
    """Whether more than one branch may be open at the same time."""
    if node.firing is not Firing.CHOICE:
        return False
    others = [branch for branch in branches if is_else(branch)]
    stated = len(branches) - len(others)
    return len(others) > 1 or (stated > 1 and not node.exclusive)
