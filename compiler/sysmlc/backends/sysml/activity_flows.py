"""Flows of an activity: successions between nodes, and flows of objects between pins and stores.

A control node of SysML v2 has no pins. An object flow that passes a control node therefore becomes
a succession, for the order, and flows from its source to all targets behind the node. Metadata
states an object flow between a control node and a store, because a store cannot end a succession.
"""

from collections.abc import Iterator

from sysmlc.backends.sysml.annotations import make_annotation
from sysmlc.backends.sysml.comments import annotate_element
from sysmlc.backends.sysml.conditions import format_condition
from sysmlc.backends.sysml.declarations import list_visibility
from sysmlc.backends.sysml.definitions import write_contents
from sysmlc.backends.sysml.elided_elements import find_step_after_merge
from sysmlc.backends.sysml.expressions import format_literal
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import Line, quote_name
from sysmlc.backends.sysml.references import (
    format_element_reference,
    format_reference,
    visible_members,
)
from sysmlc.backends.sysml.relocation import (
    find_behaviour,
    find_common_namespace,
    find_object_node,
    iter_reaching_namespaces,
)
from sysmlc.backends.sysml.shapes import is_succession
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.query import has_decision_input, has_guard

_ScopedLine = tuple[Member | None, Line]
"""The line of a flow, and the namespace in which it is written."""
_STORES = (Kind.OBJECT_NODE, Kind.DATA_STORE, Kind.ACTIVITY_PARAMETER)


# -- successions ---------------------------------------------------------------------------------


def write_successions(writer: Writer, member: Member) -> list[Line]:
    """Write the successions that leave a node, in the order of the model; ``else`` is last."""
    flows = _list_outgoing_flows(writer, member.require_element())
    flows.sort(key=lambda flow: flow.attrs.get("guard") == "else")
    lines = [_write_succession(writer, member, flow) for flow in flows]
    return [line for line in lines if line is not None]


def write_initial_successions(writer: Writer, member: Member, initial: Element) -> list[Line]:
    """Write the successions that leave an initial node."""
    lines, scope = [], member.parent
    for flow in writer.graph.sources(initial, Edge.FLOW_SOURCE):
        writer.expressed.add(flow.id)
        target = writer.graph.target(flow, Edge.FLOW_TARGET)
        end = None if target is None else _refer_to_node(writer, scope, target)
        if end is None:
            writer.record_unreachable(flow, "flow-target")
            continue
        flow_member = writer.plan.find(flow)
        words = ["first start"]
        if flow_member is not None and flow_member.name:
            words.insert(0, f"succession {quote_name(flow_member.name)}")
        if has_guard(writer.graph, flow):
            guard = str(flow.attrs["guard"])
            words.append(f"if {format_condition(writer, scope, flow, guard)}")
        body = [] if flow_member is None else write_contents(writer, flow_member)
        lines.append(Line(" ".join([*words, f"then {end}"]), body))
    return lines


def _list_outgoing_flows(writer: Writer, element: Element) -> list[Element]:
    """Return the control flows that leave a node, and the object flows that order nodes."""
    graph = writer.graph
    flows = [
        flow for flow in graph.sources(element, Edge.FLOW_SOURCE) if is_succession(graph, flow)
    ]
    for pin in graph.owned(element):
        if pin.kind is Kind.PIN:
            pin_flows = graph.sources(pin, Edge.FLOW_SOURCE)
            flows += [flow for flow in pin_flows if is_succession(graph, flow)]
    return flows


def _write_succession(writer: Writer, member: Member, flow: Element) -> Line | None:
    """Write a succession after its source as ``then``; one with a name states its source.

    A succession that leaves the action around its source stands around both its ends.
    """
    writer.expressed.add(flow.id)
    target = writer.graph.target(flow, Edge.FLOW_TARGET)
    scope = _find_succession_scope(writer, member, target)
    end = None if target is None else _refer_to_node(writer, scope, target)
    if end is None:
        if target is None or target.kind not in _STORES:
            writer.record_unreachable(flow, "flow-target")
        return None
    flow_member = writer.plan.find(flow)
    name = flow_member.name if flow_member is not None else ""
    if flow_member is not None and flow_member.parent is not scope:
        construct = "a flow that another node owns"
        writer.record_approximation(flow, construct, "a succession beside its source")
    body = [] if flow_member is None else write_contents(writer, flow_member)
    if flow.kind is not Kind.CONTROL_FLOW:
        body = [_annotate_pins(writer, member, flow), *body]
    is_decision = member.shape.keyword == "decide"
    guard = _format_guard(writer, member, scope, flow)
    if scope is not None and scope is not member.parent:
        if guard == "else":
            guard = format_condition(writer, scope, flow, guard)
        source = format_reference(writer.plan, scope, member)
        condition = "" if guard is None else f"if {guard} "
        words = f"first {source} {condition}then {end}"
        if flow_member is not None and _take_name(writer, scope, flow_member):
            words = f"succession {quote_name(name)} {words}"
        scope.added_lines.append(Line(words, body))
        return None
    if guard == "else" and not name and is_decision:
        return Line(f"else {end}", body, depth=1)
    condition = "" if guard in (None, "else") else f"if {guard} "
    if name:
        start = f"succession {quote_name(name)} first {quote_name(member.name)}"
        return Line(f"{start} {condition}then {end}", body)
    return Line(f"{condition}then {end}", body, depth=1 if is_decision else 0)


def _find_succession_scope(writer: Writer, member: Member, target: Element | None) -> Member | None:
    """Return the innermost namespace around a node that contains the target of a flow, too.

    A final node without a member needs its behaviour: in another action, ``done`` ends that action.
    """
    step = find_step_after_merge(writer.graph, target) or target
    if step is not None and step.kind is Kind.PIN:
        step = writer.graph.owner(step)
    if step is not None and writer.plan.find(step) is None:
        behaviour = find_behaviour(writer.plan, step)
        is_around = any(behaviour is namespace for namespace in iter_reaching_namespaces(member))
        return behaviour if is_around else member.parent
    return find_common_namespace(writer.plan, member, (member.element, step)) or member.parent


def _take_name(writer: Writer, scope: Member, flow: Member) -> bool:
    """Whether a flow can have its name in another namespace; from then on, it is taken."""
    if not flow.name:
        return False
    return visible_members(writer.plan, scope).setdefault(flow.name, flow) is flow


def _annotate_pins(writer: Writer, member: Member, flow: Element) -> Line:
    """Return metadata with the pins at the ends of a succession along which objects flow."""
    facts: dict[str, AttrValue] = {}
    for key, edge in (("source", Edge.FLOW_SOURCE), ("target", Edge.FLOW_TARGET)):
        end = writer.graph.target(flow, edge)
        pin = writer.plan.find(end) if end is not None and end.kind is Kind.PIN else None
        facts[key] = "" if pin is None else pin.name
    return make_annotation(writer, member, "ObjectFlow", facts)


# -- guards --------------------------------------------------------------------------------------


def _format_guard(
    writer: Writer, member: Member, scope: Member | None, flow: Element
) -> str | None:
    """Return the guard of a flow; a literal is compared with the input of the decision."""
    guard = flow.attrs.get("guard")
    if guard is None or not has_guard(writer.graph, flow):
        return None
    if isinstance(guard, str) and guard.strip() == "else":
        return "else"
    decision = member.require_element()
    if flow.attrs.get("guard_literal") and has_decision_input(writer.graph, decision):
        decision_input = _format_decision_input(writer, scope, decision)
        if decision_input is not None:
            return f"{decision_input} == {_format_guard_literal(writer, member, guard)}"
    if not isinstance(guard, str):
        return _format_guard_literal(writer, member, guard)
    return format_condition(writer, scope, flow, guard)


def _format_guard_literal(writer: Writer, member: Member, guard: object) -> str:
    if isinstance(guard, str) and (guard in ("true", "false") or guard.lstrip("-").isdigit()):
        return guard
    value = guard if isinstance(guard, str | int | float | bool) else str(guard)
    return format_literal(writer, member.parent, member.require_element(), value)


def _format_decision_input(writer: Writer, scope: Member | None, decision: Element) -> str | None:
    """Return the only object that flows into a decision, or that the decision names."""
    flow = writer.graph.get(str(decision.attrs.get("decision_input_flow", "")))
    if flow is None:
        incoming = writer.graph.sources(decision, Edge.FLOW_TARGET)
        object_flows = [flow for flow in incoming if flow.kind is Kind.OBJECT_FLOW]
        if len(object_flows) != 1:
            return None
        flow = object_flows[0]
    source = writer.graph.target(flow, Edge.FLOW_SOURCE)
    if source is None or source.kind is Kind.CONTROL:
        return None
    return _refer_to_object_node(writer, scope, source)


# -- references to nodes -------------------------------------------------------------------------


def _refer_to_node(writer: Writer, scope: Member | None, node: Element) -> str | None:
    """Return how a succession names a node: a pin by its action, a final node as ``done``."""
    if node.kind is Kind.PIN:
        action = writer.graph.owner(node)
        return None if action is None else _refer_to_node(writer, scope, action)
    step = find_step_after_merge(writer.graph, node)
    if step is not None:
        writer.expressed.add(node.id)
        return _refer_to_node(writer, scope, step)
    if node.kind in _STORES:
        return None
    if node.subkind != "initial" and writer.plan.find(node) is not None:
        return format_element_reference(writer.plan, scope, node)
    return _refer_to_start_or_done(writer, scope, node)


def _refer_to_start_or_done(writer: Writer, scope: Member | None, node: Element) -> str | None:
    """Return ``start`` or ``done``, with the path to the behaviour if it is not around *scope*."""
    word = {"initial": "start", "final": "done", "flow-final": "done"}.get(node.subkind)
    if word is None:
        return None
    behaviour = find_behaviour(writer.plan, node)
    around = () if scope is None else (scope, *scope.namespaces)
    if behaviour is None or any(behaviour is namespace for namespace in around):
        return word
    name = format_element_reference(writer.plan, scope, behaviour.element)
    return None if name is None else f"{name}.{word}"


def _refer_to_object_node(writer: Writer, scope: Member | None, node: Element) -> str | None:
    """Return how a flow names an object node; the node of a parameter by the parameter."""
    member = find_object_node(writer.plan, node)
    return None if member is None else format_reference(writer.plan, scope, member)


# -- object flows --------------------------------------------------------------------------------


def write_object_flow(writer: Writer, member: Member) -> list[Line]:
    """Write the flows from the source of an object flow to all targets behind control nodes.

    An object flow that starts at a control node has no lines: the flows to the node include it.
    """
    lines = []
    for scope, line in _list_flow_lines(writer, member):
        if scope is member.parent or scope is None:
            lines.append(line)
        else:
            scope.added_lines.append(line)
    return lines


def _list_flow_lines(writer: Writer, member: Member) -> list[_ScopedLine]:
    element = member.require_element()
    source = writer.graph.target(element, Edge.FLOW_SOURCE)
    target = writer.graph.target(element, Edge.FLOW_TARGET)
    if source is None or target is None:
        writer.drop(member, "flow ends")
        return []
    if source.kind is Kind.CONTROL:
        return _annotate_flow(writer, member, target)
    if target.kind is Kind.CONTROL:
        return _list_lines_over_control_nodes(writer, member, source, target)
    return _add_contents(writer, member, source, [target])


def _list_lines_over_control_nodes(
    writer: Writer, member: Member, source: Element, control_node: Element
) -> list[_ScopedLine]:
    """Return the flows from a source to all object nodes behind a control node.

    Metadata marks them, because they follow from the flows to and from the control nodes: a
    succession expresses such a flow, with its name and annotations, or metadata if it has no step
    at its other end.
    """
    targets = list(_iter_targets_behind(writer, control_node))
    lines = _format_flow_lines(writer, member, source, targets, "")
    for _, line in lines:
        line.body.append(make_annotation(writer, member, "Through", {}))
    return [*_annotate_flow(writer, member, source), *lines]


def _annotate_flow(writer: Writer, member: Member, end: Element) -> list[_ScopedLine]:
    """Return metadata for the flow between a control node and *end* if that is no step or pin."""
    if end.kind not in _STORES:
        return []
    flow = member.require_element()
    annotation = annotate_element(writer, member, flow)
    for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET):
        for node in writer.graph.targets(flow, edge):
            if (edge, flow.id, node.id) not in writer.stored_edges:
                writer.record_unreachable(flow, str(edge.value))
                return []
    return [(member.parent, annotation)]


def _add_contents(
    writer: Writer, member: Member, source: Element, targets: list[Element]
) -> list[_ScopedLine]:
    """Return a line for each target; the first has the name and the contents of the flow."""
    lines = _format_flow_lines(writer, member, source, targets, member.name)
    if lines:
        lines[0][1].body += write_contents(writer, member)
    return lines


def _format_flow_lines(
    writer: Writer, member: Member, source: Element, targets: list[Element], name: str
) -> list[_ScopedLine]:
    """Return a line for each target, in a namespace that contains both ends; the first is named.

    The flow has a name of its own in its namespace only.
    """
    flow = member.require_element()
    lines: list[_ScopedLine] = []
    for target in targets:
        scope = find_common_namespace(writer.plan, member, (source, target)) or member.parent
        source_name = _refer_to_object_node(writer, scope, source)
        target_name = _refer_to_object_node(writer, scope, target)
        if source_name is None or target_name is None:
            writer.drop(member, "flow ends")
            continue
        ends = ((source, source_name), (target, target_name))
        line_name = name if scope is member.parent else ""
        lines.append((scope, Line(_format_object_flow(writer, flow, line_name, *ends))))
        name = ""
    return lines


def _format_object_flow(
    writer: Writer,
    flow: Element,
    name: str,
    source: tuple[Element, str],
    target: tuple[Element, str],
) -> str:
    """Return a flow between pins, or a binding; *source* and *target* are nodes with names."""
    prefixes = list_visibility(writer, flow)
    if Kind.ACTION in (source[0].kind, target[0].kind):
        writer.record_approximation(flow, "an object flow of an action", "one of a pin of it")
    if source[0].kind is not Kind.PIN or target[0].kind is not Kind.PIN:
        _record_shared_node(writer, flow, source[0], target[0])
        words = ["binding", quote_name(name)] if name else []
        return " ".join([*prefixes, *words, "bind", target[1], "=", source[1]])
    words = ["flow", quote_name(name)] if name else ["flow"]
    return " ".join([*prefixes, *words, "from", source[1], "to", target[1]])


def _record_shared_node(writer: Writer, flow: Element, source: Element, target: Element) -> None:
    """Record the loss if a binding replaces a flow of an object node with several flows.

    Each flow of such a node adds or removes objects; a binding does not. A flow connects features
    of two elements (SysML 2.0, 7.16), but an object node belongs to the activity itself.
    """
    for node, edge in ((source, Edge.FLOW_SOURCE), (target, Edge.FLOW_TARGET)):
        if node.kind is not Kind.PIN and len(writer.graph.sources(node, edge)) > 1:
            writer.record_approximation(flow, "an object flow of a node with several", "a binding")
            return


def _iter_targets_behind(writer: Writer, control_node: Element) -> Iterator[Element]:
    """Yield the object nodes that objects reach from a control node over control nodes only."""
    seen, stack = {control_node.id}, [control_node]
    while stack:
        node = stack.pop()
        for flow in reversed(writer.graph.sources(node, Edge.FLOW_SOURCE)):
            target = writer.graph.target(flow, Edge.FLOW_TARGET)
            if flow.kind is not Kind.OBJECT_FLOW or target is None or target.id in seen:
                continue
            seen.add(target.id)
            if target.kind is Kind.CONTROL:
                stack.append(target)
            else:
                yield target
