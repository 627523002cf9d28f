"""Analysis ``activities``: the token graph of every activity, or a report why there is none.

The analysis assumes resolved names and roles. It guarantees that each stored token graph is 1-safe
and that every omitted node or flow has been reported. An activity of a library gets one token graph
for each operation whose method it is.
"""

from collections.abc import Iterator
from typing import ClassVar

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.analyses.activities import checks as activity_checks
from sysmlc.analyses.activities import construction as activity_tokens
from sysmlc.analyses.activities import drawing as activity_drawing
from sysmlc.analyses.activities import rules
from sysmlc.analyses.activities import safety as activity_search
from sysmlc.analyses.activities.assignments import (
    read_assignments,
    report_saturation,
    report_unassignable,
    report_unknown_targets,
    report_untracked,
)
from sysmlc.analyses.activities.exception_analysis import Raising, find_raising
from sysmlc.analyses.activities.inputs import Inputs, Scope
from sysmlc.analyses.activities.stores import track_stores
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.logic.activities.handshakes import complete_handshakes, name_handshake
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.feature_writes import WriterIndex, takes_one_step
from sysmlc.logic.requirements.statements import component_of

_START_AND_END = ("Actions::Action::start", "Actions::Action::done")


class _OtherBehaviours(Struct, frozen=True):
    """Facts about other behaviours: the exceptions they raise and the features they write."""

    raising: Raising
    writers: WriterIndex


class Activities(Struct, frozen=True):
    """Derive token graphs.

    ``max_markings`` bounds the search for a second token on a flow. In activities with more than
    ``collapse_over`` edges, control nodes that only pass tokens on are removed. An activity whose
    structured nodes are nested deeper than ``max_depth`` gets no token graph. ``assumed_range`` is
    the range of Integers without a declared range; the registry takes it from the options
    ``assumed_low`` and ``assumed_high`` of the analysis ``contracts``.
    """

    max_markings: int = 20_000
    collapse_over: int = 40
    max_depth: int = 100
    assumed_range: tuple[int, int] = (0, 15)

    name: ClassVar[str] = "activities"

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store a TokenGraph for each activity that has a valid one."""
        games = list(self._derive_all(graph, sink))
        graph.store(TokenGraph, complete_handshakes(graph, games))

    def _derive_all(self, graph: Graph, sink: Sink) -> Iterator[TokenGraph]:
        context = _analyse_behaviours(graph)
        for activity in graph.of_kind(Kind.ACTIVITY):
            for usage in _list_usages(graph, activity):
                tokens = self._derive(graph, usage, context, sink)
                if tokens is not None:
                    yield tokens

    def _derive(
        self, graph: Graph, activity: Element, context: _OtherBehaviours, sink: Sink
    ) -> TokenGraph | None:
        """Return the token graph of an activity or of an operation that performs one, or None."""
        drawn = _find_drawn(graph, activity)
        try:
            if drawn is activity:
                return self._build(graph, activity, activity.name, context, sink)
            # Faults of the drawing are reported once, for the activity that is drawn.
            tokens = self._build(graph, drawn, activity.name, context, Sink())
        except activity_drawing.CannotPlayError:
            return None
        component = component_of(graph, activity)
        label = f"action '{activity.name}'"
        return replace(tokens, activity=activity.id, component=component, label=label)

    def _build(
        self, graph: Graph, activity: Element, name: str, context: _OtherBehaviours, sink: Sink
    ) -> TokenGraph:
        """Return the token graph of a drawn activity; *name* is that of what performs its steps."""
        self._check_depth(graph, activity, sink)
        drawing = activity_drawing.read_drawing(graph, activity, sink)
        if not drawing.is_playable:
            raise activity_drawing.CannotPlayError
        if not drawing.nodes:
            _report_empty(graph, activity, _describe_binding(graph, activity), sink)
            raise activity_drawing.CannotPlayError
        _check_order(graph, drawing, sink)
        # The order matters: the stores need the nodes, and the checks of guards need the stores.
        scope = Scope(graph, activity, self.assumed_range, sink)
        inputs = Inputs(graph, scope, sink)
        tokens = activity_tokens.build(graph, drawing, inputs, context.raising, sink)
        actions, writers = _list_played_actions(drawing, tokens), context.writers
        written = read_assignments(graph, actions, scope)
        tokens, unfollowed = track_stores(graph, activity, written, tokens, scope, writers)
        tokens = activity_checks.check_tokens(graph, tokens, self.max_markings, sink)
        report_untracked(graph, activity, unfollowed, sink)
        report_unknown_targets(graph, activity, written, sink)
        report_unassignable(graph, written, scope, sink)
        report_saturation(graph, tokens, sink)
        if len(tokens.edges) > self.collapse_over:
            tokens = activity_search.collapse_if_safe(tokens, self.max_markings)
        tokens = activity_search.name_conditions(tokens, inputs.names)
        return replace(tokens, handshake=name_handshake(inputs.names, name))

    def _check_depth(self, graph: Graph, activity: Element, sink: Sink) -> None:
        for element in graph.subtree(activity):
            if (
                element.kind is Kind.STRUCTURED
                and _find_depth(graph, activity, element) > self.max_depth
            ):
                subject, limit = graph.subject(element), self.max_depth
                sink.report(rules.TOO_DEEP, subject, activity=activity.name, limit=limit)
                raise activity_drawing.CannotPlayError


def draw_tokens(graph: Graph, activity: Element) -> TokenGraph:
    """Return the token graph of an activity as it is drawn, before all checks.

    An activity whose tokens cannot be played has one, too. The analysis ``activities`` reports the
    faults. Exceptions that called behaviours raise are left out.
    """
    sink = Sink()
    drawing = activity_drawing.read_drawing(graph, activity, sink)
    inputs = Inputs(graph, Scope(graph, activity, Activities().assumed_range, sink), sink)
    raising = Raising(frozenset(), frozenset())
    return activity_tokens.build(graph, drawing, inputs, raising, sink)


def _check_order(graph: Graph, drawing: activity_drawing.Drawing, sink: Sink) -> None:
    """Report an unfinished activity: it has nodes, but nothing orders or starts them.

    By the letter of UML 2.5.1, 15.2.3, all its actions would start at once.
    """
    if drawing.activity.attrs.get("variation") and not drawing.flows:
        _report_empty(graph, drawing.activity, "is a variation: it has variants, no steps", sink)
        raise activity_drawing.CannotPlayError
    steps = [step for step in drawing.list_steps() if not _is_start_or_end(graph, step)]
    if not steps and not drawing.flows:
        _report_empty(graph, drawing.activity, "has no actions", sink)
        raise activity_drawing.CannotPlayError
    is_single = len(steps) == 1 and steps[0].kind is not Kind.CONTROL
    if not steps or is_single or drawing.flows or drawing.handlers:
        return
    activity = drawing.activity
    sink.report(rules.UNORDERED, graph.subject(activity), activity=activity.name)
    raise activity_drawing.CannotPlayError


def _is_start_or_end(graph: Graph, step: Element) -> bool:
    """Whether a step redefines the start or the end that each action of SysML v2 inherits."""
    called = graph.target(step, Edge.CALLS)
    return called is not None and called.attrs.get("qualified_name") in _START_AND_END


def _describe_binding(graph: Graph, activity: Element) -> str:
    """Return what an activity without nodes is: empty, or a template with actual parameters."""
    for part in graph.owned(activity):
        if part.kind is Kind.TEMPLATE_BINDING:
            template = graph.target(part, Edge.BINDS)
            name = "a template" if template is None else f"template '{template.name}'"
            return f"binds {name}, whose nodes it does not copy"
    return "has no nodes"


def _report_empty(graph: Graph, activity: Element, fault: str, sink: Sink) -> None:
    name = activity.name or graph.qualified_name(activity)
    # Bound templates are one fact of a file, because tools such as those for Alf generate many.
    cause = "bound templates" if "binds" in fault else ""
    sink.report(rules.EMPTY, graph.subject(activity), cause=cause, activity=name, fault=fault)


def _analyse_behaviours(graph: Graph) -> _OtherBehaviours:
    return _OtherBehaviours(find_raising(graph), WriterIndex(graph))


def _find_depth(graph: Graph, activity: Element, inside: Element) -> int:
    """Return the nesting depth of an element in the activity: 1 if the activity owns it."""
    ancestors = enumerate(graph.ancestors(inside), 1)
    return next(number for number, ancestor in ancestors if ancestor is activity)


def _list_played_actions(
    drawing: activity_drawing.Drawing, tokens: TokenGraph
) -> Iterator[Element]:
    """Return the actions that have a token node of their own."""
    played = {node.id for node in tokens.workers()}
    return (
        element
        for element in drawing.inside
        if element.kind in (Kind.ACTION, Kind.ACTIVITY) and element.id in played
    )


def _list_usages(graph: Graph, activity: Element) -> list[Element]:
    """Return the activity, or the operations that perform it if it belongs to a library.

    An abstract activity with such operations is treated like an activity of a library, because
    nothing else performs it.
    """
    is_elsewhere, is_abstract = _is_drawn_elsewhere(activity), activity.attrs.get("abstract")
    if not (is_elsewhere or is_abstract) or _has_assignments_as_text(graph, activity):
        return [activity]
    performed = graph.sources(activity, Edge.METHOD)
    operations = [operation for operation in performed if not operation.attrs.get("external")]
    if operations and has_steps(graph, activity):
        return operations
    return [] if is_elsewhere else [activity]


def _is_drawn_elsewhere(activity: Element) -> bool:
    """Whether the element has no drawing of its own.

    An opaque behaviour has a text body instead, and an external stub stands for another file.
    """
    return activity.subkind in ("opaque", "function") or activity.attrs.get("external") is True


def _has_assignments_as_text(graph: Graph, activity: Element) -> bool:
    """Whether an activity is a text of assignments, and no part of the step of a state machine.

    Entries, exits and effects with such texts belong to the contract of their state machine. The do
    behaviour of a state runs on its own.
    """
    if activity.attrs.get("external") or not takes_one_step(activity):
        return False
    owner = graph.owner(activity)
    is_inside_machine = owner is not None and (
        owner.kind in (Kind.STATE, Kind.TRANSITION)
        or activity in graph.targets(owner, Edge.ENTRY)
        or activity in graph.targets(owner, Edge.EXIT)
    )
    return not is_inside_machine or bool(graph.sources(activity, Edge.DO))


_STEPS = (Kind.ACTION, Kind.CONTROL, Kind.STRUCTURED)


def has_steps(graph: Graph, activity: Element) -> bool:
    """Whether the activity has nodes of its own, not only inherited or referential ones."""
    return any(
        element.kind in _STEPS and query.is_performed(graph, element)
        for element in graph.owned(activity)
    )


def _find_drawn(graph: Graph, usage: Element) -> Element:
    """Return the activity whose nodes the activity or operation *usage* performs.

    For an operation this is its method. For an activity without nodes this is the nearest general
    activity with nodes. If there is no such activity, the result is *usage*.
    """
    method = graph.target(usage, Edge.METHOD) if usage.kind is Kind.OPERATION else usage
    if method is None or has_steps(graph, method):
        return method or usage
    drawn = (general for general in query.generals(graph, method) if has_steps(graph, general))
    return next(drawn, usage)
