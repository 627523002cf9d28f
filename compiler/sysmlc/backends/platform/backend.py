"""One file ``platform.json`` for a unit that has recipes and a plant."""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.platform.document import document, places
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.recipe.plant import Platform
from sysmlc.support.json_text import encode_json
from sysmlc.support.output import Output

PATH = "platform.json"
_PLATFORMS = "sysmlc.recipe.plant"
"""The module of platforms: most models have none, and need nothing of this imported."""


class PlatformBackend(Struct, frozen=True):
    """Writes what the pass ``platform`` found (metamodels/sysmlc-platform.schema.json)."""

    name: str = "platform"
    summary: str = "which element of the plant offers which service of the recipes, as JSON"
    is_default: bool = True

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add the file; its trace names machines, services and elements of the plant."""
        if not graph.has_derived(_PLATFORMS):
            return

        for platform in graph.derived(Platform):
            found = options.locate(places(graph, platform))
            text = encode_json(document(graph, platform, found), 2)
            output.add(PATH, text, _trace(platform), self.name)


def _trace(platform: "Platform") -> Iterator[str]:
    yield from (one.element for one in platform.used)
    yield from (element for _, _, element in (*platform.machines, *platform.services))
    yield from (one.operation for one in platform.offers)
