"""Activities of assignments that entries, exits and effects perform within the step of a machine.

A chain of assignments is part of the run-to-completion step, so the machine has the assignments in
their order. Other activities are performances, or nothing is decided about them.
"""

from collections.abc import Collection

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import (
    Assignment,
    last_name,
    list_names,
    name_of,
    walk_tree,
)
from sysmlc.logic.expressions.context import Context, find_literal, make_symbol
from sysmlc.logic.expressions.elaboration import ElaborationError, Symbol, elaborate_value
from sysmlc.logic.expressions.features import check_assignable
from sysmlc.logic.expressions.parsing import performed_name
from sysmlc.logic.feature_writes import WriterIndex, read_assignments, takes_one_step

_INSTANT = (Edge.ENTRY, Edge.EXIT, Edge.EFFECT)
_HARMLESS = {Edge.OWNS, Edge.FEATURE, Edge.CLASSIFIER_BEHAVIOR, Edge.ALLOCATED_TO, Edge.SATISFIES}
_UNSEEN = [edge for edge in Edge if edge not in {*_HARMLESS, *_INSTANT, Edge.DO}]
"""Edges from what may perform an activity in a way that no state or transition names."""


def find_instant_steps(
    graph: Graph, behaviour: Element, classifier: Element | None, index: WriterIndex
) -> tuple[Element, ...]:
    """Return the actions that an entry, exit or effect performs within the step, in their order.

    The behaviour is drawn as a chain of assignments, or its text names such an activity of
    *classifier*, the type of the object that has the machine. The result is empty for others.
    Names are looked up in *index*.
    """
    activity = behaviour if graph.owned(behaviour) else None
    if activity is None and classifier is not None:
        activity = _find_named_activity(graph, behaviour, classifier)
    if activity is None or activity.kind is not Kind.ACTIVITY or activity.attrs.get("body"):
        return ()
    actions = query.list_chained_actions(graph, activity)
    is_instant = all(
        takes_one_step(action) and _shares_names(graph, action, behaviour, index)
        for action in actions
    )
    return actions if is_instant else ()


def _shares_names(graph: Graph, step: Element, behaviour: Element, index: WriterIndex) -> bool:
    """Whether the features that a step names are the same for a behaviour of the machine."""
    paths = {
        ".".join(names[:end])
        for assignment in read_assignments(step)
        for names in (name.split(".") for name in _list_names(assignment))
        for end in range(1, len(names) + 1)
    }
    return all(
        _is_same_feature(
            graph, index.resolve_target(step, path), index.resolve_target(behaviour, path)
        )
        for path in paths
    )


def _is_same_feature(graph: Graph, element: Element | None, special: Element | None) -> bool:
    """Whether two features are one, or the second redefines the first; or neither exists."""
    redefined = [] if special is None else query.redefined_features(graph, special)
    return element == special or element in redefined


def _list_names(assignment: Assignment) -> list[str]:
    """Return the names in an assignment, the target first."""
    parts = (assignment.target, *walk_tree(assignment.value))
    return [name_of(part) or "" for part in parts]


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


def find_target(
    graph: Graph, assignment: Assignment, step: Element, context: Context, index: WriterIndex
) -> str:
    """Return the name of the feature that a step assigns, or "" if no formula describes it.

    The names in *context*, that of the machine, must mean the same in the step.
    """
    features, target = context.features, name_of(assignment.target) or ""
    feature = features.get(target)
    if feature is None or feature.domain is None or feature.is_constant:
        return ""

    def find_symbol(name: str) -> Symbol | None:
        return make_symbol(features[name]) if name in features else find_literal(context, name)

    try:
        value = elaborate_value(assignment.value, find_symbol, feature.domain)
        check_assignable(value.domain, feature.domain, assignment.value)
    except ElaborationError:
        return ""
    is_same = all(
        _is_same_feature(graph, index.resolve_target(step, name), features[name].element)
        for name in _list_names(assignment)
        if name in features
    )
    return target if is_same else ""


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
