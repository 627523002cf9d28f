"""Back end ``ir``: the refined graph in its text form, for people and golden tests."""

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.ir.text import print_text
from sysmlc.support.output import Output


class IrBackend(Struct, frozen=True):
    """Writes what ``parse_text`` reads back."""

    name: str = "ir"
    summary: str = "the refined graph in readable text, graph.ir"
    is_default: bool = False

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add ``graph.ir``."""
        output.add("graph.ir", print_text(graph), backend=self.name)


BACKEND = IrBackend()
