"""Binding connectors: which connectors are, and the edges between what they bind."""

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import ends, role_of

_BINDING = "binding connector"


def add_bindings(graph: Graph) -> None:
    """Give connectors at constraint parameters their role, and ``binds`` edges to all bindings.

    Every connector of a parametric diagram is a binding connector (SysML 1.6 clause 10.3.1.2),
    with or without its stereotype; nothing else is attached to a constraint parameter.
    """
    for connector in graph.of_kind(Kind.CONNECTOR):
        bound = [role for end in ends(graph, connector) if (role := role_of(graph, end))]
        if not connector.role and any(one.role == "constraint parameter" for one in bound):
            graph.set(connector, role=_BINDING)
        if connector.role == _BINDING:
            _bind(graph, bound)


def _bind(graph: Graph, bound: list[Element]) -> None:
    for other in bound[1:]:
        if other is not bound[0]:
            graph.connect(Edge.BINDS, bound[0], other)
