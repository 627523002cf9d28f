"""Checks of constraint properties: their types, and what is bound to their parameters."""

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import features, type_of
from sysmlc.ir.query.units import unit_of

NO_CONSTRAINT_BLOCK = rule(
    "SM217",
    "constraint-without-block",
    Severity.WARNING,
    "constraint property '{property}' is typed by no constraint block",
    help="type '{property}' by a constraint block",
)
UNBOUND_PARAMETER = rule(
    "SM218",
    "unbound-parameter",
    Severity.INFO,
    "nothing is bound to parameters of constraint '{property}': {parameters}",
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
    """Report usages without constraint block, parameters without binding, units that differ."""
    for usage in graph.of_kind(Kind.PROPERTY):
        if usage.role == "constraint property" and not usage.attrs.get("external"):
            _check_usage(graph, sink, usage)
    for one, other in [(graph[a], graph[b]) for _, a, b in graph.edges(Edge.BINDS)]:
        _check_units(graph, sink, one, other)


def _check_usage(graph: Graph, sink: Sink, usage: Element) -> None:
    type_ = type_of(graph, usage)
    name = graph.qualified_name(usage)
    unresolved = usage.attrs.get("unresolved")
    if type_ is None and not (isinstance(unresolved, tuple) and "typed-by" in unresolved):
        sink.report(NO_CONSTRAINT_BLOCK, graph.subject(usage), property=name)
    if type_ is not None:
        found = features(graph, type_)
        open_ = [one for one in found if _is_parameter(one) and not _is_bound(graph, usage, one)]
        if open_:
            names = ", ".join(f"'{one.name}'" for one in open_)
            sink.report(UNBOUND_PARAMETER, graph.subject(usage), property=name, parameters=names)


def _is_parameter(feature: Element) -> bool:
    return feature.role == "constraint parameter"


def _is_bound(graph: Graph, usage: Element, parameter: Element) -> bool:
    """Whether a connector end at the parameter leads through the usage, or says no way at all.

    Old Papyrus files have no paths, so that any binding of the parameter may be meant.
    """
    paths = [graph.targets(end, Edge.PATH) for end in graph.sources(parameter, Edge.ROLE)]
    return any(not path or usage in path for path in paths)


def _check_units(graph: Graph, sink: Sink, one: Element, other: Element) -> None:
    unit, other_unit = unit_of(graph, one), unit_of(graph, other)
    if unit is None or other_unit is None or _is_same(unit, other_unit):
        return
    sink.report(
        UNITS_DIFFER,
        graph.subject(one),
        one=graph.qualified_name(one),
        unit=unit.name,
        other=graph.qualified_name(other),
        other_unit=other_unit.name,
    )


def _is_same(one: Element, other: Element) -> bool:
    """Units that only text names are elements of their value types, one for each."""
    return one is other or one.name == other.name
