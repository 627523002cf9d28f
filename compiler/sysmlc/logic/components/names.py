"""Names of actions, states and features of a component, as formulas spell them.

``running(load.grip)`` and ``finished(pick)`` are about actions, ``Work.state`` about the region in
a state, ``m1.state`` and ``m1.event`` about a part, ``m1.using`` about a feature of a part.
"""

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Edge
from sysmlc.logic import formula as f
from sysmlc.logic.activities.action_names import shorten_paths
from sysmlc.logic.activities.step_formulas import PerformanceFormulas
from sysmlc.logic.components.machines import EVENT
from sysmlc.logic.components.objects import ComponentError
from sysmlc.logic.components.signals import derive_events
from sysmlc.logic.composition.structure import join_path
from sysmlc.logic.contract import BooleanDomain, Domain, Owner, Variable
from sysmlc.logic.formula import Formula
from sysmlc.logic.identifiers import spell_name
from sysmlc.logic.machines.reader import choose_shortest, iter_region_names

if TYPE_CHECKING:
    from sysmlc.logic.components.component import Component

_ACTION = re.compile(r"(?:([\w.]+)\.)?(running|finished)\(([^()]+)\)")
"""``running(load.grip)``, or with the path of a part in front: ``robot.running(grip)``."""


_LISTED_PATHS = 3
"""Paths of an action that a message lists as alternatives of an ambiguous name."""


def finish_name(id: str) -> str:
    """Return the name that stands for the end of a performance until all are placed."""
    return f"finished {id}"


def finish_variable(id: str) -> Formula:
    """Return the placeholder for the end of the performance with a node."""
    return f.var(finish_name(id))


class Meaning(Struct, frozen=True):
    """What a name denotes: a formula about a step, with its values."""

    formula: Formula
    domain: Domain
    name: str = ""
    """The name in the formula of the author."""


class Atom(Struct, frozen=True):
    """What an author may write about a step: a variable with the author's name, and its meaning.

    ``replaced`` is the variable of the behaviour that runs show as this atom. A Boolean that is no
    feature ``is_quiet``: the first step of a run lists it only if it is true.
    """

    variable: Variable
    meaning: Formula
    replaced: str
    is_quiet: bool = False


class ComponentNames:
    """The names that a formula about a component may use."""

    def __init__(self, component: "Component") -> None:
        self._component = component
        self._states = _collect_states(component)

    def find(self, name: str) -> Meaning | None:
        """Return what a name denotes, or None. Raises ComponentError if it is ambiguous."""
        action = _ACTION.fullmatch(name)
        if action is not None:
            return self._find_action(action[2], ".".join(filter(None, (action[1], action[3]))))
        if name in self._states:
            variables = self._states[name]
            if len(variables) > 1:
                choices = " or ".join(self._spell_region(variable) for variable, _ in variables)
                raise ComponentError(f"'{name}' is ambiguous: write {choices}")
            return Meaning(f.var(variables[0][0]), variables[0][1])
        path, dot, last = name.rpartition(".")
        if last == EVENT and self._component.tree.find_object(path) is not None:
            return self._find_event(path)
        return (None if dot else self._find_own(name)) or self._find_feature(name)

    def list_names(self, kind: str = "running") -> list[str]:
        """List the shortest names of regions, events and actions; *kind* is asked of actions."""
        variables = dict.fromkeys(pair[0] for pairs in self._states.values() for pair in pairs)
        regions = map(self._spell_region, variables)
        events = (f"{path}.{EVENT}" if path else EVENT for path in self._component.events)
        actions = (f"{kind}({path})" for path in self._list_actions())
        features = (
            f"{object_.path}.{name}"
            for object_ in self._component.tree.objects
            if object_.path
            for name, feature in self._component.tree.context(object_).features.items()
            if feature.domain is not None
        )
        return [*features, *regions, *events, *actions]

    def _spell_region(self, variable: str) -> str:
        """Return the shortest unambiguous name of a region."""
        names = [
            name for name, pairs in self._states.items() if [variable] == [v for v, _ in pairs]
        ]
        return min(names, key=len, default=variable)

    def _list_actions(self) -> Iterator[str]:
        """Yield the shortest unambiguous path of each action."""
        paths = self._component.performances.paths
        nodes_by_path: dict[str, set[str]] = {}
        for action in paths:
            for start in range(len(action.names)):
                nodes_by_path.setdefault(".".join(action.names[start:]), set()).add(action.node)
        shortest: dict[str, str] = {}
        for path, nodes in nodes_by_path.items():
            if len(nodes) == 1:
                (node,) = nodes
                shortest[node] = min(path, shortest.get(node, path), key=len)
        yield from (
            shortest[node]
            for node in dict.fromkeys(item.node for item in paths)
            if node in shortest
        )

    def _find_event(self, path: str) -> Meaning | None:
        # An object without state machine gets the variable of its event here.
        events = derive_events(self._component).variables
        name = self._component.events.get(path)
        for event in events:
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
        names = {node.run for node in graph.workers()}
        names |= {edge.variable for edge in graph.edges if graph.can_hold(edge)}
        names |= {condition for _, condition in graph.named_conditions}
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
        wanted = tuple(spell_name(name.strip(" '\"")) for name in path.split("."))
        paths = self._component.performances.paths
        actions = [action for action in paths if action.names[-len(wanted) :] == wanted]
        actions = actions or [action for action in paths if _is_within(wanted, action.names)]
        exact = {action.node for action in actions if action.names == wanted}
        candidates = list(exact if len(exact) == 1 else {action.node for action in actions})
        if not candidates:
            return None
        if len(candidates) > 1:
            counts = Counter(".".join(action.names) for action in actions)
            texts = sorted(text for text, count in counts.items() if count == 1)
            more = "..." * (len(texts) > _LISTED_PATHS)
            listed = " or ".join(texts[:_LISTED_PATHS])
            advice = f"write {listed}{more}" if texts else "give these actions different names"
            raise ComponentError(f"'{path}' is performed in several places: {advice}")
        formulas = self._component.formulas
        node = formulas.graph.node(candidates[0])
        running: Formula = f.var(node.run)
        if kind == "running":
            return Meaning(running, BooleanDomain())
        return Meaning(f.both(running, formulas.done_formula(node)), BooleanDomain())


def _is_within(wanted: tuple[str, ...], names: tuple[str, ...]) -> bool:
    """Whether a path consists of some names of another path in their order, up to the last one."""
    remaining = iter(names)
    return names[-1] == wanted[-1] and all(name in remaining for name in wanted)


def _collect_states(component: "Component") -> Mapping[str, list[tuple[str, Domain]]]:
    """Return the variables of regions by the names with which formulas denote them."""
    states: dict[str, list[tuple[str, Domain]]] = {}
    for machine in component.machines:
        prefix = f"{machine.owner.path}." if machine.owner.path else ""
        is_only = sum(other.owner is machine.owner for other in component.machines) == 1
        for path, variable in iter_region_names(component.graph, machine.machine, is_only):
            name = prefix + path
            pair = machine.variables[variable], machine.machine.find_variable(variable).domain
            if pair not in states.setdefault(name, []):
                states[name].append(pair)
    return states


# -- atoms of runs ---------------------------------------------------------------------------------


def iter_atoms(
    component: "Component",
    formulas: PerformanceFormulas,
    variables: Iterable[Variable],
    accepted: Collection[str],
) -> Iterator[Atom]:
    """Yield the atoms for the variables of a behaviour, except auxiliary ones.

    *accepted* are the variables of acceptances. An atom is auxiliary if it repeats others: an
    acceptance its event, a do behaviour the activity that it performs, and the end of an action
    that takes one step the action.
    """
    names = _name_variables(component)
    features = {feature.variable.name for feature in component.tree.used_slots.values()}
    nodes = {node.run: node for node in formulas.graph.workers()}
    paths = shorten_paths(component.performances.paths)
    done_inputs = {node.done.name: node for node in nodes.values() if isinstance(node.done, f.Var)}
    repeated = {*accepted, *_list_performed_states(component)}
    for variable in variables:
        name = variable.name
        node = nodes.get(name)
        if node is not None and node.id in paths:
            path, runs, done = paths[node.id], f.var(name), formulas.done_formula(node)
            yield Atom(replace(variable, name=f"running({path})"), runs, name, is_quiet=True)
            end = done.name if isinstance(done, f.Var) and done.name not in features else ""
            finished = replace(
                variable,
                name=f"finished({path})",
                owner=Owner.ENVIRONMENT if end in done_inputs else Owner.SYSTEM,
                is_auxiliary=done == f.TRUE,
            )
            yield Atom(finished, f.both(runs, done), end, is_quiet=True)
        elif not variable.is_auxiliary and (name in features or name not in done_inputs):
            is_quiet = isinstance(variable.domain, BooleanDomain) and name not in features
            shown = replace(variable, name=names.get(name, name), is_auxiliary=name in repeated)
            yield Atom(shown, f.var(name), name, is_quiet)


def _name_variables(component: "Component") -> dict[str, str]:
    """Return the shortest name of each feature, region and event, by its variable."""
    return choose_shortest(_iter_variable_names(component))


def _iter_variable_names(component: "Component") -> Iterator[tuple[str, str]]:
    """Yield the variable of each feature, region and event with each of its names."""
    for slot, feature in component.tree.used_slots.items():
        for object_, name in component.tree.iter_joined_names(slot):
            yield feature.variable.name, join_path(object_.path, name)
    for name, variables in _collect_states(component).items():
        if len(variables) == 1:
            yield variables[0][0], name
    for path, variable in component.events.items():
        yield variable, join_path(path, EVENT)


def _list_performed_states(component: "Component") -> Iterator[str]:
    """Yield the variables of the do behaviours that are performances."""
    for root in component.roots:
        if root.machine is not None and root.state is not None and root.role is Edge.DO:
            yield root.machine.variables[root.state.do]
