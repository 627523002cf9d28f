"""Back end ``uml``: one file that Papyrus opens and our XMI front end reads back."""

import posixpath

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.backends.uml.document import document
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.support.file_names import assign_file_names
from sysmlc.support.output import Output


class UmlBackend(Struct, frozen=True):
    """Saves the graph of any front end as UML 2.5 with SysML 1.6, as Papyrus does."""

    name: str = "uml"
    summary: str = "the model as SysML 1.6 in XMI for Papyrus, uml/*.uml"
    is_default: bool = False

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add ``uml/<unit>.uml``; report what UML cannot say."""
        unit = _unit(graph, options)
        output.add(
            f"uml/{assign_file_names([unit])[unit]}.uml", document(graph, sink), (), self.name
        )


def _unit(graph: Graph, options: EmitOptions) -> str:
    """Name of the first input without its suffix, else of the first root."""
    if options.inputs:
        first = posixpath.basename(options.inputs[0].path.partition("!")[0])
        return first.partition(".")[0] or first
    return next((root.name for root in graph.roots() if root.name), "model")


BACKEND = UmlBackend()
