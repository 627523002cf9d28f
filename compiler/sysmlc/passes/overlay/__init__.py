"""Pass ``overlay``: applies overlay documents to the model (thesis 3.4)."""

from collections.abc import Sequence
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Graph, Kind, derived_id
from sysmlc.overlay.model import Allocation, PortEntry, Refinement
from sysmlc.passes.overlay import rules
from sysmlc.passes.overlay.behaviors import add_behaviors, find_behaviors, resolve_calls
from sysmlc.passes.overlay.blocks import add_items, check_domains, refine_block
from sysmlc.passes.overlay.finder import ANYTHING, PORT, TYPE, Finder
from sysmlc.passes.overlay.flows import add_flows


class Overlay(Struct, frozen=True):
    """Add item types, flows, port directions, operations, behaviours and allocations.

    Assumes resolved references, and overlays that the driver has stored in the graph. Guarantees:
    each entry is in the graph as if the author of the model had drawn it, or is reported at its
    location in the overlay. The pass runs before features are inherited and ports directed, so that
    added elements are inherited, directed and checked like all others.
    """

    name: ClassVar[str] = "overlay"
    after: ClassVar[tuple[str, ...]] = ("resolve", "kept")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Apply the overlays in place and report; see the class."""
        _apply_overlays(graph.derived(Refinement), graph, sink)


def _apply_overlays(refinements: Sequence[Refinement], graph: Graph, sink: Sink) -> None:
    """Apply overlays in steps, each of them for all overlays before the next one.

    Elements that an entry may refer to are added in an earlier step than the entry.
    """
    roots = graph.roots()
    in_file_order = sorted(refinements, key=lambda refinement: refinement.file)
    finders = [Finder(graph, sink, refinement, roots) for refinement in in_file_order]
    # Items first: flows and types of later entries name them.
    for finder in finders:
        add_items(finder)
    for finder in finders:
        for port in finder.refinement.ports:
            _refine_port(finder, port)
        for connector in finder.refinement.connectors:
            add_flows(finder, connector)
        check_domains(finder)
        for block in finder.refinement.blocks:
            refine_block(finder, block)
            find_behaviors(finder, block)
    # Only now: a behaviour that moves to a block is no longer found at its path in the model.
    for finder in finders:
        for block in finder.refinement.blocks:
            add_behaviors(finder, block)
    for finder in finders:
        for block in finder.refinement.blocks:
            resolve_calls(finder, block)
        for allocation in finder.refinement.allocations:
            _add_allocation(finder, allocation)


def _add_allocation(finder: Finder, entry: Allocation) -> None:
    """Add the dependency of an allocation (SysML 1.6 clause 15).

    The pass ``classify`` derives the edges that the dependency means.
    """
    graph = finder.graph
    client, supplier = (
        finder.find_term(entry.source, ANYTHING),
        finder.find_term(entry.target, ANYTHING),
    )
    if client is None or supplier is None:
        return
    owners = (ancestor.id for ancestor in graph.ancestors(client) if ancestor.kind is Kind.PACKAGE)
    dependency = finder.ensure_element(
        derived_id(client.id, f"allocation of an overlay:{supplier.id}"),
        Kind.DEPENDENCY,
        "",
        next(owners, None),
        entry.spot,
        origin=client.id,
        subkind="abstraction",
        role="allocate",
    )
    graph.connect(Edge.CLIENT, dependency, client)
    graph.connect(Edge.SUPPLIER, dependency, supplier)


def _refine_port(finder: Finder, entry: PortEntry) -> None:
    """Set direction and type of a port; report a direction that contradicts the model."""
    graph = finder.graph
    port = finder.find_entry(entry.key, PORT)
    if port is None:
        return
    stated = port.attrs.get("direction")
    if entry.direction and stated not in (None, entry.direction):
        finder.report(
            rules.CONTRADICTION,
            entry.key,
            name=graph.qualified_name(port),
            what="direction",
            new=entry.direction,
            old=str(stated),
        )
    graph.set(port, direction=entry.direction or stated)
    if entry.direction and stated != entry.direction:
        finder.record_change(port, f"the direction '{entry.direction}'", entry.key)
    type_ = None if entry.type is None else finder.find_term(entry.type, TYPE)
    if type_ is not None:
        graph.replace_targets(Edge.TYPED_BY, port, [type_])
        finder.record_change(port, f"the type '{type_.name}'", entry.key)
