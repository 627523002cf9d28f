"""Edges for the meaning of dependencies and «allocate» partitions: satisfies, allocated-to ..."""

from collections.abc import Iterator

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.passes.classify.vocabulary import DEPENDENCY_ROLES

NO_REQUIREMENT = rule(
    "SM212",
    "no-requirement",
    Severity.WARNING,
    "a «{relation}» relation leads to '{element}', which is not a requirement",
    help="reverse the arrow, or apply «Requirement» to '{element}'",
)

_EDGES = dict(DEPENDENCY_ROLES.values())
_EDGES_OF_SUBKINDS = {"realization": Edge.REALIZES, "role-binding": Edge.BINDS}
_OF_REQUIREMENTS = frozenset({"satisfy", "derive", "verify", "copy"})


def add_relations(graph: Graph, sink: Sink) -> None:
    """Add an edge from each client to each supplier; the dependency's role gives its type."""
    for dependency in graph.of_kind(Kind.DEPENDENCY):
        edge = _choose_edge(dependency)
        for client in graph.targets(dependency, Edge.CLIENT):
            for supplier in graph.targets(dependency, Edge.SUPPLIER):
                graph.connect(edge, client, supplier)
        _check_suppliers(graph, sink, dependency)


def _choose_edge(dependency: Element) -> Edge:
    if dependency.role in _EDGES:
        return _EDGES[dependency.role]
    return _EDGES_OF_SUBKINDS.get(dependency.subkind, Edge.DEPENDS)


def _check_suppliers(graph: Graph, sink: Sink, dependency: Element) -> None:
    if dependency.role not in _OF_REQUIREMENTS:
        return
    for supplier in graph.targets(dependency, Edge.SUPPLIER):
        if supplier.role != "requirement" and not supplier.attrs.get("external"):
            sink.report(
                NO_REQUIREMENT,
                graph.subject(dependency),
                relation=dependency.role,
                element=graph.qualified_name(supplier),
            )


# -- allocate partitions -----------------------------------------------------------------------

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
