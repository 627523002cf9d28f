"""Assignments of an activity: the features that they set, and reports of faulty assignments.

A feature that an activity assigns, but that its contract does not track, is reported with the
reason (SM544).
"""

from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct

from sysmlc.analyses.activities.inputs import Scope
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph, query
from sysmlc.ir.expressions import Expression
from sysmlc.logic.activities.saturation import Possibility, find_saturating_writes
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.expressions.context import describe_missing_range
from sysmlc.logic.expressions.features import Feature, check_assignable
from sysmlc.logic.expressions.named_elements import find_named_values
from sysmlc.logic.expressions.symbols import ElaborationError, Fault
from sysmlc.logic.feature_writes import FeatureWrite, find_label, iter_writes
from sysmlc.logic.machines.actions import (
    IS_CONSTANT,
    NOT_ASSIGNABLE,
    RULE_OF_FAULT,
)
from sysmlc.logic.machines.moves import SATURATES
from sysmlc.support.suggestions import did_you_mean


class ResolvedAssignment(Struct, frozen=True):
    """An assignment of an action. ``feature`` is None if the activity does not know the name."""

    assignment: FeatureWrite
    feature: Feature | None


def read_assignments(
    graph: Graph, actions: Iterable[Element], scope: Scope
) -> list[list[ResolvedAssignment]]:
    """Return one list for each action with assignments, in the order of their execution."""
    assignments = (iter_writes(graph, action) for action in actions)
    resolved = (
        [
            ResolvedAssignment(action, _resolve_target(action, scope))
            for action in assigned_by_action
        ]
        for assigned_by_action in assignments
    )
    return [row for row in resolved if row]


def _resolve_target(assignment: FeatureWrite, scope: Scope) -> Feature | None:
    """Return the feature that an assignment sets, or None if the activity does not know it.

    The activity may know the feature under another name, such as ``busy`` for ``robot.busy``. But
    a path through a feature leads to another object: ``busy`` of this object is not meant, even if
    both inherit it.
    """
    feature = scope.find_feature(assignment.name)
    head, dot, _ = assignment.name.partition(".")
    leads_away = bool(dot) and scope.find_feature(head) is not None
    if feature is None and not leads_away:
        target = assignment.target
        same_feature = None if target is None else scope.find_feature(target.name)
        feature = (
            same_feature if same_feature is not None and same_feature.element is target else None
        )
    return feature


def report_unassignable(
    graph: Graph,
    written: Iterable[list[ResolvedAssignment]],
    scope: Scope,
    sink: Sink,
) -> None:
    """Report assignments that are invalid, by the same rules as in state machines.

    These are assignments to constants (SM415), of values of another type (SM413), and of values
    that are always out of range (SM414).
    """
    for resolved in (assignment for statements in written for assignment in statements):
        assignment, feature = resolved.assignment, resolved.feature
        if feature is None or assignment.value is None:
            continue
        subject, text = graph.subject(assignment.action), f"{assignment.name} := {assignment.text}"
        if feature.is_constant:
            sink.report(
                NOT_ASSIGNABLE,
                subject,
                text=text,
                name=assignment.name,
                consequence="",
                reason=IS_CONSTANT.reason,
                advice=IS_CONSTANT.advice,
            )
        elif fault := _find_fault(assignment.value, feature, scope):
            reason = str(fault)
            sink.report(
                RULE_OF_FAULT[fault.fault], subject, what="assignment", text=text, reason=reason
            )


def _find_fault(value: Expression, feature: Feature, scope: Scope) -> ElaborationError | None:
    # The compiler chose an assumed range, so that a value outside it is no fault of the author.
    if feature.domain is None or feature.is_assumed:
        return None
    try:
        check_assignable(scope.evaluate(value, feature.domain).domain, feature.domain, value)
    except ElaborationError as error:
        return error if error.fault in (Fault.TYPE, Fault.OUTSIDE) else None
    return None


def report_saturation(graph: Graph, tokens: TokenGraph, sink: Sink) -> None:
    """Report each assignment that leaves, or may leave, the range of its variable (SM428)."""
    if not any(write.stops for store in tokens.stores for write in store.writes):
        return

    for store, write, can in find_saturating_writes(tokens):
        if can is not Possibility.NO:
            node, name = tokens.node(write.node), store.variable.name
            subject = graph.subject(graph[node.origin])
            sink.report(SATURATES, subject, transition=node.label, can=can.value, variable=name)


UNKNOWN_TARGET = rule(
    "SM545",
    "assigns-to-nobody",
    Severity.INFO,
    "action '{action}' assigns to '{name}', but neither '{activity}' nor an "
    "element that contains it has such a feature; {suggestion}",
    help="correct the name, or give the block or the activity a property of that name",
)


def report_unknown_targets(
    graph: Graph,
    activity: Element,
    written: Iterable[list[ResolvedAssignment]],
    sink: Sink,
) -> None:
    """Report assigned names that are unknown (SM545) or belong to another object (SM544)."""
    # A write action refers to its target by id, so that the name cannot be wrong.
    unresolved = (
        resolved.assignment for row in written for resolved in row if resolved.feature is None
    )
    for assignment in unresolved:
        if assignment.is_bound or assignment.action.subkind == "write":
            continue
        target = assignment.target
        if target is not None:
            if activity in graph.ancestors(target):
                continue
            label = find_label(graph, assignment.action)
            writers_by_label = {f"action '{label}'": assignment.action}
            unfollowed = UntrackedFeature(target, OTHER_OBJECT, writers_by_label)
            report_untracked(graph, activity, [unfollowed], sink)
        elif assignment.name.partition(".")[0] not in (
            known_names := set(_list_known_names(graph, activity))
        ):
            sink.report(
                UNKNOWN_TARGET,
                graph.subject(assignment.action),
                action=assignment.action.name,
                activity=activity.name,
                name=assignment.name,
                suggestion=did_you_mean(assignment.name, known_names),
            )


def _list_known_names(graph: Graph, activity: Element) -> Iterator[str]:
    """Yield the names of the elements in the activity and of the features of its owners."""
    scopes = (activity, *graph.ancestors(activity))
    owners = [element for element in scopes if element.kind in query.CLASSIFIERS]
    features = (name for owner in owners for name in find_named_values(graph, owner))
    yield from (name for name in features if name)
    yield from (element.name for element in graph.subtree(activity) if element.name)


# -- untracked features ------------------------------------------------------------------------

UNTRACKED = rule(
    "SM544",
    "guard-reads-what-is-written",
    Severity.INFO,
    "the contract of '{activity}' treats '{name}' as an input although {writers} {verb} "
    "it: {reason}",
    help="{advice}, or specify its value in a requirement",
)


class Refusal(Struct, frozen=True):
    """The reason why a contract cannot track a feature, and the advice for the author."""

    reason: str
    advice: str
    is_declared: bool = False
    """Whether the declaration of the feature is the reason; else the assignments are."""


NO_FINITE_DOMAIN = Refusal(
    "it has no finite type", "type it by a Boolean, an enumeration or an Integer", is_declared=True
)
NO_RANGE = Refusal(
    "it has no range", "constrain it ({name} >= 0 and {name} <= 9)", is_declared=True
)
SEVERAL_VALUES = Refusal(
    "it has several values", "give each value a name of its own", is_declared=True
)
GIVEN_OR_CONSTANT = Refusal(
    "others decide it too", "assign to a feature that is neither given nor constant"
)
OTHER_OBJECT = Refusal("it belongs to another object", "let the object itself do it (an operation)")
UNKNOWN_VALUE = Refusal(
    "the contract does not follow the assigned value",
    "assign an expression over features in the action",
)


def refuse_shared(writer: str) -> Refusal:
    """Return the refusal of a feature that the behaviour *writer* assigns, too."""
    return Refusal(f"'{writer}' assigns it too", "let only one behaviour assign it")


class UntrackedFeature(Struct, frozen=True):
    """An assigned feature that is not tracked, the reason, and the actions that assign it."""

    feature: Element
    refusal: Refusal
    writers: Mapping[str, Element]
    """The assigning actions by their labels."""


def _describe_cause(untracked: UntrackedFeature) -> str:
    """Return the cause of the findings that the contracts of several activities have."""
    id = untracked.feature.id
    return describe_missing_range(id) if untracked.refusal is NO_RANGE else f"untracked {id}"


def report_untracked(
    graph: Graph, activity: Element, untracked: Iterable[UntrackedFeature], sink: Sink
) -> None:
    """Report each feature that the contract treats as an input although actions assign it.

    The finding is at the feature if its declaration is the reason, else at each assigning action.
    """
    for feature in untracked:
        element, refusal = feature.feature, feature.refusal
        for place in [element] if refusal.is_declared else feature.writers.values():
            sink.report(
                UNTRACKED,
                graph.subject(place),
                cause=_describe_cause(feature),
                activity=find_label(graph, activity),
                name=element.name,
                writers=" and ".join(feature.writers),
                verb="assigns" if len(feature.writers) == 1 else "assign",
                reason=refusal.reason,
                advice=refusal.advice.format(name=element.name),
            )
