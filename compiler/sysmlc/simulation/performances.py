"""One step of the performances of a component, of their variables, and of messages."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import product

from sysmlc.ir import Edge
from sysmlc.logic import domains, evaluate
from sysmlc.logic.activities.token_step import State, TokenStep
from sysmlc.logic.components.arguments import Arguments, Output
from sysmlc.logic.components.machines import PlacedMachine
from sysmlc.logic.components.objects import Slot
from sysmlc.logic.components.performances import Root
from sysmlc.logic.components.signals import Wiring
from sysmlc.logic.formula import Formula, Literal
from sysmlc.logic.machines.interpreter import Valuation
from sysmlc.logic.machines.machine import NO_EVENT


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
