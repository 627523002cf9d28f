"""One file ``recipes/<recipe>.json`` for each recipe of the graph."""

from collections.abc import Iterable, Iterator
from typing import Protocol

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.recipe.document import document
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Graph
from sysmlc.recipe.model import Model
from sysmlc.support.file_names import assign_file_names
from sysmlc.support.json_text import encode_json
from sysmlc.support.output import Output

EMPTY_RECIPE = rule(
    "SM621",
    "recipe-without-tasks",
    Severity.WARNING,
    "recipe '{recipe}' has no tasks; no file is written for it",
    help="call tasks from the activity, or type its object nodes by tasks",
)


class RecipeBackend(Struct, frozen=True):
    """Writes the models that the pass ``recipe`` found (metamodels/sysmlc-recipe.schema.json)."""

    name: str = "recipe"
    summary: str = "three-level recipe models as JSON, one file a recipe"
    is_default: bool = True

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add one file a recipe; its trace names every element that it tells of."""
        if not graph.has_derived("sysmlc.recipe.model"):
            return

        models = graph.derived(Model)
        names = assign_file_names(model.recipe.id for model in models)
        for model in models:
            if not model.recipe.tasks:
                subject = graph.subject(graph[model.recipe.element])
                sink.report(EMPTY_RECIPE, subject, recipe=model.recipe.id)
                continue
            text = encode_json(document(model, options.inputs), 2)
            path = f"recipes/{names[model.recipe.id]}.json"
            output.add(path, text, _trace(model), self.name)


class _Traced(Protocol):
    @property
    def element(self) -> str: ...


def _trace(model: "Model") -> Iterator[str]:
    graphs = (*model.service_graphs, *model.function_graphs)
    parts: tuple[Iterable[_Traced], ...] = (
        (model.recipe, *model.recipe.tasks),
        model.machines,
        model.materials,
        model.services,
        model.functions,
        graphs,
        (node for graph in graphs for node in graph.nodes),
        (edge for graph in graphs for edge in graph.edges),
    )
    return (one.element for part in parts for one in part if one.element)
