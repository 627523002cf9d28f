"""Back end ``sysml``: the compile unit as one text of SysML v2, with ``SysMLC.sysml`` if needed."""

import posixpath

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.sysml.document import print_document
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.support import resources
from sysmlc.support.output import Output, assign_file_names

LIBRARY = "SysMLC.sysml"
"""The library of metadata definitions to which the text refers."""


class SysmlBackend(Struct, frozen=True):
    """Writes the graph of any front end as SysML v2 text."""

    name: str = "sysml"
    summary: str = "the model as SysML v2 text, sysml/*.sysml"
    is_default: bool = False

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add ``sysml/<unit>.sysml``; report what the text cannot express."""
        unit = _choose_name(graph, options)
        text, uses_library = print_document(graph, sink)
        output.add(f"sysml/{assign_file_names([unit])[unit]}.sysml", text, (), self.name)
        if uses_library:
            library = resources.read_text("metamodels", LIBRARY)
            output.add(f"sysml/{LIBRARY}", library, (), self.name)


def _choose_name(graph: Graph, options: EmitOptions) -> str:
    """Return the name of the first input without its suffix, else that of the first root."""
    if options.inputs:
        file_name = posixpath.basename(options.inputs[0].path.partition("!")[0])
        return file_name.partition(".")[0] or file_name
    return next((root.name for root in graph.roots() if root.name), "model")


BACKEND = SysmlBackend()
