"""Checks of a token graph: starts, reachability, guards, and at most one token on a flow."""

import re
from collections.abc import Iterator

from msgspec.structs import replace

from sysmlc.analyses.activities import rules
from sysmlc.analyses.activities import safety as activity_search
from sysmlc.analyses.activities.drawing import CannotPlayError
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph, Kind
from sysmlc.ir.algorithms import find_reachable
from sysmlc.logic import domains, evaluate
from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import (
    ACTIVITY_REGION,
    Firing,
    NodeKind,
    TokenEdge,
    TokenNode,
)
from sysmlc.logic.formula import Formula, variable_names, variables
from sysmlc.support.counts import list_first

_MAX_VALUATIONS = 20_000
"""Limit of enumeration: above it, guards count as neither exclusive nor exhaustive."""
_NAME = re.compile(r"\s*[\w.:]+\s*")
_MAX_LISTED = 8
"""Actions that a message names."""


def check_tokens(graph: Graph, tokens: TokenGraph, limit: int, sink: Sink) -> TokenGraph:
    """Check a token graph, report its faults and return it with the results of the checks.

    Raises CannotPlayError if the graph cannot start or is not shown to be 1-safe.
    """
    checker = _Checker(graph, tokens, sink)
    checker.check_start()
    checker.check_guards()
    reachable = checker.check_reachability()
    return checker.check_safety(limit, reachable)


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
        # A single action without incoming flows is the only possible start.
        if len(implied) == len(starts) > 1:
            actions = list_first([node.label for node in implied], _MAX_LISTED)
            subject = self.graph.subject(self.activity)
            self.sink.report(rules.STARTED_BY_ACTIONS, subject, activity=name, actions=actions)

    def _is_implied(self, edge: TokenEdge) -> bool:
        source = self.tokens.node(edge.source)
        return source.kind is NodeKind.INITIAL and source.id not in self.graph

    # -- guards --------------------------------------------------------------------------------

    def check_guards(self) -> None:
        nodes = tuple(self._check_choice(node) for node in self.tokens.nodes)
        self.tokens = replace(self.tokens, nodes=nodes)

    def _check_choice(self, node: TokenNode) -> TokenNode:
        """Return the node with ``exclusive`` and ``exhaustive`` set; report missing branches."""
        branches = self.tokens.outgoing(node) if node.firing is Firing.CHOICE else []
        if not branches:
            return node
        guarded = [branch for branch in branches if not branch.is_else]
        has_else = len(guarded) < len(branches)
        # One guard and an else, as in most decisions, are exclusive and exhaustive.
        is_trivial = has_else and len(guarded) == 1
        open_sets = None if is_trivial else self._list_open_branches(guarded)
        is_exhaustive = has_else or (open_sets is not None and all(open_sets))
        # Texts that became inputs as a whole (SM458) may exclude each other, as 'x < 1.5' and
        # 'x >= 1.5' do.
        is_judged = not any(_is_replaced(edge) for edge in guarded)
        if not is_exhaustive and is_judged:
            self._report_missing_branch(node, guarded)
        overlap = _find_overlap(open_sets, guarded) or _find_repeated_else(branches)
        if overlap and (is_judged or not any(_is_replaced(edge) for edge in overlap)):
            names = " and ".join(self._describe_branch(edge) for edge in overlap)
            subject = self.graph.subject(self.graph[node.origin])
            is_decision = self.graph[node.origin].subkind == "decision"
            advice = "" if is_decision else rules.FORK_ADVICE
            self.sink.report(rules.OVERLAP, subject, help=advice, node=node.label, branches=names)
        return replace(node, exclusive=not overlap, exhaustive=is_exhaustive)

    def _list_open_branches(self, guarded: list[TokenEdge]) -> list[list[TokenEdge]] | None:
        """Return the open branches of each valuation of the variables; None above the limit."""
        conditions = [(edge, _guard_condition(edge)) for edge in guarded]
        names = variable_names(*(condition for _, condition in conditions))
        opens = [(edge, evaluate.compile_evaluation(c)) for edge, c in conditions]
        declared = (*self.tokens.inputs, *(store.variable for store in self.tokens.stores))
        read = {v.name: v.domain for v in declared if v.name in names}
        if domains.count(read) > _MAX_VALUATIONS:
            return None
        return [
            [edge for edge, is_open in opens if is_open(valuation, None)]
            for valuation in domains.valuations(read)
        ]

    def _report_missing_branch(self, node: TokenNode, guarded: list[TokenEdge]) -> None:
        origin = self.graph[node.origin]
        # The origin is a flow if its guard is outside a decision, which SM468 has reported.
        if origin.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW):
            return
        guards = ", ".join(edge.guard.text for edge in guarded if edge.guard)
        subject = self.graph.subject(origin)
        self.sink.report(rules.MISSING_BRANCH, subject, node=node.label, guards=guards)

    def _describe_branch(self, edge: TokenEdge) -> str:
        target = self.tokens.node(edge.target).label
        return f"[{edge.guard.text}] to {target}" if edge.guard else f"to {target}"

    # -- reachability --------------------------------------------------------------------------

    def check_reachability(self) -> set[str]:
        """Return the ids of reachable nodes, and report unreachable ones.

        Of unreachable nodes that follow each other, only the first is reported.
        """
        starts = (edge.target for edge in self.tokens.edges if self._is_start(edge))
        reachable = find_reachable(starts, self._find_successors)
        unreachable = [n for n in self.tokens.nodes if n.id not in reachable and self._is_drawn(n)]
        covered: set[str] = set()
        # Nodes without an unreachable source come first, because they cover their successors.
        for node in sorted(unreachable, key=lambda n: self._has_unreachable_source(n, reachable)):
            if node.id not in covered:
                subject = self.graph.subject(self.graph[node.origin])
                advice = self._advise_on_unreachable(node)
                self.sink.report(rules.UNREACHABLE, subject, help=advice, node=node.label)
                covered |= find_reachable([node.id], self._find_successors)
        return reachable

    def _advise_on_unreachable(self, node: TokenNode) -> str:
        for edge in self.tokens.incoming(node):
            origin = self.graph[self.tokens.node(edge.source).origin]
            if origin.subkind == "raise":
                return rules.RAISE_ADVICE.format(action=origin.name or "without name")
        return ""

    def _is_start(self, edge: TokenEdge) -> bool:
        return edge.marked and edge.region == ACTIVITY_REGION

    def _is_drawn(self, node: TokenNode) -> bool:
        return node.id == node.origin and node.kind is not NodeKind.INITIAL

    def _has_unreachable_source(self, node: TokenNode, reachable: set[str]) -> bool:
        return any(edge.source not in reachable for edge in self.tokens.incoming(node))

    def _find_successors(self, id: str) -> list[str]:
        """Return the nodes that a token at the node, or the start of the node, leads to."""
        node = self.tokens.node(id)
        successors = [edge.target for edge in self.tokens.outgoing(node)]
        successors += self._find_listeners(id)
        if node.kind is NodeKind.STRUCTURED:
            edges, _ = self.tokens.inside(id)
            successors += [edge.target for edge in edges if edge.marked]
        return successors

    def _find_listeners(self, id: str) -> list[str]:
        """Return the nodes that listen when a token is at the node, in its interruptible region."""
        regions = {region.id for region in self.tokens.interruptibles if id in region.nodes}
        if not regions:
            return []
        return [edge.target for edge in self.tokens.edges if edge.listens in regions]

    # -- tokens --------------------------------------------------------------------------------

    def check_safety(self, limit: int, reachable: set[str]) -> TokenGraph:
        """Return the token graph with the result of the search for a second token.

        Raises CannotPlayError if the graph is not shown to be 1-safe.
        """
        result = activity_search.search(self.tokens, limit)
        self._require_safe(result, limit)
        for node in self._find_stuck(result.dead, reachable):
            subject = self.graph.subject(self.graph[node.origin])
            self.sink.report(rules.NEVER_FIRES, subject, node=node.label)
        if not result.finishes:
            subject = self.graph.subject(self.activity)
            self.sink.report(rules.NEVER_FINISHES, subject, activity=self.activity.name)
        return activity_search.apply_result(self.tokens, result)

    def _require_safe(self, result: activity_search.SafetyResult, limit: int) -> None:
        if result.unsafe:
            label, origin = self._locate(result.unsafe)
            subject = self.graph.subject(self.graph[origin])
            self.sink.report(rules.UNSAFE, subject, help=self._advise_on(result.unsafe), flow=label)
            raise CannotPlayError
        if not result.is_complete:
            subject = self.graph.subject(self.activity)
            name = self.activity.name
            self.sink.report(rules.TOO_LARGE, subject, activity=name, limit=limit)
            raise CannotPlayError

    def _advise_on(self, unsafe: str) -> str:
        """Return how to avoid a second token, or "" for the advice of the rule.

        An accept action without incoming flows accepts again and again, so that a second token may
        follow the first on all flows after it.
        """
        sources = {unsafe, *(edge.source for edge in self.tokens.edges if edge.id == unsafe)}
        for edge in self.tokens.edges:
            is_listening = edge.source == edge.target and edge.origin == edge.source
            reachable: set[str] = find_reachable([edge.source], self._find_successors)
            if is_listening and sources & reachable:
                return rules.LISTENING_ADVICE.format(action=self.tokens.node(edge.source).label)
        origin = self.graph.get(self._locate(unsafe)[1])
        is_store = origin is not None and origin.kind in (Kind.OBJECT_NODE, Kind.DATA_STORE)
        return rules.BUFFER_ADVICE if is_store else ""

    def _locate(self, id: str) -> tuple[str, str]:
        """Return the label and the origin of an edge or node."""
        for edge in self.tokens.edges:
            if edge.id == id:
                return edge.label, edge.origin
        node = self.tokens.node(id)
        return node.label, node.origin

    def _find_stuck(self, dead: frozenset[str], reachable: set[str]) -> Iterator[TokenNode]:
        """Yield the dead nodes that tokens reach on some incoming edges, but never on all."""
        for id in sorted(dead & reachable, key=[n.id for n in self.tokens.nodes].index):
            node = self.tokens.node(id)
            sources = [edge.source for edge in self.tokens.incoming(node)]
            is_joined = len(sources) > 1 and node.firing not in (Firing.ANY, Firing.END)
            if is_joined and any(source not in dead for source in sources):
                yield node


def _guard_condition(edge: TokenEdge) -> Formula:
    condition = edge.guard.condition if edge.guard else None
    return f.TRUE if condition is None else condition


def _is_replaced(edge: TokenEdge) -> bool:
    """Whether the guard is a text that is not understood, so that an input replaces it."""
    guard = edge.guard
    if guard is None or guard.condition is None or _NAME.fullmatch(guard.text):
        return False
    names = [variable.name for variable in variables(guard.condition)]
    return len(names) == 1 and guard.condition == f.var(names[0])


def _find_overlap(
    open_sets: list[list[TokenEdge]] | None, guarded: list[TokenEdge]
) -> list[TokenEdge]:
    # Above the limit of enumeration, any two guards may be open together.
    if open_sets is None:
        return guarded if len(guarded) > 1 else []
    return max(open_sets, key=len, default=[]) if any(len(s) > 1 for s in open_sets) else []


def _find_repeated_else(branches: list[TokenEdge]) -> list[TokenEdge]:
    else_branches = [branch for branch in branches if branch.is_else]
    return else_branches if len(else_branches) > 1 else []
