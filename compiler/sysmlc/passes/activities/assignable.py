"""Assignments of an activity that cannot be what was meant, by the rules of state machines."""

from collections.abc import Iterable

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph
from sysmlc.logic.expressions.declared import Feature
from sysmlc.logic.expressions.elaborate import ElaborationError, Fault
from sysmlc.logic.expressions.expression import Expression
from sysmlc.logic.machines.actions import NOT_ASSIGNABLE, RULE_OF, check_assignable
from sysmlc.passes.activities.assignments import Written
from sysmlc.passes.activities.scope import Scope


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
            context = _context(graph, activity, feature)
            sink.report(NOT_ASSIGNABLE, subject, text=text, name=one.name, context=context)
        elif fault := _fault(one.value, feature, scope):
            reason = str(fault)
            sink.report(RULE_OF[fault.fault], subject, what="assignment", text=text, reason=reason)


def _context(graph: Graph, activity: Element, feature: Feature) -> str:
    owner = graph.owner(feature.element)
    return activity.name if owner is None else owner.name


def _fault(value: Expression, feature: Feature, scope: Scope) -> ElaborationError | None:
    if feature.domain is None or feature.is_assumed:
        return None
    try:
        check_assignable(scope.value(value, feature.domain).domain, feature.domain, value)
    except ElaborationError as error:
        return error if error.fault in (Fault.TYPE, Fault.OUTSIDE) else None
    return None
