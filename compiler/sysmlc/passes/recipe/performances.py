"""Blocks that perform a recipe: which of their parts are its machines, what does its steps."""

from collections.abc import Iterable, Iterator

from sysmlc.ir import Edge, Element, Kind
from sysmlc.passes.recipe.context import Context
from sysmlc.recipe.model import Performance


def performances(
    context: Context, recipe: Element, graphs: Iterable[str]
) -> tuple[Performance, ...]:
    """What the blocks whose behaviour the recipe is say of it, sorted by the block.

    ``graphs`` are the ids of the activities whose nodes the recipe's graphs have.
    """
    owners = {recipe.id, *graphs}
    blocks = context.graph.sources(recipe, Edge.CLASSIFIER_BEHAVIOR)
    found = (_performance(context, block, recipe, owners) for block in blocks)
    said = (one for one in found if one.arguments or one.steps)
    return tuple(sorted(said, key=lambda one: one.block))


def _performance(
    context: Context, block: Element, recipe: Element, owners: set[str]
) -> Performance:
    arguments: dict[str, str] = {}
    steps: dict[str, str] = {}
    for client, path in _allocated(context, block):
        if client.kind is Kind.PARAMETER and client.owner == recipe.id:
            arguments[client.name] = path
        elif client.kind is not Kind.PARAMETER and client.owner in owners:
            steps[context.name(client)] = path
    name = context.name(block)
    return Performance(name, _sorted(arguments), _sorted(steps), block.id)


def _allocated(context: Context, block: Element) -> Iterator[tuple[Element, str]]:
    """What the block allocates, and the path from the block to what it is allocated to."""
    graph = context.graph
    for one in graph.owned(block):
        if one.kind is Kind.DEPENDENCY and one.role == "allocate":
            client, supplier = graph.target(one, Edge.CLIENT), graph.target(one, Edge.SUPPLIER)
            if client is not None and supplier is not None:
                yield client, ".".join([*_path(context, one), context.label(supplier)])


def _path(context: Context, allocation: Element) -> Iterator[str]:
    given = allocation.attrs.get("target_path")
    for id in given if isinstance(given, tuple) else str(given or "").split():
        found = context.graph.get(str(id))
        yield str(id) if found is None else context.label(found)


def _sorted(pairs: dict[str, str]) -> tuple[tuple[str, str], ...]:
    return tuple(sorted(pairs.items()))
