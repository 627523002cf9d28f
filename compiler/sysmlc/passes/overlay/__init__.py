"""Pass ``overlay``: what overlays add to the model (thesis 3.4)."""

from collections.abc import Sequence
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Graph, Kind, derived_id
from sysmlc.overlay.model import Allocation, PortEntry, Refinement
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.behaviors import add_behaviors, note_behaviors, resolve_calls
from sysmlc.passes.overlay.blocks import refine_block
from sysmlc.passes.overlay.finder import ANYTHING, PORT, TYPE, Finder
from sysmlc.passes.overlay.flows import add_flows
from sysmlc.passes.overlay.items import add_items, check_domains


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
        add_all(graph.derived(Refinement), graph, sink)


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


def add_allocation(finder: Finder, entry: Allocation) -> None:
    """Add an allocation as its author would have drawn it; ``classify`` gives it its meaning."""
    graph = finder.graph
    client, supplier = finder.term(entry.source, ANYTHING), finder.term(entry.target, ANYTHING)
    if client is None or supplier is None:
        return
    owners = (one.id for one in graph.ancestors(client) if one.kind is Kind.PACKAGE)
    made = finder.add(
        derived_id(client.id, f"allocation of an overlay:{supplier.id}"),
        Kind.DEPENDENCY,
        "",
        next(owners, None),
        entry.spot,
        origin=client.id,
        subkind="abstraction",
        role="allocate",
    )
    graph.connect(Edge.CLIENT, made, client)
    graph.connect(Edge.SUPPLIER, made, supplier)


def refine_port(finder: Finder, entry: PortEntry) -> None:
    """Give a port its direction and type; who contradicts the model is told so."""
    graph = finder.graph
    port = finder.entry(entry.key, PORT)
    if port is None:
        return
    known = port.attrs.get("direction")
    if entry.direction and known not in (None, entry.direction):
        finder.report(
            rules.OTHER_WISE,
            entry.key,
            name=graph.qualified_name(port),
            what="direction",
            new=entry.direction,
            old=str(known),
        )
    graph.set(port, direction=entry.direction or known)
    type_ = None if entry.type is None else finder.term(entry.type, TYPE)
    if type_ is not None:
        graph.replace_targets(Edge.TYPED_BY, port, [type_])
