"""What refines a task or a service: its graph, what that calls, and what is to be said of it."""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.ir import Element, Kind
from sysmlc.passes.recipe.context import Context
from sysmlc.passes.recipe.graphs import flow_graph
from sysmlc.passes.recipe.nodes import by_position, step_kind
from sysmlc.passes.recipe.regions import is_inlined
from sysmlc.recipe.model import FlowGraph

_LEVELS = {"service": "service", "function": "machine function"}


class Called(Struct, frozen=True):
    """A service, machine function or helper that a node calls, both by their ids."""

    kind: str
    node: str
    definition: str


class Refined(Struct, frozen=True):
    """An activity that refines a task or a service.

    ``remarks`` are ids of nodes whose content is left out, with an empty text, and of what is
    called by position, with the level that it is taken for.
    """

    graph: FlowGraph
    calls: tuple[Called, ...]
    remarks: tuple[tuple[str, str], ...]


def refined(context: Context, activity: Element, inside: str) -> Refined:
    """Return what an activity that refines a task or a service (*inside*) consists of."""
    refinement = context.refinements.get((inside, activity.id))
    if refinement is None:
        graph = flow_graph(context, activity, inside)
        calls = tuple(_calls(context, activity, inside))
        refinement = Refined(graph, calls, tuple(_remarks(context, activity, inside)))
        context.refinements[inside, activity.id] = refinement
    return refinement


def _calls(context: Context, activity: Element, inside: str) -> Iterator[Called]:
    for node in context.nodes(activity):
        kind = step_kind(context, node, inside)
        if kind in ("call", "service", "function"):
            called = context.definition(node) or node
            yield Called(kind, node.id, called.id)


def _remarks(context: Context, activity: Element, inside: str) -> Iterator[tuple[str, str]]:
    for node in context.nodes(activity):
        kind = step_kind(context, node, inside)
        if node.kind is Kind.STRUCTURED and not is_inlined(context.graph, node):
            yield node.id, ""
        elif by_position(context, node, kind):
            yield (context.definition(node) or node).id, _LEVELS[kind]
