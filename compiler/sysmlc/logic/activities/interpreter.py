"""Reference interpreter of token graphs, independent of the derived formulas.

A step first ends the complete regions, whose nodes do nothing more. All other nodes then move the
tokens that they can move. After that, interrupted nodes lose their tokens, and started regions get
the tokens of their marked edges.

Tests compare the contracts of ``derivation`` with the interpreter: every conjunct must hold in each
of its runs, and must fail in a run that was changed.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Protocol, TypeVar

from msgspec import Struct

from sysmlc.logic import domains, evaluate
from sysmlc.logic.activities.token_graph import (
    ACTIVITY_REGION,
    Duration,
    Firing,
    Handshake,
    NodeKind,
    TokenEdge,
    TokenGraph,
    TokenNode,
    Write,
)
from sysmlc.logic.formula import Formula, Literal

Inputs = Mapping[str, Literal]
_T = TypeVar("_T")


class Choose(Protocol):
    """Decides where the token game leaves a choice: open branches, or writes in one step."""

    def __call__(self, node: TokenNode, options: Sequence[_T], /) -> _T:
        """Return one of the options."""


class NotSafeError(RuntimeError):
    """A second token reached an edge or a merge, or an action was started while it ran."""


class State(Struct, frozen=True):
    """Ids of edges with a token and of running nodes, and the values of written variables.

    ``is_performed`` is false before the start and after the end of an activity with a handshake.
    """

    tokens: frozenset[str]
    running: frozenset[str]
    stored: tuple[tuple[str, Literal], ...] = ()
    is_performed: bool = True


def _choose_first(node: TokenNode, options: Sequence[_T]) -> _T:
    """Return the first option."""
    del node
    return options[0]


def initial_state(graph: TokenGraph) -> State:
    """Return the first state. A variable without an initial value has its least value."""
    stored = (
        (
            store.variable.name,
            domains.values(store.variable.domain)[0] if store.first is None else store.first,
        )
        for store in graph.stores
    )
    if graph.handshake is not None and not graph.handshake.is_started:
        return State(frozenset(), frozenset(), tuple(stored), is_performed=False)
    return State(frozenset(_marked_edges(graph, ACTIVITY_REGION)), frozenset(), tuple(stored))


def _restarted_state(graph: TokenGraph, state_before: State) -> State:
    """Return the state in which the activity starts after another state."""
    reset_values = {
        store.variable.name: store.first
        for store in graph.stores
        if store.local and store.first is not None
    }
    stored = tuple((name, reset_values.get(name, value)) for name, value in state_before.stored)
    return State(frozenset(_marked_edges(graph, ACTIVITY_REGION)), frozenset(), stored)


def values_of(graph: TokenGraph, state: State) -> dict[str, Literal]:
    """Return the values of all variables of the system in a state."""
    runs: dict[str, Literal] = {node.run: node.id in state.running for node in graph.workers()}
    quiet = {name: is_complete(graph, state, region) for region, name in graph.quiets}
    tokens = {edge.variable: edge.id in state.tokens for edge in graph.edges}
    if graph.handshake is not None:
        tokens[graph.handshake.running] = state.is_performed
        tokens[graph.handshake.finished] = is_finished(graph, state)
    return runs | tokens | quiet | dict(state.stored)


def state_of(graph: TokenGraph, valuation: Inputs) -> State:
    """Return the state with these values of variables, the inverse of ``values_of``."""
    return State(
        frozenset(edge.id for edge in graph.edges if valuation[edge.variable]),
        frozenset(node.id for node in graph.workers() if valuation[node.run]),
        tuple((store.variable.name, valuation[store.variable.name]) for store in graph.stores),
        graph.handshake is None or bool(valuation[graph.handshake.running]),
    )


def next_state(
    graph: TokenGraph,
    state: State,
    inputs: Inputs,
    holds: Callable[[Formula, Inputs], bool],
    choose: Choose = _choose_first,
) -> State:
    """Return the state after one step; *holds* evaluates a condition over the inputs.

    Raises NotSafeError if the graph is not 1-safe.
    """
    return TokenStep(graph, state, inputs, holds, choose).compute_next()


def is_finished(graph: TokenGraph, state: State) -> bool:
    """Whether the activity ends in this state. Without a handshake the next step restarts it."""
    return state.is_performed and is_complete(graph, state, ACTIVITY_REGION)


def is_complete(graph: TokenGraph, state: State, region: str) -> bool:
    """Whether a region is complete.

    Then a token is at one of its final nodes, or nothing in it can move.
    """
    if any(edge.id in state.tokens for edge in graph.ends(region)):
        return True
    return not any(_is_active(graph, state, node) for node in graph.members(region))


def _is_active(graph: TokenGraph, state: State, node: TokenNode) -> bool:
    """Whether the node prevents the completion of its region.

    It does if it runs, or has all tokens that it can get from inside its region.
    """
    if node.id in state.running:
        return True
    if node.firing is Firing.NEVER:
        return False
    if node.firing in (Firing.ANY, Firing.END):
        return any(edge.id in state.tokens for edge in graph.incoming(node))
    triggers = graph.triggers(node)
    return bool(triggers) and all(edge.id in state.tokens for edge in triggers)


def _marked_edges(graph: TokenGraph, region: str) -> list[str]:
    return [edge.id for edge in graph.edges if edge.marked and edge.region == region]


class BranchPlan:
    """A choice function for one replay of a step: backtracking without copies of the state.

    It takes the *planned* branches, and then the first branch of each further choice. It counts the
    options of every choice, so that ``list_alternatives`` can plan the branches not taken.
    """

    def __init__(self, planned: list[int]) -> None:
        self._planned = planned
        self._counts: list[int] = []

    def choose(self, _node: TokenNode | None, options: Sequence[_T]) -> _T:
        """Return the planned option, or the first one."""
        self._counts.append(len(options))
        position = len(self._counts) - 1
        return options[self._planned[position] if position < len(self._planned) else 0]

    def list_alternatives(self) -> Iterator[list[int]]:
        """Yield a plan for each other branch of the choices that were not planned."""
        branches = [*self._planned, *[0] * (len(self._counts) - len(self._planned))]
        for position in range(len(self._planned), len(self._counts)):
            for branch in range(1, self._counts[position]):
                yield [*branches[:position], branch]


class TokenStep:
    """One step of all nodes at once: it reads the state ``old`` and changes copies of its sets."""

    def __init__(
        self,
        graph: TokenGraph,
        old: State,
        inputs: Inputs,
        holds: Callable[[Formula, Inputs], bool],
        choose: Choose = _choose_first,
    ) -> None:
        self.graph = graph
        self.old = old
        self.inputs = {**inputs, **dict(old.stored)}
        self.holds = holds
        self.choose = choose
        self.tokens = set(old.tokens)
        self.running = set(old.running)
        self.started: list[TokenNode] = []
        self.ended: list[TokenNode] = []
        self.interrupted: list[str] = []
        self.finished: set[str] = set()
        self.taken: set[str] = set()

    def compute_next(self) -> State:
        """Return the next state.

        A start has an effect if the activity does not run after this step. Without a handshake,
        an activity that is complete starts again.
        """
        handshake, is_over = self.graph.handshake, is_finished(self.graph, self.old)
        if self.old.is_performed and not is_over:
            self.move_tokens()
        stored = tuple(self._stored_values())
        ends = is_over or not self.old.is_performed or self._is_given(handshake, "stop")
        if not ends:
            return State(frozenset(self.tokens), frozenset(self.running), stored)
        after = State(frozenset(), frozenset(), stored, is_performed=False)
        is_started = handshake is None or self._is_given(handshake, "start")
        return _restarted_state(self.graph, after) if is_started else after

    def _is_given(self, handshake: Handshake | None, role: str) -> bool:
        name = getattr(handshake, role, "")
        return bool(name and self.inputs[name])

    def move_tokens(self) -> None:
        """Move all tokens that can move, and end and start regions."""
        self.ended = [node for node in self.graph.workers() if self._ends(node)]
        alive = [node for node in self.graph.nodes if self._is_alive(node)]
        # Taking comes before giving: a token may arrive where another has just left.
        gifts = [edge for node in alive for edge in self._fire_node(node)]
        for edge in gifts:
            self._give_token(edge)
        for edge in self.graph.edges:
            if edge.listens and self._is_listening_triggered(edge):
                self._give_token(edge)
        for node in self.ended:
            self.clear_region(node.id)
        for region in self.interrupted:
            self._interrupt(region)
        for node in self.started:
            self.start_region(node)

    def _is_listening_triggered(self, edge: TokenEdge) -> bool:
        """Whether a listening edge gets a token.

        A token enters the region to which it listens, and its target neither waits nor runs.
        """
        target = self.graph.node(edge.target)
        is_waiting = edge.id in self.old.tokens or edge.target in self.old.running
        is_entered = any(
            entering_edge.id in self.taken for entering_edge in self.graph.entering(edge.listens)
        )
        return is_entered and not is_waiting and self._is_alive(target)

    def _stored_values(self) -> Iterator[tuple[str, Literal]]:
        """Yield the values of the variables after the writes of all finished nodes."""
        for store, (name, value) in zip(self.graph.stores, self.old.stored, strict=True):
            writes = [write for write in store.writes if write.node in self.finished]
            if len(writes) > 1:
                writes = [self.choose(self.graph.node(writes[0].node), writes)]
            yield name, self._written_value(writes[0]) if writes else value

    def _written_value(self, write: Write) -> Literal:
        enabled_values = (
            value for condition, value in write.values if self.holds(condition, self.inputs)
        )
        return evaluate.value_of(next(enabled_values), self.inputs)

    def _ends(self, node: TokenNode) -> bool:
        is_running = node.kind is NodeKind.STRUCTURED and node.id in self.old.running
        return is_running and self.is_complete(node.id)

    def is_complete(self, region: str) -> bool:
        """Whether a region is complete in this step."""
        return is_complete(self.graph, self.old, region)

    def _is_alive(self, node: TokenNode) -> bool:
        """Whether all regions around the node run and none of them ends in this step."""
        enclosing = list(self.graph.regions_around(node.region))
        return all(
            region_node.id in self.old.running and region_node not in self.ended
            for region_node in enclosing
        )

    def _fire_node(self, node: TokenNode) -> Sequence[TokenEdge]:
        incoming, outgoing = self.graph.incoming(node), self.graph.outgoing(node)
        ready = [edge for edge in incoming if edge.id in self.old.tokens]
        match node.firing:
            case Firing.ANY if ready:
                self._take_tokens(ready)
                self._check_single(node, ready, outgoing)
                return outgoing
            case Firing.ALL if incoming and len(ready) == len(incoming):
                self._take_tokens(ready)
                return outgoing
            case Firing.CHOICE if incoming and len(ready) == len(incoming):
                return self._take_branch(node, ready, outgoing)
            case Firing.WORK:
                return self._work_step(node, incoming, ready, outgoing)
            case _:
                return ()

    def _check_single(
        self, node: TokenNode, ready: list[TokenEdge], outgoing: list[TokenEdge]
    ) -> None:
        # Of several flows that interrupt one region in the same step, UML lets only one pass.
        sources = {edge.interrupts or edge.id for edge in ready}
        if len(sources) > 1 and any(not edge.keeps for edge in outgoing):
            raise NotSafeError(f"two tokens reach {node.label} at once")

    def _take_branch(
        self, node: TokenNode, ready: list[TokenEdge], outgoing: list[TokenEdge]
    ) -> Sequence[TokenEdge]:
        branches = self.list_open_branches(outgoing)
        if outgoing and not branches:
            return ()
        self._take_tokens(ready)
        if not outgoing:
            return ()
        return (branches[0] if len(branches) == 1 else self.choose(node, branches),)

    def list_open_branches(self, outgoing: list[TokenEdge]) -> list[TokenEdge]:
        """Return the branches of a decision that a token may take."""
        guarded = [edge for edge in outgoing if not edge.is_else]
        open_edges = [edge for edge in guarded if self.is_open(edge)]
        return open_edges or [edge for edge in outgoing if edge.is_else]

    def is_open(self, edge: TokenEdge) -> bool:
        """Whether the guard of an edge is true; that of an else edge always is."""
        guard = edge.guard
        return guard is None or guard.condition is None or self.holds(guard.condition, self.inputs)

    def _work_step(
        self,
        node: TokenNode,
        incoming: list[TokenEdge],
        ready: list[TokenEdge],
        outgoing: list[TokenEdge],
    ) -> Sequence[TokenEdge]:
        is_running = node.id in self.old.running
        has_all = bool(incoming) and len(ready) == len(incoming)
        if has_all and is_running and not node.queues:
            raise NotSafeError(f"{node.label} is started while it runs")
        if has_all and not is_running:
            self._take_tokens(ready)
            self.running.add(node.id)
            self.started.append(node)
        if not is_running or not self.is_done(node):
            return ()
        self.running.discard(node.id)
        self.finished.add(node.id)
        return outgoing

    def is_done(self, node: TokenNode) -> bool:
        """Whether a running node is done in this step."""
        if node.kind is NodeKind.STRUCTURED:
            return node in self.ended
        if node.duration is Duration.PULSE or node.done is None:
            return True
        return self.holds(node.done, self.inputs)

    def _take_tokens(self, edges: Sequence[TokenEdge]) -> None:
        ids = [edge.id for edge in edges if not edge.keeps]
        self.tokens.difference_update(ids)
        self.taken.update(ids)

    def _give_token(self, edge: TokenEdge) -> None:
        if edge.id in self.tokens and not edge.keeps:
            raise NotSafeError(f"a second token reaches the flow {edge.label}")
        self.tokens.add(edge.id)
        if edge.interrupts:
            self.interrupted.append(edge.interrupts)

    def start_region(self, node: TokenNode) -> None:
        """Put tokens on the marked edges of a structured node that runs."""
        if node.kind is NodeKind.STRUCTURED and node.id in self.running:
            self.tokens.update(_marked_edges(self.graph, node.id))

    def clear_region(self, region: str) -> None:
        """Remove all tokens in a region and stop all nodes in it."""
        edges, nodes = self.graph.inside(region)
        self.tokens.difference_update(edge.id for edge in edges)
        self._stop_nodes(nodes)

    def _interrupt(self, region: str) -> None:
        interruptible = next(r for r in self.graph.interruptibles if r.id == region)
        members = frozenset(interruptible.nodes)
        self.tokens.difference_update(
            edge.id for edge in self.graph.edges if {edge.source, edge.target} <= members
        )
        self._stop_nodes([node for node in self.graph.workers() if node.id in members])

    def _stop_nodes(self, nodes: Sequence[TokenNode]) -> None:
        for node in nodes:
            self.running.discard(node.id)
            if node.kind is NodeKind.STRUCTURED:
                self.clear_region(node.id)
