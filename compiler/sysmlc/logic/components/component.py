"""The behaviours of a component and when they run.

A state machine and the activities that an object performs by itself start with the object. The do
behaviour of a state starts when the state is entered and stops when it is left. The environment may
start an activity that nothing in the component performs.
"""

from collections.abc import Iterator
from functools import cached_property, partial

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic import formula as f
from sysmlc.logic.activities.action_names import make_path
from sysmlc.logic.activities.step_formulas import PerformanceFormulas
from sysmlc.logic.components.arguments import Arguments
from sysmlc.logic.components.machines import PlacedMachine, find_machines, place_machine
from sysmlc.logic.components.names import finish_variable
from sysmlc.logic.components.objects import ComponentError, ComponentObject, ObjectTree
from sysmlc.logic.components.performances import Caller, Performances, Root
from sysmlc.logic.components.signals import check_signal_names
from sysmlc.logic.composition.structure import find_drawn_activity
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Owner, Source, Variable
from sysmlc.logic.expressions.context import context_of
from sysmlc.logic.expressions.parsing import performed_name
from sysmlc.logic.feature_writes import WriterIndex
from sysmlc.logic.formula import Formula
from sysmlc.logic.identifiers import Names, identifier
from sysmlc.logic.machines.instant_activities import find_instant_steps, may_name
from sysmlc.logic.machines.machine import Machine, Vertex, element_id
from sysmlc.logic.machines.reader import MachineOptions, find_context_classifier
from sysmlc.logic.machines.supported_constructs import list_behaviours

_LONG_LIMITS = {
    Edge.ENTRY: " beside substates or a time-out",
    Edge.EXIT: " beside substates, a time-out, a choice, or a state around it",
}
"""Where entries and exits that take time are not described."""
_SENDING = ("send", "broadcast", "call-operation")  # sub-kinds of actions


class Component:
    """The objects and behaviours of one component.

    Callers may name further features before ``describe_component`` derives the step relation.
    """

    def __init__(
        self,
        graph: Graph,
        subject: Element,
        options: MachineOptions,
        writers: WriterIndex | None = None,
    ) -> None:
        """Collect the objects and behaviours. Raises ComponentError.

        *writers* are the writers of all features of the graph, if an index exists.
        """
        self.writers = writers or WriterIndex(graph)
        self.graph = graph
        self.subject = subject
        self._options = options
        is_activity = subject.kind is Kind.ACTIVITY
        type_ = (find_context_classifier(graph, subject) or subject) if is_activity else subject
        context = context_of(graph, type_, options.assumed_range)
        self.names = Names("event", "none", *context.variables.values())
        self.tree = ObjectTree(graph, type_, options.assumed_range, self.names)
        self.performances = Performances(self.tree)
        self.machines: list[PlacedMachine] = []
        self.events: dict[str, str] = {}
        self.roots: list[Root] = []
        self.conjuncts: list[Conjunct] = []
        """Steps of the do behaviours; ``finish_variable`` stands for the end of a performance."""
        self.variables: list[Variable] = []
        self.ends: dict[str, Formula] = {}
        """Whether a do behaviour has ended, or ends, by the machine's variables for its end."""
        self.released: set[str] = set()
        """Ids of writers whose writes are not described everywhere."""
        self.instant: dict[str, tuple[Element, ...]] = {}
        """The steps of activities that machines perform within a step, by the activity."""
        self.obstacle = ""
        """Why the steps of the component are not described, although its objects are; or empty."""
        self.end_aliases: dict[str, str] = {}
        """Nodes of do behaviours by the input that would end them in the machine alone."""
        if is_activity:
            self._add_offered(self.tree.root, subject, prefix="", is_started=True)
        else:
            for object_ in self.tree.objects:
                self._add_machines(object_)
            for object_ in self.tree.objects:
                self._add_own_activities(object_)
            for object_ in self.tree.objects:
                self._add_services(object_)
        check_signal_names(self)

    @cached_property
    def formulas(self) -> PerformanceFormulas:
        """The formulas of all performances."""
        tokens = self.performances.build("", self.subject.id, (), ())
        starts = {root.id: root.start for root in self.roots}
        return PerformanceFormulas(tokens, starts, {root.id: root.stop for root in self.roots})

    @cached_property
    def arguments(self) -> Arguments:
        """The values that pass between calls and what they call. Raises ComponentError."""
        return Arguments(self.tree, self.performances, self.writers)

    # -- behaviours --------------------------------------------------------------------------------

    def _add_machines(self, object_: ComponentObject) -> None:
        main = query.classifier_behavior(self.graph, object_.type_)
        elements = find_machines(self.tree, object_)
        for element in elements:
            is_main = element is main or len(elements) == 1
            prefix = _join_names(object_.path, "" if is_main else element.name)
            event = self.events.setdefault(
                object_.path, self.names.new(f"{object_.path}_event") if object_.path else "event"
            )
            machine = place_machine(
                self.tree,
                object_,
                element,
                prefix,
                event,
                self._options,
                partial(self._list_long, object_),
                self.writers,
            )
            if machine is None:
                raise ComponentError(f"no steps can be derived from state machine '{element.name}'")
            self.machines.append(machine)
            entries: dict[str, str] = {}
            exits = frozenset(self._list_long(object_, machine.machine, Edge.EXIT))
            for state in machine.machine.list_states():
                if state.opening:
                    run = machine.variables[state.opening]
                    entries[state.id] = self._add_transient(machine, state, prefix, Edge.ENTRY, run)
                if state.id in exits:
                    run = self.performances.name_variable(f"run_{state.literal}_exit", prefix)
                    self._add_transient(machine, state, prefix, Edge.EXIT, run)
            for state, behaviours in machine.list_do_states(self.tree):
                self._add_do(machine, state, behaviours, prefix, entries.get(state.id, ""))
            self._release_instant_behaviours(machine)

    def _list_long(self, object_: ComponentObject, machine: Machine, role: Edge) -> Iterator[str]:
        """Yield the ids of the states whose entries, or exits, take time and are described."""
        for state in machine.list_states():
            behaviours = list_behaviours(self.graph, self.graph[element_id(state.id)], role)
            performed = [self._find_performed(object_, behaviour) for behaviour in behaviours]
            if len(performed) != 1 or performed[0] is None or not self._takes_time(performed[0][1]):
                continue
            is_plain = not state.regions and not state.timer
            if is_plain and (role is Edge.ENTRY or machine.has_simple_exits(state)):
                yield state.id

    def _takes_time(self, activity: Element) -> bool:
        tokens = self.performances.find_tokens(activity)
        if tokens is None:
            return self.performances.has_steps(activity) and not find_instant_steps(
                self.graph, activity, None
            )
        return tokens.takes_time

    def _add_transient(
        self, machine: PlacedMachine, state: Vertex, prefix: str, role: Edge, run: str
    ) -> str:
        """Add the entry or exit behaviour of a state, which takes time; return its node.

        The state is active meanwhile, and none of its transitions is enabled (the Library: entry
        and exit are inside of the performance of the state).
        """
        (behaviour,) = list_behaviours(self.graph, self.graph[element_id(state.id)], role)
        performed = self._find_performed(machine.owner, behaviour)
        assert performed is not None
        object_, activity = performed
        name = activity.name or str(role)
        names = machine.owner.extend_path(name)
        caller = Caller(object_, names, _join_names(prefix, state.literal, name))
        id = self.performances.add(activity, caller, run)
        self.performances.paths.append(make_path((*names[:-1], state.literal, name), id))
        if role is Edge.ENTRY:
            starts, stops = machine.entered_formula(state), machine.left_formula(state)
            is_first = machine.active_formula(state)
        else:
            starts, stops, is_first = machine.exit_starts_formula(state), f.FALSE, f.FALSE
            for phase in state.leaving:
                is_leaving = f.var(machine.variables[phase.memory])
                end = machine.variables[phase.end]
                self.ends[end] = f.both(is_leaving, finish_variable(id))
        self.roots.append(Root(id, starts, stops, is_first, machine, state, role=role))
        return id

    def _add_do(
        self,
        machine: PlacedMachine,
        state: Vertex,
        behaviours: list[Element],
        prefix: str,
        entry: str,
    ) -> None:
        """Add the do behaviour of a state; *entry* is the node of its entry if that takes time."""
        if len(behaviours) != 1:
            raise ComponentError(f"state '{state.literal}' has several do behaviours")
        behaviour = behaviours[0]
        performed = self._find_performed(machine.owner, behaviour)
        object_, activity = performed or (machine.owner, behaviour)
        name = state.do.removeprefix("do_")
        names = machine.owner.extend_path(name)
        run = self.performances.name_variable(f"run_{name}", prefix)
        caller = Caller(object_, names, _join_names(prefix, name))
        id = self.performances.add(activity, caller, run)
        place = (*names[:-1], state.literal, name)
        self.performances.paths.append(make_path(place, id))
        is_first = f.FALSE if entry else machine.active_formula(state)
        entered = machine.entered_formula(state)
        left = f.either(machine.left_formula(state), machine.exit_starts_formula(state))
        starts = finish_variable(entry) if entry else entered
        root = Root(id, starts, left, is_first, machine, state, after=entry)
        self.roots.append(root)
        if state.done:
            self.end_aliases[_join_names(prefix, state.done)] = id
            root.over = self._remember_end(machine, state, id, entered, left)

    def _release_instant_behaviours(self, machine: PlacedMachine) -> None:
        """Record the writers in activities that entries, exits and effects perform.

        The machine performs them within its step, which is not described unless it has all their
        assignments. What takes time is an obstacle, apart from the entries and exits that are
        performances of their own, and so is what they send to other objects.
        """
        described = {
            (element_id(root.state.id), root.role) for root in self.roots if root.state is not None
        }
        for element in machine.iter_elements(self.graph):
            if element.kind is Kind.STATE_MACHINE and element is not machine.element:
                continue  # Its states perform its behaviours.
            for edge in (Edge.ENTRY, Edge.EXIT, Edge.EFFECT):
                if (element.id, edge) in described:
                    continue
                for behaviour in list_behaviours(self.graph, element, edge):
                    if self._is_within_step(machine, behaviour):
                        continue
                    performed = self._find_performed(machine.owner, behaviour)
                    if performed is None:
                        continue
                    activity = performed[1]
                    inner = list(self.graph.subtree(activity))
                    sends = any(action.subkind in _SENDING for action in inner)
                    if sends and len(self.tree.objects) > 1:
                        self.obstacle = f"no step describes what {edge} '{activity.name}' sends"
                    if self._takes_time(activity):
                        name = element.name or "a transition"
                        self.obstacle = f"the {edge} '{activity.name}' of {name} takes time"
                        self.obstacle += _LONG_LIMITS.get(edge, "")
                    self.released.update(action.id for action in inner)

    def _is_within_step(self, machine: PlacedMachine, behaviour: Element) -> bool:
        """Whether a machine has all assignments of a behaviour; record what it performs."""
        steps = find_instant_steps(self.graph, behaviour, machine.owner.type_)
        activity = self.graph.owner(steps[0]) if steps else None
        if activity is None or not machine.written.issuperset(step.id for step in steps):
            return False
        self.instant[activity.id] = steps
        self.performances.performed.add((machine.owner.path, activity.id))
        return True

    def _remember_end(
        self, machine: PlacedMachine, state: Vertex, id: str, entered: Formula, left: Formula
    ) -> str:
        """Define when a state's do behaviour has ended: now, or in an earlier step of the state.

        Return the variable that remembers the end.
        """
        name = self.names.new(f"over_{machine.variables[state.do]}")
        memory = Variable(name, Owner.SYSTEM, BooleanDomain(), state.id, is_auxiliary=True)
        self.variables.append(memory)
        is_over = f.either(f.var(name), finish_variable(id))
        self.ends[machine.variables[state.done]] = is_over
        self.ends[machine.variables[state.ending]] = finish_variable(id)
        remains = f.both(is_over, f.negate(left), f.negate(entered))
        self.add(f.negate(f.var(name)), Class.INIT, state.id)
        self.add(f.fold_iff(f.prime(f.var(name)), remains), Class.SAFETY, state.id)
        return name

    def _find_performed(
        self, object_: ComponentObject, behaviour: Element
    ) -> tuple[ComponentObject, Element] | None:
        """Return the activity that a behaviour of a state performs, and the object that has it."""
        if self.performances.find_tokens(behaviour) is not None:
            return object_, behaviour
        called = self.graph.targets(behaviour, Edge.CALLS)
        if called:
            performer = self.tree.find_performer(object_, called[0])
            return None if performer is None else (performer, called[0])
        path = performed_name(str(behaviour.attrs.get("body", "")))
        return None if path is None else self.tree.find_named_activity(object_, path)

    def _add_own_activities(self, object_: ComponentObject) -> None:
        for classifier in object_.list_family(self.graph)[::-1]:
            for activity in self.graph.targets(classifier, Edge.CLASSIFIER_BEHAVIOR):
                if activity.kind is not Kind.ACTIVITY:
                    continue
                is_main = not object_.path and activity is query.classifier_behavior(
                    self.graph, object_.type_
                )
                names = object_.extend_path(activity.name)
                prefix = "" if is_main else _join_names(object_.path, activity.name)
                run = self.names.new(_join_names(object_.path, f"run_{activity.name or 'it'}"))
                drawn = find_drawn_activity(self.graph, activity)
                performer = self.tree.find_performer(object_, drawn)
                if performer is None:
                    reason = f"the part that performs '{drawn.name}' is unknown"
                    self.performances.gaps[run] = reason
                caller = Caller(performer or object_, names, prefix)
                id = self.performances.add(activity, caller, run)
                self.performances.performed.add((object_.path, activity.id))
                self.roots.append(Root(id, f.FALSE, f.FALSE, f.TRUE))

    def _add_services(self, object_: ComponentObject) -> None:
        """Add the activities of an object that something outside the component may perform.

        The environment may start them. Raises ComponentError for an activity without token game
        that calls or sends something.
        """
        for classifier in object_.list_family(self.graph):
            for activity in self.graph.owned(classifier):
                if activity.kind is not Kind.ACTIVITY or not self.performances.has_steps(activity):
                    continue
                if self.performances.find_tokens(activity) is None:
                    self._check_isolated(activity)
                elif self._is_offered(object_, activity):
                    prefix = _join_names(object_.path, activity.name)
                    self._add_offered(object_, activity, prefix, is_started=False)

    def _check_isolated(self, activity: Element) -> None:
        for action in self.graph.subtree(activity):
            if action.kind is Kind.ACTION and self.graph.targets(action, Edge.CALLS):
                raise ComponentError(f"'{activity.name}' has no token game")

    def _is_offered(self, object_: ComponentObject, activity: Element) -> bool:
        """Whether nothing in the component performs the activity, or something outside does."""
        if (object_.path, activity.id) not in self.performances.performed:
            return True
        inside = {copy.activity.id for copy in self.performances.copies.values()}
        inside |= {e.id for machine in self.machines for e in machine.iter_elements(self.graph)}
        return any(
            inside.isdisjoint(element.id for element in (user, *self.graph.ancestors(user)))
            for user in self._iter_users(activity)
        )

    def _iter_users(self, activity: Element) -> Iterator[Element]:
        """Yield the actions that call an activity, and the bodies of states that name it."""
        yield from self.graph.sources(activity, Edge.CALLS)
        for behaviour in self.graph.of_kind(Kind.ACTIVITY):
            if may_name(self.graph, behaviour, activity):
                yield behaviour

    def _add_offered(
        self, object_: ComponentObject, activity: Element, prefix: str, *, is_started: bool
    ) -> None:
        """Add an activity that the environment starts.

        *is_started* states that it runs in the first step; otherwise the environment decides.
        """
        names = object_.extend_path(activity.name)
        run = self.names.new(_join_names(object_.path, f"run_{activity.name or 'it'}"))
        id = self.performances.add(activity, Caller(object_, names, prefix), run)
        start = self.names.new(_join_names(object_.path, f"start_{activity.name or 'it'}"))
        self.variables.append(Variable(start, Owner.ENVIRONMENT, BooleanDomain(), activity.id))
        may_start = f.both(f.var(start), f.either(f.negate(f.var(run)), finish_variable(id)))
        first = f.TRUE if is_started else f.var(run)
        self.roots.append(Root(id, may_start, f.FALSE, first, service=start))

    def list_constituents(self) -> frozenset[str]:
        """Return the ids of the types of the parts, and of the activities that are performed."""
        types = {
            type_.id
            for object_ in self.tree.objects
            if object_.path
            for type_ in object_.list_family(self.graph)
        }
        activities = {copy.activity.id for copy in self.performances.copies.values()}
        return frozenset(types | activities) - {self.subject.id}

    def add(self, formula: Formula, class_: Class, origin: str) -> None:
        """Add a fact about all runs."""
        self.conjuncts.append(Conjunct(formula, class_, origin, source=Source.DERIVED))


def _join_names(*names: str) -> str:
    return "_".join(identifier(name) for name in names if name)
