"""Binding connectors: their role, and the edges between the bound elements."""

from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import ends, role_of

_BINDING = "binding connector"


def add_bindings(graph: Graph) -> None:
    """Give connectors at constraint parameters their role, and bound elements ``binds`` edges.

    Every connector of a parametric diagram is a binding connector (SysML 1.6 clause 10.3.1.2), with
    or without its stereotype; no other connector is attached to a constraint parameter.
    """
    for connector in graph.of_kind(Kind.CONNECTOR):
        roles = [role for end in ends(graph, connector) if (role := role_of(graph, end))]
        if not connector.role and any(
            bound_role.role == "constraint parameter" for bound_role in roles
        ):
            graph.set(connector, role=_BINDING)
        if connector.role == _BINDING:
            _bind(graph, roles)


def _bind(graph: Graph, roles: list[Element]) -> None:
    for role in roles[1:]:
        if role is not roles[0]:
            graph.connect(Edge.BINDS, roles[0], role)
