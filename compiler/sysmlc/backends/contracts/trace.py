"""Which elements a contract tells of."""

from sysmlc.ir import Edge, Graph, Kind
from sysmlc.logic.contract import Contract


def trace(graph: Graph, contract: Contract) -> list[str]:
    """Ids of the behaviour with all its parts, of what its variables stand for, and of the
    constraints on its owner: an error in any of them may be missing from the contract."""
    behaviour = graph[contract.origin]
    told = [element.id for element in graph.subtree(behaviour)]
    owner = graph.owner(behaviour)
    if owner is not None:
        around = [*graph.owned(owner), *graph.sources(owner, Edge.REFERENCES)]
        told += [one.id for one in around if one.kind is Kind.CONSTRAINT]
    named = dict.fromkeys(one.origin for one in contract.variables)
    named |= dict.fromkeys(one.origin for one in contract.assumptions + contract.guarantees)
    return [*told, *(id for id in named if id in graph)]
