"""One recipe with the closure of what it refers to."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Protocol, TypeVar

from sysmlc.ir import Edge, Element, Kind
from sysmlc.passes.recipe.context import Context, word
from sysmlc.passes.recipe.data import Data
from sysmlc.passes.recipe.graphs import refined
from sysmlc.passes.recipe.machine_variables import with_variables
from sysmlc.passes.recipe.machines import machine, material
from sysmlc.passes.recipe.nodes import activity_flows, refinement
from sysmlc.passes.recipe.services import function, service
from sysmlc.passes.recipe.tasks import (
    Step,
    material_of,
    precedence,
    steps,
    task,
)
from sysmlc.recipe.derive import derive
from sysmlc.recipe.model import FlowGraph, Model, Performance, Recipe


class _Named(Protocol):
    @property
    def id(self) -> str: ...


_T = TypeVar("_T", bound=_Named)


@dataclass(slots=True)
class _Closure:
    """Definitions that a recipe needs, each with the nodes that use it, by element id."""

    services: dict[str, tuple[Element, list[Element]]] = field(default_factory=dict)
    functions: dict[str, tuple[Element, list[Element]]] = field(default_factory=dict)
    service_graphs: dict[str, FlowGraph] = field(default_factory=dict)
    function_graphs: dict[str, FlowGraph] = field(default_factory=dict)


def recipe_model(context: Context, activity: Element) -> Model:
    """The recipe of an activity, with everything derived."""
    found = steps(context, activity)
    closure = _Closure()
    for step in found:
        if step.refinement is not None:
            _refine(context, step.refinement, "task", closure)
    recipe = _recipe(context, activity, found, closure)
    services = [service(context, *one) for one in closure.services.values()]
    functions = [function(context, *one) for one in closure.functions.values()]
    named = {m for one in recipe.tasks for mode in one.equipment for m in mode.machines}
    named |= {provider.machine for one in services for provider in one.providers}
    model = Model(
        recipe,
        _known(context, named, machine, "machine"),
        _known(context, _materials(context, recipe, activity), material, "material"),
        _sorted(services),
        _sorted(functions),
        _sorted(closure.service_graphs.values()),
        _sorted(closure.function_graphs.values()),
    )
    return derive(with_variables(context, model))


def _recipe(context: Context, activity: Element, found: list[Step], closure: _Closure) -> Recipe:
    tags = context.tags(activity, "Recipe")
    product = tags.text("product")
    data = Data.of(context, activity)
    tasks = [task(context, activity, step, data) for step in found]
    return Recipe(
        context.name(activity),
        _sorted(tasks),
        precedence(context, activity, found),
        data.parameters("in", "inout"),
        data.parameters("out", "inout", "return"),
        data.variables(),
        tags.text("version"),
        context.reference(product) if product else "",
        tags.integer("priority"),
        bool(tags.flag("noWait")),
        activity.id,
        performances(context, activity, [*closure.service_graphs, *closure.function_graphs]),
    )


def _refine(context: Context, activity: Element, inside: str, closure: _Closure) -> None:
    """The graph of an activity, and what its nodes call, level by level; cycles end it."""
    graphs = closure.service_graphs if inside == "task" else closure.function_graphs
    if activity.id in graphs:
        return
    made = refined(context, activity, inside)
    graphs[activity.id] = made.graph
    tables = {"service": closure.services, "function": closure.functions}
    for called in made.calls:
        definition = context.graph[called.definition]
        if called.kind in tables:
            callers = tables[called.kind].setdefault(definition.id, (definition, []))[1]
            callers.append(context.graph[called.node])
        inner = None if called.kind == "function" else refinement(context, definition)
        if inner is not None:
            _refine(context, inner, "service", closure)


def _materials(context: Context, recipe: Recipe, activity: Element) -> set[str]:
    flows = activity_flows(context, activity)
    found = (material_of(context, flow) for flow in flows)
    named = {context.name(one) for one in found if one is not None}
    return named | ({recipe.product} if recipe.product else set())


def _known(
    context: Context, names: set[str], make: Callable[[Context, Element], _T], level: str
) -> tuple[_T, ...]:
    """Values for the names that are elements of the level, sorted by name."""
    # A name has the word that an element is called by: few elements have one of these.
    some = "\n".join(names)
    candidates = (one for one in context.of_level(level) if word(one) in some)
    found = {context.name(one): one for one in candidates}
    return tuple(make(context, found[name]) for name in sorted(names) if name in found)


def _sorted(values: Iterable[_T]) -> tuple[_T, ...]:
    return tuple(sorted(values, key=lambda one: one.id))


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
    return Performance(name, _sort_pairs(arguments), _sort_pairs(steps), block.id)


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


def _sort_pairs(pairs: dict[str, str]) -> tuple[tuple[str, str], ...]:
    return tuple(sorted(pairs.items()))
