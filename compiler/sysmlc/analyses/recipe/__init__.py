"""Analysis ``recipe``: three-level recipe models from activities (thesis 3.5, 6.5.4)."""

from collections.abc import Iterator, Mapping
from typing import ClassVar

from msgspec import Struct, field

from sysmlc.analyses.activities.regions import NODES
from sysmlc.analyses.recipe.context import Context
from sysmlc.analyses.recipe.derived_levels import (
    add_derived_levels,
    report_derived_levels,
    report_missing_levels,
)
from sysmlc.analyses.recipe.model import build_model
from sysmlc.analyses.recipe.reports import check_tags, report_decisions
from sysmlc.diagnostics import Sink, Subject
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.recipe import validate
from sysmlc.recipe.model import Model


class Recipe(Struct, frozen=True):
    """Find the recipes, derive their models, and report faults.

    Assumes resolved names, roles and levels. Afterwards ``graph.derived(recipe.model.Model)`` holds
    one model for each recipe, sorted by id; the graph itself stays unchanged. ``levels`` maps ids
    or qualified names of elements to recipe levels and overrides the model. ``tolerance`` is the
    share by which the times of two levels may differ.
    """

    name: ClassVar[str] = "recipe"

    levels: Mapping[str, str] = field(default_factory=dict)
    tolerance: float = 0.1

    def run(self, graph: Graph, sink: Sink) -> None:
        """Store the recipe models of the graph."""
        context = Context.build(graph, self.levels)
        activities = list(_find_recipes(context))
        if not activities and not context.stated:
            report_missing_levels(context, sink)
        if activities or graph.derived(Model):
            self._store(context, activities, sink)

    def _store(self, context: Context, activities: list[Element], sink: Sink) -> None:
        faulty: set[str] = set()
        if activities:
            context, derived = add_derived_levels(context)
            report_derived_levels(context, derived, sink)
            faulty = check_tags(context, sink)
        models = sorted(
            (build_model(context, activity) for activity in activities), key=lambda m: m.recipe.id
        )
        for model in models:
            report_decisions(context, model, sink)
            validate(model, sink, lambda id: _subject(context.graph, id), self.tolerance, faulty)
        context.graph.store(Model, models)


def _find_recipes(context: Context) -> Iterator[Element]:
    """Yield the activities at the level recipe, and those without a level that call tasks.

    An activity without steps that other recipes specialise is not a recipe itself.
    """
    calling = {
        _owning_activity(context, node)
        for node in context.elements_of_level("task")
        if node.kind in NODES
    }
    for activity in context.graph.of_kind(Kind.ACTIVITY):
        level = context.own_level(activity)
        if level == "recipe" and _is_only_general(context, activity):
            continue
        if level == "recipe" or (not level and activity.id in calling):
            yield activity


def _is_only_general(context: Context, activity: Element) -> bool:
    is_general = bool(context.graph.sources(activity, Edge.SPECIALIZES))
    return is_general and not context.has_nodes(activity)


def _owning_activity(context: Context, node: Element) -> str | None:
    """Return the id of the activity to whose graph the node belongs."""
    owner = context.graph.owner(node)
    while owner is not None and context.is_inlined(owner):
        owner = context.graph.owner(owner)
    return None if owner is None else owner.id


def _subject(graph: Graph, id: str) -> Subject:
    element = graph.get(id)
    return Subject(id) if element is None else graph.subject(element)
