"""Token graphs: activities as 1-safe token games with one Boolean for each edge.

The pass ``activities`` derives a token graph from an activity diagram (UML 2.5.1, clauses 15 and
16; fUML 1.5, clause 8). Contracts, the reference interpreter and back ends read it.

In one step of the game, every token that can move passes one node; each node reads the edges as
they are at the start of the step. ``FIRING`` states what each kind of node does with tokens.

A region is the content of a structured node, or of the activity. An edge belongs to the innermost
region that contains both of its ends. A node moves tokens only while its region runs; a token for a
node in a region that does not run waits on its edge. A region is complete when a token is at one of
its final nodes, or when nothing in it can move.
"""

from collections.abc import Iterator
from enum import StrEnum
from functools import cached_property

from msgspec import Struct

from sysmlc.logic.contract import Variable
from sysmlc.logic.formula import Formula, Literal, variables

ACTIVITY_REGION = ""
"""The region of nodes and edges that are in no structured node."""


class NodeKind(StrEnum):
    """Kind of a node in UML's words; an object node or pin that only passes tokens is a merge."""

    INITIAL = "initial"
    ACTION = "action"
    STRUCTURED = "structured"
    FORK = "fork"
    JOIN = "join"
    MERGE = "merge"
    DECISION = "decision"
    DATA_STORE = "data-store"
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
    """It takes the tokens of all marked incoming edges and gives one to every outgoing edge."""
    CHOICE = "choice"
    """It waits for all incoming edges and gives one token to one edge whose guard is open."""
    WORK = "work"
    """It starts as ALL does; when it is done, it gives a token to every outgoing edge."""
    END = "end"
    """A token that reaches it ends the region."""


class Duration(StrEnum):
    """How long an action runs."""

    TIMED = "timed"
    """Until the environment ends it."""
    PULSE = "pulse"
    """One step, because its effect is visible outside: it sends a signal or writes a value."""
    SILENT = "silent"
    """No time, because it has no visible effect: it reads or computes a value."""


FIRING: dict[NodeKind, Firing] = {
    NodeKind.INITIAL: Firing.NEVER,
    NodeKind.ACTION: Firing.WORK,
    NodeKind.STRUCTURED: Firing.WORK,
    NodeKind.FORK: Firing.ALL,
    NodeKind.JOIN: Firing.ALL,
    NodeKind.MERGE: Firing.ANY,
    NodeKind.DECISION: Firing.CHOICE,
    NodeKind.DATA_STORE: Firing.ANY,
    NodeKind.SINK: Firing.ANY,
    NodeKind.FLOW_FINAL: Firing.ANY,
    NodeKind.ACTIVITY_FINAL: Firing.END,
}


_ACTION, _SILENT, _ALL, _WORK = NodeKind.ACTION, Duration.SILENT, Firing.ALL, Firing.WORK
# Module-level names: in Python 3.11, looking up a member of an enumeration takes twice as long.


class Guard(Struct, frozen=True):
    """Guard of an edge that leaves a decision; ``condition`` is None for else."""

    text: str
    condition: Formula | None


class TokenNode(Struct, frozen=True):
    """One node; ``label`` is the name that diagnostics use ("action 'read id'").

    ``region`` is the id of the structured node that owns it. ``run`` is the variable that is true
    while it runs, ``done`` the condition on inputs that ends a timed action. ``exclusive`` is true
    for a decision whose guards never hold together, ``exhaustive`` if one of them always holds.
    ``queues`` is true for an action that may receive tokens while it runs; they wait until it is
    done (UML 2.5.1, 16.2.3: no action is locally reentrant unless it says so).
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
    queues: bool = False

    @property
    def firing(self) -> Firing:
        """How the node moves tokens."""
        return _ALL if self.duration is _SILENT and self.kind is _ACTION else FIRING[self.kind]


class TokenEdge(Struct, frozen=True):
    """One edge and the variable that is true while it holds a token.

    ``origins`` are the ids of the drawn flows that the edge stands for, several after a collapse. A
    ``marked`` edge holds a token when its region starts. ``interrupts`` is the id of the
    interruptible region that loses its tokens when a token enters this edge. A ``keeps`` edge
    leaves a data store: its token stays when it is taken. An edge that ``listens`` to an
    interruptible region (its id) gets a token when one enters the region, unless its target holds a
    token or runs: this enables accept actions without incoming flows (UML 2.5.1, 15.6.3).
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
    keeps: bool = False
    listens: str = ""

    @property
    def origin(self) -> str:
        """The first drawn flow that the edge stands for."""
        return self.origins[0]

    @property
    def is_else(self) -> bool:
        """Whether the edge is taken when no other branch of its decision is open."""
        return self.guard is not None and self.guard.condition is None


class Interruptible(Struct, frozen=True):
    """Nodes (ids) that lose their tokens together.

    Such a group is an interruptible activity region, the nodes that an exception ends, or the nodes
    that a loop restarts in each round.
    """

    id: str
    label: str
    nodes: tuple[str, ...]


class Write(Struct, frozen=True):
    """A write of a variable when a node is done.

    ``values`` are pairs of a condition and the value written under it, both over the values at that
    time; exactly one of the conditions holds. Under a condition in ``stops`` the value is clamped
    to a bound of the range. ``text`` is the value as the modeller writes it, empty if earlier
    assignments are substituted into it.
    """

    node: str
    text: str
    values: tuple[tuple[Formula, Formula], ...]
    stops: tuple[Formula, ...] = ()


class Store(Struct, frozen=True):
    """A variable that the activity decides: it keeps its value until a node writes another.

    ``first`` is its initial value, or None if the model gives none. A ``local`` variable is reset
    to it each time the activity starts.
    """

    variable: Variable
    writes: tuple[Write, ...]
    first: Literal | None = None
    local: bool = False


class Handshake(Struct, frozen=True):
    """Variables with which an activity is started and abandoned, and tells that it runs and ends.

    ``start`` and ``stop`` are inputs: an activity without the first is never started from outside,
    one without the second always runs to its end. An activity that ``is_started`` runs in the first
    step.
    """

    running: str
    finished: str
    start: str = ""
    stop: str = ""
    is_started: bool = False


class TokenGraph(Struct, frozen=True, dict=True):
    """One activity as a token game; nodes and edges are in the order of the model.

    ``inputs`` are the variables that the environment decides. ``pulses`` names those that stand for
    an event or the end of an action; the others keep their value until they change. ``finishes`` is
    false if no run can end. ``rests`` are the regions that can be complete without a token at a
    final node (None: any of them). ``quiets`` are pairs of a region and the variable that is true
    when it is complete: formulas that would repeat a long condition refer to the variable.
    ``stores`` are the variables that nodes write. ``shared`` are variables that nodes write but
    that the activity alone does not decide: other behaviours write them, too, or they are features
    of parts; ``shared_inputs`` are further variables that these writes read. An activity without
    ``handshake`` starts in the first step, and again after each end.
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
    rests: frozenset[str] | None = None
    quiets: tuple[tuple[str, str], ...] = ()
    stores: tuple[Store, ...] = ()
    shared: tuple[Store, ...] = ()
    shared_inputs: tuple[Variable, ...] = ()
    handshake: Handshake | None = None

    @cached_property
    def written_variables(self) -> frozenset[str]:
        """Names of the variables that nodes of the activity write."""
        return frozenset(store.variable.name for store in self.stores)

    def is_decided_outside(self, formula: Formula) -> bool:
        """Whether the condition reads an input."""
        return any(variable.name not in self.written_variables for variable in variables(formula))

    def is_decided_inside(self, formula: Formula) -> bool:
        """Whether the condition reads variables, all of which the activity writes."""
        return bool(variables(formula)) and not self.is_decided_outside(formula)

    @cached_property
    def _nodes(self) -> dict[str, TokenNode]:
        return {node.id: node for node in self.nodes}

    @cached_property
    def _incoming(self) -> dict[str, list[TokenEdge]]:
        edges: dict[str, list[TokenEdge]] = {node.id: [] for node in self.nodes}
        for edge in self.edges:
            edges[edge.target].append(edge)
        return edges

    @cached_property
    def _outgoing(self) -> dict[str, list[TokenEdge]]:
        edges: dict[str, list[TokenEdge]] = {node.id: [] for node in self.nodes}
        for edge in self.edges:
            edges[edge.source].append(edge)
        return edges

    def node(self, id: str) -> TokenNode:
        """Return the node with this id. Raises KeyError."""
        return self._nodes[id]

    def incoming(self, node: TokenNode) -> list[TokenEdge]:
        """Return the edges that reach the node, in order."""
        return self._incoming[node.id]

    def outgoing(self, node: TokenNode) -> list[TokenEdge]:
        """Return the edges that leave the node, in order."""
        return self._outgoing[node.id]

    def workers(self) -> Iterator[TokenNode]:
        """Iterate over the nodes that run for some steps and have a variable for that."""
        return (node for node in self.nodes if node.firing is _WORK)

    @cached_property
    def _inside(self) -> dict[str, tuple[list[TokenEdge], list[TokenNode]]]:
        content: dict[str, tuple[list[TokenEdge], list[TokenNode]]] = {}
        for edge in self.edges:
            content.setdefault(edge.region, ([], []))[0].append(edge)
        for node in self.workers():
            content.setdefault(node.region, ([], []))[1].append(node)
        return content

    def inside(self, region: str) -> tuple[list[TokenEdge], list[TokenNode]]:
        """Return the edges and running nodes directly in a region."""
        return self._inside.get(region, ([], []))

    def regions(self) -> Iterator[str]:
        """Yield the region of the activity and that of every structured node."""
        yield ACTIVITY_REGION
        yield from (node.id for node in self.nodes if node.kind is NodeKind.STRUCTURED)

    def entering(self, interruptible: str) -> list[TokenEdge]:
        """Return the edges by which tokens enter an interruptible region, also from its start."""
        region = next(region for region in self.interruptibles if region.id == interruptible)
        members = frozenset(region.nodes)
        return [
            edge
            for edge in self.edges
            if edge.target in members
            and not edge.keeps
            and (edge.source not in members or self._nodes[edge.source].kind is NodeKind.INITIAL)
        ]

    def enters(self, edge: TokenEdge) -> bool:
        """Return whether the edge leads into a region from outside."""
        return self._nodes[edge.target].region != edge.region

    def is_entered_from_outside(self, node: TokenNode) -> bool:
        """Whether an edge from outside its region leads to the node."""
        return any(map(self.enters, self._incoming[node.id]))

    @property
    def takes_time(self) -> bool:
        """Whether an action lasts until something else ends it: the environment, or what it calls.

        The others assign, send and compute.
        """
        return any(
            node.kind is NodeKind.ACTION and node.duration is Duration.TIMED
            for node in self.workers()
        )

    def triggers(self, node: TokenNode) -> list[TokenEdge]:
        """Return the edges that prevent the completion of the region while all hold a token.

        These are the edges from inside the region, if the node has any: it then waits for the
        tokens from outside (docs/decisions/0013).
        """
        incoming = self._incoming[node.id]
        return [edge for edge in incoming if edge.region == node.region] or incoming

    @cached_property
    def _members(self) -> dict[str, list[TokenNode]]:
        members: dict[str, list[TokenNode]] = {}
        for node in self.nodes:
            members.setdefault(node.region, []).append(node)
        return members

    def members(self, region: str) -> list[TokenNode]:
        """Return the nodes directly in a region."""
        return self._members.get(region, [])

    def regions_around(self, region: str) -> Iterator[TokenNode]:
        """Yield the structured node of the region and those around it, innermost first."""
        while region != ACTIVITY_REGION:
            node = self._nodes[region]
            yield node
            region = node.region

    def nodes_between(self, inner: str, outer: str) -> Iterator[TokenNode]:
        """Yield the structured nodes from region *inner* up to, not including, region *outer*."""
        for node in self.regions_around(inner):
            if node.id == outer:
                return
            yield node

    def can_rest(self, region: str) -> bool:
        """Whether the region can be complete without a token at a final node."""
        return self.rests is None or region in self.rests

    def ends(self, region: str) -> list[TokenEdge]:
        """Return the edges whose token ends the region."""
        return [
            edge
            for node in self.members(region)
            if node.firing is Firing.END
            for edge in self._incoming[node.id]
        ]
