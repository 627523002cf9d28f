"""The pass ``platform``: recipes on the plant that runs them (thesis 3.2)."""

from collections.abc import Iterable, Sequence
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.passes.platform.binding import bind_machines
from sysmlc.passes.platform.context import Context
from sysmlc.passes.platform.offering import find_offers
from sysmlc.recipe import platform as model
from sysmlc.recipe.model import Model
from sysmlc.recipe.plant import PlantElement
from sysmlc.recipe.platform import Binding, Offer, Unused, Used


class Platform(Struct, frozen=True):
    """Finds which element of the plant is which machine, and what it offers.

    Assumes the models of the pass ``recipe``; then ``graph.derived(recipe.platform.Platform)``
    holds one platform when there are recipes and a plant, else none. The graph stays as it is.
    """

    name: ClassVar[str] = "platform"
    after: ClassVar[tuple[str, ...]] = ("recipe",)

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store the platform of the unit, and report what does not fit."""
        models = [recipe for recipe in graph.derived(Model) if recipe.machines or recipe.services]
        context = Context(graph, models, sink)
        if models and context.has_plant():
            bindings = bind_machines(context)
            offers = find_offers(context, bindings)
            graph.store(model.Platform, [_describe_platform(context, bindings, offers)])


def _describe_platform(
    context: Context, bound: Sequence[Binding], offered: Sequence[Offer]
) -> model.Platform:
    ids = sorted({*(one.plant for one in bound), *(one.plant for one in offered)})
    used = [context.found[id] for id in ids]
    return model.Platform(
        used=tuple(sorted((_used(context, one) for one in used), key=lambda one: one.name)),
        bindings=tuple(sorted(bound, key=lambda one: (one.machine, one.plant))),
        offers=tuple(sorted(offered, key=lambda one: (one.service, one.machine, one.plant))),
        unused=tuple(_unused(context, used)),
        machines=tuple(context.machine_uses()),
        services=tuple(context.service_uses()),
    )


def _used(context: Context, one: PlantElement) -> Used:
    return Used(one.id, context.plant.name_of(one), _type(context, one), one.element.id)


def _type(context: Context, one: PlantElement) -> str:
    return "" if one.block is None else context.graph.qualified_name(one.block)


def _unused(context: Context, used: Iterable[PlantElement]) -> list[Unused]:
    """The topmost elements that are not used, hold nothing used, and are in nothing used."""
    plant = context.plant
    inside = {one.id for one in used}
    holding = inside | {up.id for one in used for up in plant.iter_owners(one)}
    tops: dict[str, int] = {}
    top_of: dict[str, str | None] = {}
    for one in plant.elements.values():
        above = next(plant.iter_owners(one), None)
        if one.id in holding:
            top_of[one.id] = None
        elif above is None or above.id in holding - inside:
            top_of[one.id] = one.id
            tops[one.id] = 0
        else:
            top_of[one.id] = top = top_of.get(above.id)
            if top is not None:
                tops[top] += 1
    found = ((plant.elements[id], contents) for id, contents in tops.items())
    made = [
        Unused(one.id, plant.name_of(one), _type(context, one), one.element.id, contents)
        for one, contents in found
    ]
    return sorted(made, key=lambda one: (one.name, one.id))
