"""The pass ``activities``: every activity becomes a token graph, or a rule says why not.

It assumes that names are resolved and roles found; it then guarantees that each stored token
graph is 1-safe and that every node and flow that is left out has been reported. The graph itself
stays as it is. An activity of a library is played by each operation that it is the method of.
"""

from collections.abc import Iterator
from typing import ClassVar

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.requirements.statements import component_of
from sysmlc.logic.writers import Writers
from sysmlc.passes.activities import checks as activity_checks
from sysmlc.passes.activities import construction as activity_tokens
from sysmlc.passes.activities import drawing as activity_drawing
from sysmlc.passes.activities import rules
from sysmlc.passes.activities import safety as activity_search
from sysmlc.passes.activities.assignments import (
    report_faults,
    report_stops,
    report_unknown,
    written_by,
)
from sysmlc.passes.activities.exception_analysis import Raising, find_raising
from sysmlc.passes.activities.inputs import Inputs
from sysmlc.passes.activities.refusals import report_unfollowed
from sysmlc.passes.activities.scope import Scope
from sysmlc.passes.activities.stores import follow


class _Others(Struct, frozen=True):
    """What other behaviours do that matters to an activity: raise exceptions, write features."""

    raising: Raising
    writers: Writers


class Activities(Struct, frozen=True):
    """Makes token graphs.

    ``max_markings`` bounds the search for a second token on a flow; activities with more than
    ``collapse_over`` edges lose the control nodes that only pass tokens on. Structured nodes that
    are nested deeper than ``max_depth`` are not followed.
    """

    max_markings: int = 20_000
    collapse_over: int = 40
    max_depth: int = 100

    name: ClassVar[str] = "activities"
    after: ClassVar[tuple[str, ...]] = ("classify", "flows")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store a TokenGraph for each activity that can be played."""
        graph.store(TokenGraph, self._token_graphs(graph, sink))

    def _token_graphs(self, graph: Graph, sink: Sink) -> Iterator[TokenGraph]:
        others = _others(graph)
        for activity in graph.of_kind(Kind.ACTIVITY):
            for one in _played(graph, activity):
                found = self._found(graph, one, others, sink)
                if found is not None:
                    yield found

    def _found(
        self, graph: Graph, activity: Element, others: _Others, sink: Sink
    ) -> TokenGraph | None:
        drawn = drawn_of(graph, activity)
        try:
            if drawn is activity:
                return self._token_graph(graph, activity, others, sink)
            # What is odd in a drawing is told where it is drawn.
            tokens = self._token_graph(graph, drawn, others, Sink())
        except activity_drawing.CannotPlayError:
            return None
        component = component_of(graph, activity)
        label = f"action '{activity.name}'"
        return replace(tokens, activity=activity.id, component=component, label=label)

    def _token_graph(
        self, graph: Graph, activity: Element, others: _Others, sink: Sink
    ) -> TokenGraph:
        self._check_depth(graph, activity, sink)
        drawing = activity_drawing.read(graph, activity, sink)
        if not drawing.nodes:
            sink.report(rules.EMPTY, graph.subject(activity), activity=activity.name)
            raise activity_drawing.CannotPlayError
        scope = Scope(graph, activity, sink)
        inputs = Inputs(graph, scope, sink)
        tokens = activity_tokens.build(graph, drawing, inputs, others.raising, sink)
        actions, writers = _played_actions(drawing, tokens), others.writers
        written = written_by(graph, actions, scope, writers)
        tokens, unfollowed = follow(graph, activity, written, tokens, scope, writers)
        tokens = activity_checks.check(graph, tokens, self.max_markings, sink)
        report_unfollowed(graph, activity, unfollowed, sink)
        report_unknown(graph, activity, written, writers, sink)
        report_faults(graph, activity, written, scope, sink)
        report_stops(graph, tokens, sink)
        if len(tokens.edges) > self.collapse_over:
            tokens = activity_search.collapsed(tokens, self.max_markings)
        return activity_search.named(tokens, inputs.names)

    def _check_depth(self, graph: Graph, activity: Element, sink: Sink) -> None:
        for element in graph.subtree(activity):
            if (
                element.kind is Kind.STRUCTURED
                and _depth(graph, activity, element) > self.max_depth
            ):
                subject, limit = graph.subject(element), self.max_depth
                sink.report(rules.TOO_DEEP, subject, activity=activity.name, limit=limit)
                raise activity_drawing.CannotPlayError


def _others(graph: Graph) -> _Others:
    return _Others(find_raising(graph), Writers(graph))


def _depth(graph: Graph, activity: Element, inside: Element) -> int:
    """How deep an element is in the activity: 1 for what the activity owns."""
    around = enumerate(graph.ancestors(inside), 1)
    return next(number for number, one in around if one is activity)


def _played_actions(drawing: activity_drawing.Drawing, tokens: TokenGraph) -> Iterator[Element]:
    """The actions that have a token of their own."""
    played = {node.id for node in tokens.workers()}
    return (one for one in drawing.inside if one.kind is Kind.ACTION and one.id in played)


def _played(graph: Graph, activity: Element) -> list[Element]:
    """The activity, or the operations that are performed as an activity of a library says.

    An abstract activity that operations perform is one of those, too: nothing else is it.
    """
    is_elsewhere, is_abstract = _is_drawn_elsewhere(activity), activity.attrs.get("abstract")
    if not (is_elsewhere or is_abstract):
        return [activity]
    performed = graph.sources(activity, Edge.METHOD)
    own = [one for one in performed if not one.attrs.get("external")]
    if own and has_steps(graph, activity):
        return own
    return [] if is_elsewhere else [activity]


def _is_drawn_elsewhere(activity: Element) -> bool:
    """An opaque behaviour has a body instead of a drawing; a stub stands for another file."""
    return activity.subkind in ("opaque", "function") or activity.attrs.get("external") is True


_STEPS = (Kind.ACTION, Kind.CONTROL, Kind.STRUCTURED)


def has_steps(graph: Graph, activity: Element) -> bool:
    """Whether something is drawn in the activity itself."""
    return any(one.kind in _STEPS for one in graph.owned(activity))


def drawn_of(graph: Graph, usage: Element) -> Element:
    """The activity whose steps a usage performs: its method's, or those of the nearest that it
    specialises when it draws none; the usage itself when there is no other.
    """
    method = graph.target(usage, Edge.METHOD) if usage.kind is Kind.OPERATION else usage
    if method is None or has_steps(graph, method):
        return method or usage
    drawn = (one for one in query.generals(graph, method) if has_steps(graph, one))
    return next(drawn, usage)
