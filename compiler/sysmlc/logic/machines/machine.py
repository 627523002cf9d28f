"""A state machine as plain values, the common input of the derivation and the interpreter.

The values describe the diagram and name the variables of the contract. ``interpreter`` defines the
meaning of a step.
"""

from collections.abc import Collection, Iterable, Iterator

from msgspec import Struct, field
from msgspec.structs import replace

from sysmlc.ir.expressions import Expression
from sysmlc.ir.expressions import Literal as LiteralExpression
from sysmlc.logic.contract import BooleanDomain, Owner, Variable
from sysmlc.logic.expressions.symbols import Scope
from sysmlc.logic.formula import Literal

NO_EVENT = "none"
"""Literal of ``event`` in a step without event, and of a choice variable without choice."""
INACTIVE = "inactive"
"""Literal of the variable of an inner region while its owner, a state, is inactive."""
HISTORIES = ("shallow-history", "deep-history")
_SUBMACHINE_SEPARATOR = "\x1f"
"""Separates the id of a submachine state from the id of an element of the submachine."""


def submachine_id(state: str, id: str) -> str:
    """Return the id of the copy of element *id* in the submachine state *state*.

    Each submachine state has its own copy of the elements of its submachine. An empty *state*
    means the machine itself.
    """
    return f"{state}{_SUBMACHINE_SEPARATOR}{id}" if state else id


def element_id(id: str) -> str:
    """Return the id of the drawn element behind the id of a vertex, region or transition."""
    return id.rpartition(_SUBMACHINE_SEPARATOR)[2]


class Assign(Struct, frozen=True):
    """An assignment to a property of the context."""

    variable: str
    value: Expression
    origin: str


class Raise(Struct, frozen=True):
    """An action other than an assignment, represented by an output that is true when it is done."""

    output: str
    origin: str


Action = Assign | Raise


class OnEvent(Struct, frozen=True):
    """An event of the environment; None matches any event."""

    literal: str | None


class AfterTicks(Struct, frozen=True):
    """The source has been active for this many steps."""

    count: int


class Memory(Struct, frozen=True):
    """What a variable remembers: whether *condition* was true in the previous step.

    With a *state* it remembers this only while the state remains active: the variable is false in
    the first step of each stay in the state.
    """

    condition: Expression
    state: str = ""


class OnChange(Struct, frozen=True):
    """A condition is true, and the variable ``memory`` does not remember it from the step before.

    An *immediate* change trigger of SysML v2 fires in the first step of its source, too. It has
    no memory ("") if every step in which the condition is true leaves the source.
    """

    memory: str
    condition: Expression
    is_immediate: bool = False


class OnInput(Struct, frozen=True):
    """An occurrence that the environment reports by a Boolean input."""

    variable: str


Occurrence = OnEvent | AfterTicks | OnChange | OnInput


class Transition(Struct, frozen=True):
    """A transition; without occurrences, a transition from a state is a completion transition.

    ``literal`` is its value of the choice variable, ``words`` its description for diagnostics.
    ``join_partners`` are the other transitions that lead to the same join. All of them are taken
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
    join_partners: tuple["Transition", ...] = ()

    @property
    def sources(self) -> tuple[str, ...]:
        """The vertices that the transition and its join partners leave."""
        return self.source, *(partner.source for partner in self.join_partners)


class ExitPhase(Struct, frozen=True):
    """The time between a trigger and the end of an exit behaviour that takes time.

    ``memory`` is the variable that holds meanwhile, ``end`` the input that holds in the last step.
    ``transition`` is the id of the transition, whose first half sets the memory.
    """

    transition: str
    memory: str
    end: str


class Vertex(Struct, frozen=True):
    """A state, final state or pseudostate.

    ``do`` is the output that holds while the state is active, ``done`` the input that reports the
    end of the do behaviour, ``timer`` counts the steps that the state has been active, and ``pick``
    names the enabled outgoing transition that was taken. An empty name means that there is no such
    variable. ``border`` is the state that owns an entry or exit point. The machine of a component
    alone has ``opening``, which holds while an entry behaviour that takes time runs, ``ending``,
    which holds in the step in which the do behaviour ends, and ``leaving``, the phases of an exit
    behaviour that takes time, one for each transition that leaves the state.
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
    opening: str = ""
    ending: str = ""
    leaving: tuple[ExitPhase, ...] = ()

    @property
    def is_stable(self) -> bool:
        """Whether a step may end in the vertex."""
        return self.kind in ("state", "final")


class Region(Struct, frozen=True):
    """A region and its variable, whose literals are the names of its states.

    The variable of a nested region has the literal ``inactive`` too. ``memory`` is the variable
    that stores the last active state for a history pseudostate.
    """

    id: str
    variable: str
    state: str
    """The state that owns the region; empty for a region of the machine."""
    initial: str
    vertices: tuple[str, ...]
    memory: str = ""
    wording: str = ""
    """The name by which formulas about the owner of the machine denote the variable."""


class Machine(Struct, frozen=True):
    """A state machine with the variables of its contract."""

    id: str
    name: str
    variables: tuple[Variable, ...]
    vertices: dict[str, Vertex]
    regions: dict[str, Region]
    outgoing: dict[str, tuple[Transition, ...]]
    top: tuple[str, ...]
    scope: Scope
    initial: dict[str, Literal] = field(default_factory=dict)
    """Default values of the assigned properties; a property without default is not in it."""
    outputs: tuple[str, ...] = ()
    assigned: tuple[str, ...] = ()
    assumed: tuple[str, ...] = ()
    """Assigned properties without a range, so that the compiler chose one."""
    memories: dict[str, Memory] = field(default_factory=dict)
    late: dict[str, str] = field(default_factory=dict)
    """The variables for the values of properties after do behaviours have assigned them in the
    present step, by property; the machine of a component alone has them."""
    reads: dict[str, tuple[str, ...]] = field(default_factory=dict)
    """The properties without a range that the values of each property read; those that conditions
    read, by "". A formula names them only where its value is not the same in the whole range."""
    entry: tuple[Action, ...] = ()
    """What the machine does before it enters its first states."""

    def find_variable(self, name: str) -> Variable:
        """Return the variable called *name*."""
        return next(variable for variable in self.variables if variable.name == name)

    @property
    def wordings(self) -> dict[str, str]:
        """The names by which formulas of the author denote the regions, by variable."""
        return {region.variable: region.wording for region in self.regions.values()}

    def list_states(self) -> list[Vertex]:
        """List all states in the order of the model."""
        return [vertex for vertex in self.vertices.values() if vertex.kind == "state"]

    def list_exit_phases(self) -> Iterator[ExitPhase]:
        """Iterate over the phases of all exit behaviours that take time."""
        return (phase for vertex in self.vertices.values() for phase in vertex.leaving)

    def list_transitions(self) -> list[Transition]:
        """List all transitions, grouped by source."""
        return [transition for group in self.outgoing.values() for transition in group]

    def list_incoming(self, vertex: str) -> list[Transition]:
        """List the transitions that lead to a vertex, with their join partners apart."""
        return [item for item in self.list_transitions() if item.target == vertex]

    def list_blockers(self, transition: Transition) -> list[str]:
        """List the variables that are true while entry or exit behaviours disable *transition*.

        These are the entries and exits of its sources, and the entries of the states inside them if
        it leaves them. The end of an exit enables the second half of its transition.
        """
        openings = [
            state.opening
            for state in self.vertices.values()
            if state.opening
            and any(
                source == state.id
                or (transition.kind != "internal" and self.contains(source, state.id))
                for source in transition.sources
            )
        ]
        phases = [phase for id in transition.sources for phase in self.vertices[id].leaving]
        is_second_half = any(OnInput(phase.end) in transition.occurrences for phase in phases)
        return openings if is_second_half else openings + [phase.memory for phase in phases]

    def has_simple_exits(self, state: Vertex) -> bool:
        """Whether transitions from the state, which nothing contains, lead straight to states."""
        leaving = [move for move in self.list_transitions() if state.id in move.sources]
        return not self.regions[state.region].state and all(
            not move.join_partners and self.vertices[move.target].is_stable for move in leaving
        )

    # -- behaviours that take time -----------------------------------------------------------------

    def with_openings(self, states: Iterable[str]) -> "Machine":
        """Return the machine with variables that are true while the entries of *states* run."""
        openings = {id: f"opening of {id}" for id in states}
        vertices = dict(self.vertices)
        for id, name in openings.items():
            vertices[id] = replace(vertices[id], opening=name)
        inputs = (_make_input(name, id) for id, name in openings.items())
        return replace(self, vertices=vertices, variables=(*self.variables, *inputs))

    def with_exit_phases(self, states: Collection[str]) -> "Machine":
        """Return the machine in which the exits of *states* take time.

        A transition that leaves such a state has two halves: the first reacts to the trigger, and
        the second leaves the state when the exit behaviour ends.
        """
        vertices, outgoing = dict(self.vertices), dict(self.outgoing)
        memories: list[Variable] = []
        ends: list[Variable] = []
        for id in states:
            halves = list(map(_split_transition, self.outgoing.get(id, ())))
            outgoing[id] = tuple(half for group, _ in halves for half in group)
            phases = tuple(phase for _, phase in halves if phase is not None)
            vertices[id] = replace(vertices[id], leaving=phases)
            for phase in phases:
                origin = element_id(phase.transition)
                memory = Variable(phase.memory, Owner.SYSTEM, BooleanDomain(), origin)
                memories.append(replace(memory, is_auxiliary=True))
                ends.append(_make_input(phase.end, phase.transition))
        names = [memory.name for memory in memories]
        return replace(
            self,
            vertices=vertices,
            outgoing=outgoing,
            variables=(*self.variables, *memories, *ends),
            assigned=(*self.assigned, *names),
            initial={**self.initial, **dict.fromkeys(names, False)},
        )

    def with_late_values(self, features: Iterable[str]) -> "Machine":
        """Return the machine with variables for the values and ends of do behaviours.

        *features* are those that the do behaviours may assign.
        """
        late = {name: f"late {name}" for name in features}
        vertices = {
            id: replace(vertex, ending=f"ending of {id}" * bool(vertex.done))
            for id, vertex in self.vertices.items()
        }
        values = [replace(self.find_variable(name), name=late[name]) for name in late]
        ends = [_make_input(state.ending, state.id) for state in vertices.values() if state.ending]
        variables = (*self.variables, *values, *ends)
        return replace(self, vertices=vertices, variables=variables, late=late)

    # -- places ------------------------------------------------------------------------------------

    def list_enclosing_states(self, vertex: str) -> list[str]:
        """List the states that contain *vertex*, innermost first.

        The state on whose border an entry or exit point lies counts as containing it.
        """
        start = self.vertices[vertex]
        states = [start.border] if start.border else []
        region = start.region
        while region and self.regions[region].state:
            states.append(self.regions[region].state)
            region = self.vertices[states[-1]].region
        return states

    def contains(self, state: str, vertex: str) -> bool:
        """Whether *vertex* lies strictly inside *state*."""
        return bool(self.vertices[state].regions) and state in self.list_enclosing_states(vertex)

    def list_enclosing_regions(self, vertex: str) -> list[str]:
        """List the regions that contain *vertex*, innermost first."""
        regions = [
            self.vertices[inner].region for inner in [vertex, *self.list_enclosing_states(vertex)]
        ]
        return list(dict.fromkeys(regions))

    def has_concurrent_exits(self, vertex: str) -> bool:
        """Whether all transitions that leave *vertex* are taken together.

        That holds for a fork, and for an entry point of an orthogonal state whose transitions lead
        to different regions of the state (UML 2.5.1, 14.2.3.7).
        """
        start, outgoing = self.vertices[vertex], self.outgoing.get(vertex, ())
        if start.kind == "entry-point" and len(outgoing) > 1:
            border_regions = self.vertices[start.border].regions if start.border else ()
            entered = [
                region
                for transition in outgoing
                for region in self.list_enclosing_regions(transition.target)
                if region in border_regions
            ]
            return len(set(entered)) == len(outgoing)
        return start.kind == "fork"

    def find_main_region(self, transition: Transition) -> str | None:
        """Return the region that *transition* changes.

        The active states of that region are left, then the states on the way to the target are
        entered. The result is empty for an internal transition and None if no region contains both
        ends.

        It is the least region that contains source and target (UML 2.5.1, 14.2.3.8.1 and
        14.2.3.9.5). A local transition to a vertex inside its source does not leave the source. An
        exit point is reached without leaving its state; an entry point is reached when its state is
        entered.
        """
        if transition.kind == "internal":
            return ""
        start, end = self.vertices[transition.source], self.vertices[transition.target]
        if start.region == end.region and not start.border and not end.border:
            return start.region
        source_regions, target_regions = (
            self.list_enclosing_regions(transition.source),
            self.list_enclosing_regions(transition.target),
        )
        # Transitions from an entry point stay inside the state, whose border is already crossed.
        if start.kind == "entry-point" and start.border:
            border_regions = self.vertices[start.border].regions
            return next((region for region in target_regions if region in border_regions), None)
        if end.kind == "exit-point" and end.border in self.list_enclosing_states(transition.source):
            border_regions = self.vertices[end.border].regions
            return next((region for region in source_regions if region in border_regions), None)
        if transition.kind == "local" and self.contains(transition.source, transition.target):
            return next(region for region in target_regions if region in start.regions)
        return next((region for region in source_regions if region in target_regions), None)


def _make_input(name: str, vertex: str) -> Variable:
    return Variable(name, Owner.ENVIRONMENT, BooleanDomain(), element_id(vertex))


def _split_transition(transition: Transition) -> tuple[tuple[Transition, ...], ExitPhase | None]:
    """Return the halves of a transition and the phase between them.

    An internal transition does not leave its state and remains whole.
    """
    if transition.kind == "internal":
        return (transition,), None
    id = transition.id
    phase = ExitPhase(id, f"leaving by {id}", f"exit ends before {id}")
    sets = Assign(phase.memory, LiteralExpression(True), element_id(id))
    resets = Assign(phase.memory, LiteralExpression(False), element_id(id))
    first = replace(transition, kind="internal", effect=(sets,))
    second = replace(
        transition,
        id=submachine_id(f"end of {id}", element_id(id)),
        occurrences=(OnInput(phase.end),),
        guard=None,
        effect=(*transition.effect, resets),
    )
    return (first, second), phase
