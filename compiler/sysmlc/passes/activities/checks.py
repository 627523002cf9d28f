"""Checks of a token graph: starts, reachability, guards, and one token a flow."""

from collections.abc import Iterable, Iterator

from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph, Kind
from sysmlc.logic import domains, evaluate
from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_graph import (
    ACTIVITY_REGION,
    Firing,
    NodeKind,
    TokenEdge,
    TokenGraph,
    TokenNode,
)
from sysmlc.logic.formula import Formula, variables
from sysmlc.passes.activities import rules
from sysmlc.passes.activities import safety as activity_search
from sysmlc.passes.activities.drawing import CannotPlayError

_MOST_VALUATIONS = 20_000
"""Guards over more valuations than this are taken as neither exclusive nor exhaustive."""


def check(graph: Graph, tokens: TokenGraph, limit: int, sink: Sink) -> TokenGraph:
    """The token graph with what the checks found out; reports what is wrong with it.

    Raises CannotPlayError when it can't start or is not shown to be 1-safe.
    """
    checker = _Checker(graph, tokens, sink)
    checker.check_start()
    checker.check_guards()
    reached = checker.check_reached()
    return checker.check_tokens(limit, reached)


class _Checker:
    def __init__(self, graph: Graph, tokens: TokenGraph, sink: Sink) -> None:
        self.graph = graph
        self.tokens = tokens
        self.sink = sink
        self.activity = graph[tokens.activity]

    # -- start ---------------------------------------------------------------------------------

    def check_start(self) -> None:
        name = self.activity.name
        starts = [e for e in self.tokens.edges if e.marked and e.region == ACTIVITY_REGION]
        if not starts:
            self.sink.report(rules.NO_START, self.graph.subject(self.activity), activity=name)
            raise CannotPlayError
        implied = [self.tokens.node(e.target) for e in starts if self._is_implied(e)]
        if len(implied) == len(starts):
            actions = ", ".join(node.label for node in implied)
            subject = self.graph.subject(self.activity)
            self.sink.report(rules.STARTED_BY_ACTIONS, subject, activity=name, actions=actions)

    def _is_implied(self, edge: TokenEdge) -> bool:
        source = self.tokens.node(edge.source)
        return source.kind is NodeKind.INITIAL and source.id not in self.graph

    # -- guards --------------------------------------------------------------------------------

    def check_guards(self) -> None:
        nodes = tuple(self._checked(node) for node in self.tokens.nodes)
        self.tokens = replace(self.tokens, nodes=nodes)

    def _checked(self, node: TokenNode) -> TokenNode:
        branches = self.tokens.outgoing(node) if node.firing is Firing.CHOICE else []
        if not branches:
            return node
        stated = [branch for branch in branches if not branch.is_else]
        has_else = len(stated) < len(branches)
        # One guard beside an else is neither too few nor too many: most decisions are such.
        is_plain = has_else and len(stated) == 1
        open_sets = None if is_plain else self._open_sets(stated)
        is_exhaustive = has_else or (open_sets is not None and all(open_sets))
        if not is_exhaustive:
            self._report_missing(node, stated)
        overlap = _first_overlap(open_sets, stated) or _two_elses(branches)
        if overlap:
            names = " and ".join(self._branch(edge) for edge in overlap)
            subject = self.graph.subject(self.graph[node.origin])
            self.sink.report(rules.OVERLAP, subject, node=node.label, branches=names)
        return replace(node, exclusive=not overlap, exhaustive=is_exhaustive)

    def _open_sets(self, stated: list[TokenEdge]) -> list[list[TokenEdge]] | None:
        """For each valuation of the inputs the branches that are open; None: too many."""
        conditions = [(edge, _condition(edge)) for edge in stated]
        names = {v.name for _, c in conditions for v in variables(c)}
        opens = [(edge, evaluate.evaluation(c)) for edge, c in conditions]
        known = (*self.tokens.inputs, *(one.variable for one in self.tokens.stores))
        read = {v.name: v.domain for v in known if v.name in names}
        if domains.count(read) > _MOST_VALUATIONS:
            return None
        return [
            [edge for edge, is_open in opens if is_open(valuation, None)]
            for valuation in domains.valuations(read)
        ]

    def _report_missing(self, node: TokenNode, stated: list[TokenEdge]) -> None:
        origin = self.graph[node.origin]
        if origin.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW):
            return
        guards = ", ".join(edge.guard.text for edge in stated if edge.guard)
        subject = self.graph.subject(origin)
        self.sink.report(rules.MISSING_BRANCH, subject, node=node.label, guards=guards)

    def _branch(self, edge: TokenEdge) -> str:
        target = self.tokens.node(edge.target).label
        return f"[{edge.guard.text}] to {target}" if edge.guard else f"to {target}"

    # -- reachability --------------------------------------------------------------------------

    def check_reached(self) -> set[str]:
        reached = self._closure(e.target for e in self.tokens.edges if self._starts(e))
        lost = [n for n in self.tokens.nodes if n.id not in reached and self._is_drawn(n)]
        told: set[str] = set()
        for node in sorted(lost, key=lambda n: self._has_lost_source(n, reached)):
            if node.id not in told:
                subject = self.graph.subject(self.graph[node.origin])
                self.sink.report(rules.UNREACHABLE, subject, node=node.label)
                told |= self._closure([node.id])
        return reached

    def _starts(self, edge: TokenEdge) -> bool:
        return edge.marked and edge.region == ACTIVITY_REGION

    def _is_drawn(self, node: TokenNode) -> bool:
        return node.id == node.origin and node.kind is not NodeKind.INITIAL

    def _has_lost_source(self, node: TokenNode, reached: set[str]) -> bool:
        return any(edge.source not in reached for edge in self.tokens.incoming(node))

    def _closure(self, first: Iterable[str]) -> set[str]:
        found: set[str] = set()
        waiting = list(first)
        while waiting:
            id = waiting.pop()
            if id in found:
                continue
            found.add(id)
            node = self.tokens.node(id)
            waiting += [edge.target for edge in self.tokens.outgoing(node)]
            waiting += self._listeners(id)
            if node.kind is NodeKind.STRUCTURED:
                edges, _ = self.tokens.inside(id)
                waiting += [edge.target for edge in edges if edge.marked]
        return found

    def _listeners(self, id: str) -> list[str]:
        """What listens once a token is at a node of its interruptible region."""
        around = {one.id for one in self.tokens.interruptibles if id in one.nodes}
        if not around:
            return []
        return [edge.target for edge in self.tokens.edges if edge.listens in around]

    # -- tokens --------------------------------------------------------------------------------

    def check_tokens(self, limit: int, reached: set[str]) -> TokenGraph:
        """The graph with what a search found. Raises CannotPlayError unless it is 1-safe."""
        found = activity_search.search(self.tokens, limit)
        self._require_safe(found, limit)
        for node in self._stuck(found.dead, reached):
            subject = self.graph.subject(self.graph[node.origin])
            self.sink.report(rules.NEVER_FIRES, subject, node=node.label)
        if not found.finishes:
            subject = self.graph.subject(self.activity)
            self.sink.report(rules.ENDLESS, subject, activity=self.activity.name)
        return activity_search.noted(self.tokens, found)

    def _require_safe(self, found: activity_search.Found, limit: int) -> None:
        if found.unsafe:
            label, origin = self._place(found.unsafe)
            self.sink.report(rules.UNSAFE, self.graph.subject(self.graph[origin]), flow=label)
            raise CannotPlayError
        if not found.is_complete:
            subject = self.graph.subject(self.activity)
            name = self.activity.name
            self.sink.report(rules.TOO_LARGE, subject, activity=name, limit=limit)
            raise CannotPlayError

    def _place(self, id: str) -> tuple[str, str]:
        for edge in self.tokens.edges:
            if edge.id == id:
                return edge.label, edge.origin
        node = self.tokens.node(id)
        return node.label, node.origin

    def _stuck(self, dead: frozenset[str], reached: set[str]) -> Iterator[TokenNode]:
        """Dead nodes that are to blame: tokens reach them, but not all of their edges."""
        for id in sorted(dead & reached, key=[n.id for n in self.tokens.nodes].index):
            node = self.tokens.node(id)
            sources = [edge.source for edge in self.tokens.incoming(node)]
            is_joined = len(sources) > 1 and node.firing not in (Firing.ANY, Firing.END)
            if is_joined and any(source not in dead for source in sources):
                yield node


def _condition(edge: TokenEdge) -> Formula:
    condition = edge.guard.condition if edge.guard else None
    return f.TRUE if condition is None else condition


def _first_overlap(
    open_sets: list[list[TokenEdge]] | None, stated: list[TokenEdge]
) -> list[TokenEdge]:
    if open_sets is None:
        return stated if len(stated) > 1 else []
    return max(open_sets, key=len, default=[]) if any(len(s) > 1 for s in open_sets) else []


def _two_elses(branches: list[TokenEdge]) -> list[TokenEdge]:
    others = [branch for branch in branches if branch.is_else]
    return others if len(others) > 1 else []
