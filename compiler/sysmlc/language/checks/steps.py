"""Transitions begin in states, and what is assigned may change (SysML 8.3.16, 8.3.17)."""

from collections.abc import Iterator

from sysmlc.language.checks.found import Found, error, name_of, written
from sysmlc.language.metaclasses import is_composite, kinds_of
from sysmlc.language.names import Model
from sysmlc.language.tree import Node

NO_STATE = error(
    "SM276",
    "accepts-outside-state",
    "'{name}' is no state, so nothing waits in it to accept",
    "A transition that accepts something is taken while its source state is active (SysML 2.0, "
    "validateTransitionUsageTriggerActions).",
    "let the transition begin in a state",
    "item def Go;\nstate def Run { action a; state b; transition first a accept Go then b; }\n",
    "item def Go;\nstate def Run { state a; state b; transition first a accept Go then b; }\n",
)
UNCHANGING = error(
    "SM277",
    "assigns-unchanging",
    "'{name}' is part of what happens, and nothing can be assigned to it",
    "What is assigned varies in time; a composite action is there as long as its owner (SysML "
    "2.0, validateAssignmentActionUsageReferent).",
    "assign to an attribute, item or reference",
    "item gate { action open; }\naction def Do { assign gate.open := null; }\n",
    "item gate { ref item lock; }\naction def Do { assign gate.lock := null; }\n",
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
