"""A state machine as values: what the derivation and the interpreter both start from.

It says what is drawn, with names for variables; it does not say what a step is.
"""

from dataclasses import field

from sysmlc.logic.contract import Variable
from sysmlc.logic.expressions.elaborate import Scope
from sysmlc.logic.expressions.expression import Expression
from sysmlc.logic.formula import Literal
from sysmlc.values import dataclass

NO_EVENT = "none"
"""Literal of ``event`` when nothing happens, and of a choice that was not made."""
INACTIVE = "inactive"
"""Literal of an inner region whose state is not active."""


@dataclass(frozen=True, slots=True)
class Assign:
    """An assignment to a property of the context."""

    variable: str
    value: Expression
    origin: str


@dataclass(frozen=True, slots=True)
class Raise:
    """Something done that has no meaning in the model: an output proposition."""

    output: str
    origin: str


Action = Assign | Raise


@dataclass(frozen=True, slots=True)
class OnEvent:
    """The environment's event; None stands for any event."""

    literal: str | None


@dataclass(frozen=True, slots=True)
class AfterTicks:
    """The source has been active for this many steps."""

    count: int


@dataclass(frozen=True, slots=True)
class OnRise:
    """A condition that was false in the step before is true; ``memory`` holds what it was."""

    memory: str
    condition: Expression


@dataclass(frozen=True, slots=True)
class WhenTold:
    """An occurrence that only the environment knows, as a Boolean input."""

    variable: str


Occurrence = OnEvent | AfterTicks | OnRise | WhenTold


@dataclass(frozen=True, slots=True)
class Transition:
    """A transition; without occurrences it is a completion transition (of a state)."""

    id: str
    literal: str
    words: str
    source: str
    target: str
    kind: str
    occurrences: tuple[Occurrence, ...]
    guard: Expression | None
    effect: tuple[Action, ...]


@dataclass(frozen=True, slots=True)
class Vertex:
    """A state, final state or pseudostate.

    ``do`` is the output that holds while the state is active, ``done`` the input that says
    its end; ``timer`` counts the steps that the state has been active; ``pick`` says which of
    several enabled outgoing transitions was taken. Empty names: there is no such variable.
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

    @property
    def is_stable(self) -> bool:
        """Whether a step may end in it."""
        return self.kind in ("state", "final")


@dataclass(frozen=True, slots=True)
class Region:
    """A region: its variable has the names of its states, and ``inactive`` when it is nested."""

    id: str
    variable: str
    state: str
    """The state that owns it, or empty for a region of the machine."""
    initial: str
    vertices: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Machine:
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
        """The states that contain the vertex, innermost first."""
        found: list[str] = []
        region = self.vertices[vertex].region
        while region and self.regions[region].state:
            found.append(self.regions[region].state)
            region = self.vertices[found[-1]].region
        return found

    def contains(self, state: str, vertex: str) -> bool:
        """Whether the vertex lies strictly inside the state."""
        return bool(self.vertices[state].regions) and state in self.above(vertex)

    def main_region(self, source: str, target: str, kind: str) -> str:
        """The region that a transition changes: what is active in it is left, then the target
        is entered. Empty for an internal transition.

        UML 2.5.1 clauses 14.2.3.8.1 and 14.2.3.9.5: the least region that contains source and
        target; a local transition to inside its source does not leave the source.
        """
        if kind == "internal":
            return ""
        inside = [self.vertices[one].region for one in [target, *self.above(target)]]
        if kind == "local" and self.contains(source, target):
            own = self.vertices[source].regions
            return next(region for region in inside if region in own)
        around = [self.vertices[one].region for one in [source, *self.above(source)]]
        return next(region for region in around if region in inside)
