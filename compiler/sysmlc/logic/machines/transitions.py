"""Transitions of a state machine, and those that forks and joins make one."""

from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph
from sysmlc.logic.expressions.expression import Binary, Expression, Unary
from sysmlc.logic.expressions.expression import Literal as Written
from sysmlc.logic.machines.actions import read_behaviours, read_condition
from sysmlc.logic.machines.machine import (
    NO_EVENT,
    Machine,
    Transition,
    Vertex,
    element_id,
    id_within,
)
from sysmlc.logic.machines.supported_constructs import JOIN_BESIDE
from sysmlc.logic.machines.triggers import occurrence_of
from sysmlc.logic.machines.vertices import Parts, drawn_from
from sysmlc.logic.machines.well_formedness import common_state
from sysmlc.logic.names import unique


def read_transitions(parts: Parts) -> None:
    """Read the transitions that leave each vertex, in the order of the drawing."""
    graph = parts.reading.graph
    for vertex in tuple(parts.vertices.values()):
        drawn = drawn_from(parts, vertex.id)
        literals = unique([_label(graph, one) for one, _ in drawn], "transition", NO_EVENT)
        read = [
            _read_transition(parts, one, within, vertex, literal)
            for (one, within), literal in zip(drawn, literals, strict=True)
        ]
        if read:
            parts.outgoing[vertex.id] = _without_else(graph, read)


def _label(graph: Graph, transition: Element) -> str:
    target = graph.target(transition, Edge.FLOW_TARGET)
    return transition.name or f"to_{target.name if target and target.name else 'next'}"


def _read_transition(
    parts: Parts, element: Element, within: str, vertex: Vertex, literal: str
) -> Transition:
    graph = parts.reading.graph
    text = _guard_text(graph, element)
    guard = None
    if text and text.strip() != "else":
        guard = read_condition(parts.reading, text.strip(), "guard", element)
    triggers = graph.targets(element, Edge.TRIGGER) if vertex.kind == "state" else []
    target = graph.target(element, Edge.FLOW_TARGET)
    return Transition(
        id_within(within, element.id),
        literal,
        _words(graph, element, text),
        vertex.id,
        _target(parts, within, target),
        element.subkind or "external",
        tuple(occurrence_of(parts, trigger, vertex) for trigger in triggers),
        guard,
        read_behaviours(parts.reading, element, Edge.EFFECT),
    )


def _target(parts: Parts, within: str, target: Element | None) -> str:
    """The id of a target; what stands for a point of a submachine leads there."""
    id = "" if target is None else id_within(within, target.id)
    return next(iter(parts.aliases.get(id, ())), id)


def _guard_text(graph: Graph, transition: Element) -> str:
    text = transition.attrs.get("guard")
    if isinstance(text, str) and text.strip():
        return text
    constraint = graph.target(transition, Edge.GUARD)
    return "" if constraint is None else str(constraint.attrs.get("body", ""))


def _words(graph: Graph, transition: Element, guard: str) -> str:
    ends = [graph.target(transition, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
    names = [end.name or end.subkind or str(end.kind) for end in ends if end is not None]
    condition = f" [{guard.strip()}]" if guard.strip() else ""
    return " to ".join(names) + condition


def _without_else(graph: Graph, drawn: list[Transition]) -> tuple[Transition, ...]:
    """The same with ``else`` written out as the negation of the other guards."""
    return tuple(
        replace(one, guard=_negated(one, drawn)) if _is_else(graph, one) else one for one in drawn
    )


def _is_else(graph: Graph, transition: Transition) -> bool:
    return _guard_text(graph, graph[element_id(transition.id)]).strip() == "else"


def _negated(transition: Transition, drawn: list[Transition]) -> Expression | None:
    guards: list[Expression] = [
        one.guard or Written(True)
        for one in drawn
        if one is not transition and _share_occurrence(one, transition)
    ]
    if not guards:
        return None
    joined = guards[0]
    for guard in guards[1:]:
        joined = Binary("or", joined, guard)
    return Unary("not", joined)


def _share_occurrence(left: Transition, right: Transition) -> bool:
    same = set(left.occurrences) & set(right.occurrences)
    return bool(same) or (not left.occurrences and not right.occurrences)


# -- forks and joins -----------------------------------------------------------------------------


def join_up(graph: Graph, machine: Machine, sink: Sink) -> bool:
    """Make one transition of those that lead to a join, and let forks and joins stand outside the
    state whose regions they split; False, reported, when a source has another way to complete.

    What is malformed stays as it is, for ``shape`` to tell.
    """
    is_clear = True
    for vertex in tuple(machine.vertices.values()):
        if vertex.kind == "fork":
            _move_out(machine, vertex, [one.target for one in machine.outgoing.get(vertex.id, ())])
        elif vertex.kind == "join":
            into = [one for one in machine.transitions() if one.target == vertex.id]
            if len(into) > 1 and all(_may_join(machine, one) for one in into):
                _move_out(machine, vertex, [one.source for one in into])
                is_clear = _join(graph, machine, into, sink) and is_clear
    return is_clear


def _may_join(machine: Machine, one: Transition) -> bool:
    is_bare = one.guard is None and not one.occurrences
    return machine.vertices[one.source].kind == "state" and is_bare


def _move_out(machine: Machine, vertex: Vertex, ends: list[str]) -> None:
    known = [one for one in ends if one in machine.vertices]
    state = common_state(machine, known[0], known[1]) if len(known) > 1 else None
    if state:
        region = machine.vertices[state].region
        machine.vertices[vertex.id] = replace(vertex, region=region)


def _join(graph: Graph, machine: Machine, into: list[Transition], sink: Sink) -> bool:
    first, *others = into
    for one in into:
        beside = [each for each in machine.outgoing[one.source] if each is not one]
        rival = next((each for each in beside if not each.occurrences), None)
        if rival is not None:
            _report_rival(graph, machine, one, rival, sink)
            return False
        machine.outgoing[one.source] = tuple(beside)
    joined = replace(first, also=tuple(others))
    machine.outgoing[first.source] = (joined, *machine.outgoing[first.source])
    return True


def _report_rival(
    graph: Graph, machine: Machine, one: Transition, rival: Transition, sink: Sink
) -> None:
    element, other = (graph[element_id(each)] for each in (one.source, rival.id))
    target = graph.target(other, Edge.FLOW_TARGET)
    name = other.name or f"{element.name} -> {target.name if target is not None else ''}"
    subject = graph.subject(other)
    sink.report(JOIN_BESIDE, subject, state=element.name, machine=machine.name, other=name)
