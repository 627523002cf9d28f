"""One step of the performances of a component, of their variables, and of messages."""

from collections.abc import Iterable, Iterator, Mapping
from itertools import product

from sysmlc.logic import domains, evaluate
from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities.token_graph import Firing, NodeKind, TokenEdge, TokenNode
from sysmlc.logic.components.arguments import Arguments, Output
from sysmlc.logic.components.objects import Slot
from sysmlc.logic.components.signals import Wiring
from sysmlc.logic.formula import Formula, Literal
from sysmlc.logic.machines.interpreter import Valuation
from sysmlc.logic.machines.machine import NO_EVENT


class PerformanceStep(token_game.TokenStep):
    """One step of the performances of a component, whose outermost nodes others start and stop.

    A region is complete, too, if a token reaches one of its final nodes just now: the way to a
    final node takes no step. A performance that is complete does not start again.
    """

    def is_complete(self, region: str) -> bool:
        if token_game.is_complete(self.graph, self.old, region):
            return True
        return any(self._arrives(edge) for edge in self.graph.ends(region))

    def list_finished(self) -> set[str]:
        """Return the ids of the running nodes that are done; what they write counts."""
        return {
            node.id
            for node in self.graph.workers()
            if node.id in self.old.running and self._finishes(node)
        }

    def start_and_stop(self, starts: set[str], stops: set[str]) -> token_game.State:
        """Return the next state after performances were stopped and others were started."""
        self.move_tokens()
        for id in stops:
            self.running.discard(id)
            self.clear_region(id)
        for id in starts:
            self.running.add(id)
            self.start_region(self.graph.node(id))
        return token_game.State(frozenset(self.tokens), frozenset(self.running))

    def _finishes(self, node: TokenNode) -> bool:
        if node.kind is NodeKind.STRUCTURED:
            return self.is_complete(node.id)
        return self.is_done(node)

    def _arrives(self, edge: TokenEdge) -> bool:
        """Whether the source of an edge gives it a token in this step, without another choice."""
        source = self.graph.node(edge.source)
        around = self.graph.regions_around(source.region)
        inner = self.graph.nodes_between(source.region, edge.region)
        if any(region.id not in self.old.running for region in around) or any(
            self.is_complete(region.id) for region in inner
        ):
            return False
        waiting = [token.id in self.old.tokens for token in self.graph.incoming(source)]
        match source.firing:
            case Firing.ANY:
                return any(waiting)
            case Firing.ALL:
                return bool(waiting) and all(waiting)
            case Firing.CHOICE:
                branches = self.graph.outgoing(source)
                is_open = edge in self.list_open_branches(branches)
                return is_open and all(waiting) and not _can_choose(source, branches)
            case Firing.WORK:
                return source.id in self.old.running and self._finishes(source)
            case _:
                return False


def _can_choose(node: TokenNode, branches: list[TokenEdge]) -> bool:
    """Whether several branches of a decision can be open at once, so that its token waits."""
    else_count = sum(branch.is_else for branch in branches)
    guarded_count = len(branches) - else_count
    return else_count > 1 or (guarded_count > 1 and not node.exclusive)


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
            if argument.is_bound:
                continue
            name = argument.variable.name
            options.setdefault(name, [self._now[name]])
            if argument.node in started:
                options[name] = [evaluate_cases(argument.cases, self._now)]
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
        is_impossible = any(d.message == valuation[event] and not d.is_open for d in deliveries)
        options[event] = [*sent] or [NO_EVENT if is_impossible else valuation[event]]
    for events in choose_values(options):
        step = {**valuation, **events}
        yield step | {
            name: step[event] == message for name, (event, message) in wiring.accepted.items()
        }


def bind_arguments(arguments: Arguments, valuation: Valuation) -> Valuation:
    """Return the valuation with the values of bound arguments (``=``)."""
    for argument in arguments.values:
        if argument.is_bound:
            value = evaluate_cases(argument.cases, valuation)
            valuation = {**valuation, argument.variable.name: value}
    return valuation


def evaluate_cases(cases: Iterable[tuple[Formula, Formula]], now: Mapping[str, Literal]) -> Literal:
    """Return the value of the case whose condition is true."""
    return next(
        evaluate.value_of(value, now)
        for condition, value in cases
        if evaluate.is_true(condition, now)
    )
