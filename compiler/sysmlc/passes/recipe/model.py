"""One recipe with the closure of what it refers to."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Protocol, TypeVar

from sysmlc.ir import Element
from sysmlc.passes.recipe.context import Context, word
from sysmlc.passes.recipe.data import Data
from sysmlc.passes.recipe.machine_variables import with_variables
from sysmlc.passes.recipe.machines import machine, material
from sysmlc.passes.recipe.nodes import activity_flows, refinement
from sysmlc.passes.recipe.performances import performances
from sysmlc.passes.recipe.refined import refined
from sysmlc.passes.recipe.services import function, service
from sysmlc.passes.recipe.tasks import (
    Step,
    material_of,
    precedence,
    steps,
    task,
)
from sysmlc.recipe.derive import derive
from sysmlc.recipe.model import FlowGraph, Model, Recipe


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
