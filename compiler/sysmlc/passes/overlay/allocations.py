"""Allocations: what of the model is allocated to what (SysML 1.6 clause 15)."""

from sysmlc.ir import Edge, Kind, derived_id
from sysmlc.overlay.model import Allocation
from sysmlc.passes.overlay.finder import ANYTHING, Finder


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
