"""Allocation of actions to the elements that their «allocate» partitions represent."""

from collections.abc import Iterator

from sysmlc.ir import Edge, Element, Graph, Kind

_PERFORMED = (Kind.ACTION, Kind.STRUCTURED)


def add_allocations(graph: Graph) -> None:
    """Add ``allocated-to`` from each action to the elements that its allocate partitions represent.

    SysML 1.6 clause 15.3.2.2: the represented elements are the targets of an allocation from the
    actions in the partition. Actions in subpartitions are in it too (UML 2.5.1 clause 15.6.3).
    """
    for partition in graph.of_kind(Kind.PARTITION):
        if partition.role == "allocate partition":
            for target in graph.targets(partition, Edge.REPRESENTS):
                for action in _list_actions(graph, partition):
                    graph.connect(Edge.ALLOCATED_TO, action, target)


def _list_actions(graph: Graph, partition: Element) -> Iterator[Element]:
    for element in graph.subtree(partition):
        if element.kind is Kind.PARTITION:
            nodes = graph.sources(element, Edge.IN_PARTITION)
            yield from (node for node in nodes if node.kind in _PERFORMED)
