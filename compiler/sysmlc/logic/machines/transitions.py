"""Transitions of a state machine and their triggers.

Triggers are events, times and changes; the reader creates the variables that they need. The
transitions that lead to a join are combined into one.
"""

from itertools import combinations
from math import ceil

from msgspec.structs import replace

from sysmlc.diagnostics import Severity, Sink, rule
from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.ir.expressions import Binary, Expression, Name, Unary, print_expression
from sysmlc.ir.expressions import Literal as Written
from sysmlc.ir.query import port_names
from sysmlc.logic.contract import (
    BooleanDomain,
)
from sysmlc.logic.identifiers import make_unique
from sysmlc.logic.machines.actions import (
    read_behaviours,
    read_condition,
)
from sysmlc.logic.machines.machine import (
    NO_EVENT,
    AfterTicks,
    Machine,
    Memory,
    Occurrence,
    OnChange,
    OnEvent,
    OnInput,
    Transition,
    Vertex,
    element_id,
    submachine_id,
)
from sysmlc.logic.machines.supported_constructs import JOIN_BESIDE, collect_submachines
from sysmlc.logic.machines.vertices import MachineDraft, list_outgoing
from sysmlc.logic.machines.well_formedness import find_common_state
from sysmlc.support.counts import count as count_nouns
from sysmlc.support.units import Time, split_quantity


def _read_occurrences(
    draft: MachineDraft, trigger: Element, vertex: Vertex
) -> tuple[Occurrence, ...]:
    """Return the occurrences that make *trigger* fire; create their variables on first use."""
    kind = trigger.subkind
    if kind == "time" or (not kind and "when" in trigger.attrs):
        return (_read_time(draft, trigger, vertex),)
    if kind == "change" or (not kind and "condition" in trigger.attrs):
        return (_read_change(draft, trigger, vertex),)
    if kind == "any":
        literals = make_unique([*draft.events.values(), "other"], "", NO_EVENT)
        draft.events.setdefault("any", literals[-1])
        return (OnEvent(None),)
    return tuple(OnEvent(literal) for literal in _read_events(draft, trigger))


def _read_events(draft: MachineDraft, trigger: Element) -> list[str]:
    """Return the literals of ``event`` for a signal or operation; triggers of one type share them.

    If the machine waits for the type at several ports, each port has a literal, and a trigger
    without port takes all of them. The same port of two parts is two ports.
    """
    type_ = draft.reading.graph.target(trigger, Edge.TYPED_BY)
    if type_ is None:
        return [_read_event(draft, trigger.name or trigger.id, trigger.name)]
    ports = _list_ports(draft, type_)
    name, own_path = type_.name or trigger.name, port_names(draft.reading.graph, trigger)
    if len(ports) < 2:
        return [_read_event(draft, type_.id, name)]
    return [
        _read_event(
            draft,
            " ".join([type_.id, *path]),
            f"{name} via {'.'.join(path)}" if path else name,
        )
        for path in ports
        if own_path in ((), path)
    ]


def _list_ports(draft: MachineDraft, type_: Element) -> list[tuple[str, ...]]:
    """Return the paths to the ports at which triggers of the machine wait for a type.

    The empty path stands for the triggers that name no port.
    """
    graph = draft.reading.graph
    triggers = [t for t in graph.sources(type_, Edge.TYPED_BY) if t.kind is Kind.TRIGGER]
    paths = dict.fromkeys(port_names(graph, trigger) for trigger in triggers)
    if len(paths) > 1:
        machines = collect_submachines(graph, draft.machine)
        paths = dict.fromkeys(
            port_names(graph, trigger)
            for trigger in triggers
            if any(ancestor in machines for ancestor in graph.ancestors(trigger))
        )
    return list(paths)


def _read_event(draft: MachineDraft, key: str, name: str) -> str:
    """Return the literal of ``event`` for this key; create it on first use."""
    if key not in draft.events:
        literals = make_unique([*draft.events.values(), name or "event"], "event", NO_EVENT)
        draft.events[key] = literals[-1]
    return draft.events[key]


def _read_change(draft: MachineDraft, trigger: Element, vertex: Vertex) -> Occurrence:
    """Return the occurrence of a change trigger; create the memory that it needs.

    The triggers of UML with equal conditions share a memory. In SysML v2 each state waits anew.
    """
    text = str(trigger.attrs.get("condition", "")).strip() or trigger.name
    condition = read_condition(draft.reading, text, "change condition", trigger)
    printed = print_expression(condition)
    # An input that replaces the condition, or its negation, has another name than the text.
    name = f"was_{printed if isinstance(condition, Name | Unary) else text}"
    state, key = "", f"memory {printed}"
    is_immediate = trigger.attrs.get("immediate") is True
    if is_immediate:
        state, key, name = vertex.id, f"{key} {vertex.id}", f"{name}_in_{vertex.literal}"
    memory = draft.reading.memory_for(key, name, BooleanDomain(), trigger.id)
    draft.memories[memory] = Memory(condition, state)
    return OnChange(memory, condition, is_immediate)


# -- time ----------------------------------------------------------------------------------------


OPAQUE_TIME = rule(
    "SM417",
    "opaque-time",
    Severity.WARNING,
    "{time} {reason}; the contract {treatment}",
    help="{advice}",
)


def _read_time(draft: MachineDraft, trigger: Element, vertex: Vertex) -> Occurrence:
    """Return the occurrence of a time trigger; an input replaces a time that is not constant."""
    reading, time = draft.reading, query.time_of(trigger)
    if time.duration is None:
        variable = reading.input_for(f"time {time}", f"time_{time.text}", trigger.id)
        reason, advice = _explain_input(time)
        treatment = f"treats the event as the input '{variable}'"
        occurrence: Occurrence = OnInput(variable)
    else:
        steps = time.duration.count_steps(reading.tick_seconds)
        # Rounded up, so that a time trigger never occurs early; a reaction takes at least one step.
        count = max(1, ceil(steps))
        draft.bounds[vertex.id] = max(count, draft.bounds.get(vertex.id, 0))
        occurrence = AfterTicks(count)
        if steps.denominator == 1:
            return occurrence
        reason = f"is not a whole number of steps of {reading.tick_seconds:g} s"
        advice = "set the option 'tick_seconds' of the pass 'contracts' to a length that divides it"
        treatment = f"counts {count_nouns(count, 'step')}"
    reading.sink.report(
        OPAQUE_TIME,
        reading.graph.subject(trigger),
        time=f"time '{time.text}'" if time.text else "the time of a trigger",
        reason=reason,
        advice=advice,
        treatment=treatment,
    )
    return occurrence


def _explain_input(time: Time) -> tuple[str, str]:
    """Return why a time is not a number of steps, and what to do."""
    if not time.text:
        return "is not stated", "write 'after' and a duration"
    if not time.is_relative:
        advice = "write 'after' and a duration if the time counts from the entry of the state"
        return "is absolute", advice
    quantity = split_quantity(time.text)
    if quantity is not None and quantity[0] >= 0:
        return (
            f"is in '{quantity[1]}', which is not a known unit of time",
            "write ms, s, min, h or ticks",
        )
    advice = "write a number, or a number with a unit, if the duration is constant"
    return "is not a number", advice


# -- transitions -------------------------------------------------------------------------------


def read_transitions(draft: MachineDraft) -> None:
    """Read the transitions that leave each vertex, in the order of the diagram."""
    graph = draft.reading.graph
    for vertex in tuple(draft.vertices.values()):
        elements = list_outgoing(draft, vertex.id)
        literals = make_unique(
            [_base_literal(graph, element) for element, _ in elements], "transition", NO_EVENT
        )
        transitions = [
            _read_transition(draft, element, within, vertex, literal)
            for (element, within), literal in zip(elements, literals, strict=True)
        ]
        if transitions:
            draft.outgoing[vertex.id] = _expand_else(graph, transitions)
    for vertex in draft.vertices.values():
        _drop_idle_memories(draft, vertex)


def _base_literal(graph: Graph, transition: Element) -> str:
    target = graph.target(transition, Edge.FLOW_TARGET)
    return transition.name or f"to_{target.name if target and target.name else 'next'}"


def _read_transition(
    draft: MachineDraft, element: Element, within: str, vertex: Vertex, literal: str
) -> Transition:
    graph = draft.reading.graph
    text = _guard_text(graph, element)
    guard = None
    if text is not None and text != "else":
        guard = read_condition(draft.reading, text, "guard", element)
    triggers = graph.targets(element, Edge.TRIGGER) if vertex.kind == "state" else []
    target = graph.target(element, Edge.FLOW_TARGET)
    return Transition(
        submachine_id(within, element.id),
        literal,
        _describe(graph, element, text or ""),
        vertex.id,
        _resolve_target(draft, within, target),
        element.subkind or "external",
        tuple(
            occurrence
            for trigger in triggers
            for occurrence in _read_occurrences(draft, trigger, vertex)
        ),
        guard,
        read_behaviours(draft.reading, element, Edge.EFFECT),
    )


def _resolve_target(draft: MachineDraft, within: str, target: Element | None) -> str:
    """Return the id of a target.

    A connection point reference of a submachine state is replaced by the point of the submachine.
    """
    id = "" if target is None else submachine_id(within, target.id)
    return next(iter(draft.aliases.get(id, ())), id)


def _guard_text(graph: Graph, transition: Element) -> str | None:
    """Return the text of a guard, which may be empty, or None if the transition has no guard."""
    constraint = graph.target(transition, Edge.GUARD)
    text = str(transition.attrs.get("guard") or "").strip()
    if not text and constraint is not None:
        text = str(constraint.attrs.get("body", "")).strip()
    has_guard = constraint is not None or "guard" in transition.attrs
    return text if has_guard else None


def _describe(graph: Graph, transition: Element, guard: str) -> str:
    """Describe a transition for diagnostics, by its ends and its guard."""
    ends = [graph.target(transition, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
    end_names = [end.name or end.subkind or str(end.kind) for end in ends if end is not None]
    condition = f" [{guard.strip()}]" if guard.strip() else ""
    return " to ".join(end_names) + condition


def _expand_else(graph: Graph, transitions: list[Transition]) -> tuple[Transition, ...]:
    """Replace each guard ``else`` by the negation of the other guards."""
    return tuple(
        replace(transition, guard=_negate_siblings(transition, transitions))
        if _guard_text(graph, graph[element_id(transition.id)]) == "else"
        else transition
        for transition in transitions
    )


def _negate_siblings(transition: Transition, transitions: list[Transition]) -> Expression | None:
    """Return the negated disjunction of the guards of the siblings that share a trigger."""
    guards: list[Expression] = [
        sibling.guard or Written(True)
        for sibling in transitions
        if sibling is not transition and _share_occurrence(sibling, transition)
    ]
    if not guards:
        return None
    disjunction = guards[0]
    for guard in guards[1:]:
        disjunction = Binary("or", disjunction, guard)
    return Unary("not", disjunction)


def _share_occurrence(left: Transition, right: Transition) -> bool:
    same = set(left.occurrences) & set(right.occurrences)
    return bool(same) or (not left.occurrences and not right.occurrences)


def _drop_idle_memories(draft: MachineDraft, state: Vertex) -> None:
    """Remove the memories of a state that is left in every step in which their condition is true.

    They would never be true. Something else than a transition without a guard may preempt it if the
    state has regions or internal transitions.
    """
    outgoing = draft.outgoing.get(state.id, ())
    if state.regions or any(transition.kind == "internal" for transition in outgoing):
        return
    idle = {
        occurrence.memory
        for transition in outgoing
        if transition.guard is None and _can_always_enter(draft, transition.target)
        for occurrence in transition.occurrences
        if isinstance(occurrence, OnChange) and draft.memories[occurrence.memory].state
    }
    if not idle:
        return
    for memory in idle:
        del draft.memories[memory]
        draft.reading.remove_auxiliary(memory)
    draft.outgoing[state.id] = tuple(
        replace(
            transition,
            occurrences=tuple(
                replace(occurrence, memory="")
                if isinstance(occurrence, OnChange) and occurrence.memory in idle
                else occurrence
                for occurrence in transition.occurrences
            ),
        )
        for transition in outgoing
    )


def _can_always_enter(draft: MachineDraft, id: str) -> bool:
    """Whether a vertex is a state that is entered whatever the values of guards are."""
    vertex = draft.vertices.get(id)
    if vertex is None or not vertex.is_stable:
        return False
    regions = [draft.regions[region] for region in vertex.regions]
    starts = [(region, draft.outgoing.get(region.initial, ())) for region in regions]
    return all(
        len(start) == 1
        and start[0].guard is None
        and start[0].target in region.vertices
        and _can_always_enter(draft, start[0].target)
        for region, start in starts
    )


# -- forks and joins -----------------------------------------------------------------------------


def combine_joins(graph: Graph, machine: Machine, sink: Sink) -> bool:
    """Combine the transitions that lead to each join into one transition.

    A fork or join is moved to the region that contains the state whose regions it connects. An exit
    point to which several regions lead is a join (UML 2.5.1, 14.2.3.7). If a source of a join has
    another completion transition, the fault is reported and the result is
    False. A malformed fork or join is not changed; ``well_formedness`` reports it.
    """
    is_valid = True
    for vertex in tuple(machine.vertices.values()):
        if vertex.kind == "fork":
            targets = [transition.target for transition in machine.outgoing.get(vertex.id, ())]
            _move_to_outer_region(machine, vertex, targets)
            continue
        incoming = machine.list_incoming(vertex.id)
        if _is_joining_exit_point(machine, vertex, incoming):
            machine.vertices[vertex.id] = vertex = replace(vertex, kind="join")
        if vertex.kind == "join" and _can_combine(machine, incoming):
            _move_to_outer_region(machine, vertex, [transition.source for transition in incoming])
            is_valid = _combine(graph, machine, incoming, sink) and is_valid
    return is_valid


def _can_combine(machine: Machine, incoming: list[Transition]) -> bool:
    return len(incoming) > 1 and all(_can_join(machine, transition) for transition in incoming)


def _is_joining_exit_point(machine: Machine, vertex: Vertex, incoming: list[Transition]) -> bool:
    """Whether the vertex is an exit point at which all transitions come from different regions."""
    if vertex.kind != "exit-point" or len(machine.outgoing.get(vertex.id, ())) != 1:
        return False
    pairs = combinations([transition.source for transition in incoming], 2)
    return _can_combine(machine, incoming) and all(
        find_common_state(machine, *pair) is not None for pair in pairs
    )


def _can_join(machine: Machine, transition: Transition) -> bool:
    is_unconditional = transition.guard is None and not transition.occurrences
    return machine.vertices[transition.source].kind == "state" and is_unconditional


def _move_to_outer_region(machine: Machine, vertex: Vertex, ends: list[str]) -> None:
    """Move a fork or join to the region of the state whose regions it connects.

    The transitions into a join then leave that state, and those from a fork enter it.
    """
    inner = [end for end in ends if end in machine.vertices]
    state = find_common_state(machine, inner[0], inner[1]) if len(inner) > 1 else None
    if state:
        region = machine.vertices[state].region
        machine.vertices[vertex.id] = replace(vertex, region=region)


def _combine(graph: Graph, machine: Machine, incoming: list[Transition], sink: Sink) -> bool:
    """Replace the transitions into a join by the first, which has the others as join partners."""
    first, *partners = incoming
    for transition in incoming:
        siblings = [
            sibling for sibling in machine.outgoing[transition.source] if sibling is not transition
        ]
        competitor = next((sibling for sibling in siblings if not sibling.occurrences), None)
        if competitor is not None:
            _report_competing_completion(graph, machine, transition, competitor, sink)
            return False
        machine.outgoing[transition.source] = tuple(siblings)
    joined = replace(first, join_partners=tuple(partners))
    machine.outgoing[first.source] = (joined, *machine.outgoing[first.source])
    return True


def _report_competing_completion(
    graph: Graph, machine: Machine, transition: Transition, competitor: Transition, sink: Sink
) -> None:
    """Report that a source of a join has another completion transition."""
    element, completion = (graph[element_id(id)] for id in (transition.source, competitor.id))
    target = graph.target(completion, Edge.FLOW_TARGET)
    name = completion.name or f"{element.name} -> {target.name if target is not None else ''}"
    subject = graph.subject(completion)
    sink.report(JOIN_BESIDE, subject, state=element.name, machine=machine.name, other=name)
