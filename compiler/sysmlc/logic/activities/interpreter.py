"""Reference interpreter of token graphs: plays the game on the diagram, not on formulas.

First the regions that are complete are ended; what is in them does nothing more. All other nodes
then move what they can move, interrupted nodes lose their tokens, and what has been started gets
its first ones.

The interpreter is the judge of the contracts that ``activity_contract`` derives: a run that it
plays must satisfy every conjunct, and a changed run must not.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Protocol, TypeVar

from msgspec import Struct

from sysmlc.logic import domains, evaluate
from sysmlc.logic.activities.token_graph import (
    ACTIVITY_REGION,
    Duration,
    Firing,
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
    """Picks one of several branches of a node, or of the writes of one variable in one step."""

    def __call__(self, node: TokenNode, options: Sequence[_T], /) -> _T:
        """One of the options."""


class NotSafeError(RuntimeError):
    """A second token reached an edge or a merge, or an action was started while it ran."""


class State(Struct, frozen=True):
    """Where the tokens are: ids of the edges that hold one and of the nodes that run; and what
    the variables are that nodes write.
    """

    tokens: frozenset[str]
    running: frozenset[str]
    stored: tuple[tuple[str, Literal], ...] = ()


def first(node: TokenNode, options: Sequence[_T]) -> _T:
    """The first of several open branches."""
    del node
    return options[0]


def start(graph: TokenGraph) -> State:
    """The state in which the activity starts; what nothing gives a value has the least."""
    stored = (
        (
            one.variable.name,
            domains.values(one.variable.domain)[0] if one.first is None else one.first,
        )
        for one in graph.stores
    )
    return State(frozenset(_marked(graph, ACTIVITY_REGION)), frozenset(), tuple(stored))


def _start_again(graph: TokenGraph, old: State) -> State:
    """The state in which the activity starts once more."""
    afresh = {
        one.variable.name: one.first for one in graph.stores if one.local and one.first is not None
    }
    stored = tuple((name, afresh.get(name, value)) for name, value in old.stored)
    return State(frozenset(_marked(graph, ACTIVITY_REGION)), frozenset(), stored)


def values(graph: TokenGraph, state: State) -> dict[str, Literal]:
    """The value of every variable that the state decides."""
    runs: dict[str, Literal] = {node.run: node.id in state.running for node in graph.workers()}
    quiet = {name: is_complete(graph, state, region) for region, name in graph.quiets}
    tokens = {edge.variable: edge.id in state.tokens for edge in graph.edges}
    return runs | tokens | quiet | dict(state.stored)


def state_of(graph: TokenGraph, valuation: Inputs) -> State:
    """The state that decides these values: the inverse of ``values``."""
    return State(
        frozenset(edge.id for edge in graph.edges if valuation[edge.variable]),
        frozenset(node.id for node in graph.workers() if valuation[node.run]),
        tuple((one.variable.name, valuation[one.variable.name]) for one in graph.stores),
    )


def step(
    graph: TokenGraph,
    state: State,
    inputs: Inputs,
    holds: Callable[[Formula, Inputs], bool],
    choose: Choose = first,
) -> State:
    """The state after one step; ``holds`` evaluates a condition on the inputs.

    Raises NotSafeError when the graph is not 1-safe.
    """
    return _Step(graph, state, inputs, holds, choose).play()


def finishes(graph: TokenGraph, state: State) -> bool:
    """Whether the activity ends in this state, so that the next step starts it anew."""
    return is_complete(graph, state, ACTIVITY_REGION)


def is_complete(graph: TokenGraph, state: State, region: str) -> bool:
    """A token is at a final node of the region, or nothing in the region can move."""
    if any(edge.id in state.tokens for edge in graph.ends(region)):
        return True
    return not any(_is_active(graph, state, node) for node in graph.members(region))


def _is_active(graph: TokenGraph, state: State, node: TokenNode) -> bool:
    """The node runs, or it has all tokens that it can get from inside its region."""
    if node.id in state.running:
        return True
    if node.firing is Firing.NEVER:
        return False
    if node.firing in (Firing.ANY, Firing.END):
        return any(edge.id in state.tokens for edge in graph.incoming(node))
    triggers = graph.triggers(node)
    return bool(triggers) and all(edge.id in state.tokens for edge in triggers)


def _marked(graph: TokenGraph, region: str) -> list[str]:
    return [edge.id for edge in graph.edges if edge.marked and edge.region == region]


class _Step:
    """One step: everything looks at ``old``; ``tokens`` and ``running`` become the new state."""

    def __init__(
        self,
        graph: TokenGraph,
        old: State,
        inputs: Inputs,
        holds: Callable[[Formula, Inputs], bool],
        choose: Choose,
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

    def play(self) -> State:
        if finishes(self.graph, self.old):
            return _start_again(self.graph, self.old)
        self.ended = [node for node in self.graph.workers() if self._ends(node)]
        alive = [node for node in self.graph.nodes if self._is_alive(node)]
        # Taking comes before giving: a token may arrive where another has just left.
        gifts = [edge for node in alive for edge in self._fire(node)]
        for edge in gifts:
            self._give(edge)
        for edge in self.graph.edges:
            if edge.listens and self._hears(edge):
                self._give(edge)
        for node in self.ended:
            self._clear_region(node.id)
        for region in self.interrupted:
            self._interrupt(region)
        for node in self.started:
            self._open(node)
        return State(frozenset(self.tokens), frozenset(self.running), tuple(self._stored()))

    def _hears(self, edge: TokenEdge) -> bool:
        """A token enters the region that the edge listens to, and its target does not wait yet."""
        target = self.graph.node(edge.target)
        waits = edge.id in self.old.tokens or edge.target in self.old.running
        coming = any(one.id in self.taken for one in self.graph.entering(edge.listens))
        return coming and not waits and self._is_alive(target)

    def _stored(self) -> Iterator[tuple[str, Literal]]:
        """What the variables are when all nodes that are done have written."""
        for store, (name, value) in zip(self.graph.stores, self.old.stored, strict=True):
            writes = [one for one in store.writes if one.node in self.finished]
            if len(writes) > 1:
                writes = [self.choose(self.graph.node(writes[0].node), writes)]
            yield name, self._written(writes[0]) if writes else value

    def _written(self, write: Write) -> Literal:
        held = (value for when, value in write.values if self.holds(when, self.inputs))
        return evaluate.value_of(next(held), self.inputs)

    def _ends(self, node: TokenNode) -> bool:
        runs = node.kind is NodeKind.STRUCTURED and node.id in self.old.running
        return runs and is_complete(self.graph, self.old, node.id)

    def _is_alive(self, node: TokenNode) -> bool:
        """All regions around it run, and none of them ends in this step."""
        around = list(self.graph.regions_around(node.region))
        return all(one.id in self.old.running and one not in self.ended for one in around)

    def _fire(self, node: TokenNode) -> Sequence[TokenEdge]:
        incoming, outgoing = self.graph.incoming(node), self.graph.outgoing(node)
        ready = [edge for edge in incoming if edge.id in self.old.tokens]
        match node.firing:
            case Firing.ANY if ready:
                self._take(ready)
                self._check_single(node, ready, outgoing)
                return outgoing
            case Firing.ALL if incoming and len(ready) == len(incoming):
                self._take(ready)
                return outgoing
            case Firing.CHOICE if incoming and len(ready) == len(incoming):
                return self._decide(node, ready, outgoing)
            case Firing.WORK:
                return self._work(node, incoming, ready, outgoing)
            case _:
                return ()

    def _check_single(
        self, node: TokenNode, ready: list[TokenEdge], outgoing: list[TokenEdge]
    ) -> None:
        # Of several flows that interrupt one region at once, UML lets one pass.
        apart = {edge.interrupts or edge.id for edge in ready}
        if len(apart) > 1 and any(not edge.keeps for edge in outgoing):
            raise NotSafeError(f"two tokens reach {node.label} at once")

    def _decide(
        self, node: TokenNode, ready: list[TokenEdge], outgoing: list[TokenEdge]
    ) -> Sequence[TokenEdge]:
        branches = self._open_branches(outgoing)
        if outgoing and not branches:
            return ()
        self._take(ready)
        if not outgoing:
            return ()
        return (branches[0] if len(branches) == 1 else self.choose(node, branches),)

    def _open_branches(self, outgoing: list[TokenEdge]) -> list[TokenEdge]:
        stated = [edge for edge in outgoing if not edge.is_else]
        true = [edge for edge in stated if self._is_open(edge)]
        return true or [edge for edge in outgoing if edge.is_else]

    def _is_open(self, edge: TokenEdge) -> bool:
        guard = edge.guard
        return guard is None or guard.condition is None or self.holds(guard.condition, self.inputs)

    def _work(
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
            self._take(ready)
            self.running.add(node.id)
            self.started.append(node)
        if not is_running or not self._is_done(node):
            return ()
        self.running.discard(node.id)
        self.finished.add(node.id)
        return outgoing

    def _is_done(self, node: TokenNode) -> bool:
        if node.kind is NodeKind.STRUCTURED:
            return node in self.ended
        if node.duration is Duration.PULSE or node.done is None:
            return True
        return self.holds(node.done, self.inputs)

    def _take(self, edges: Sequence[TokenEdge]) -> None:
        taken = [edge.id for edge in edges if not edge.keeps]
        self.tokens.difference_update(taken)
        self.taken.update(taken)

    def _give(self, edge: TokenEdge) -> None:
        if edge.id in self.tokens and not edge.keeps:
            raise NotSafeError(f"a second token reaches the flow {edge.label}")
        self.tokens.add(edge.id)
        if edge.interrupts:
            self.interrupted.append(edge.interrupts)

    def _open(self, node: TokenNode) -> None:
        if node.kind is NodeKind.STRUCTURED and node.id in self.running:
            self.tokens.update(_marked(self.graph, node.id))

    def _clear_region(self, region: str) -> None:
        edges, nodes = self.graph.inside(region)
        self.tokens.difference_update(edge.id for edge in edges)
        self._stop(nodes)

    def _interrupt(self, region: str) -> None:
        found = next(r for r in self.graph.interruptibles if r.id == region)
        members = frozenset(found.nodes)
        self.tokens.difference_update(
            edge.id for edge in self.graph.edges if {edge.source, edge.target} <= members
        )
        self._stop([node for node in self.graph.workers() if node.id in members])

    def _stop(self, nodes: Sequence[TokenNode]) -> None:
        for node in nodes:
            self.running.discard(node.id)
            if node.kind is NodeKind.STRUCTURED:
                self._clear_region(node.id)
