"""State machines of the objects of a component: moves, writes of features, and do behaviours."""

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.logic import formula as f
from sysmlc.logic.basis import Reads
from sysmlc.logic.components.objects import (
    ComponentError,
    ComponentObject,
    ObjectTree,
    Slot,
    is_value,
)
from sysmlc.logic.contract import Class, Conjunct, EnumerationDomain, Owner, Variable
from sysmlc.logic.feature_writes import WriterIndex, iter_writes
from sysmlc.logic.formula import Const, Formula, rename_variables
from sysmlc.logic.identifiers import identifier
from sysmlc.logic.machines.derivation import (
    Touches,
    choice_formula,
    describe_exploration,
    list_changes,
)
from sysmlc.logic.machines.machine import Assign, Machine, Transition, Vertex, element_id
from sysmlc.logic.machines.moves import (
    Exploration,
    Move,
    explore_machine,
    is_active_formula,
)
from sysmlc.logic.machines.paths import Path
from sysmlc.logic.machines.reader import MachineOptions, read_machine
from sysmlc.logic.machines.supported_constructs import list_behaviours

EVENT = "event"
"""The variable of a machine that names the event which occurs."""


class MachineWrite(Struct, frozen=True):
    """A write of a slot by a machine: the condition about a step, and the value."""

    slot: Slot
    condition: Formula
    value: Formula


class PlacedMachine(Struct, frozen=True):
    """A state machine of an object, with its variables in the component."""

    owner: ComponentObject
    element: Element
    exploration: Exploration
    variables: Mapping[str, str]
    slots: Mapping[str, Slot]
    """The slots of the features that the machine names, by its own variables."""
    written: frozenset[str]
    """Ids of the effects, entries and exits whose assignments ``iter_writes`` yields."""

    @property
    def machine(self) -> Machine:
        """The machine, in its own variables."""
        return self.exploration.machine

    @property
    def key(self) -> tuple[str, str]:
        """The id of the element and the path of the object; equal parts have the same element."""
        return self.element.id, self.owner.path

    def rename(self, formula: Formula) -> Formula:
        """Return a formula about the machine in the variables of the component."""
        return rename_variables(formula, self.variables)

    @property
    def events(self) -> tuple[str, ...]:
        """The literals of the events to which the machine reacts."""
        for variable in self.machine.variables:
            if variable.name == EVENT and isinstance(variable.domain, EnumerationDomain):
                return variable.domain.literals
        return ()

    @property
    def late_variables(self) -> Mapping[str, Slot]:
        """The slots with variables for their values after do behaviours have assigned them."""
        late = self.machine.late
        return {self.variables[late[name]]: self.slots[name] for name in late}

    def list_variables(self) -> Iterator[Variable]:
        """Yield the machine's own variables.

        These are all but features, the event, and what tells how far behaviours of states are.
        """
        states = self.machine.list_states()
        others = {*self.slots, *self.machine.late.values(), EVENT}
        others |= {name for state in states for name in (state.opening, state.ending)}
        others |= {phase.end for phase in self.machine.list_exit_phases()}
        for variable in self.machine.variables:
            if variable.name not in others:
                yield replace(variable, name=self.variables[variable.name])

    def iter_steps(self) -> Iterator[Conjunct]:
        """Yield how the machine moves, without the values of features and without its start."""
        for conjunct in describe_exploration(self._drop_features(), "").guarantees:
            if conjunct.class_ is not Class.INIT:
                yield replace(conjunct, formula=self.rename(conjunct.formula))

    def iter_starts(self) -> Iterator[Conjunct]:
        """Yield how the machine starts, with the values that its first entries write."""
        start = replace(
            self.exploration,
            moves=(),
            machine=replace(self.machine, assigned=tuple(self.list_start_writes())),
        )
        for conjunct in describe_exploration(start, "").guarantees:
            if conjunct.class_ is Class.INIT:
                yield replace(conjunct, formula=self.rename(conjunct.formula))

    def list_start_writes(self) -> list[str]:
        """List the variables that the start of the machine decides.

        It sets a feature to another value than the default, or the machine itself has the feature.
        """
        initial = {name: Const(value) for name, value in self.machine.initial.items()}
        return [
            name
            for name in self.machine.assigned
            if name not in self.slots
            or any(path.values.get(name) != initial.get(name) for path in self.exploration.starts)
        ]

    def _drop_features(self) -> Exploration:
        moves = tuple(
            replace(move, paths=tuple(map(self._drop_slots, move.paths)))
            for move in self.exploration.moves
        )
        own = tuple(name for name in self.machine.assigned if name not in self.slots)
        machine = replace(self.machine, assigned=own)
        return replace(self.exploration, moves=moves, machine=machine)

    def _drop_slots(self, path: Path) -> Path:
        values = {name: path.values[name] for name in path.values if name not in self.slots}
        return replace(path, values=values)

    def iter_writes(self) -> Iterator[MachineWrite]:
        """Yield the writes of features by the transitions of the machine."""
        for move in self.exploration.moves:
            for path in move.paths:
                condition = self._path_formula(move, path)
                for name, value in path.values.items():
                    if name not in self.slots:
                        continue
                    yield MachineWrite(self.slots[name], condition, self.rename(value))

    def _path_formula(self, move: Move, path: Path) -> Formula:
        """Return the formula that the machine takes a path of a move in this step."""
        choices = choice_formula(self.exploration, move, path)
        return self.rename(f.both(move.fires, path.when, choices))

    def iter_reads(self) -> Iterator[Reads]:
        """Yield the properties with assumed ranges on which variables of the machine depend."""
        own = {self.variables[name] for name in self.variables.keys() - self.slots.keys()}
        own |= {self.variables[name] for name in self.machine.assigned}
        for target, names in self.machine.reads.items():
            decided = {self.variables[target]} if target else own
            yield frozenset(decided), frozenset(self.variables[name] for name in names)

    def iter_clamps(self) -> Iterator[tuple[str, Formula]]:
        """Yield each feature with an assumed range, and when a value is stopped at its bound."""
        starts = ((f.TRUE, path) for path in self.exploration.starts)
        steps = (
            (self._path_formula(move, path), path)
            for move in self.exploration.moves
            for path in move.paths
            if path.saturated
        )
        for condition, path in (*starts, *steps):
            for name, _ in path.saturated:
                if name in self.machine.assumed:
                    yield self.variables[name], condition

    # -- states ------------------------------------------------------------------------------------

    def active_formula(self, state: Vertex) -> Formula:
        """The state is active."""
        return self.rename(is_active_formula(self.machine, state.id))

    def entered_formula(self, state: Vertex) -> Formula:
        """A transition enters the state in this step."""
        region = self.machine.regions[state.region].variable
        return self._change_formula(
            region, lambda path, name: path.entered.get(name) == state.literal
        )

    def exit_starts_formula(self, state: Vertex) -> Formula:
        """The exit behaviour of the state, which takes time, starts after this step."""
        transitions = {phase.transition for phase in state.leaving}
        moves = self.exploration.moves
        return self.rename(f.either(*(m.fires for m in moves if m.transition.id in transitions)))

    def left_formula(self, state: Vertex) -> Formula:
        """A transition leaves the state in this step."""
        return self._change_formula(state.id, lambda path, id: id in path.left_states)

    def passed_formula(self, transition: Transition) -> Formula:
        """A transition that leaves a pseudostate is taken in this step, or at the start."""
        if any(transition.id in path.passed for path in self.exploration.starts):
            return f.TRUE
        return self._change_formula(transition.id, lambda path, id: id in path.passed)

    def _change_formula(self, name: str, has_changed: Touches) -> Formula:
        """A path on which *name*, a variable or an id, changes is taken in this step."""
        return self.rename(f.either(*list_changes(self.exploration, name, has_changed)))

    def iter_elements(self, graph: Graph) -> Iterator[Element]:
        """Yield the machine, its submachines, and the states and transitions of both."""
        yield from graph.subtree(self.element)
        regions = (graph[element_id(id)] for id in self.machine.regions)
        yield from (owner for owner in map(graph.owner, regions) if owner is not None)
        for id in self.machine.vertices:
            yield graph[element_id(id)]
        for transition in self.machine.list_transitions():
            for segment in (transition, *transition.join_partners):
                yield graph[element_id(segment.id)]

    def list_do_states(self, tree: ObjectTree) -> Iterator[tuple[Vertex, list[Element]]]:
        """Yield the states with do behaviours."""
        for state in self.machine.list_states():
            if state.do:
                yield state, list_behaviours(tree.graph, tree.graph[element_id(state.id)], Edge.DO)


def find_machines(tree: ObjectTree, object_: ComponentObject) -> list[Element]:
    """Return the state machines of an object, which its type has, exhibits or inherits.

    Raises ComponentError if a type has machines and inherits others.
    """
    groups: list[list[Element]] = []
    for classifier in object_.list_family(tree.graph):
        machines = [
            element
            for element in dict.fromkeys(
                (
                    *tree.graph.owned(classifier),
                    *tree.graph.targets(classifier, Edge.CLASSIFIER_BEHAVIOR),
                )
            )
            if element.kind is Kind.STATE_MACHINE
            and element.subkind != "protocol"
            and any(region.kind is Kind.REGION for region in tree.graph.owned(element))
            and not any(user.kind is Kind.STATE for user in tree.graph.sources(element, Edge.CALLS))
        ]
        groups += [machines] if machines else []
    if len(groups) > 1:
        raise ComponentError(f"'{object_.type_.name}' has state machines and inherits others")
    return groups[0] if groups else []


def place_machine(
    tree: ObjectTree,
    object_: ComponentObject,
    element: Element,
    prefix: str,
    event: str,
    options: MachineOptions,
    list_long: Callable[[Machine, Edge], Iterable[str]],
    writers: WriterIndex,
) -> PlacedMachine | None:
    """Read a machine of an object; return None if no steps can be derived from it.

    *prefix* stands before its own variables; *event* is the variable of the object's event.
    *list_long* returns the ids of the states whose entries, or exits, take time. Raises
    ComponentError.
    """
    machine = read_machine(tree.graph, element, Sink(), options, classifier=object_.type_)
    if machine is None:
        return None
    machine = machine.with_openings(list_long(machine, Edge.ENTRY))
    written = frozenset(_list_written_ids(tree.graph, machine))
    machine = machine.with_exit_phases(list(list_long(machine, Edge.EXIT)))
    variables: dict[str, str] = {EVENT: event}
    for name, words in _list_phase_names(tree, machine):
        word = identifier(words)
        variables[name] = tree.names.new(f"{prefix}_{word}" if prefix else word)
    slots: dict[str, Slot] = {}
    for variable in machine.variables:
        if variable.name in variables:
            continue
        slot = _find_slot(tree, object_, element, variable)
        if slot is not None:
            slots[variable.name] = slot
            variables[variable.name] = tree.read_slot(slot).variable.name
        elif variable.name != EVENT:
            name = f"{prefix}_{variable.name}" if prefix else variable.name
            variables[variable.name] = tree.names.new(name)
    late = [name for name in slots if _has_other_writer(tree, slots[name], writers, written)]
    machine = machine.with_late_values(late)
    for name, late_name in machine.late.items():
        variables[late_name] = tree.names.new(f"late_{variables[name]}")
    # What a state does decides its end, not the environment.
    ends = [name for state in machine.list_states() for name in (state.done, state.ending) if name]
    ends += [phase.end for phase in machine.list_exit_phases()]
    variables |= {name: f"end of {prefix} {name}" for name in ends}
    exploration = explore_machine(tree.graph, machine, Sink())
    if exploration is None:
        return None
    return PlacedMachine(object_, element, exploration, variables, slots, written)


def _list_phase_names(tree: ObjectTree, machine: Machine) -> Iterator[tuple[str, str]]:
    """Yield the variables of entries and exits that take time, and names for them."""
    for state in machine.list_states():
        name = tree.graph[element_id(state.id)].name
        if state.opening:
            yield state.opening, f"run_{name}_entry"
        for phase in state.leaving:
            yield phase.memory, f"leaving_{name}"


def _has_other_writer(
    tree: ObjectTree, slot: Slot, writers: WriterIndex, written: Collection[str]
) -> bool:
    """Whether anything but the effects, entries and exits in *written* may assign a feature.

    A step of an activity counts, because a do behaviour may perform the activity, too.
    """
    return any(
        writer.id not in written or writer.kind is Kind.ACTION
        for element in tree.read_slot(slot).elements
        for writer in (*writers.iter_writers(element), *writers.iter_unclear_writers(element))
    )


def find_unread_features(
    tree: ObjectTree, machines: Iterable[PlacedMachine], index: WriterIndex
) -> dict[str, str]:
    """Return the inputs of machines that the model decides in a way that is not read.

    They stand for features of the machines that nothing assigns, and for conditions about other
    objects. Each has a reason.

    Raises ComponentError if something else assigns a feature of a machine.
    """
    reasons: dict[str, str] = {}
    for machine in machines:
        for variable in machine.list_variables():
            element = tree.graph.get(variable.origin)
            path = "" if element is None else tree.find_unread_name(machine.element, element)
            if path and variable.owner is Owner.ENVIRONMENT:
                reasons[variable.name] = f"the owner of '{path}' is unknown"
            if element is None or element.kind is not Kind.PROPERTY:
                continue
            writers = [*index.iter_writers(element), *index.iter_unclear_writers(element)]
            if any(writer.id not in machine.written for writer in writers):
                raise ComponentError(f"'{variable.name}' is not assigned by its machine alone")
            if not writers:
                reasons[variable.name] = f"nothing assigns '{variable.name}'"
    return reasons


def _find_slot(
    tree: ObjectTree, object_: ComponentObject, machine: Element, variable: Variable
) -> Slot | None:
    element = tree.graph.get(variable.origin)
    if element is None or not is_value(element) or machine in tree.graph.ancestors(element):
        return None
    slot = tree.find_slot(object_, element, variable.name, machine)
    if slot is not None and tree.read_slot(slot).variable.domain != variable.domain:
        raise ComponentError(f"'{variable.name}' has other values in '{machine.name}'")
    return slot


def _list_written_ids(graph: Graph, machine: Machine) -> Iterator[str]:
    """Yield the ids of the texts of which the machine has all assignments."""
    groups = [group for state in machine.vertices.values() for group in (state.entry, state.exit)]
    groups.append(machine.entry)
    for transition in machine.list_transitions():
        groups += (segment.effect for segment in (transition, *transition.join_partners))
    counts: dict[str, set[int]] = {}
    for group in groups:
        origins = Counter(action.origin for action in group if isinstance(action, Assign))
        for id, count in origins.items():
            counts.setdefault(id, set()).add(count)
    for id in counts:
        if counts[id] == {sum(1 for _ in iter_writes(graph, graph[id]))}:
            yield id
