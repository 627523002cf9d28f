"""A state machine as values: what the derivation and the interpreter both start from.

It says what is drawn, with names for variables; it does not say what a step is.
"""

from msgspec import Struct, field

from sysmlc.logic.contract import Variable
from sysmlc.logic.expressions.elaborate import Scope
from sysmlc.logic.expressions.expression import Expression
from sysmlc.logic.formula import Literal

NO_EVENT = "none"
"""Literal of ``event`` when nothing happens, and of a choice that was not made."""
INACTIVE = "inactive"
"""Literal of an inner region whose state is not active."""
HISTORIES = ("shallow-history", "deep-history")
_WITHIN = "\x1f"
"""Between the id of a submachine state and ids of what it has of its submachine."""


def id_within(state: str, id: str) -> str:
    """The id that an element of a submachine has within a state that is such a submachine."""
    return f"{state}{_WITHIN}{id}" if state else id


def element_id(id: str) -> str:
    """The id of the element that is drawn, of a vertex, region or transition."""
    return id.rpartition(_WITHIN)[2]


class Assign(Struct, frozen=True):
    """An assignment to a property of the context."""

    variable: str
    value: Expression
    origin: str


class Raise(Struct, frozen=True):
    """Something done that has no meaning in the model: an output proposition."""

    output: str
    origin: str


Action = Assign | Raise


class OnEvent(Struct, frozen=True):
    """The environment's event; None stands for any event."""

    literal: str | None


class AfterTicks(Struct, frozen=True):
    """The source has been active for this many steps."""

    count: int


class OnRise(Struct, frozen=True):
    """A condition that was false in the step before is true; ``memory`` holds what it was."""

    memory: str
    condition: Expression


class WhenTold(Struct, frozen=True):
    """An occurrence that only the environment knows, as a Boolean input."""

    variable: str


Occurrence = OnEvent | AfterTicks | OnRise | WhenTold


class Transition(Struct, frozen=True):
    """A transition; without occurrences it is a completion transition (of a state).

    ``also`` are the other transitions that lead to the join that it leads to: they are taken
    together, when all their sources are complete.
    """

    id: str
    literal: str
    words: str
    source: str
    target: str
    kind: str
    occurrences: tuple[Occurrence, ...]
    guard: Expression | None
    effect: tuple[Action, ...]
    also: tuple["Transition", ...] = ()

    @property
    def sources(self) -> tuple[str, ...]:
        """The vertices that it leaves."""
        return self.source, *(one.source for one in self.also)


class Vertex(Struct, frozen=True):
    """A state, final state or pseudostate.

    ``do`` is the output that holds while the state is active, ``done`` the input that says
    its end; ``timer`` counts the steps that the state has been active; ``pick`` says which of
    several enabled outgoing transitions was taken. Empty names: there is no such variable.
    ``border`` is the state that an entry or exit point belongs to.
    """

    id: str
    kind: str
    literal: str
    region: str
    regions: tuple[str, ...] = ()
    entry: tuple[Action, ...] = ()
    exit: tuple[Action, ...] = ()
    do: str = ""
    done: str = ""
    timer: str = ""
    pick: str = ""
    border: str = ""

    @property
    def is_stable(self) -> bool:
        """Whether a step may end in it."""
        return self.kind in ("state", "final")


class Region(Struct, frozen=True):
    """A region: its variable has the names of its states, and ``inactive`` when it is nested.

    ``memory`` is the variable that has what it was before it became inactive, where history is
    asked for.
    """

    id: str
    variable: str
    state: str
    """The state that owns it, or empty for a region of the machine."""
    initial: str
    vertices: tuple[str, ...]
    memory: str = ""


class Machine(Struct, frozen=True):
    """A state machine in its context."""

    id: str
    name: str
    variables: tuple[Variable, ...]
    vertices: dict[str, Vertex]
    regions: dict[str, Region]
    outgoing: dict[str, tuple[Transition, ...]]
    top: tuple[str, ...]
    scope: Scope
    initial: dict[str, Literal] = field(default_factory=dict)
    """Initial values of the properties that the machine assigns, where they have one."""
    outputs: tuple[str, ...] = ()
    assigned: tuple[str, ...] = ()
    memories: dict[str, Expression] = field(default_factory=dict)

    def variable(self, name: str) -> Variable:
        """The variable of this name."""
        return next(one for one in self.variables if one.name == name)

    def states(self) -> list[Vertex]:
        """All states, in order."""
        return [one for one in self.vertices.values() if one.kind == "state"]

    def transitions(self) -> list[Transition]:
        """All transitions, source by source."""
        return [one for group in self.outgoing.values() for one in group]

    def above(self, vertex: str) -> list[str]:
        """The states that contain the vertex, innermost first; also those on whose border it is."""
        one = self.vertices[vertex]
        found = [one.border] if one.border else []
        region = one.region
        while region and self.regions[region].state:
            found.append(self.regions[region].state)
            region = self.vertices[found[-1]].region
        return found

    def contains(self, state: str, vertex: str) -> bool:
        """Whether the vertex lies strictly inside the state."""
        return bool(self.vertices[state].regions) and state in self.above(vertex)

    def around(self, vertex: str) -> list[str]:
        """The regions that contain the vertex, innermost first."""
        found = [self.vertices[one].region for one in [vertex, *self.above(vertex)]]
        return list(dict.fromkeys(found))

    def is_split(self, vertex: str) -> bool:
        """Whether all transitions that leave it are taken together, into regions of their own.

        Those of a fork, and of an entry point of an orthogonal state (UML 2.5.1, 14.2.3.7).
        """
        one, outgoing = self.vertices[vertex], self.outgoing.get(vertex, ())
        if one.kind == "entry-point" and len(outgoing) > 1:
            own = self.vertices[one.border].regions if one.border else ()
            into = [
                region for each in outgoing for region in self.around(each.target) if region in own
            ]
            return len(set(into)) == len(outgoing)
        return one.kind == "fork"

    def main_region(self, one: Transition) -> str | None:
        """The region that a transition changes: what is active in it is left, then the way to
        the target is entered. Empty for an internal transition, None when there is none.

        UML 2.5.1 clauses 14.2.3.8.1 and 14.2.3.9.5: the least region that contains source and
        target; a local transition to inside its source does not leave the source. An exit point
        is reached without leaving its state, an entry point when its state is entered.
        """
        if one.kind == "internal":
            return ""
        start, end = self.vertices[one.source], self.vertices[one.target]
        if start.region == end.region and not start.border and not end.border:
            return start.region
        around, inside = self.around(one.source), self.around(one.target)
        if start.kind == "entry-point" and start.border:
            own = self.vertices[start.border].regions
            return next((region for region in inside if region in own), None)
        if end.kind == "exit-point" and end.border in self.above(one.source):
            own = self.vertices[end.border].regions
            return next((region for region in around if region in own), None)
        if one.kind == "local" and self.contains(one.source, one.target):
            return next(region for region in inside if region in start.regions)
        return next((region for region in around if region in inside), None)
