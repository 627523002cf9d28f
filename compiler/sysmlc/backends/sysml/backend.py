"""Back end ``sysml``: the compile unit as one text of SysML v2, with ``SysMLC.sysml`` if needed."""

from msgspec import Struct

from sysmlc.backends.base import EmitOptions, name_compile_unit
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
        unit = name_compile_unit(graph, options)
        text, uses_library = print_document(graph, sink)
        output.add(f"sysml/{assign_file_names([unit])[unit]}.sysml", text, (), self.name)
        if uses_library:
            library = resources.read_text("metamodels", LIBRARY)
            output.add(f"sysml/{LIBRARY}", library, (), self.name)


BACKEND = SysmlBackend()
