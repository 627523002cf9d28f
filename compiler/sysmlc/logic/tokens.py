"""Token graphs: activities as 1-safe token games, one Boolean an edge, as frozen values.

A token graph is what the pass ``activities`` makes of an activity diagram (UML 2.5.1, clauses 15
and 16; fUML 1.5, clause 8). Contracts, the reference interpreter and back ends read it.

One step of the game moves every token that can move by one node: each node looks at the edges as
they are at the start of the step. What the kinds of nodes do with tokens is in ``FIRING``.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

from sysmlc.logic.contract import Variable
from sysmlc.logic.formula import Formula

ACTIVITY_REGION = ""
"""The region of what no structured node owns."""


class NodeKind(StrEnum):
    """What a node is, in UML's words; object nodes and pins that only pass tokens are merges."""

    INITIAL = "initial"
    ACTION = "action"
    STRUCTURED = "structured"
    FORK = "fork"
    JOIN = "join"
    MERGE = "merge"
    DECISION = "decision"
    SINK = "sink"
    FLOW_FINAL = "flow-final"
    ACTIVITY_FINAL = "final"


class Firing(StrEnum):
    """How a node moves tokens in one step."""

    NEVER = "never"
    """It only names where tokens are at the start of its region."""
    ALL = "all"
    """It takes a token from every incoming edge and gives one to every outgoing edge."""
    ANY = "any"
    """It takes the tokens of all marked incoming edges and gives one to its outgoing edge."""
    CHOICE = "choice"
    """It waits for all incoming edges and gives one token to one edge whose guard is open."""
    WORK = "work"
    """It starts as ALL does; when it is done, it gives a token to every outgoing edge."""
    END = "end"
    """A token that reaches it ends the region."""


class Duration(StrEnum):
    """How long an action runs."""

    TIMED = "timed"
    """Until the environment says that it is done."""
    PULSE = "pulse"
    """One step: what it does is seen from outside (a signal is sent, a value is written)."""
    SILENT = "silent"
    """No time, and nothing to be seen: it reads or computes a value."""


FIRING: dict[NodeKind, Firing] = {
    NodeKind.INITIAL: Firing.NEVER,
    NodeKind.ACTION: Firing.WORK,
    NodeKind.STRUCTURED: Firing.WORK,
    NodeKind.FORK: Firing.ALL,
    NodeKind.JOIN: Firing.ALL,
    NodeKind.MERGE: Firing.ANY,
    NodeKind.DECISION: Firing.CHOICE,
    NodeKind.SINK: Firing.ANY,
    NodeKind.FLOW_FINAL: Firing.ANY,
    NodeKind.ACTIVITY_FINAL: Firing.END,
}


@dataclass(frozen=True, slots=True)
class Guard:
    """Guard of an edge that leaves a decision; ``condition`` is None for else."""

    text: str
    condition: Formula | None


@dataclass(frozen=True, slots=True)
class TokenNode:
    """One node; ``label`` is what the modeller calls it ("action 'read id'").

    ``region`` is the id of the structured node that owns it. ``run`` is the variable that says
    that it runs, ``done`` the condition on inputs that ends a timed action. ``exclusive`` is true
    of a decision whose guards never hold together, ``exhaustive`` when one of them always holds.
    """

    id: str
    kind: NodeKind
    label: str
    origin: str
    region: str = ACTIVITY_REGION
    duration: Duration = Duration.TIMED
    run: str = ""
    done: Formula | None = None
    exclusive: bool = False
    exhaustive: bool = False

    @property
    def firing(self) -> Firing:
        """How it moves tokens."""
        if self.kind is NodeKind.ACTION and self.duration is Duration.SILENT:
            return Firing.ALL
        return FIRING[self.kind]


@dataclass(frozen=True, slots=True)
class TokenEdge:
    """One edge and the variable that says whether it holds a token.

    ``origins`` are the ids of the drawn flows that it stands for, several after a collapse.
    ``marked`` edges hold a token when their region starts. ``interrupts`` is the id of the
    interruptible region that loses its tokens when a token enters this edge.
    """

    id: str
    variable: str
    label: str
    source: str
    target: str
    origins: tuple[str, ...]
    region: str = ACTIVITY_REGION
    marked: bool = False
    guard: Guard | None = None
    interrupts: str = ""

    @property
    def origin(self) -> str:
        """The first drawn flow that it stands for."""
        return self.origins[0]


@dataclass(frozen=True, slots=True)
class Interruptible:
    """An interruptible activity region and the ids of its nodes."""

    id: str
    label: str
    nodes: tuple[str, ...]


@dataclass(frozen=True)
class TokenGraph:
    """One activity as a token game; nodes and edges in the order of the model.

    ``inputs`` are the variables that the environment decides. ``pulses`` names those that stand
    for an event or the end of an action; the others keep their value until they are changed.
    ``finishes`` is false when no run can end.
    """

    activity: str
    component: str
    label: str
    nodes: tuple[TokenNode, ...]
    edges: tuple[TokenEdge, ...]
    inputs: tuple[Variable, ...] = ()
    pulses: tuple[str, ...] = ()
    interruptibles: tuple[Interruptible, ...] = ()
    finishes: bool = True

    @cached_property
    def _nodes(self) -> dict[str, TokenNode]:
        return {node.id: node for node in self.nodes}

    @cached_property
    def _incoming(self) -> dict[str, list[TokenEdge]]:
        return self._index("target")

    @cached_property
    def _outgoing(self) -> dict[str, list[TokenEdge]]:
        return self._index("source")

    def _index(self, end: str) -> dict[str, list[TokenEdge]]:
        found: dict[str, list[TokenEdge]] = {node.id: [] for node in self.nodes}
        for edge in self.edges:
            found[getattr(edge, end)].append(edge)
        return found

    def node(self, id: str) -> TokenNode:
        """The node with this id; KeyError when there is none."""
        return self._nodes[id]

    def incoming(self, node: TokenNode) -> list[TokenEdge]:
        """Edges that reach the node, in order."""
        return self._incoming[node.id]

    def outgoing(self, node: TokenNode) -> list[TokenEdge]:
        """Edges that leave the node, in order."""
        return self._outgoing[node.id]

    def workers(self) -> Iterator[TokenNode]:
        """Nodes that run for a while and have a variable for it."""
        return (node for node in self.nodes if node.firing is Firing.WORK)

    def inside(self, region: str) -> tuple[list[TokenEdge], list[TokenNode]]:
        """Edges and running nodes directly in a region."""
        edges = [edge for edge in self.edges if edge.region == region]
        return edges, [node for node in self.workers() if node.region == region]

    def regions_around(self, region: str) -> Iterator[TokenNode]:
        """The structured node of the region and those around it, innermost first."""
        while region != ACTIVITY_REGION:
            node = self._nodes[region]
            yield node
            region = node.region

    def can_empty(self, region: str) -> bool:
        """Whether the region may end because no token is left in it.

        Not when every node passes its tokens on to the final node.
        """
        if not self.ends(region) or not any(e.marked for e in self.edges if e.region == region):
            return True
        return any(
            not self._outgoing[node.id]
            for node in self.nodes
            if node.region == region and node.firing not in (Firing.END, Firing.NEVER)
        )

    def ends(self, region: str) -> list[TokenEdge]:
        """Edges whose token ends the region."""
        return [
            edge
            for node in self.nodes
            if node.firing is Firing.END and node.region == region
            for edge in self._incoming[node.id]
        ]
