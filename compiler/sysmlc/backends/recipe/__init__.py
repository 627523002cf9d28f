"""The back end ``recipe``: one JSON file a recipe, for schedulers and service executors."""

from collections.abc import Iterable, Iterator
from typing import Protocol

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.recipe.document import describe_model
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph, query
from sysmlc.recipe.model import Model
from sysmlc.support.output import Output, assign_file_names, encode_json

EMPTY_RECIPE = rule(
    "SM621",
    "recipe-without-tasks",
    Severity.WARNING,
    "recipe '{recipe}' has no tasks; no file is written for it",
    help="call tasks from the activity, or type its object nodes by tasks",
)


class RecipeBackend(Struct, frozen=True):
    """Writes the models of the analysis ``recipe`` (metamodels/sysmlc-recipe.schema.json)."""

    name: str = "recipe"
    summary: str = "three-level recipe models as JSON, one file a recipe"
    is_default: bool = True
    needs: tuple[str, ...] = ("recipe",)

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add one file for each recipe.

        Its trace contains the elements of all its parts and the stereotypes applied to them.
        """
        models = graph.derived(Model)
        names = assign_file_names(model.recipe.id for model in models)
        for model in models:
            if not model.recipe.tasks:
                subject = graph.subject(graph[model.recipe.element])
                sink.report(EMPTY_RECIPE, subject, recipe=model.recipe.id)
                continue
            text = encode_json(describe_model(model, options.inputs), 2)
            path = f"recipes/{names[model.recipe.id]}.json"
            traced = list(dict.fromkeys((*_iter_traced_elements(model), *model.sources)))
            elements = [element for id in traced if (element := graph.get(id)) is not None]
            traced += [item.id for e in elements for item in query.applications(graph, e)]
            output.add(path, text, traced, self.name, name=model.recipe.id)


class _Traced(Protocol):
    """A part of a recipe model with the id of its element, empty if it has none."""

    @property
    def element(self) -> str: ...


def _iter_traced_elements(model: Model) -> Iterator[str]:
    graphs = (*model.service_graphs, *model.function_graphs)
    groups: tuple[Iterable[_Traced], ...] = (
        (model.recipe, *model.recipe.tasks),
        model.machines,
        model.materials,
        model.services,
        model.functions,
        graphs,
        (node for graph in graphs for node in graph.nodes),
        (edge for graph in graphs for edge in graph.edges),
    )
    return (part.element for group in groups for part in group if part.element)


BACKEND = RecipeBackend()
