"""Nodes, edges and variables of token graphs."""

from enum import StrEnum

from msgspec import Struct

from sysmlc.logic.contract import Variable
from sysmlc.logic.formula import Formula, Literal

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
    """It moves no tokens: it marks the edges that have a token when its region starts."""
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
    while it runs, ``done`` the condition on inputs that ends a timed action. ``awaited`` says
    what ends an accept action ("Go comes"); it is empty if time does. ``exclusive`` is true for a
    decision whose guards never hold together, ``exhaustive`` if one of them always holds.
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
    awaited: str = ""
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
    to it each time the activity starts. A variable that ``follows`` a condition has no writes: it
    tells in each step whether the condition held in the step before, also while nothing runs.
    """

    variable: Variable
    writes: tuple[Write, ...]
    first: Literal | None = None
    local: bool = False
    follows: Formula | None = None


class Handshake(Struct, frozen=True):
    """Variables that start and abandon an activity, and that report that it runs and ends.

    ``start`` and ``stop`` are inputs: an activity without the first is never started from outside,
    one without the second always runs to its end. An activity that ``is_started`` runs in the first
    step.
    """

    running: str
    finished: str
    start: str = ""
    stop: str = ""
    is_started: bool = False


class RegionStart(Struct, frozen=True):
    """What a region has when it starts: ids of edges with tokens, and of nodes that run.

    ``moved`` are the nodes that have taken tokens before the first step.
    """

    tokens: frozenset[str] = frozenset()
    running: frozenset[str] = frozenset()
    moved: frozenset[str] = frozenset()


NO_START = RegionStart()
"""Nothing runs, and there is no token."""
