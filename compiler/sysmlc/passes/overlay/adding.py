"""The steps in which overlays are added: what later steps name comes first."""

from collections.abc import Sequence

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.overlay.model import Refinement
from sysmlc.passes.overlay.allocations import add_allocation
from sysmlc.passes.overlay.behaviors import add_behaviors, note_behaviors
from sysmlc.passes.overlay.blocks import refine_block
from sysmlc.passes.overlay.calls import resolve_calls
from sysmlc.passes.overlay.finder import Finder
from sysmlc.passes.overlay.flows import add_flows
from sysmlc.passes.overlay.items import add_items, check_domains
from sysmlc.passes.overlay.ports import refine_port


def add_all(refinements: Sequence[Refinement], graph: Graph, sink: Sink) -> None:
    """Add what the overlays say; of several, each step of all before the next step."""
    roots = graph.roots()
    ordered = sorted(refinements, key=lambda one: one.file)
    finders = [Finder(graph, sink, one, roots) for one in ordered]
    for finder in finders:
        add_items(finder)
    for finder in finders:
        for port in finder.refinement.ports:
            refine_port(finder, port)
        for connector in finder.refinement.connectors:
            add_flows(finder, connector)
        check_domains(finder)
        for block in finder.refinement.blocks:
            refine_block(finder, block)
            note_behaviors(finder, block)
    for finder in finders:
        for block in finder.refinement.blocks:
            add_behaviors(finder, block)
    for finder in finders:
        for block in finder.refinement.blocks:
            resolve_calls(finder, block)
        for allocation in finder.refinement.allocations:
            add_allocation(finder, allocation)
