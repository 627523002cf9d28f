"""The pass ``recipe``: three-level recipe models from activities (thesis 3.5, 6.5.4)."""

from collections.abc import Iterator, Mapping
from typing import ClassVar

from msgspec import Struct, field

from sysmlc.diagnostics import Sink, Subject
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.passes.recipe.context import NODES, Context
from sysmlc.passes.recipe.derived_levels import tell, with_derived
from sysmlc.passes.recipe.model import recipe_model
from sysmlc.passes.recipe.regions import is_inlined
from sysmlc.passes.recipe.reports import check_tags, remark
from sysmlc.recipe.model import Model
from sysmlc.recipe.validate import validate


class Recipe(Struct, frozen=True):
    """Finds the recipes, derives what follows, and reports what is wrong with them.

    Assumes names resolved and roles and levels set; then ``graph.derived(recipe.model.Model)``
    holds one model a recipe, sorted by id. The graph itself stays as it is.
    ``levels`` maps ids or qualified names of elements to recipe levels and wins over the model;
    ``tolerance`` is the share by which the times of two levels may differ.
    """

    name: ClassVar[str] = "recipe"
    after: ClassVar[tuple[str, ...]] = ("classify", "activities", "behaviours")

    levels: Mapping[str, str] = field(default_factory=dict)
    tolerance: float = 0.1

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store the recipe models of the graph."""
        context = Context.of(graph, self.levels)
        found = list(recipes(context))
        if found or graph.derived(Model):
            self._store(context, found, sink)

    def _store(self, context: Context, found: list[Element], sink: Sink) -> None:

        if found:
            context, derived = with_derived(context)
            tell(context, derived, sink)
            check_tags(context, sink)
        models = sorted((recipe_model(context, one) for one in found), key=lambda m: m.recipe.id)
        for model in models:
            remark(context, model, sink)
            validate(model, sink, lambda id: _subject(context.graph, id), self.tolerance)
        context.graph.store(Model, models)


def recipes(context: Context) -> Iterator[Element]:
    """Activities at the level recipe, and those that only call tasks without being one.

    What has no steps and only says what recipes are, by being their general, is none.
    """
    calling = {_activity(context, one) for one in context.of_level("task") if one.kind in NODES}
    for activity in context.graph.of_kind(Kind.ACTIVITY):
        level = context.own_level(activity)
        if level == "recipe" and _only_names(context, activity):
            continue
        if level == "recipe" or (not level and activity.id in calling):
            yield activity


def _only_names(context: Context, activity: Element) -> bool:
    is_general = bool(context.graph.sources(activity, Edge.SPECIALIZES))
    return is_general and not context.nodes(activity)


def _activity(context: Context, node: Element) -> str | None:
    """Id of what has the node as a step, be it in an inlined node."""
    owner = context.graph.owner(node)
    while owner is not None and is_inlined(context.graph, owner):
        owner = context.graph.owner(owner)
    return None if owner is None else owner.id


def _subject(graph: Graph, id: str) -> Subject:
    element = graph.get(id)
    return Subject(id) if element is None else graph.subject(element)
