"""Names of actions, states and features of a component, as formulas spell them.

``running(load.grip)`` and ``finished(pick)`` are about actions, ``Work.state`` about the region in
a state, ``m1.state`` and ``m1.event`` about a part, ``m1.using`` about a feature of a part.
"""

import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from msgspec import Struct

from sysmlc.logic import formula as f
from sysmlc.logic.components.machines import EVENT, PlacedMachine
from sysmlc.logic.components.objects import ComponentError
from sysmlc.logic.components.signals import derive_events
from sysmlc.logic.contract import BooleanDomain, Domain
from sysmlc.logic.formula import Formula
from sysmlc.logic.machines.machine import element_id

if TYPE_CHECKING:
    from sysmlc.logic.components.component import Component

_ACTION = re.compile(r"(running|finished)\(\s*([\w.]+)\s*\)")


class Meaning(Struct, frozen=True):
    """What a name denotes: a formula about a step, with its values."""

    formula: Formula
    domain: Domain
    name: str = ""
    """The name in the formula of the author."""


class ComponentNames:
    """The names that a formula about a component may use."""

    def __init__(self, component: "Component") -> None:
        self._component = component
        self._states = _collect_states(component)

    def find(self, name: str) -> Meaning | None:
        """Return what a name denotes, or None. Raises ComponentError if it is ambiguous."""
        action = _ACTION.fullmatch(name)
        if action is not None:
            return self._find_action(action[1], action[2])
        if name in self._states:
            variables = self._states[name]
            if len(variables) > 1:
                raise ComponentError(f"'{name}' names several state machines")
            return Meaning(f.var(variables[0][0]), variables[0][1])
        path, dot, last = name.rpartition(".")
        if last == EVENT and self._component.tree.find_object(path) is not None:
            return self._find_event(path)
        return (None if dot else self._find_own(name)) or self._find_feature(name)

    def _find_event(self, path: str) -> Meaning | None:
        name = self._component.events.get(path)
        for event in derive_events(self._component).variables:
            if event.name == name:
                return Meaning(f.var(name), event.domain)
        return None

    def _find_own(self, name: str) -> Meaning | None:
        """Return what a variable of the component's own behaviour denotes."""
        component = self._component
        for machine in component.machines:
            for variable in machine.list_variables():
                if variable.name == name:
                    return Meaning(f.var(name), variable.domain)
        performances = component.performances
        if name in performances.inputs:
            return Meaning(f.var(name), performances.inputs[name].domain)
        ended = component.end_aliases.get(name) or performances.aliases.get(name)
        if ended is not None:
            formulas = component.formulas
            return Meaning(formulas.done_formula(formulas.graph.node(ended)), BooleanDomain())
        graph = component.formulas.graph
        names = {node.run for node in graph.workers()} | {edge.variable for edge in graph.edges}
        names |= {quiet for _, quiet in graph.quiets}
        return Meaning(f.var(name), BooleanDomain()) if name in names else None

    def _find_feature(self, name: str) -> Meaning | None:
        tree = self._component.tree
        for object_ in sorted(tree.objects, key=lambda object_: -len(object_.path)):
            prefix = f"{object_.path}." if object_.path else ""
            feature_name = name.removeprefix(prefix)
            if name.startswith(prefix) and feature_name in tree.context(object_).features:
                feature = tree.context(object_).features[feature_name]
                if feature.domain is None and not object_.path:
                    return None
                if feature.domain is None:
                    several = "several values" if feature.has_several_values else "no finite type"
                    raise ComponentError(f"'{name}' has {several}")
                if feature.is_constant and feature.default is not None:
                    return Meaning(f.const(feature.default), feature.domain)
                slot = tree.find_slot(object_, feature.element, feature.variable)
                variable = tree.read_slot(slot or tree.slot_of(object_.path, feature_name)).variable
                return Meaning(f.var(variable.name), variable.domain)
        return None

    def _find_action(self, kind: str, path: str) -> Meaning | None:
        wanted = tuple(path.split("."))
        actions = [
            action
            for action in self._component.performances.paths
            if action.names[-len(wanted) :] == wanted
        ]
        exact = {action.node for action in actions if action.names == wanted}
        candidates = list(exact if len(exact) == 1 else {action.node for action in actions})
        if not candidates:
            return None
        if len(candidates) > 1:
            paths = " or ".join(sorted({".".join(action.names) for action in actions}))
            raise ComponentError(f"'{path}' is performed in several places: write {paths}")
        formulas = self._component.formulas
        node = formulas.graph.node(candidates[0])
        running: Formula = f.var(node.run)
        if kind == "running":
            return Meaning(running, BooleanDomain())
        return Meaning(f.both(running, formulas.done_formula(node)), BooleanDomain())


def _collect_states(component: "Component") -> Mapping[str, list[tuple[str, Domain]]]:
    """Return the variables of regions by the names with which formulas denote them."""
    states: dict[str, list[tuple[str, Domain]]] = {}
    for machine in component.machines:
        for name, variable in _iter_regions(component, machine):
            pair = machine.variables[variable], machine.machine.find_variable(variable).domain
            if pair not in states.setdefault(name, []):
                states[name].append(pair)
    return states


def _iter_regions(component: "Component", machine: PlacedMachine) -> Iterator[tuple[str, str]]:
    """Yield each name of a region with the machine's own variable for it."""
    prefix = f"{machine.owner.path}." if machine.owner.path else ""
    named = f"{prefix}{machine.element.name}."
    count = sum(other.owner is machine.owner for other in component.machines)
    regions = machine.machine.regions
    if len(machine.machine.top) == 1:
        variable = regions[machine.machine.top[0]].variable
        yield f"{named}state", variable
        if count == 1:
            yield f"{prefix}state", variable
    for state in machine.machine.list_states():
        if len(state.regions) == 1:
            name = component.graph[element_id(state.id)].name
            outer = [
                component.graph[element_id(id)].name
                for id in reversed(machine.machine.list_enclosing_states(state.id))
            ]
            variable = regions[state.regions[0]].variable
            for path in dict.fromkeys((name, ".".join((*outer, name)))):
                yield f"{prefix}{path}.state", variable
                yield f"{named}{path}.state", variable
