"""One step of the token game.

In a step, actions end, and the tokens that they give pass the nodes without steps until actions
take them or they rest. Complete regions lose all that is in them, interrupted nodes lose their
tokens, and started regions get what they start with.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Protocol, TypeVar

from msgspec import Struct

from sysmlc.logic import evaluate
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import (
    ACTIVITY_REGION,
    Duration,
    Firing,
    Handshake,
    NodeKind,
    TokenEdge,
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
    """A second token reached an edge or a merge, or an action was started while it ran.

    ``place`` is the id of the edge or node.
    """

    def __init__(self, message: str, place: str) -> None:
        super().__init__(message)
        self.place = place


class State(Struct, frozen=True):
    """Ids of edges with a token and of running nodes, and the values of written variables.

    ``is_performed`` is false before the start and after the end of an activity with a handshake.
    """

    tokens: frozenset[str]
    running: frozenset[str]
    stored: tuple[tuple[str, Literal], ...] = ()
    is_performed: bool = True


def choose_first(node: TokenNode, options: Sequence[_T]) -> _T:
    """Return the first option."""
    del node
    return options[0]


def restarted_state(graph: TokenGraph, state_before: State) -> State:
    """Return the state in which the activity starts after another state."""
    reset_values = {
        store.variable.name: store.first
        for store in graph.stores
        if store.local and store.first is not None
    }
    stored = tuple((name, reset_values.get(name, value)) for name, value in state_before.stored)
    start = graph.start_all(ACTIVITY_REGION)
    return State(start.tokens, start.running, stored)


class TokenStep:
    """One step of all nodes at once.

    ``finished`` are the nodes that are done, ``begun`` those that start to run in the next step.
    """

    def __init__(
        self,
        graph: TokenGraph,
        old: State,
        inputs: Inputs,
        holds: Callable[[Formula, Inputs], bool],
        choose: Choose = choose_first,
    ) -> None:
        self.graph = graph
        self.old = old
        self.inputs = {**inputs, **dict(old.stored)}
        self.holds = holds
        self.choose = choose
        self.tokens: set[str] = set()
        self.running: set[str] = set()
        self.finished: set[str] = set()
        self.begun: set[str] = set()
        self._present: dict[str, bool] = {}
        self._complete: dict[str, bool] = {}
        self._chosen: dict[str, TokenEdge | None] = {}
        for edge in graph.passing_edges:
            self.is_present(edge)

    def compute_next(self) -> State:
        """Return the next state.

        A start has an effect if the activity does not run after this step. Without a handshake,
        an activity that is complete starts again.
        """
        handshake, is_over = self.graph.handshake, self.is_finished()
        if self.old.is_performed:
            self.move_tokens()
        stored = tuple(self._stored_values())
        ends = is_over or not self.old.is_performed or self._is_signalled(handshake, "stop")
        if not ends:
            return State(frozenset(self.tokens), frozenset(self.running), stored)
        after = State(frozenset(), frozenset(), stored, is_performed=False)
        is_started = handshake is None or self._is_signalled(handshake, "start")
        return restarted_state(self.graph, after) if is_started else after

    def is_finished(self) -> bool:
        """Whether the activity ends in this step."""
        return self.old.is_performed and self.is_complete(ACTIVITY_REGION)

    def _is_signalled(self, handshake: Handshake | None, role: str) -> bool:
        name = getattr(handshake, role, "")
        return bool(name and self.inputs[name])

    def move_tokens(self) -> None:
        """Move all tokens that can move, and end and start regions."""
        graph, old = self.graph, self.old
        workers = list(graph.workers())
        finished = self._list_done()
        started = [node for node in workers if self._is_started(node)]
        arrived = [edge for edge in graph.edges if self.arrives(edge)]
        self._check_safety(arrived)
        self.finished = {node.id for node in finished}
        self.tokens = {edge.id for edge in graph.edges if self._holds_after(edge)}
        self.running = set(old.running) - self.finished | {node.id for node in started}
        for node in finished:
            self.clear_region(node.id)
        for edge in arrived:
            if edge.interrupts:
                self._interrupt(edge.interrupts)
        for node in started:
            if node.id in self.running:
                self.start_node(node)

    def start_node(self, node: TokenNode) -> None:
        """Let a node run from the next step on, with what its region starts with."""
        self.running.add(node.id)
        self.begun.add(node.id)
        if node.kind is NodeKind.STRUCTURED:
            start = self.graph.start_all(node.id)
            self.tokens |= start.tokens
            self.running |= start.running
            self.begun |= start.running

    # -- tokens ----------------------------------------------------------------------------

    def is_present(self, edge: TokenEdge) -> bool:
        """Whether the target can take a token from the edge in this step."""
        if edge.id not in self._present:
            arrives = not self.graph.delays(edge) and self.arrives(edge)
            self._present[edge.id] = edge.id in self.old.tokens or arrives
        return self._present[edge.id]

    def has_all(self, edges: Sequence[TokenEdge]) -> bool:
        """Whether there are edges, and their targets can take tokens from all of them."""
        return bool(edges) and all(map(self.is_present, edges))

    def arrives(self, edge: TokenEdge) -> bool:
        """Whether the edge gets a token in this step."""
        return self._is_given(edge) or self._is_listening_triggered(edge)

    def _is_given(self, edge: TokenEdge) -> bool:
        """Whether the source gives the edge a token."""
        source = self.graph.node(edge.source)
        incoming = self.graph.incoming(source)
        if not self._is_alive(source, edge.region):
            return False
        match source.firing:
            case Firing.ANY:
                return any(map(self.is_present, incoming))
            case Firing.ALL:
                return self.has_all(incoming)
            case Firing.CHOICE:
                return self.has_all(incoming) and self._choose_branch(source) is edge
            case Firing.WORK:
                return source.id in self.old.running and self.is_done(source)
            case _:
                return False

    def _is_taken(self, edge: TokenEdge) -> bool:
        """Whether the target takes the token that is present on the edge."""
        target = self.graph.node(edge.target)
        incoming = self.graph.incoming(target)
        if edge.keeps or not self._is_alive(target, edge.region):
            return False
        match target.firing:
            case Firing.ANY | Firing.END:
                return True
            case Firing.NEVER:
                return False
            case Firing.CHOICE:
                return self.has_all(incoming) and self._is_decided(target)
            case Firing.WORK:
                return self._is_started(target)
            case _:
                return self.has_all(incoming)

    def _holds_after(self, edge: TokenEdge) -> bool:
        if not self.graph.delays(edge):
            return self.is_present(edge) and not self._is_taken(edge)
        return self.arrives(edge) or (edge.id in self.old.tokens and not self._is_taken(edge))

    def _is_listening_triggered(self, edge: TokenEdge) -> bool:
        """Whether a listening edge gets a token.

        A token enters the region to which it listens, and its target neither waits nor runs.
        """
        is_waiting = edge.id in self.old.tokens or edge.target in self.old.running
        if not edge.listens or is_waiting or not self._runs_around(edge.region):
            return False
        entering = self.graph.entering(edge.listens)
        return any(self.is_present(enter) and self._is_taken(enter) for enter in entering)

    def _is_started(self, node: TokenNode) -> bool:
        """Whether a node takes its tokens in order to run."""
        if not self.has_all(self.graph.incoming(node)) or not self._runs_around(node.region):
            return False
        is_busy = self.is_busy(node)
        if is_busy and not node.queues and not self._is_aborted(node.region):
            raise NotSafeError(f"{node.label} is started while it runs", node.id)
        return not is_busy

    def _runs_around(self, region: str) -> bool:
        return all(node.id in self.old.running for node in self.graph.regions_around(region))

    def _is_alive(self, node: TokenNode, outer: str) -> bool:
        """Whether all regions around the node run, and no final node ends one inside *outer*."""
        return self._runs_around(node.region) and not any(
            self.reaches_final(around.id) for around in self.graph.nodes_between(node.region, outer)
        )

    def _is_aborted(self, region: str) -> bool:
        """Whether a final node ends the region or one around it, with all the tokens in it."""
        around = (node.id for node in self.graph.regions_around(region))
        return any(map(self.reaches_final, (*around, ACTIVITY_REGION)))

    def _check_safety(self, arrived: Sequence[TokenEdge]) -> None:
        for edge in arrived:
            stays = not self.graph.delays(edge) or not self._is_taken(edge)
            is_second = edge.id in self.old.tokens and stays and not edge.keeps
            if is_second and not self._is_aborted(edge.region):
                raise NotSafeError(f"a second token reaches the flow {edge.label}", edge.id)
        for node in self.graph.nodes:
            if node.firing is not Firing.ANY or all(e.keeps for e in self.graph.outgoing(node)):
                continue
            # Of several flows that interrupt one region in the same step, UML lets only one pass.
            ready = filter(self.is_present, self.graph.incoming(node))
            count = len({edge.interrupts or edge.id for edge in ready})
            if count > 1 and not self._is_aborted(node.region):
                raise NotSafeError(f"two tokens reach {node.label} at once", node.id)

    # -- decisions -------------------------------------------------------------------------

    def _choose_branch(self, node: TokenNode) -> TokenEdge | None:
        """Return the branch that the token at a decision takes, or None if none is open."""
        if node.id not in self._chosen:
            branches = self.list_open_branches(node)
            first = branches[0] if branches else None
            self._chosen[node.id] = first if len(branches) < 2 else self.choose(node, branches)
        return self._chosen[node.id]

    def _is_decided(self, node: TokenNode) -> bool:
        return not self.graph.outgoing(node) or bool(self.list_open_branches(node))

    def list_open_branches(self, node: TokenNode) -> list[TokenEdge]:
        """Return the branches of a decision that a token may take."""
        outgoing = self.graph.outgoing(node)
        guarded = [edge for edge in outgoing if not edge.is_else]
        open_edges = [edge for edge in guarded if self.is_open(edge)]
        return open_edges or [edge for edge in outgoing if edge.is_else]

    def is_open(self, edge: TokenEdge) -> bool:
        """Whether the guard of an edge is true; that of an else edge always is."""
        guard = edge.guard
        return guard is None or guard.condition is None or self.holds(guard.condition, self.inputs)

    # -- ends ------------------------------------------------------------------------------

    def _list_done(self) -> list[TokenNode]:
        runs = (node for node in self.graph.workers() if node.id in self.old.running)
        return [node for node in runs if self.is_done(node)]

    def list_finished(self) -> set[str]:
        """Return the ids of the running nodes that are done; what they write counts."""
        return {node.id for node in self._list_done()}

    def is_busy(self, node: TokenNode) -> bool:
        """Whether a node runs, and goes on after this step."""
        return node.id in self.old.running and not self.is_done(node)

    def is_done(self, node: TokenNode) -> bool:
        """Whether a running node is done in this step."""
        if node.kind is NodeKind.STRUCTURED:
            return self.is_complete(node.id)
        if node.duration is Duration.PULSE or node.done is None:
            return True
        return self.holds(node.done, self.inputs)

    def is_complete(self, region: str) -> bool:
        """Whether a region that runs ends in this step.

        Then a token reaches one of its final nodes, or nothing is left in it after the step.
        """
        if region not in self._complete:
            self._complete[region] = self.reaches_final(region) or not (
                any(map(self._remains, self.graph.members(region)))
                or any(map(self._is_given, self.graph.list_delays(region)))
            )
        return self._complete[region]

    def reaches_final(self, region: str) -> bool:
        """Whether a token at a final node ends the region."""
        return any(map(self.is_present, self.graph.ends(region)))

    def _remains(self, node: TokenNode) -> bool:
        """Whether the node prevents the end of its region.

        It does if it runs after this step, or waits with all tokens from inside its region.
        """
        triggers = self.graph.triggers(node)
        match node.firing:
            case Firing.WORK:
                return self.is_busy(node) or self.has_all(triggers)
            case Firing.ALL:
                return self.has_all(triggers) and not self.has_all(self.graph.incoming(node))
            case Firing.CHOICE:
                moves = not self.graph.can_choose(node) and all(map(self._is_taken, triggers))
                return self.has_all(triggers) and not moves
            case _:
                return False

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

    # -- variables -------------------------------------------------------------------------

    def _stored_values(self) -> Iterator[tuple[str, Literal]]:
        """Yield the values of the variables after the writes of all finished nodes."""
        for store, (name, value) in zip(self.graph.stores, self.old.stored, strict=True):
            if store.follows is not None:
                yield name, self.holds(store.follows, self.inputs)
                continue
            writes = [write for write in store.writes if write.node in self.finished]
            if len(writes) > 1:
                writes = [self.choose(self.graph.node(writes[0].node), writes)]
            yield name, self._written_value(writes[0]) if writes else value

    def _written_value(self, write: Write) -> Literal:
        enabled_values = (
            value for condition, value in write.values if self.holds(condition, self.inputs)
        )
        return evaluate.value_of(next(enabled_values), self.inputs)
