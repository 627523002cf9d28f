"""The pass ``platform``: recipes on the plant that runs them (thesis 3.2)."""

from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph

_RECIPES = "sysmlc.recipe.model"
"""The module of the recipe models: most models have none, and need nothing of this imported."""


class Platform(Struct, frozen=True):
    """Finds which element of the plant is which machine, and what it offers.

    Assumes the models of the pass ``recipe``; then ``graph.derived(recipe.platform.Platform)``
    holds one platform when there are recipes and a plant, else none. The graph stays as it is.
    """

    name: ClassVar[str] = "platform"
    after: ClassVar[tuple[str, ...]] = ("recipe",)

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store the platform of the unit, and report what does not fit."""
        if graph.has_derived(_RECIPES):
            from sysmlc.passes.platform.mapping import mapping

            mapping(graph, sink)
