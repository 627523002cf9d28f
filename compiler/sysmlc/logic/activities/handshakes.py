"""Handshakes of activities: who performs an activity, and how it is started, stopped and ended.

An activity that a state, a transition or an action performs runs when they start it; so does a
service, which the environment of its owner may start. An activity that nothing performs, such as a
classifier behaviour, starts once (UML 2.5.1, 13.2.3).
"""

from collections.abc import Iterable, Iterator
from functools import cache

from msgspec.structs import replace

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.expressions import last_name
from sysmlc.logic import formula as f
from sysmlc.logic.activities.concurrency import ConcurrencyRelation
from sysmlc.logic.activities.step_formulas import StepFormulas
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import ACTIVITY_REGION, Duration, Handshake
from sysmlc.logic.contract import Class, Conjunct
from sysmlc.logic.expressions.parsing import performed_name
from sysmlc.logic.identifiers import Names, identifier

_PERFORMING = (Edge.ENTRY, Edge.DO, Edge.EXIT, Edge.EFFECT)
_Use = tuple[Edge, Element]
"""A state or transition with the edge to what it performs, or an action that calls something."""


def name_handshake(names: Names, activity: str) -> Handshake:
    """Return a handshake with all its variables, for an activity of this name."""
    base = identifier(activity or "activity")
    return Handshake(
        names.new(f"running_{base}"),
        names.new(f"finished_{base}"),
        names.new(f"start_{base}"),
        names.new(f"stop_{base}"),
    )


def complete_handshakes(graph: Graph, games: list[TokenGraph]) -> Iterator[TokenGraph]:
    """Yield the token graphs with the variables that their performers need."""
    performers = _Performers(graph, games)
    for game in games:
        handshake = game.handshake
        if handshake is None:
            yield game
            continue
        activity = graph[game.activity]
        is_main = bool(graph.sources(activity, Edge.CLASSIFIER_BEHAVIOR))
        is_called = any(performers.iter_uses(activity)) or _is_service(graph, activity)
        handshake = replace(
            handshake,
            start=handshake.start if is_called else "",
            stop=handshake.stop if performers.can_be_stopped(game.activity) else "",
            is_started=is_main or not is_called,
        )
        yield replace(game, handshake=handshake)


def _is_service(graph: Graph, activity: Element) -> bool:
    """Whether the environment of the owner may start the activity if nothing else does."""
    if activity.kind is Kind.OPERATION or graph.sources(activity, Edge.METHOD):
        return True
    owner = graph.owner(activity)
    is_block = owner is not None and owner.kind in (Kind.CLASS, Kind.COMPONENT)
    return is_block and not graph.sources(activity, Edge.CLASSIFIER_BEHAVIOR)


class _Performers:
    """Finds what performs an activity, and whether that can abandon it."""

    def __init__(self, graph: Graph, games: Iterable[TokenGraph]) -> None:
        self._graph = graph
        self._games_of_node: dict[str, list[TokenGraph]] = {}
        for game in games:
            for node in game.nodes:
                self._games_of_node.setdefault(node.id, []).append(game)
        self._behaviours_by_body: dict[str, list[Element]] = {}
        for behaviour in graph.of_kind(Kind.ACTIVITY):
            name = last_name(performed_name(str(behaviour.attrs.get("body", ""))) or "")
            self._behaviours_by_body.setdefault(name, []).append(behaviour)
        self._find_relation = cache(ConcurrencyRelation)

    def iter_uses(self, activity: Element) -> Iterator[_Use]:
        """Yield the states, transitions and call actions that perform an activity."""
        operations = self._graph.sources(activity, Edge.METHOD)
        for behaviour in (activity, *operations, *self._list_namesakes(activity)):
            for edge in _PERFORMING:
                yield from ((edge, user) for user in self._graph.sources(behaviour, edge))
            for user in self._graph.sources(behaviour, Edge.CALLS):
                if user.kind is Kind.ACTION:
                    yield Edge.CALLS, user
                for edge in _PERFORMING:
                    yield from ((edge, state) for state in self._graph.sources(user, edge))

    def _list_namesakes(self, activity: Element) -> list[Element]:
        """List the behaviours of states whose text is the name of the activity."""
        owner = self._graph.owner(activity)
        return [
            behaviour
            for behaviour in self._behaviours_by_body.get(activity.name, ())
            if activity.name and (owner is None or owner in self._graph.ancestors(behaviour))
        ]

    def can_be_stopped(self, activity: str) -> bool:
        """Whether something that performs the activity, by its id, may abandon it.

        What abandons a caller abandons what it calls.
        """
        worklist = [activity]
        visited = {activity}
        for id in worklist:
            for edge, user in self.iter_uses(self._graph[id]):
                if edge is Edge.DO and self._can_leave(user):
                    return True
                if edge is not Edge.CALLS or user.attrs.get("synchronous") is False:
                    continue
                callers = self._games_of_node.get(user.id)
                if callers is None or any(self._can_abandon(game, user) for game in callers):
                    # A call in an activity without token game may be abandoned.
                    return True
                new = {game.activity for game in callers} - visited
                visited |= new
                worklist += sorted(new)
        return False

    def _can_leave(self, state: Element) -> bool:
        """Whether a transition may leave the state although its do behaviour has not ended.

        All transitions of the machine count if another state contains the state.
        """
        machine = next(
            (e for e in self._graph.ancestors(state) if e.kind is Kind.STATE_MACHINE), None
        )
        is_nested = any(e.kind is Kind.STATE for e in self._graph.ancestors(state))
        leaving = self._graph.sources(state, Edge.FLOW_SOURCE)
        if is_nested and machine is not None:
            leaving = list(self._graph.subtree(machine))
        return any(self._graph.targets(transition, Edge.TRIGGER) for transition in leaving)

    def _can_abandon(self, game: TokenGraph, call: Element) -> bool:
        """Whether a region around a call action may end, or interrupt it, before it is done."""
        node = game.node(call.id)
        if node.duration is not Duration.TIMED:
            return False
        regions = [node.region, *(outer.region for outer in game.regions_around(node.region))]
        inside = {node.id, *regions}
        if any(not inside.isdisjoint(group.nodes) for group in game.interruptibles):
            return True
        relation = self._find_relation(game)
        return any(
            relation.are_concurrent(node.id, edge.id)
            for region in regions
            for edge in game.ends(region)
        )


# -- conjuncts -----------------------------------------------------------------------------------


def derive_handshake(formulas: StepFormulas, handshake: Handshake) -> Iterator[Conjunct]:
    """Yield when the activity runs and when it has finished."""
    origin, label = formulas.graph.activity, formulas.graph.label
    running, finished = f.var(handshake.running), f.var(handshake.finished)
    first = running if handshake.is_started else f.negate(running)
    verb = "runs" if handshake.is_started else "does not run"
    yield Conjunct(first, Class.INIT, origin, f"At the start {label} {verb}.")
    goes_on = f.both(running, f.negate(finished), f.negate(formulas.stop_formula()))
    runs = f.either(formulas.begin_formula(ACTIVITY_REGION), goes_on)
    name = f"{label[:1].upper()}{label[1:]}"
    text = f"{name} runs {describe_performance(handshake)}."
    yield Conjunct(f.fold_iff(f.prime(running), runs), Class.SAFETY, origin, text)
    ends = f.both(running, formulas.completion_formula(ACTIVITY_REGION))
    text = (
        f"{name} ends in the step in which a token reaches a final node, or after which nothing "
        "is left in it."
    )
    yield Conjunct(f.fold_iff(finished, ends), Class.SAFETY, origin, text)


def describe_performance(handshake: Handshake, quote: str = "'") -> str:
    """Return from when until when an activity runs, with names of inputs between *quote*."""
    start, stop = (f"{quote}{name}{quote}" for name in (handshake.start, handshake.stop))
    ends = "until it ends" + (f" or {stop} abandons it" if handshake.stop else "")
    if not handshake.start:
        return f"from the first step {ends}, and not again"
    first = "from the first step, and " if handshake.is_started else ""
    return f"{first}from the step after {start} {ends}"
