"""Pass ``guards``: reads names of flows as guards where they can mean nothing else.

Many modellers write "Accepted" or "else" as the name of a flow instead of its guard.
"""

import re
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.query import has_generated_name, type_of

GUARD_FROM_NAME = rule(
    "SM461",
    "guard-from-name",
    Severity.INFO,
    "the names of {flows} are read as guards: {names}",
    help="write them as the guards of the flows",
)

_IN_BRACKETS = re.compile(r"[^\[\]]*\[([^\[\]]+)\]\s*")
"""A name in the notation of diagrams, ``[load > 3]``."""
_FLOWS = (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
_BOOLEAN = frozenset({"boolean", "bool", "eboolean"})
_TRUTH_VALUES = frozenset({"true", "false"})


class Guards(Struct, frozen=True):
    """Set the guards of flows to their names, where these can mean nothing else.

    The names of the flows that leave a decision are guards if each is a value of the type that the
    decision tests, or if one of the flows is called ``else`` or has that guard. A name in brackets
    is a guard on every flow.
    """

    name: ClassVar[str] = "guards"
    after: ClassVar[tuple[str, ...]] = ("classify", "flows")

    def run(self, graph: Graph, sink: Sink) -> None:
        """Change the guards of the flows of decisions, and of flows with names in brackets."""
        for decision in graph.of_kind(Kind.CONTROL):
            if decision.subkind != "decision":
                continue
            flows = [f for f in graph.sources(decision, Edge.FLOW_SOURCE) if f.kind in _FLOWS]
            named = [flow for flow in flows if _is_named_without_guard(flow)]
            if not named:
                continue
            values = _list_tested_values(graph, decision)
            are_values = all(flow.name.strip() in values for flow in named)
            if not are_values and not any(map(_is_else, flows)):
                continue
            for flow in named:
                text = "else" if _is_else(flow) else _strip_brackets(flow.name)
                graph.set(flow, guard=text, guard_literal=(are_values and text != "else") or None)
            flows_of_decision = f"the flows that leave decision '{decision.name}'"
            _report(graph, decision, flows_of_decision, named, sink)
        for flow in graph.of_kind(*_FLOWS):
            if _IN_BRACKETS.fullmatch(flow.name) and _is_named_without_guard(flow):
                graph.set(flow, guard=_strip_brackets(flow.name), guard_literal=None)
                _report(graph, flow, "flows", [flow], sink)


def _report(graph: Graph, element: Element, flows: str, named: list[Element], sink: Sink) -> None:
    names = ", ".join(f"'{flow.name}'" for flow in named)
    sink.report(GUARD_FROM_NAME, graph.subject(element), flows=flows, names=names)


def _strip_brackets(name: str) -> str:
    match = _IN_BRACKETS.fullmatch(name)
    return (match[1] if match is not None else name).strip()


def _is_named_without_guard(flow: Element) -> bool:
    """Whether a flow has a name of its author's and no guard but the literal that tools add."""
    guard = flow.attrs.get("guard")
    is_default = guard == "true" and flow.attrs.get("guard_literal") is True
    return not has_generated_name(flow) and (guard is None or is_default)


def _is_else(flow: Element) -> bool:
    words = [str(flow.attrs.get("guard", "")), flow.name]
    return any(_strip_brackets(word).casefold() == "else" for word in words)


def _list_tested_values(graph: Graph, decision: Element) -> frozenset[str]:
    """Return the values of the Boolean or enumeration that the decision tests, as texts."""
    type_ = _find_tested_type(graph, decision)
    if type_ is None:
        return frozenset()
    if type_.name.casefold() in _BOOLEAN:
        return _TRUTH_VALUES
    literals = (item for item in graph.owned(type_) if item.kind is Kind.ENUMERATION_LITERAL)
    return frozenset(literal.name for literal in literals)


def _find_tested_type(graph: Graph, decision: Element) -> Element | None:
    """Return the type of the result of the decision input, or of the objects that arrive."""
    behaviour = graph.get(str(decision.attrs.get("decision_input", "")))
    if behaviour is not None:
        parameters = [p for p in graph.owned(behaviour) if p.kind is Kind.PARAMETER]
        results = [p for p in parameters if p.attrs.get("direction") in ("return", "out")]
        return type_of(graph, results[0]) if results else None
    incoming = [
        flow for flow in graph.sources(decision, Edge.FLOW_TARGET) if flow.kind is Kind.OBJECT_FLOW
    ]
    chosen = graph.get(str(decision.attrs.get("decision_input_flow", "")))
    for flow in [chosen] if chosen is not None else incoming:
        source = graph.target(flow, Edge.FLOW_SOURCE)
        if source is not None:
            return type_of(graph, source)
    return None
