"""Which elements a contract tells of."""

from collections.abc import Iterator

from sysmlc.ir import Edge, Graph, Kind
from sysmlc.logic.contract import Contract


def trace(graph: Graph, contract: Contract) -> Iterator[str]:
    """Ids of the behaviour with all its parts, of what its variables stand for, and of the
    constraints on its owner: an error in any of them may be missing from the contract."""
    behaviour = graph[contract.origin]
    yield from (element.id for element in graph.subtree(behaviour))
    owner = graph.owner(behaviour)
    if owner is not None:
        around = [*graph.owned(owner), *graph.sources(owner, Edge.REFERENCES)]
        yield from (one.id for one in around if one.kind is Kind.CONSTRAINT)
    yield from (variable.origin for variable in contract.variables if variable.origin in graph)
    for conjunct in (*contract.assumptions, *contract.guarantees):
        if conjunct.origin in graph:
            yield conjunct.origin
