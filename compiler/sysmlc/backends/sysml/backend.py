"""Back end ``sysml``: one text of SysML v2 for the unit, with our library beside it if needed."""

import posixpath

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.sysml.document import document
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.support import resources
from sysmlc.support.file_names import assign_file_names
from sysmlc.support.output import Output

LIBRARY = "SysMLC.sysml"
"""Our library of metadata definitions, which the text refers to."""


class SysmlBackend(Struct, frozen=True):
    """Writes the graph of any front end as SysML v2 text."""

    name: str = "sysml"
    summary: str = "the model as SysML v2 text, sysml/*.sysml"
    is_default: bool = False

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add ``sysml/<unit>.sysml``; report what the text cannot say."""
        unit = _unit(graph, options)
        text, uses_library = document(graph, sink)
        output.add(f"sysml/{assign_file_names([unit])[unit]}.sysml", text, (), self.name)
        if uses_library:
            output.add(
                f"sysml/{LIBRARY}", resources.read_text("metamodels", LIBRARY), (), self.name
            )


def _unit(graph: Graph, options: EmitOptions) -> str:
    """Name of the first input without its suffix, else of the first root."""
    if options.inputs:
        first = posixpath.basename(options.inputs[0].path.partition("!")[0])
        return first.partition(".")[0] or first
    return next((root.name for root in graph.roots() if root.name), "model")


BACKEND = SysmlBackend()
