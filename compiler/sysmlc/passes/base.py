"""The interface of a pass: options as fields, a name, its predecessors, and ``run``."""

from typing import ClassVar, Protocol

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph


class Pass(Protocol):
    """A refinement of the graph. The graph is valid before and after; running it twice equals once.

    A pass is a frozen value; its fields are its options.
    """

    name: ClassVar[str]
    after: ClassVar[tuple[str, ...]]

    def run(self, graph: Graph, sink: Sink) -> None:
        """Refine the graph in place and report faults of the model."""
