"""What was found of a graph of a recipe: a process that stays has the same graphs again."""

from collections.abc import Callable, Iterable
from functools import wraps
from typing import TypeVar

from sysmlc.recipe.model import FlowGraph

_T = TypeVar("_T")
_MOST = 256
"""Graphs of which something is remembered; the first of more is forgotten."""


def remembered(
    find: Callable[[FlowGraph], Iterable[_T]],
) -> Callable[[FlowGraph], tuple[_T, ...]]:
    """A search in a graph that is done once while the graph is the very same value.

    An equal one is not enough: 1, 1.0 and True are equal, too.
    """
    known: dict[int, tuple[FlowGraph, tuple[_T, ...]]] = {}

    @wraps(find)
    def found(graph: FlowGraph) -> tuple[_T, ...]:
        # Who is remembered is alive, so that no other graph has its id.
        before = known.pop(id(graph), None) or (graph, tuple(find(graph)))
        known[id(graph)] = before
        if len(known) > _MOST:
            del known[next(iter(known))]
        return before[1]

    return found
