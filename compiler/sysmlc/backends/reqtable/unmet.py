"""Which requirements nothing satisfies or verifies."""

from collections.abc import Iterable, Iterator

from sysmlc.backends.reqtable.rules import UNSATISFIED, UNVERIFIED
from sysmlc.backends.reqtable.table import is_listed
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph


def report_open(graph: Graph, requirements: list[Element], sink: Sink) -> None:
    """Report each requirement that has no such relation, directly or through others."""
    for rule, edge in ((UNSATISFIED, Edge.SATISFIES), (UNVERIFIED, Edge.VERIFIES)):
        done = met(graph, requirements, edge)
        for one in requirements:
            if one.id not in done:
                sink.report(rule, graph.subject(one), requirement=graph.qualified_name(one))


def met(graph: Graph, requirements: Iterable[Element], edge: Edge) -> frozenset[str]:
    """Ids of the requirements that have the relation, or whose answer others give.

    A compound requirement holds when all that it contains hold (SysML 1.6 clause 16.3.1), and
    what is said of a derived requirement answers its source.
    """
    waiting = [one for one in requirements if _is_direct(graph, one, edge)]
    done = {one.id for one in waiting}
    for one in waiting:
        for other in _find_satisfied(graph, one, done):
            if other.id not in done:
                done.add(other.id)
                waiting.append(other)
    return frozenset(done)


def _is_direct(graph: Graph, requirement: Element, edge: Edge) -> bool:
    # A SysML v2 requirement leads to its subject itself.
    has_subject = edge is Edge.SATISFIES and bool(graph.targets(requirement, Edge.SUBJECT))
    return has_subject or bool(graph.sources(requirement, edge))


def _find_satisfied(graph: Graph, requirement: Element, done: set[str]) -> Iterator[Element]:
    yield from graph.targets(requirement, Edge.DERIVES)
    owner = graph.owner(requirement)
    if owner is not None and is_listed(owner):
        inside = [inner for inner in graph.owned(owner) if is_listed(inner)]
        if all(inner.id in done for inner in inside):
            yield owner
