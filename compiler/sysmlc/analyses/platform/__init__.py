"""Analysis ``platform``: maps machines and services of recipes to the plant (thesis 3.2)."""

from collections.abc import Iterable, Sequence
from typing import ClassVar

from msgspec import Struct

from sysmlc.analyses.platform.binding import Context, bind_machines
from sysmlc.analyses.platform.offering import find_offers
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.recipe import plant as mapping
from sysmlc.recipe.model import Model
from sysmlc.recipe.plant import Binding, Offer, PlantElement, Unused, Used


class Platform(Struct, frozen=True):
    """Find the plant element of each machine, and the services that plant elements offer.

    Assumes the models of the analysis ``recipe``. Afterwards
    ``graph.derived(recipe.plant.Platform)`` holds one platform if there are recipes and a plant,
    else none.
    """

    name: ClassVar[str] = "platform"

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store the platform of the unit; report missing bindings and offers."""
        models = [recipe for recipe in graph.derived(Model) if recipe.machines or recipe.services]
        context = Context(graph, models, sink)
        if models and context.has_plant():
            bindings = bind_machines(context)
            offers = find_offers(context, bindings)
            graph.store(mapping.Platform, [_describe_platform(context, bindings, offers)])


def _describe_platform(
    context: Context, bindings: Sequence[Binding], offers: Sequence[Offer]
) -> mapping.Platform:
    ids = sorted({*(entry.plant for entry in bindings), *(entry.plant for entry in offers)})
    used = [context.bound_elements[id] for id in ids]
    return mapping.Platform(
        used=tuple(
            sorted((_describe_used(context, entry) for entry in used), key=lambda entry: entry.name)
        ),
        bindings=tuple(sorted(bindings, key=lambda entry: (entry.machine, entry.plant))),
        offers=tuple(sorted(offers, key=lambda entry: (entry.service, entry.machine, entry.plant))),
        unused=tuple(_list_unused(context, used)),
        machines=tuple(context.list_uses(context.machines.values())),
        services=tuple(context.list_uses(context.services.values())),
    )


def _describe_used(context: Context, element: PlantElement) -> Used:
    return Used(
        element.id,
        context.plant.qualified_name(element),
        _type_name(context, element),
        element.element.id,
    )


def _type_name(context: Context, element: PlantElement) -> str:
    return "" if element.block is None else context.graph.qualified_name(element.block)


def _list_unused(context: Context, used: Iterable[PlantElement]) -> list[Unused]:
    """Return the topmost plant elements that contain no used element and lie in none.

    Each has the number of elements inside it.
    """
    plant = context.plant
    used_ids = {element.id for element in used}
    containing = used_ids | {up.id for element in used for up in plant.iter_owners(element)}
    sizes: dict[str, int] = {}
    top_of: dict[str, str | None] = {}
    # The elements are in document order, so that a container comes before its content.
    for element in plant.elements.values():
        container = next(plant.iter_owners(element), None)
        if element.id in containing:
            top_of[element.id] = None
        elif container is None or container.id in containing - used_ids:
            top_of[element.id] = element.id
            sizes[element.id] = 0
        else:
            top_of[element.id] = top = top_of.get(container.id)
            if top is not None:
                sizes[top] += 1
    topmost = ((plant.elements[id], contents) for id, contents in sizes.items())
    unused = [
        Unused(
            element.id,
            plant.qualified_name(element),
            _type_name(context, element),
            element.element.id,
            contents,
        )
        for element, contents in topmost
    ]
    return sorted(unused, key=lambda element: (element.name, element.id))
