"""Activities of assignments that entries, exits and effects perform within the step of a machine.

A chain of assignments is part of the run-to-completion step, so the machine has the assignments in
their order. Other activities are performances, or nothing is decided about them.
"""

from collections.abc import Collection
from functools import partial

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import (
    Assignment,
    Expression,
    Statement,
    element_of,
    last_name,
    list_names,
    name_of,
    walk_tree,
)
from sysmlc.logic.expressions.context import Context, find_symbol
from sysmlc.logic.expressions.elaboration import elaborate_value
from sysmlc.logic.expressions.features import check_assignable
from sysmlc.logic.expressions.named_elements import VALUE_KINDS
from sysmlc.logic.expressions.parsing import performed_name
from sysmlc.logic.expressions.symbols import ElaborationError
from sysmlc.logic.feature_writes import takes_one_step

_INSTANT = (Edge.ENTRY, Edge.EXIT, Edge.EFFECT)
_HARMLESS = {Edge.OWNS, Edge.FEATURE, Edge.CLASSIFIER_BEHAVIOR, Edge.ALLOCATED_TO, Edge.SATISFIES}
_UNSEEN = [edge for edge in Edge if edge not in {*_HARMLESS, *_INSTANT, Edge.DO}]
"""Edges from what may perform an activity in a way that no state or transition names."""


def find_instant_steps(
    graph: Graph, behaviour: Element, classifier: Element | None
) -> tuple[Element, ...]:
    """Return the actions that an entry, exit or effect performs within the step, in their order.

    The behaviour is drawn as a chain of assignments, or its text names such an activity of
    *classifier*, the type of the object that has the machine. The result is empty for others.
    """
    activity = behaviour if graph.owned(behaviour) else None
    if activity is None and classifier is not None:
        activity = _find_named_activity(graph, behaviour, classifier)
    if activity is None or activity.kind is not Kind.ACTIVITY or activity.attrs.get("body"):
        return ()
    actions = query.list_chained_actions(graph, activity)
    return actions if all(map(takes_one_step, actions)) else ()


def _find_named_activity(graph: Graph, behaviour: Element, classifier: Element) -> Element | None:
    """Return the activity of a classifier or its generals that the text of a behaviour names.

    The result is None if several of their members have the name, or a member of the machine has it.
    """
    name = performed_name(str(behaviour.attrs.get("body", "")))
    family = (classifier, *query.generals(graph, classifier))
    for scope in graph.ancestors(behaviour):
        owners = family if scope in family else (scope,)
        members = [m for owner in owners for m in graph.owned(owner) if name and m.name == name]
        if members or scope in family:
            is_only = len(members) == 1 and members[0].kind is Kind.ACTIVITY
            return members[0] if is_only and scope in family else None
    return None


def may_name(graph: Graph, behaviour: Element, activity: Element) -> bool:
    """Whether the text of a behaviour is a path to an activity, or its name where it is visible."""
    body = str(behaviour.attrs.get("body", ""))
    owner = graph.owner(activity)
    if body != activity.name or owner is None or owner.kind not in query.CLASSIFIERS:
        return bool(body) and last_name(body) == activity.name
    return bool(body) and any(
        query.conforms(graph, scope, owner) or query.conforms(graph, owner, scope)
        for scope in graph.ancestors(behaviour)
    )


def find_target(graph: Graph, assignment: Assignment, context: Context) -> str:
    """Return the name of the feature that a step assigns, or "" if no formula describes it.

    The names in *context*, that of the machine, must mean the same in the step.
    """
    features, target = context.features, name_of(assignment.target) or ""
    feature = features.get(target)
    if feature is None or feature.domain is None or feature.is_constant:
        return ""
    try:
        value = elaborate_value(assignment.value, partial(find_symbol, context), feature.domain)
        check_assignable(value.domain, feature.domain, assignment.value)
    except ElaborationError:
        return ""
    nodes = walk_tree((assignment,))
    return target if all(_means_same(graph, node, context) for node in nodes) else ""


def _means_same(graph: Graph, node: Expression | Statement, context: Context) -> bool:
    """Whether a name of a value denotes a feature that has the name in a context, too.

    The feature of the context may redefine the one that the name denotes.
    """
    element = graph.get(element_of(node))
    feature = context.features.get(name_of(node) or "")
    if feature is None:
        return element is None or element.kind not in VALUE_KINDS
    redefined = query.redefined_features(graph, feature.element)
    return element == feature.element or element in redefined


def has_unknown_performer(graph: Graph, activity: Element, machines: Collection[str]) -> bool:
    """Whether something may perform an activity that is not the owner or of a known kind.

    Known are states and transitions with an id in *machines*, and all behaviours whose text is the
    name of the activity.
    """
    owners = graph.sources(activity, Edge.CLASSIFIER_BEHAVIOR)
    users = [user for edge in (*_INSTANT, Edge.DO) for user in graph.sources(activity, edge)]
    return (
        any(graph.sources(activity, edge) for edge in _UNSEEN)
        or any(owner != graph.owner(activity) for owner in owners)
        or any(user.id not in machines for user in users)
        or (bool(activity.name) and _is_mentioned(graph, activity.name))
    )


def _is_mentioned(graph: Graph, name: str) -> bool:
    """Whether a text names an activity; a behaviour whose whole text is the name does not count."""
    bodies = ((e, str(e.attrs.get("body", ""))) for e in graph.of_kind(Kind.ACTIVITY, Kind.ACTION))
    return any(
        name in list_names(body) and (element.kind is Kind.ACTION or performed_name(body) != name)
        for element, body in bodies
        if name in body
    )
