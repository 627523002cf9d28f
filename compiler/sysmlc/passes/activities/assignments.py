"""What the actions of an activity assign, and which feature each name means there."""

from collections.abc import Iterable, Iterator

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph, query
from sysmlc.logic.activities.saturation import Can, leaving
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.expressions.context import named_values
from sysmlc.logic.expressions.declared import Feature
from sysmlc.logic.expressions.elaborate import ElaborationError, Fault
from sysmlc.logic.expressions.expression import Expression
from sysmlc.logic.machines.actions import NOT_ASSIGNABLE, RULE_OF_FAULT, check_assignable
from sysmlc.logic.machines.moves import SATURATES
from sysmlc.logic.writers import Writers, called
from sysmlc.logic.written import Assigned, assigned
from sysmlc.passes.activities.refusals import ELSEWHERE, Unfollowed, report_unfollowed
from sysmlc.passes.activities.scope import Scope
from sysmlc.support.suggestions import did_you_mean


class Written(Struct, frozen=True):
    """What an action assigns; the feature is None where the activity knows none of the name."""

    said: Assigned
    feature: Feature | None


def written_by(
    graph: Graph, actions: Iterable[Element], scope: Scope, writers: Writers
) -> list[list[Written]]:
    """What each action assigns, one after the other; only those that assign something."""
    each = (assigned(graph, one) for one in actions)
    found = ([Written(one, _feature(one, scope, writers)) for one in said] for said in each)
    return [some for some in found if some]


def _feature(one: Assigned, scope: Scope, writers: Writers) -> Feature | None:
    """The feature that an activity knows by the name that is assigned to, or by its own name."""
    found = scope.named(one.name)
    if found is None:
        target = writers.target(one.action, one.name)
        near = None if target is None else scope.named(target.name)
        found = near if near is not None and near.element is target else None
    return found


def report_faults(
    graph: Graph,
    activity: Element,
    written: Iterable[list[Written]],
    scope: Scope,
    sink: Sink,
) -> None:
    """Report assignments to constants (SM415), and of values that what they assign to never has:
    of another type (SM413), or always out of range (SM414). ``written`` is what each action
    assigns.
    """
    for each in (one for statements in written for one in statements):
        one, feature = each.said, each.feature
        if feature is None or one.value is None:
            continue
        subject, text = graph.subject(one.action), f"{one.name} := {one.text}"
        if feature.constant:
            context = _owner_name(graph, activity, feature)
            sink.report(NOT_ASSIGNABLE, subject, text=text, name=one.name, context=context)
        elif fault := _find_fault(one.value, feature, scope):
            reason = str(fault)
            sink.report(
                RULE_OF_FAULT[fault.fault], subject, what="assignment", text=text, reason=reason
            )


def _owner_name(graph: Graph, activity: Element, feature: Feature) -> str:
    owner = graph.owner(feature.element)
    return activity.name if owner is None else owner.name


def _find_fault(value: Expression, feature: Feature, scope: Scope) -> ElaborationError | None:
    if feature.domain is None or feature.is_assumed:
        return None
    try:
        check_assignable(scope.value(value, feature.domain).domain, feature.domain, value)
    except ElaborationError as error:
        return error if error.fault in (Fault.TYPE, Fault.OUTSIDE) else None
    return None


def report_stops(graph: Graph, tokens: TokenGraph, sink: Sink) -> None:
    """Report each write that can leave the range of its variable, or may for all we know."""
    if not any(one.stops for store in tokens.stores for one in store.writes):
        return

    for store, write, can in leaving(tokens):
        if can is not Can.NO:
            node, name = tokens.node(write.node), store.variable.name
            subject = graph.subject(graph[node.origin])
            sink.report(SATURATES, subject, transition=node.label, can=can.value, variable=name)


UNKNOWN_TARGET = rule(
    "SM545",
    "assigns-to-nobody",
    Severity.INFO,
    "action '{action}' assigns to '{name}', which is no feature that '{activity}' or what it is in "
    "has; {suggestion}",
    help="correct the name, or give the block or the activity a property of that name",
)


def report_unknown(
    graph: Graph,
    activity: Element,
    written: Iterable[list[Written]],
    writers: Writers,
    sink: Sink,
) -> None:
    """Report each name that one of the actions assigns to and that the activity does not know."""
    # What a write action writes is a reference, no name.
    lost = (one.said for found in written for one in found if one.feature is None)
    for one in lost:
        if one.is_bound or one.action.subkind == "write":
            continue
        target = writers.target(one.action, one.name)
        if target is not None:
            if activity in graph.ancestors(target):
                continue
            label = called(graph, one.action)
            unfollowed = Unfollowed(target, ELSEWHERE, (f"action '{label}'",))
            report_unfollowed(graph, activity, [unfollowed], sink)
        elif one.name.partition(".")[0] not in (known := set(_known(graph, activity))):
            sink.report(
                UNKNOWN_TARGET,
                graph.subject(one.action),
                action=one.action.name,
                activity=activity.name,
                name=one.name,
                suggestion=did_you_mean(one.name, known),
            )


def _known(graph: Graph, activity: Element) -> Iterator[str]:
    """Names of what the activity has, and of features of the classifiers that it is in."""
    around = (activity, *graph.ancestors(activity))
    owners = [one for one in around if one.kind in query.CLASSIFIERS]
    features = (name for owner in owners for name in named_values(graph, owner))
    yield from (name for name in features if name)
    yield from (one.name for one in graph.subtree(activity) if one.name)
