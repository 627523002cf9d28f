"""What a pass is: options as fields, a name, its predecessors, and ``run``."""

from typing import ClassVar, Protocol

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph


class Pass(Protocol):
    """One refinement of the graph: valid before and after, and twice equals once.

    A pass is a frozen dataclass; its fields are its options.
    """

    name: ClassVar[str]
    after: ClassVar[tuple[str, ...]]

    def run(self, graph: Graph, sink: Sink) -> None:
        """Refine the graph in place and report what is wrong with the model."""
