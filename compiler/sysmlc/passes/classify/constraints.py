"""Constraint properties: checks of their types and parameters, and binding connectors.

The pass sets the role of binding connectors and adds edges between the bound elements.
"""

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import ends, features, role_of, type_of
from sysmlc.ir.query.classifiers import unit_of

NO_CONSTRAINT_BLOCK = rule(
    "SM217",
    "constraint-without-block",
    Severity.WARNING,
    "constraint property '{property}' is not typed by a constraint block",
    help="type '{property}' by a constraint block",
)
UNBOUND_PARAMETER = rule(
    "SM218",
    "unbound-parameter",
    Severity.INFO,
    "parameters of constraint '{property}' are not bound: {parameters}",
    help="bind a value property or another parameter to each",
)
UNITS_DIFFER = rule(
    "SM219",
    "bound-units-differ",
    Severity.WARNING,
    "'{one}' in {unit} is bound to '{other}' in {other_unit}",
    help="give both the same value type, or bind them through a constraint that converts",
)


def check_constraints(graph: Graph, sink: Sink) -> None:
    """Report usages without constraint block, unbound parameters, and bindings between units."""
    for usage in graph.of_kind(Kind.PROPERTY):
        if usage.role == "constraint property" and not usage.attrs.get("external"):
            _check_usage(graph, sink, usage)
    for left, right in [(graph[a], graph[b]) for _, a, b in graph.edges(Edge.BINDS)]:
        _check_units(graph, sink, left, right)


def _check_usage(graph: Graph, sink: Sink, usage: Element) -> None:
    type_ = type_of(graph, usage)
    name = graph.qualified_name(usage)
    unresolved = usage.attrs.get("unresolved")
    if type_ is None and not (isinstance(unresolved, tuple) and "typed-by" in unresolved):
        sink.report(NO_CONSTRAINT_BLOCK, graph.subject(usage), property=name)
    # In SysML v2 a value, such as another predicate, stands for the whole usage.
    if type_ is not None and "default" not in usage.attrs:
        parameters = (f for f in features(graph, type_) if f.role == "constraint parameter")
        unbound = [p for p in parameters if p.name and not _is_bound(graph, usage, p)]
        if unbound:
            names = ", ".join(f"'{parameter.name}'" for parameter in unbound)
            sink.report(UNBOUND_PARAMETER, graph.subject(usage), property=name, parameters=names)


def _is_bound(graph: Graph, usage: Element, parameter: Element) -> bool:
    """Whether a connector end at the parameter leads through the usage, or has no path at all.

    Old Papyrus files have no paths, so that any binding of the parameter may be meant.
    """
    paths = [graph.targets(end, Edge.PATH) for end in graph.sources(parameter, Edge.ROLE)]
    return any(not path or usage in path for path in paths)


def _check_units(graph: Graph, sink: Sink, left: Element, right: Element) -> None:
    unit, other_unit = unit_of(graph, left), unit_of(graph, right)
    # For a unit that is only a text, the pass adds one element to each value type.
    if unit is None or other_unit is None or unit.name == other_unit.name:
        return
    sink.report(
        UNITS_DIFFER,
        graph.subject(left),
        one=graph.qualified_name(left),
        unit=unit.name,
        other=graph.qualified_name(right),
        other_unit=other_unit.name,
    )


# -- binding connectors ------------------------------------------------------------------------

_BINDING = "binding connector"


def add_bindings(graph: Graph) -> None:
    """Set the role of binding connectors, and add ``binds`` edges between the bound elements.

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
