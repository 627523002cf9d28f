"""What the actions of an activity assign, and which feature each name means there."""

from collections.abc import Iterable

from msgspec import Struct

from sysmlc.ir import Element, Graph
from sysmlc.logic.expressions.declared import Feature
from sysmlc.logic.writers import Writers
from sysmlc.logic.written import Assigned, assigned
from sysmlc.passes.activities.scope import Scope
from sysmlc.values import dataclass


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
