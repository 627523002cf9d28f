"""Transitions begin in states, and what is assigned may change (SysML 8.3.16, 8.3.17)."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, rule
from sysmlc.language.checks.found import Found, name_of, written
from sysmlc.language.metaclasses import is_composite, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Node

NO_STATE = rule(
    "SM276",
    "accepts-outside-state",
    Severity.ERROR,
    "'{name}' is no state, so nothing waits in it to accept",
    help="let the transition begin in a state",
)
UNCHANGING = rule(
    "SM277",
    "assigns-unchanging",
    Severity.ERROR,
    "'{name}' is part of what happens, and nothing can be assigned to it",
    help="assign to an attribute, item or reference",
)

_MEMBERSHIP = frozenset({"Membership"})
_ACTIONS = kinds_of("ActionUsage")
_STATES = kinds_of("StateUsage")


def check_source(model: Model, node: Node) -> Iterator[Found]:
    """Report what a transition accepts when its source is an action that is no state."""
    triggers = [one for one in node.members if one.role == "trigger"]
    for _, source in written(node, _MEMBERSHIP):
        if triggers and source.kind in _ACTIONS - _STATES:
            yield Found(NO_STATE, triggers[0].start, {"name": name_of(model, source)})


def check_assigned(model: Model, node: Node) -> Iterator[Found]:
    """Report an assignment to a composite action."""
    for relation, target in written(node, _MEMBERSHIP):
        if target.kind in _ACTIONS and is_composite(target):
            yield Found(UNCHANGING, relation.reference.start, {"name": name_of(model, target)})


CHECKS = (
    (frozenset({"TransitionUsage"}), check_source),
    (frozenset({"AssignmentActionUsage"}), check_assigned),
)
