"""Player of a component: its state machines, and everything that they and it perform and call.

All behaviours react to the same step, and the reactions are visible in the next one. Actions that
end in a step write first; the effects of a machine read what its do behaviours write and override
it. Guards behind a choice read it too, and the guards of the completion transitions that the end of
a do behaviour triggers. Of several values that different behaviours write, any may result. A do
behaviour starts when its state is entered and stops when the state is left; a completion transition
waits for its end. What a component performs by itself runs once.

The player executes the diagrams with the reference interpreters of state machines and activities;
it reads no formula of the contract that ``logic.components`` derives, so that tests can compare
the two.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cached_property
from itertools import islice, product

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, query
from sysmlc.logic import domains, evaluate
from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities.interpreter import BranchPlan
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_step import State, TokenStep
from sysmlc.logic.components.arguments import Arguments, Output
from sysmlc.logic.components.component import Component
from sysmlc.logic.components.derivation import ComponentBehaviour, describe_component
from sysmlc.logic.components.machines import EVENT, PlacedMachine
from sysmlc.logic.components.objects import ComponentError, Slot
from sysmlc.logic.components.performances import Root
from sysmlc.logic.components.signals import Wiring, derive_events
from sysmlc.logic.contract import Owner, Variable
from sysmlc.logic.formula import TRUE, Formula, Literal
from sysmlc.logic.machines import interpreter as machine_interpreter
from sysmlc.logic.machines.interpreter import Valuation
from sysmlc.logic.machines.machine import NO_EVENT, Vertex
from sysmlc.logic.machines.reaction import Reaction, is_active
from sysmlc.logic.machines.reader import MachineOptions

MAX_RUNS = 10_000
"""Most runs followed at the same time if a diagram leaves choices."""
_Options = dict[str, list[Literal]]
"""The values that a feature may get in a step, by its variable."""


class _MachineReaction(Struct, frozen=True):
    """How a machine reacts, and which performances it starts and stops."""

    machine: PlacedMachine
    reaction: Reaction
    options: _Options
    """What the machine and its do behaviours write."""

    def enters(self, state: Vertex) -> bool:
        """Whether the state is active from the next step on, and was not or was left."""
        return state.id in self.reaction.opened

    def leaves(self, state: Vertex) -> bool:
        """Whether the state is left, or begins to be left by an exit behaviour that takes time."""
        return state.id in self.reaction.left_states or self.starts_exit(state)

    def starts_exit(self, state: Vertex) -> bool:
        """Whether the exit behaviour of the state, which takes time, starts after this step."""
        store, assigned = self.reaction.store, self.reaction.assigned
        return any(phase.memory in assigned and store[phase.memory] for phase in state.leaving)


class ComponentPlayer(Struct, frozen=True, dict=True):
    """Player of a component with everything that it performs, calls and contains."""

    graph: Graph
    parts: Component
    behaviour: ComponentBehaviour
    component: str
    wiring: Wiring

    @cached_property
    def variables(self) -> tuple[Variable, ...]:
        accepted = self.wiring.accepted
        late = {name for machine in self.parts.machines for name in machine.late_variables}
        return tuple(
            replace(variable, owner=Owner.SYSTEM) if variable.name in accepted else variable
            for variable in self.behaviour.contract.variables
            if variable.name not in late
        )

    @cached_property
    def pulses(self) -> frozenset[str]:
        lasting = {slot.variable.name for slot in self.parts.tree.used_slots.values()}
        inputs = (v.name for v in self.variables if v.owner is Owner.ENVIRONMENT)
        return frozenset(name for name in inputs if name not in lasting)

    @cached_property
    def _tokens(self) -> TokenGraph:
        return self.parts.performances.build(self.component, self.parts.subject.id, (), ())

    @cached_property
    def _features(self) -> dict[str, Variable]:
        """The features that the component decides, by their variables."""
        slots = self.parts.tree.used_slots.values()
        return {slot.variable.name: slot.variable for slot in slots if not slot.is_input}

    # -- first step --------------------------------------------------------------------------------

    def initial(self, inputs: Mapping[str, Literal]) -> list[Valuation]:
        return _limit_valuations(self._iter_first_valuations(inputs))

    def _iter_first_valuations(self, inputs: Mapping[str, Literal]) -> Iterator[Valuation]:
        for features in self._list_first_values():
            before = {**inputs, **features}
            reactions = (
                [
                    self._make_reaction(machine, reaction, {})
                    for reaction in machine_interpreter.list_first_reactions(
                        machine.machine, {**machine.machine.initial, **_select(machine, before)}
                    )
                ]
                for machine in self.parts.machines
            )
            for combination in product(*reactions):
                for state in self._list_first_states(combination):
                    stored = list_first_options(self.parts.arguments, state.running)
                    options = {**_merge_options(combination), **stored}
                    for written in choose_values(options):
                        after = {**before, **written}
                        yield from self._receive(
                            self._complete(after, after, inputs, combination, state, is_first=True),
                            state.running,
                        )

    def _list_first_values(self) -> Iterator[Valuation]:
        slots = [slot for slot in self.parts.tree.used_slots.values() if not slot.is_input]
        choices = (
            domains.values(slot.variable.domain) if slot.default is None else [slot.default]
            for slot in slots
        )
        names = [slot.variable.name for slot in slots]
        for row in product(*choices):
            yield dict(zip(names, row, strict=True))

    def _list_first_states(self, reactions: tuple[_MachineReaction, ...]) -> Iterator[State]:
        """Yield the first states of the performances: those of services may already run."""
        by_machine = {id(reaction.machine): reaction for reaction in reactions}
        choices: list[list[bool]] = []
        for root in self.parts.roots:
            if root.after or root.role is Edge.EXIT:
                choices.append([False])
            elif root.machine is not None and root.state is not None:
                reaction = by_machine[id(root.machine)]
                machine = root.machine.machine
                choices.append([is_active(machine, reaction.reaction.store, root.state.id)])
            else:
                choices.append([True] if root.first == TRUE else [False, True])
        nothing = State(frozenset(), frozenset())
        for choice in product(*choices):
            ids = {
                root.id
                for root, is_running in zip(self.parts.roots, choice, strict=True)
                if is_running
            }
            step = PerformanceStep(self._tokens, nothing, {}, evaluate.is_true)
            yield step.start_and_stop(ids, set())

    # -- next steps --------------------------------------------------------------------------------

    def successors(
        self, now: Mapping[str, Literal], inputs: Mapping[str, Literal]
    ) -> list[Valuation]:
        return _limit_valuations(self._iter_successors(now, inputs))

    def _iter_successors(
        self, now: Mapping[str, Literal], inputs: Mapping[str, Literal]
    ) -> Iterator[Valuation]:
        state = token_game.state_of(self._tokens, now)
        step = PerformanceStep(self._tokens, state, now, evaluate.is_true)
        finished = step.list_finished()
        parameters = ParameterStep(self.parts.arguments, now, finished)
        writes = list(self._list_writes(finished, now, parameters))
        own_options: _Options = {}
        for name, value, root in writes:
            if root.machine is None:
                own_options.setdefault(name, []).append(value)
        alternatives = [
            list(self._list_reactions(machine, now, finished, writes))
            for machine in self.parts.machines
        ]
        for combination in product(*alternatives):
            options = _merge_options(combination)
            for name, choices in own_options.items():
                options[name] = [*options.get(name, []), *choices]
            kept = {name: now[name] for name in self._features}
            starts, stops = self._list_starts(state, now, finished, combination)
            for following, started in self._list_states(state, now, starts, stops):
                stored = parameters.list_options(started)
                for written in choose_values({**options, **stored}):
                    after = {**inputs, **kept, **written}
                    yield from self._receive(
                        self._complete(
                            now, after, inputs, combination, following, finished=finished
                        ),
                        started,
                    )

    def _list_writes(
        self, finished: set[str], now: Mapping[str, Literal], parameters: "ParameterStep"
    ) -> Iterator[tuple[str, Literal, Root]]:
        """Yield what performances write: the variable of a feature, the value, the performance."""
        slots = self.parts.tree.used_slots
        roots = {root.id: root for root in self.parts.roots}
        for write in self.parts.performances.writes:
            if write.node in finished:
                value = evaluate_cases(write.values, now)
                yield slots[write.slot].variable.name, value, roots[write.root]
        for output, value in parameters.iter_outputs():
            if isinstance(output.target, tuple):
                yield slots[output.target].variable.name, value, roots[output.root]

    def _list_reactions(
        self,
        machine: PlacedMachine,
        now: Mapping[str, Literal],
        finished: set[str],
        writes: list[tuple[str, Literal, Root]],
    ) -> Iterator[_MachineReaction]:
        """Yield the reactions of a machine after what its do behaviours write in this step."""
        own_values = _select(machine, now)
        own_values |= decide_ends(self.parts.roots, machine, now, finished)
        done_options: _Options = {}
        for name, value, root in writes:
            if root.machine is machine:
                done_options.setdefault(name, []).append(value)
        names = {variable: own for own, variable in machine.variables.items()}
        for seen in choose_values(done_options):
            written = {names[name]: value for name, value in seen.items() if name in names}
            for reaction in machine_interpreter.list_reactions(
                machine.machine, own_values, written
            ):
                yield self._make_reaction(machine, reaction, done_options)

    def _make_reaction(
        self, machine: PlacedMachine, reaction: Reaction, done_options: _Options
    ) -> _MachineReaction:
        assigned = {
            machine.variables[name]: [reaction.store[name]]
            for name in reaction.assigned
            if name in machine.slots
        }
        return _MachineReaction(machine, reaction, {**done_options, **assigned})

    def _list_starts(
        self,
        state: State,
        now: Mapping[str, Literal],
        finished: set[str],
        reactions: tuple[_MachineReaction, ...],
    ) -> tuple[set[str], set[str]]:
        """Return the performances that start and those that are stopped in this step."""
        by_machine = {id(reaction.machine): reaction for reaction in reactions}
        starts: set[str] = set()
        stops: set[str] = set()
        for root in self.parts.roots:
            if root.machine is not None and root.state is not None:
                reaction = by_machine[id(root.machine)]
                is_exit = root.role is Edge.EXIT
                begins = reaction.starts_exit if is_exit else reaction.enters
                is_started = root.after in finished if root.after else begins(root.state)
                starts |= {root.id} if is_started else set()
                stops |= {root.id} if reaction.leaves(root.state) and not is_exit else set()
            elif root.service and now[root.service]:
                is_free = root.id not in state.running or root.id in finished
                starts |= {root.id} if is_free else set()
        return starts, stops

    def _list_states(
        self,
        state: State,
        now: Mapping[str, Literal],
        starts: set[str],
        stops: set[str],
    ) -> Iterator[tuple[State, frozenset[str]]]:
        """Yield the states of the performances after one step, and the nodes that start."""
        worklist: list[list[int]] = [[]]
        states: dict[tuple[State, frozenset[str]], None] = {}
        while worklist:
            plan = BranchPlan(worklist.pop())
            step = PerformanceStep(self._tokens, state, now, evaluate.is_true, plan.choose)
            following = step.start_and_stop(starts, stops)
            states[following, frozenset(step.begun)] = None
            worklist += plan.list_alternatives()
        yield from states

    def _complete(
        self,
        now: Mapping[str, Literal],
        after: Mapping[str, Literal],
        inputs: Mapping[str, Literal],
        reactions: tuple[_MachineReaction, ...],
        state: State,
        *,
        finished: set[str] | None = None,
        is_first: bool = False,
    ) -> Valuation:
        """Return the valuation of all variables; *after* has the inputs and the features."""
        valuation: Valuation = {
            **inputs,
            **after,
            **token_game.values_of_state(self._tokens, state),
        }
        for entry in reactions:
            machine = entry.machine
            names = machine.variables
            features = {name: after[names[name]] for name in machine.slots}
            reaction = entry.reaction
            store = {**reaction.store, **features}
            own = machine_interpreter.complete_valuation(
                machine.machine,
                _select(machine, now),
                Reaction(store, reaction.raised, reaction.picked, reaction.left_states),
                {**_select(machine, after), **features},
                is_first,
            )
            ends = {vertex.done for vertex in machine.machine.list_states() if vertex.done}
            valuation |= {
                names[name]: value
                for name, value in own.items()
                if name in names and name not in ends and name != EVENT
            }
            for root in self.parts.roots:
                if root.machine is machine and root.state is not None and root.over:
                    is_over = not is_first and (
                        bool(now[root.over]) or root.id in (finished or set())
                    )
                    is_moved = entry.enters(root.state) or entry.leaves(root.state)
                    valuation[root.over] = is_over and not is_moved
        return valuation

    def _receive(self, valuation: Valuation, started: frozenset[str]) -> Iterator[Valuation]:
        """Yield the valuations with the messages received, and with the values of arguments."""
        for received in receive_messages(self.wiring, valuation):
            yield bind_arguments(self.parts.arguments, received, started)


def open_component(graph: Graph, subject: Element) -> ComponentPlayer | None:
    """Return the player of a block; None if not all that it does is known."""
    name = query.component_name(graph, subject)
    try:
        component = Component(graph, subject, MachineOptions())
        for object_ in component.tree.objects:
            for label, feature in component.tree.context(object_).features.items():
                # Of features without an initial value, those that behaviours name are enough.
                if feature.default is not None and not feature.is_constant:
                    component.tree.read_slot(component.tree.slot_of(object_.path, label))
        behaviour = describe_component(component, name)
        wiring = derive_events(component)
    except ComponentError:
        return None
    if behaviour.gaps or component.performances.named_conditions:
        return None
    return ComponentPlayer(graph, component, behaviour, name, wiring)


def _select(machine: PlacedMachine, valuation: Mapping[str, Literal]) -> Valuation:
    """Return the values of the machine's own variables."""
    return {
        own: valuation[variable]
        for own, variable in machine.variables.items()
        if variable in valuation
    }


def _merge_options(reactions: tuple[_MachineReaction, ...]) -> _Options:
    options: _Options = {}
    for reaction in reactions:
        for name, choices in reaction.options.items():
            options[name] = [*options.get(name, []), *choices]
    return options


def _limit_valuations(iterator: Iterator[Valuation]) -> list[Valuation]:
    """Return the distinct valuations, or, if there are too many, over ``MAX_RUNS`` of them."""
    valuations = list(islice(iterator, MAX_RUNS + 1))
    if len(valuations) > MAX_RUNS:
        return valuations
    distinct = {frozenset(valuation.items()): valuation for valuation in valuations}
    return list(distinct.values())


# -- performances ------------------------------------------------------------------------------


class PerformanceStep(TokenStep):
    """One step of the performances of a component, whose outermost nodes others start and stop.

    A performance that is complete does not start again. ``begun`` are the nodes that start.
    """

    def start_and_stop(self, starts: set[str], stops: set[str]) -> State:
        """Return the next state after performances were stopped and others were started."""
        self.move_tokens()
        for id in stops:
            self.running.discard(id)
            self.clear_region(id)
        for id in starts:
            self.start_node(self.graph.node(id))
        self.begun &= self.running
        return State(frozenset(self.tokens), frozenset(self.running))


class ParameterStep:
    """One step of the variables of called activities: arguments, outputs and stored attributes.

    *finished* are the nodes that end in this step.
    """

    def __init__(
        self, arguments: Arguments, now: Mapping[str, Literal], finished: set[str]
    ) -> None:
        self._arguments = arguments
        self._now = now
        self._finished = finished

    def iter_outputs(self, target: Slot | str | None = None) -> Iterator[tuple[Output, Literal]]:
        """Yield the outputs of the calls that end in this step, each with a possible value.

        *target* selects the outputs that set one feature or variable.
        """
        for output in self._arguments.outputs:
            if output.node in self._finished and target in (None, output.target):
                for value in self._list_after(output.variable):
                    now = {**self._now, output.variable: value}
                    yield output, evaluate_cases(output.cases, now)

    def list_options(self, started: Iterable[str]) -> dict[str, list[Literal]]:
        """Return the values that each stored variable may have in the next step.

        *started* are the nodes that start now. An attribute without a default may then have any
        value.
        """
        options: dict[str, list[Literal]] = {}
        for store, node in self._arguments.locals:
            variable = store.variable
            if store.follows is not None:
                options[variable.name] = [evaluate.is_true(store.follows, self._now)]
                continue
            options[variable.name] = self._list_after(variable.name)
            if node in started:
                any_value = domains.values(variable.domain)
                options[variable.name] = list(any_value if store.first is None else [store.first])
        for argument in self._arguments.values:
            name = argument.variable.name
            if not argument.is_bound:
                options.setdefault(name, [self._now[name]])
        return options

    def _list_after(self, variable: str) -> list[Literal]:
        """Return the values that a variable may have after the writes of this step."""
        written = [
            evaluate_cases(write.values, self._now)
            for store, _ in self._arguments.locals
            for write in store.writes
            if store.variable.name == variable and write.node in self._finished
        ]
        written += [value for _, value in self.iter_outputs(variable)]
        return written or [self._now[variable]]


def list_first_options(arguments: Arguments, running: Iterable[str]) -> dict[str, list[Literal]]:
    """Return the values that stored variables may have in the first step.

    *running* are the nodes that run in it. Nothing reads a variable without value before its
    activity starts, so that it has the least value until then.
    """
    options: dict[str, list[Literal]] = {}
    for argument in arguments.values:
        if not argument.is_bound:
            options[argument.variable.name] = [domains.values(argument.variable.domain)[0]]
    for store, node in arguments.locals:
        any_value = domains.values(store.variable.domain)
        any_value = any_value if node in running else any_value[:1]
        options[store.variable.name] = list(any_value if store.first is None else [store.first])
    return options


def choose_values(options: Mapping[str, Iterable[Literal]]) -> Iterator[Valuation]:
    """Yield each choice of one value for each variable."""
    for row in product(*(dict.fromkeys(choices) for choices in options.values())):
        yield dict(zip(options, row, strict=True))


def receive_messages(wiring: Wiring, valuation: Valuation) -> Iterator[Valuation]:
    """Yield the valuations of a step with the events that occur in it.

    One of the messages that are sent to an object occurs. Otherwise the event of the environment
    occurs, unless only others in the component send it.
    """
    options: dict[str, list[Literal]] = {}
    for event in dict.fromkeys(delivery.event for delivery in wiring.deliveries):
        deliveries = [delivery for delivery in wiring.deliveries if delivery.event == event]
        sent = [d.message for d in deliveries if any(valuation[name] for name in d.outputs)]
        # An event that only parts of the component send is none of its inputs.
        from_outside = valuation.get(event, NO_EVENT)
        is_impossible = any(d.message == from_outside and not d.is_open for d in deliveries)
        options[event] = [*sent] or [NO_EVENT if is_impossible else from_outside]
    for events in choose_values(options):
        step = {**valuation, **events}
        yield step | {
            name: step[event] == message for name, (event, message) in wiring.accepted.items()
        }


def bind_arguments(
    arguments: Arguments, valuation: Valuation, started: Collection[str]
) -> Valuation:
    """Return the valuation with the values of bound arguments (``=``), and of calls that start.

    *started* are the nodes that run newly in this step.
    """
    for argument in arguments.values:
        if argument.is_bound or argument.node in started:
            value = evaluate_cases(argument.cases, valuation)
            valuation = {**valuation, argument.variable.name: value}
    return valuation


def decide_ends(
    roots: Iterable[Root], machine: PlacedMachine, now: Mapping[str, Literal], finished: set[str]
) -> Valuation:
    """Return the machine's variables that tell which behaviours of its states have ended.

    *finished* are the nodes that end in this step.
    """
    ends: Valuation = {}
    for root in roots:
        if root.machine is not machine or root.state is None:
            continue
        is_finished = root.id in finished
        if root.over:
            ends[root.state.done] = bool(now[root.over]) or is_finished
            ends[root.state.ending] = is_finished
        if root.role is Edge.EXIT:
            for phase in root.state.leaving:
                is_leaving = bool(now[machine.variables[phase.memory]])
                ends[phase.end] = is_leaving and is_finished
    return ends


def evaluate_cases(cases: Iterable[tuple[Formula, Formula]], now: Mapping[str, Literal]) -> Literal:
    """Return the value of the case whose condition is true."""
    return next(
        evaluate.value_of(value, now)
        for condition, value in cases
        if evaluate.is_true(condition, now)
    )
