"""Formulas about the present step of the token game.

The derivation of contracts combines them: which nodes start and finish, which edges gain and lose a
token, which regions are complete or end. Nodes without steps pass a token in the step in which they
get it, so that a formula follows it back to the action that gives it or the edge on which it rests.
"""

from collections.abc import Iterator, Mapping
from functools import cached_property

from sysmlc.logic import formula as f
from sysmlc.logic.activities.concurrency import ConcurrencyRelation
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import (
    ACTIVITY_REGION,
    Duration,
    Firing,
    Interruptible,
    NodeKind,
    TokenEdge,
    TokenNode,
)
from sysmlc.logic.formula import Formula
from sysmlc.logic.simplification import merge_terms


def token_at(edge: TokenEdge) -> Formula:
    """Return the formula that a token rests on the edge, which must be one that can hold it."""
    return f.var(edge.variable)


class StepFormulas:
    """Formulas of one token graph. The docstring of each method states what its formula means.

    The formulas of regions are cached, because many other formulas contain them.
    """

    def __init__(self, graph: TokenGraph) -> None:
        self.graph = graph
        self._names = dict(graph.named_conditions)
        self._present: dict[str, Formula] = {}
        self._completions: dict[str, Formula] = {}
        self._interrupted: dict[str, Formula] = {}
        self._endings: dict[str, Formula] = {}
        for edge in graph.passing_edges:
            self.present_formula(edge)

    @cached_property
    def concurrency(self) -> ConcurrencyRelation:
        """Which places may hold tokens at the same time."""
        return ConcurrencyRelation(self.graph)

    # -- nodes -----------------------------------------------------------------------------

    def waiting_formula(self, node: TokenNode) -> Formula:
        """The node can take a token from every incoming edge."""
        incoming = self.graph.incoming(node)
        return f.both(*map(self.present_formula, incoming)) if incoming else f.FALSE

    def start_formula(self, node: TokenNode) -> Formula:
        """The node can take its tokens; the formula does not exclude that its region ends now."""
        return f.both(
            self.waiting_formula(node), self.idle_formula(node), self.region_runs_formula(node)
        )

    def idle_formula(self, node: TokenNode) -> Formula:
        """The node does not run any longer; true for a node that gets no tokens while it runs."""
        if not node.queues:
            return f.TRUE
        return f.either(f.negate(f.var(node.run)), self.done_formula(node))

    def region_runs_formula(self, node: TokenNode) -> Formula:
        """The region of the node runs; true where the tokens of the node imply it."""
        if node.region == ACTIVITY_REGION or not self.graph.is_entered_from_outside(node):
            return f.TRUE
        return f.var(self.graph.node(node.region).run)

    def done_formula(self, node: TokenNode) -> Formula:
        """A running node is done."""
        if node.kind is NodeKind.STRUCTURED:
            return self.complete_formula(node.id)
        if node.duration is Duration.PULSE or node.done is None:
            return f.TRUE
        return node.done

    def finish_formula(self, node: TokenNode) -> Formula:
        """A running node is done; what it writes counts even if a region around it ends now."""
        return f.both(f.var(node.run), self.done_formula(node))

    def is_chosen(self, edge: TokenEdge) -> bool:
        """Whether the edge leaves a decision with several branches open at the same time."""
        return self.graph.can_choose(self.graph.node(edge.source))

    # -- complete regions ------------------------------------------------------------------

    def complete_formula(self, region: str) -> Formula:
        """Return the formula that a region is complete: its variable if the graph has one."""
        variable = self._completion_variable(region)
        return self.completion_formula(region) if variable is None else variable

    def _completion_variable(self, region: str) -> Formula | None:
        """Return the variable of the graph that is true when the region is complete, or None."""
        handshake = self.graph.handshake
        if region == ACTIVITY_REGION and handshake is not None:
            return f.var(handshake.finished)
        name = self._names.get(region)
        return f.var(name) if name else None

    def completion_formula(self, region: str) -> Formula:
        """A token reaches a final node of the region, or nothing is left in it after this step."""
        if region not in self._completions:
            self._completions[region] = self._build_completion(region)
        return self._completions[region]

    def _build_completion(self, region: str) -> Formula:
        at_final = self._final_formula(region)
        if not self.graph.can_rest(region):
            return at_final
        remaining = [
            part for node in self.graph.members(region) for part in self._remaining_formulas(node)
        ]
        remaining += map(self.given_formula, self.graph.list_delays(region))
        return f.either(at_final, f.both(*map(f.negate, merge_terms(remaining))))

    def _final_formula(self, region: str) -> Formula:
        """A token at a final node ends the region."""
        return f.either(*map(self.present_formula, self.graph.ends(region)))

    def _remaining_formulas(self, node: TokenNode) -> Iterator[Formula]:
        """Yield the conditions under which the node prevents the end of its region."""
        triggers = self.graph.triggers(node)
        has_all = f.both(*map(self.present_formula, triggers)) if triggers else f.FALSE
        if node.firing is Firing.WORK:
            yield has_all
            yield f.both(f.var(node.run), f.negate(self.done_formula(node)))
        elif node.firing is Firing.ALL:
            # With all its tokens it passes them on, and does not remain itself.
            yield f.both(has_all, f.negate(self.waiting_formula(node)))
        elif node.firing is Firing.CHOICE and self.graph.can_choose(node):
            yield has_all
        elif node.firing is Firing.CHOICE and triggers:
            yield f.both(*map(self.kept_formula, triggers))

    def _aborted_formula(self, inner: str, outer: str) -> Formula:
        """A final node ends a region from *inner* outwards, not counting *outer* and around it.

        Tokens leave a region that ends because nothing is left in it.
        """
        if inner == outer:
            return f.FALSE
        between = self.graph.nodes_between(inner, outer)
        return f.either(*(self._final_formula(node.id) for node in between))

    # -- edges -----------------------------------------------------------------------------

    def present_formula(self, edge: TokenEdge) -> Formula:
        """The target can take a token from the edge: one rests on it, or it gets one just now."""
        if edge.id not in self._present:
            rests = token_at(edge) if self.graph.can_hold(edge) else f.FALSE
            arrives = f.FALSE if self.graph.delays(edge) else self._arriving_formula(edge)
            self._present[edge.id] = f.either(rests, arrives)
        return self._present[edge.id]

    def _arriving_formula(self, edge: TokenEdge) -> Formula:
        """The edge gets a token; a variable of the graph stands for it if there is one."""
        name = self._names.get(edge.id)
        return f.var(name) if name else self.arrival_condition(edge)

    def arrival_condition(self, edge: TokenEdge) -> Formula:
        """The source gives the edge a token, or the edge begins to listen."""
        return f.either(self.given_formula(edge), self.listening_formula(edge))

    def resting_formula(self, edge: TokenEdge) -> Formula:
        """A token is on the edge after this step, unless something removes it."""
        if self.graph.delays(edge):
            return f.either(self._arriving_formula(edge), self.kept_formula(edge))
        return f.both(self.present_formula(edge), f.negate(self.taken_formula(edge)))

    def guard_formula(self, edge: TokenEdge) -> Formula:
        """Return the guard of the edge; ``else`` is true if no guard of a sibling is."""
        guard = edge.guard
        if guard is None:
            return f.TRUE
        if guard.condition is not None:
            return guard.condition
        siblings = self.graph.outgoing(self.graph.node(edge.source))
        return f.both(*(f.negate(self.guard_formula(s)) for s in siblings if not s.is_else))

    def given_formula(self, edge: TokenEdge) -> Formula:
        """The source gives the edge a token, or may do so if it can choose between branches."""
        source = self.graph.node(edge.source)
        alive = f.negate(self._aborted_formula(source.region, edge.region))
        return f.both(self._source_formula(source, edge), self.region_runs_formula(source), alive)

    def _source_formula(self, source: TokenNode, edge: TokenEdge) -> Formula:
        match source.firing:
            case Firing.ANY:
                return f.either(*map(self.present_formula, self.graph.incoming(source)))
            case Firing.ALL:
                return self.waiting_formula(source)
            case Firing.CHOICE:
                return f.both(self.waiting_formula(source), self.guard_formula(edge))
            case Firing.WORK:
                return f.both(f.var(source.run), self.done_formula(source))
            case _:
                return f.FALSE

    def taken_formula(self, edge: TokenEdge) -> Formula:
        """The target takes the token on the edge."""
        target = self.graph.node(edge.target)
        if edge.keeps:
            return f.FALSE
        alive = f.negate(self._aborted_formula(target.region, edge.region))
        return f.both(self._target_formula(target, edge), self.region_runs_formula(target), alive)

    def _target_formula(self, target: TokenNode, edge: TokenEdge) -> Formula:
        match target.firing:
            case Firing.ANY | Firing.END:
                return f.TRUE
            case Firing.NEVER:
                return f.FALSE
            case Firing.CHOICE:
                return f.both(self._other_tokens(edge), self.decision_formula(target))
            case _:
                return f.both(self._other_tokens(edge), self.idle_formula(target))

    def decision_formula(self, node: TokenNode) -> Formula:
        """Some branch of the decision is open; the constant true for exhaustive guards."""
        branches = self.graph.outgoing(node)
        if node.exhaustive or not branches:
            return f.TRUE
        return f.either(*map(self.guard_formula, branches))

    def _other_tokens(self, edge: TokenEdge) -> Formula:
        """A token is on every other edge into the same node."""
        incoming = self.graph.incoming(self.graph.node(edge.target))
        others = (sibling for sibling in incoming if sibling is not edge)
        return f.both(*map(self.present_formula, others))

    def listening_formula(self, edge: TokenEdge) -> Formula:
        """A token enters the region of a listening edge, whose target neither waits nor runs."""
        if not edge.listens:
            return f.FALSE
        target = self.graph.node(edge.target)
        arrivals = (
            f.both(self.present_formula(entering), self.taken_formula(entering))
            for entering in self.graph.entering(edge.listens)
        )
        rests = token_at(edge) if self.graph.can_hold(edge) else f.FALSE
        is_idle = f.both(f.negate(rests), f.negate(f.var(target.run)))
        regions = self.graph.regions_around(edge.region)
        return f.both(f.either(*arrivals), is_idle, *(f.var(node.run) for node in regions))

    def kept_formula(self, edge: TokenEdge) -> Formula:
        """The edge holds a token that stays on it."""
        return f.both(token_at(edge), f.negate(self.taken_formula(edge)))

    def arrival_formula(self, edge: TokenEdge) -> Formula:
        """The edge gets a token. For a branch of a choice, the formula reads the next state."""
        if not self.is_chosen(edge):
            return self.given_formula(edge)
        return f.both(
            self.given_formula(edge), f.prime(token_at(edge)), f.negate(self.kept_formula(edge))
        )

    # -- ends of regions -------------------------------------------------------------------

    def cleared_formula(self, region: str, members: set[str]) -> Formula:
        """The region ends, or an interruption removes the tokens of *members* (node ids)."""
        return f.either(self._completed_formula(region), self.removed_formula(region, members))

    def aborted_formula(self, region: str, members: set[str]) -> Formula:
        """The region ends or an interruption removes *members*, although one of them is left in it.

        A region without a variable for its end is asked only for its final nodes: it ends by itself
        only if nothing is left in it.
        """
        around = (node.id for node in self.graph.regions_around(region))
        ends = (
            self._completion_variable(id) or self._final_formula(id)
            for id in (ACTIVITY_REGION, *around)
        )
        return f.either(*ends, self.removed_formula(region, members))

    def removed_formula(self, region: str, members: set[str]) -> Formula:
        """The activity is abandoned, or an interruption removes the tokens of *members*."""
        return f.either(self.stop_formula(region), *self.interruption_formulas(region, members))

    def ended_formula(self, region: str) -> Formula:
        """The region, or a region around it, ends or is stopped."""
        return f.either(self._completed_formula(region), self.stop_formula(region))

    def stop_formula(self, region: str = ACTIVITY_REGION) -> Formula:
        """The activity is abandoned in this step, with the tokens of the region."""
        del region
        handshake = self.graph.handshake
        return f.var(handshake.stop) if handshake is not None and handshake.stop else f.FALSE

    def _completed_formula(self, region: str) -> Formula:
        """The region, or a region around it, is complete."""
        if region not in self._endings:
            around = map(self.finish_formula, self.graph.regions_around(region))
            self._endings[region] = f.either(self.complete_formula(ACTIVITY_REGION), *around)
        return self._endings[region]

    def interruption_formulas(self, region: str, members: set[str]) -> Iterator[Formula]:
        """Yield the interruptions that remove tokens of *members*, which belong to *region*."""
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
            edges = [e for e in self.graph.edges if e.interrupts == interruptible.id]
            self._interrupted[interruptible.id] = f.either(*map(self.arrival_formula, edges))
        return self._interrupted[interruptible.id]

    def begin_formula(self, region: str) -> Formula:
        """The region starts in the next step, by its tokens or with the region around it."""
        if region == ACTIVITY_REGION:
            return self._restart_formula()
        node = self.graph.node(region)
        starts = f.both(
            self.start_formula(node), f.negate(self.aborted_formula(node.region, {node.id}))
        )
        return f.either(starts, self.first_formula(node))

    def first_formula(self, node: TokenNode) -> Formula:
        """The region of the node starts in the next step, and the node runs from then on."""
        is_first = node.id in self.graph.start(node.region).running
        return self.begin_formula(node.region) if is_first else f.FALSE

    def _restart_formula(self) -> Formula:
        """The activity starts in the next step. A start while it runs has no effect."""
        handshake = self.graph.handshake
        if handshake is None:
            return self.complete_formula(ACTIVITY_REGION)
        if not handshake.start:
            return f.FALSE
        ends = f.either(f.var(handshake.finished), self.stop_formula())
        is_free = f.either(f.negate(f.var(handshake.running)), ends)
        return f.both(f.var(handshake.start), is_free)


class PerformanceFormulas(StepFormulas):
    """Formulas of a token graph whose outermost nodes others start and stop.

    *starts* and *stops* have a formula about the present step for each outermost node.
    """

    def __init__(
        self, graph: TokenGraph, starts: Mapping[str, Formula], stops: Mapping[str, Formula]
    ) -> None:
        self._starts = starts
        self._stops = stops
        super().__init__(graph)

    def start_formula(self, node: TokenNode) -> Formula:
        """Return the formula that a node starts; it is given for an outermost node."""
        return self._starts[node.id] if node.id in self._starts else super().start_formula(node)

    def complete_formula(self, region: str) -> Formula:
        """The region is complete; the region around all performances never is."""
        return f.FALSE if region == ACTIVITY_REGION else super().complete_formula(region)

    def begin_formula(self, region: str) -> Formula:
        """The region starts in the next step."""
        return self._starts[region] if region in self._starts else super().begin_formula(region)

    def stop_formula(self, region: str = ACTIVITY_REGION) -> Formula:
        """The performance that contains the region is stopped in this step."""
        outermost = [node.id for node in self.graph.regions_around(region)][-1:]
        return f.either(*(self._stops.get(id, f.FALSE) for id in outermost))

    def run_formula(self, root: TokenNode) -> Formula:
        """The performance of an outermost node runs in the next step."""
        goes_on = f.both(
            f.var(root.run),
            f.negate(self.done_formula(root)),
            f.negate(self._stops.get(root.id, f.FALSE)),
        )
        return f.either(self._starts[root.id], goes_on)
