"""Back end ``aml``: CAEX 3.0 files that engineering tools open and our front end reads back."""

import posixpath

from msgspec import Struct

from sysmlc.backends.aml.document import documents
from sysmlc.backends.base import EmitOptions
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.support.output import Output


class AmlBackend(Struct, frozen=True):
    """Saves the structure of the graph of any front end as AutomationML."""

    name: str = "aml"
    summary: str = "the structure as AutomationML, CAEX 3.0, aml/*.aml"
    is_default: bool = False

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add a file for each AutomationML file of the unit, else one; report what is lost."""
        for path, text in documents(graph, _unit(graph, options), sink).items():
            output.add(path, text, (), self.name)


def _unit(graph: Graph, options: EmitOptions) -> str:
    """Name of the first input without its suffix, else of the first root."""
    if options.inputs:
        first = posixpath.basename(options.inputs[0].path.partition("!")[0])
        return first.partition(".")[0] or first
    return next((root.name for root in graph.roots() if root.name), "model")


BACKEND = AmlBackend()
