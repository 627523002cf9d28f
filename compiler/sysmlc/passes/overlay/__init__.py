"""Pass ``overlay``: what overlays add to the model (thesis 3.4)."""

from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph

_REFINEMENTS = "sysmlc.overlay.model"


class Overlay(Struct, frozen=True):
    """Add item types, flows, port directions, operations, behaviours and allocations.

    Assumes resolved references, and overlays that the driver has stored in the graph.
    Guarantees: each entry is in the graph as an author of SysML would have drawn it, or is
    reported where it stands in the overlay. It runs before features are inherited and ports
    directed, so that what is added is inherited, directed and checked like all else.
    """

    name: ClassVar[str] = "overlay"
    after: ClassVar[tuple[str, ...]] = ("resolve", "kept")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Add in place and report; see the class."""
        if graph.has_derived(_REFINEMENTS):
            from sysmlc.overlay.model import Refinement
            from sysmlc.passes.overlay.adding import add_all

            add_all(graph.derived(Refinement), graph, sink)
