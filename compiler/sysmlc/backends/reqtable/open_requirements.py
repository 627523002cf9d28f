"""Open requirements: those that nothing satisfies or verifies."""

from collections.abc import Iterable, Iterator

from sysmlc.backends.reqtable.table import is_listed
from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph

UNSATISFIED = rule(
    "SM715",
    "unsatisfied-requirement",
    Severity.INFO,
    "nothing satisfies requirement '{requirement}'",
    help="draw «satisfy» from the block or behaviour to the requirement",
)
UNVERIFIED = rule(
    "SM716",
    "unverified-requirement",
    Severity.INFO,
    "nothing verifies requirement '{requirement}'",
    help="draw «verify» from a test case to the requirement",
)


def report_open_requirements(graph: Graph, requirements: list[Element], sink: Sink) -> None:
    """Report each requirement that nothing satisfies, and each that nothing verifies."""
    for open_rule, edge in ((UNSATISFIED, Edge.SATISFIES), (UNVERIFIED, Edge.VERIFIES)):
        closed = _find_closed(graph, requirements, edge)
        for requirement in requirements:
            if requirement.id not in closed:
                name = graph.qualified_name(requirement)
                sink.report(open_rule, graph.subject(requirement), requirement=name)


def _find_closed(graph: Graph, requirements: Iterable[Element], edge: Edge) -> frozenset[str]:
    """Return the ids of the requirements with a relation *edge*, directly or by implication.

    A compound requirement is satisfied if all requirements in it are (SysML 1.6 clause 16.3.1), and
    a requirement is satisfied if one derived from it is.
    """
    worklist = [element for element in requirements if _has_relation(graph, element, edge)]
    closed = {requirement.id for requirement in worklist}
    for requirement in worklist:
        for implied in _iter_implied(graph, requirement, closed):
            if implied.id not in closed:
                closed.add(implied.id)
                worklist.append(implied)
    return frozenset(closed)


def _has_relation(graph: Graph, requirement: Element, edge: Edge) -> bool:
    # A SysML v2 requirement leads to its subject itself.
    has_subject = edge is Edge.SATISFIES and bool(graph.targets(requirement, Edge.SUBJECT))
    return has_subject or bool(graph.sources(requirement, edge))


def _iter_implied(graph: Graph, requirement: Element, closed: set[str]) -> Iterator[Element]:
    """Yield the requirements that have the relation because *requirement* has it."""
    yield from graph.targets(requirement, Edge.DERIVES)
    owner = graph.owner(requirement)
    if owner is not None and is_listed(owner):
        contained = [element for element in graph.owned(owner) if is_listed(element)]
        if all(element.id in closed for element in contained):
            yield owner
