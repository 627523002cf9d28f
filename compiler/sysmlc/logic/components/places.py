"""Places in the behaviour of a component that some run should reach."""

from collections.abc import Iterable, Iterator, Mapping
from enum import StrEnum
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.components.machines import PlacedMachine
from sysmlc.logic.composition.structure import join_path
from sysmlc.logic.contract import BooleanDomain, Variable
from sysmlc.logic.formula import Formula
from sysmlc.logic.machines.descriptions import name_transition
from sysmlc.logic.machines.machine import Transition, element_id
from sysmlc.logic.simplification import substitute

if TYPE_CHECKING:
    from sysmlc.logic.components.component import Component


class PlaceKind(StrEnum):
    """What a place in a behaviour is."""

    ACTIVITY = "activity"
    """A state or an action."""
    TRANSITION = "transition"
    GUARD = "guard"
    FEATURE = "feature"


class PlaceInBehaviour(Struct, frozen=True):
    """A place that runs should reach, its name in the component, and when it is reached.

    It is a state or an action that is active, a transition that is taken, a guard that lets a token
    pass, or a feature that changes. The question makes sense only in runs that reach ``within``:
    the source of a transition, a state or pseudostate, or the decision with the guard.
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
    component: "Component", tokens: TokenGraph, assigned: Iterable[tuple[str, Variable]]
) -> Iterator[PlaceInBehaviour]:
    """Yield states, actions, transitions, guards of decisions, and the features that are assigned.

    *assigned* are names and variables of features. Conditions may have placeholders for the ends of
    performances.
    """
    for machine in component.machines:
        yield from _merge_copies(_iter_machine_places(component, machine))
    names: dict[str, tuple[str, ...]] = {}
    for action in component.performances.paths:
        names.setdefault(action.node, action.names)
    for id, path in names.items():
        node = tokens.node(id)
        yield PlaceInBehaviour(".".join(path), node.origin, f.var(node.run))
    for edge in tokens.edges:
        if edge.guard is not None and edge.guard.condition is not None:
            arrives = (
                f.var(enter.variable) for enter in tokens.edges if enter.target == edge.source
            )
            yield PlaceInBehaviour(
                edge.guard.text,
                edge.origin,
                f.var(edge.variable),
                PlaceKind.GUARD,
                f.either(*arrives),
            )
    for name, variable in assigned:
        now = f.var(variable.name)
        is_boolean = isinstance(variable.domain, BooleanDomain)
        stays = f.iff(f.prime(now), now) if is_boolean else f.eq(f.prime(now), now)
        yield PlaceInBehaviour(name, variable.origin, f.negate(stays), PlaceKind.FEATURE)


def _iter_machine_places(
    component: "Component", machine: PlacedMachine
) -> Iterator[PlaceInBehaviour]:
    for state in machine.machine.list_states():
        element = component.graph[element_id(state.id)]
        name = join_path(machine.owner.path, element.name)
        yield PlaceInBehaviour(name, element.id, machine.active_formula(state))
    for move in machine.exploration.moves:
        source = machine.machine.vertices[move.transition.source]
        yield _describe_transition(
            machine, move.transition, machine.rename(move.fires), machine.active_formula(source)
        )
    for source in machine.machine.vertices.values():
        branches = machine.machine.outgoing.get(source.id, ())
        # A single branch is taken whenever its pseudostate is reached, as all those of a fork.
        if not source.is_stable and len(branches) > 1:
            taken = [machine.passed_formula(branch) for branch in branches]
            for branch, is_taken in zip(branches, taken, strict=True):
                yield _describe_transition(machine, branch, is_taken, f.either(*taken))


def _merge_copies(places: Iterable[PlaceInBehaviour]) -> Iterator[PlaceInBehaviour]:
    """Yield one place for each element: states that use one submachine have copies of its content.

    It is reached if a copy is.
    """
    copies: dict[str, list[PlaceInBehaviour]] = {}
    for place in places:
        copies.setdefault(place.origin, []).append(place)
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
        join_path(machine.owner.path, name_transition(transition)),
        element_id(transition.id),
        is_taken,
        PlaceKind.TRANSITION,
        within,
        machine.active_formula(target) if target.kind == "state" else f.FALSE,
    )
