"""Places in the behaviour of a component that some run should reach."""

from collections.abc import Iterable, Iterator, Mapping
from enum import StrEnum
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Edge
from sysmlc.logic import formula as f
from sysmlc.logic.activities.step_formulas import StepFormulas
from sysmlc.logic.components.machines import PlacedMachine
from sysmlc.logic.composition.structure import join_path
from sysmlc.logic.contract import Variable, equals
from sysmlc.logic.domains import regions_of, values
from sysmlc.logic.formula import Const, Formula
from sysmlc.logic.machines.descriptions import name_occurrence, name_transition
from sysmlc.logic.machines.machine import Transition, element_id
from sysmlc.logic.machines.moves import Move, trigger_condition
from sysmlc.logic.simplification import substitute

if TYPE_CHECKING:
    from sysmlc.logic.components.component import Component


_ACCEPTING = ("accept", "accept-call")


class PlaceKind(StrEnum):
    """What a place in a behaviour is."""

    ACTIVITY = "activity"
    """A state or an action."""
    TRANSITION = "transition"
    EVENT = "event"
    """One of several triggers of a transition, or what an action waits for."""
    GUARD = "guard"
    FEATURE = "feature"


class PlaceInBehaviour(Struct, frozen=True):
    """A place that runs should reach, its name in the component, and when it is reached.

    It is a state or an action that is active, a transition that is taken, an event that is
    accepted, a guard that lets a token pass, or a feature that changes. The question makes sense
    only in runs that reach ``within``: the source of a transition, a state or pseudostate, the
    transition or action that accepts the event, or the decision with the guard.
    """

    name: str
    origin: str
    is_active: Formula
    kind: PlaceKind = PlaceKind.ACTIVITY
    within: Formula = f.TRUE
    leads_to: Formula = f.FALSE
    """The target of a transition is active."""

    def replace_variables(self, values: Mapping[str, Formula]) -> "PlaceInBehaviour":
        """Return the place with formulas instead of some variables of its conditions."""
        is_active, within = substitute(self.is_active, values), substitute(self.within, values)
        return replace(self, is_active=is_active, within=within)


def iter_places(
    component: "Component", formulas: StepFormulas, assigned: Iterable[tuple[str, Variable]]
) -> Iterator[PlaceInBehaviour]:
    """Yield states, actions, transitions, events, guards of decisions, and features.

    *assigned* are names and variables of the features that are assigned. Conditions may have
    placeholders for the ends of performances.
    """
    for machine in component.machines:
        yield from _merge_copies(_iter_machine_places(component, machine))
    names: dict[str, tuple[str, ...]] = {}
    for action in component.performances.paths:
        names.setdefault(action.node, action.names)
    for id, path in names.items():
        node = formulas.graph.node(id)
        running = f.var(node.run)
        yield PlaceInBehaviour(".".join(path), node.origin, running)
        element = component.graph.get(node.origin)
        if node.done is not None and element is not None and element.subkind in _ACCEPTING:
            text = f"the event of action '{'.'.join(path)}'"
            accepts = f.both(running, node.done)
            yield PlaceInBehaviour(text, node.origin, accepts, PlaceKind.EVENT, running)
    yield from _merge_copies(_iter_guard_places(formulas))
    for name, variable in assigned:
        yield PlaceInBehaviour(name, variable.origin, _may_change(variable), PlaceKind.FEATURE)


def _may_change(variable: Variable) -> Formula:
    """Return the formula that a value changes; a number may do so inside its region."""
    value = f.var(variable.name)
    changes = f.negate(equals(variable, value, is_next=True))
    regions = regions_of(variable.domain)
    literals = values(variable.domain) if regions is not None else ()
    is_inside = (
        f.eq(value, Const(literal))
        for index, literal in enumerate(literals)
        if regions is not None and not regions.is_point(index)
    )
    return f.either(changes, *is_inside)


def _iter_guard_places(formulas: StepFormulas) -> Iterator[PlaceInBehaviour]:
    """Yield the guards of decisions, once for each copy of an activity. ``else`` is no guard."""
    for edge in formulas.graph.edges:
        if edge.guard is not None and edge.guard.condition is not None:
            is_open = formulas.present_formula(edge)
            is_reached = formulas.waiting_formula(formulas.graph.node(edge.source))
            text, origin = edge.guard.text, edge.origin
            yield PlaceInBehaviour(text, origin, is_open, PlaceKind.GUARD, is_reached)


def _iter_machine_places(
    component: "Component", machine: PlacedMachine
) -> Iterator[PlaceInBehaviour]:
    for state in machine.machine.list_states():
        element = component.graph[element_id(state.id)]
        name = join_path(machine.owner.path, element.name)
        yield PlaceInBehaviour(name, element.id, machine.active_formula(state))
    for move in machine.exploration.moves:
        source = machine.machine.vertices[move.transition.source]
        fires = machine.rename(move.fires)
        yield _describe_transition(machine, move.transition, fires, machine.active_formula(source))
        # A single event that is never accepted is a transition that is never taken.
        if len(move.transition.occurrences) > 1:
            yield from _iter_events(component, machine, move)
    for source in machine.machine.vertices.values():
        branches = machine.machine.outgoing.get(source.id, ())
        # A single branch is taken whenever its pseudostate is reached, as all those of a fork.
        if not source.is_stable and len(branches) > 1:
            taken = [machine.passed_formula(branch) for branch in branches]
            for branch, is_taken in zip(branches, taken, strict=True):
                yield _describe_transition(machine, branch, is_taken, f.either(*taken))


def _iter_events(
    component: "Component", machine: PlacedMachine, move: Move
) -> Iterator[PlaceInBehaviour]:
    """Yield the events of a transition with several triggers."""
    transition = move.transition
    source = machine.machine.vertices[transition.source]
    drawn = component.graph[element_id(transition.id)]
    triggers = component.graph.targets(drawn, Edge.TRIGGER)
    for trigger, occurrence in zip(triggers, transition.occurrences, strict=True):
        occurs = trigger_condition(machine.machine, source, occurrence)
        text = f"{name_occurrence(occurrence)} of {name_transition(transition)}"
        yield PlaceInBehaviour(
            _add_owner(machine, text),
            trigger.id,
            machine.rename(f.both(move.fires, occurs)),
            PlaceKind.EVENT,
            machine.rename(move.fires),
        )


def _merge_copies(places: Iterable[PlaceInBehaviour]) -> Iterator[PlaceInBehaviour]:
    """Yield one place for each element, which is reached if a copy of it is.

    States that use one submachine have copies of its content, calls copies of their activity.
    """
    copies: dict[tuple[PlaceKind, str], list[PlaceInBehaviour]] = {}
    for place in places:
        copies.setdefault((place.kind, place.origin), []).append(place)
    for first, *others in copies.values():
        group = [first, *others]
        yield replace(
            first,
            is_active=f.either(*(place.is_active for place in group)),
            within=f.either(*(place.within for place in group)),
            leads_to=f.either(*(place.leads_to for place in group)),
        )


def _describe_transition(
    machine: PlacedMachine, transition: Transition, is_taken: Formula, within: Formula
) -> PlaceInBehaviour:
    target = machine.machine.vertices[transition.target]
    return PlaceInBehaviour(
        _add_owner(machine, name_transition(transition)),
        element_id(transition.id),
        is_taken,
        PlaceKind.TRANSITION,
        within,
        machine.active_formula(target) if target.kind == "state" else f.FALSE,
    )


def _add_owner(machine: PlacedMachine, text: str) -> str:
    """Return a text about a machine, with the part that has the machine."""
    return f"{text} of '{machine.owner.path}'" if machine.owner.path else text
