"""Checks of attributes whose values must be literals of enumerations of UML or SysML."""

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.query import FLOW_DIRECTIONS, tag

UNKNOWN_LITERAL = rule(
    "SM220",
    "unknown-literal",
    Severity.WARNING,
    "the {attribute} of '{element}' is '{value}', which is none of {known}",
    help="choose one of {known} in the modelling tool",
)

_KINDS = (Kind.PARAMETER, Kind.PORT, Kind.PROPERTY, Kind.FLOW_PROPERTY)
_LITERALS = {
    "aggregation": ("none", "shared", "composite"),
    "direction": ("in", "inout", "out", "return"),
}


def check_literals(graph: Graph, sink: Sink) -> None:
    """Report and remove directions and aggregations that do not exist."""
    for element in graph.of_kind(*_KINDS):
        attrs = element.attrs
        for attribute, literals in _LITERALS.items() if attrs else ():
            if attribute in attrs and attrs[attribute] not in literals:
                _report(graph, sink, element, attribute)
                # SysML 1.6 clause 9.3.2: a flow property without direction has inout.
                is_flow = element.role == "flow property" and attribute == "direction"
                graph.set(element, **{attribute: "inout" if is_flow else None})
    for port in graph.of_kind(Kind.PORT):
        if port.role == "flow port":
            _check_tag(graph, sink, port)


def _check_tag(graph: Graph, sink: Sink, port: Element) -> None:
    """Check the direction of a flow port of SysML 1.1: a tag, which the pass ``ports`` reads."""
    direction = tag(graph, port, "direction")
    if isinstance(direction, str) and direction and direction not in FLOW_DIRECTIONS:
        _report(graph, sink, port, "direction", direction)


def _report(
    graph: Graph, sink: Sink, element: Element, attribute: str, tag_value: str = ""
) -> None:
    sink.report(
        UNKNOWN_LITERAL,
        graph.subject(element),
        attribute=attribute,
        element=graph.qualified_name(element),
        value=tag_value or element.attrs[attribute],
        known=", ".join(FLOW_DIRECTIONS if tag_value else _LITERALS[attribute]),
    )
