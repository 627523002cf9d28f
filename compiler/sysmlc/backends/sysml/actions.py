"""Actions and control nodes of an activity, each followed by the successions that leave it."""

from sysmlc.backends.sysml.activity_flows import write_initial_successions, write_successions
from sysmlc.backends.sysml.annotations import make_annotation
from sysmlc.backends.sysml.behaviours import chain_statements, format_statements
from sysmlc.backends.sysml.comments import write_opaque_bodies
from sysmlc.backends.sysml.conditions import format_trigger
from sysmlc.backends.sysml.declarations import list_visibility
from sysmlc.backends.sysml.definitions import write_contents
from sysmlc.backends.sysml.expressions import format_expression
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import Line, quote_name
from sysmlc.backends.sysml.references import format_chain, is_accessible, look_up
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import features, generals, is_referential, type_of

_EXPRESSED_SUBKINDS = frozenset(
    {"", "opaque", "call-behavior", "call-operation", "send", "accept", "value", "read"}
)
"""Subkinds that keywords of SysML v2 express; metadata states the others."""


def write_action(writer: Writer, member: Member) -> list[Line]:
    """Write an action of an activity, and the successions that leave it."""
    element = member.require_element()
    write = _BY_SUBKIND.get(element.subkind, _write_other)
    line = write(writer, member, element)
    return [line, *write_successions(writer, member)]


def write_control_node(writer: Writer, member: Member) -> list[Line]:
    """Write a decision, merge, fork or join; a final node that ends all flows terminates."""
    element = member.require_element()
    keyword = member.shape.keyword
    if keyword == "start":
        return write_initial_successions(writer, member, element)
    body = write_contents(writer, member)
    name = quote_name(member.name)
    if keyword == "action":
        return [Line(f"action {name} terminate", body)]
    return [Line(f"{keyword} {name}", body), *write_successions(writer, member)]


def write_control_flow(writer: Writer, member: Member) -> list[Line]:
    """Write nothing: the node that a control flow leaves writes it as a succession."""
    element = member.require_element()
    if writer.graph.target(element, Edge.FLOW_SOURCE) is None:
        return writer.drop(member, "flow-source")
    return []


def _format_head(writer: Writer, member: Member, element: Element) -> str:
    prefixes = [*list_visibility(writer, element), *(["ref"] if is_referential(element) else [])]
    return " ".join([*prefixes, "action", quote_name(member.name)])


def _write_body(writer: Writer, member: Member, element: Element) -> list[Line]:
    annotations = []
    if element.subkind not in _EXPRESSED_SUBKINDS or _has_no_target(writer, element):
        annotations.append(make_annotation(writer, member, "Kind", {"name": element.subkind}))
    if _is_repeated(writer, element):
        annotations.append(make_annotation(writer, member, "Repeated", {}))
        construct = "an accept action without incoming flows"
        writer.record_approximation(element, construct, "one that accepts once")
    return annotations + write_contents(writer, member)


def _has_no_target(writer: Writer, action: Element) -> bool:
    """Whether an action calls or accepts nothing, so that no word of its text states its kind."""
    if action.subkind in ("call-behavior", "call-operation"):
        return not writer.graph.targets(action, Edge.CALLS)
    return action.subkind == "accept" and not _list_triggers(writer, action)


def _is_repeated(writer: Writer, action: Element) -> bool:
    """Whether an accept action waits again after each event (UML 2.5.1, 16.10.3).

    An accept action of SysML v2 occurs once.
    """
    is_accept = action.subkind.startswith("accept") and _list_triggers(writer, action)
    flows = writer.graph.sources(action, Edge.FLOW_TARGET)
    has_start = any(flow.kind is Kind.CONTROL_FLOW for flow in flows) or is_referential(action)
    return bool(is_accept) and not has_start


# -- calls ---------------------------------------------------------------------------------------


def _write_call(writer: Writer, member: Member, element: Element) -> Line:
    """Write a call: an action typed by a definition, or the performance of another action."""
    body = _write_body(writer, member, element)
    target = writer.graph.target(element, Edge.CALLS)
    if target is None:
        return Line(_format_head(writer, member, element), body)
    called = writer.plan.find(target)
    name = _refer_to_called(writer, member, element, target)
    if name is None or called is None:
        return Line(_format_head(writer, member, element), body)
    if called.shape.is_definition:
        return Line(f"{_format_head(writer, member, element)} : {name}", body)
    prefixes = list_visibility(writer, element)
    words = " ".join([*prefixes, "perform", "action", quote_name(member.name)])
    return Line(f"{words} ::> {name}", body)


def _refer_to_called(
    writer: Writer, member: Member, action: Element, target: Element
) -> str | None:
    """Return the name of a called definition, or the feature chain to a called action."""
    called = writer.plan.find(target)
    if called is None:
        writer.record_unreachable(action, "calls")
        return None
    is_usage = not called.shape.is_definition
    if is_usage and look_up(writer.plan, member.parent, called.name) is not called:
        chain = _find_chain(writer, member, target)
        if chain is not None:
            return chain
    return writer.refer_to(member.parent, action, Edge.CALLS, target)


def _find_chain(writer: Writer, member: Member, operation: Element) -> str | None:
    """Return the chain through the only property of the context whose type has the operation."""
    owner = writer.graph.owner(operation)
    for namespace in member.namespaces:
        classifier = namespace.element
        if classifier is None or classifier.kind not in (Kind.CLASS, Kind.COMPONENT):
            continue
        properties = [
            feature
            for feature in features(writer.graph, classifier)
            if feature.kind is Kind.PROPERTY and _has_type(writer, feature, owner)
        ]
        if len(properties) == 1:
            return format_chain(writer.plan, member.parent, [properties[0], operation])
    return None


def _has_type(writer: Writer, feature: Element, owner: Element | None) -> bool:
    type_ = type_of(writer.graph, feature)
    return type_ is not None and (type_ is owner or owner in generals(writer.graph, type_))


# -- other actions -------------------------------------------------------------------------------


def _write_opaque(writer: Writer, member: Member, element: Element) -> Line:
    body = _write_body(writer, member, element)
    statements = format_statements(writer, member, element)
    head = _format_head(writer, member, element)
    if statements is None:
        return Line(head, body + write_opaque_bodies(writer, element))
    if len(statements) == 1 and not statements[0].startswith("perform"):
        return Line(f"{head} {statements[0]}", body)
    return Line(head, body + chain_statements(statements))


def _write_send(writer: Writer, member: Member, element: Element) -> Line:
    body = _write_body(writer, member, element)
    signal_name = None
    for signal in writer.graph.targets(element, Edge.CALLS):
        signal_name = writer.refer_to(member, element, Edge.CALLS, signal)
    port_name = writer.refer_to_port(member.parent, element)
    payload = f" send new {signal_name}()" if signal_name is not None else " send"
    via = f" via {port_name}" if port_name else ""
    return Line(f"{_format_head(writer, member, element)}{payload}{via}", body)


def _write_accept(writer: Writer, member: Member, element: Element) -> Line:
    triggers = _list_triggers(writer, element)
    writer.expressed.update(trigger.id for trigger in triggers)
    # Triggers may declare attributes in the body.
    accepts = [format_trigger(writer, member, trigger) for trigger in triggers]
    body = _write_body(writer, member, element)
    if len(accepts) > 1:
        construct = "an accept action with several triggers"
        writer.record_approximation(element, construct, "its first one")
    accept = f" {accepts[0]}" if accepts else ""
    return Line(f"{_format_head(writer, member, element)}{accept}", body)


def _list_triggers(writer: Writer, action: Element) -> list[Element]:
    """Return the triggers of an accept action, or those that it owns."""
    owned = [child for child in writer.graph.owned(action) if child.kind is Kind.TRIGGER]
    return writer.graph.targets(action, Edge.TRIGGER) or owned


def _write_other(writer: Writer, member: Member, element: Element) -> Line:
    """Write any other action: metadata states its kind, a reference the feature that it uses."""
    body = _write_body(writer, member, element)
    for target in writer.graph.targets(element, Edge.CALLS):
        target_member = writer.plan.find(target)
        name = writer.refer_to(member, element, Edge.CALLS, target)
        if name is None or target_member is None:
            continue
        if is_accessible(writer.plan, member, target_member):
            operator = ":" if target_member.shape.is_definition else ":>"
            body.append(Line(f"ref {operator} {name}"))
    head = _format_head(writer, member, element)
    return Line(head, body + write_opaque_bodies(writer, element))


_BY_SUBKIND = {
    "call-behavior": _write_call,
    "call-operation": _write_call,
    "opaque": _write_opaque,
    "": _write_opaque,
    "send": _write_send,
    "broadcast": _write_send,
    "accept": _write_accept,
    "accept-call": _write_accept,
}


# -- structured nodes ----------------------------------------------------------------------------


def write_structured_node(writer: Writer, member: Member) -> list[Line]:
    """Write a structured node: an action with its nodes inside, or a loop over a collection."""
    element = member.require_element()
    head = _format_head(writer, member, element)
    loop = _format_loop(writer, member, element)
    body = write_contents(writer, member)
    if loop:
        # The keyword ``for`` states the kind of the node.
        kind = f"@{writer.refer_to_sysmlc(member, 'Kind')}"
        head, body = f"{head} {loop}", [line for line in body if line.head != kind]
    return [Line(head, body), *write_successions(writer, member)]


def _format_loop(writer: Writer, member: Member, element: Element) -> str:
    """Return ``for p in belt.pallets`` for an iterative expansion region.

    Empty if the collection is not an expression over the model. The loop declares its variable, so
    that the variable has no line of its own.
    """
    is_loop = element.subkind == "expansion" and element.attrs.get("mode") == "iterative"
    collection = element.attrs.get("collection")
    variable = next((child for child in member.members if _is_variable(child)), None)
    if not is_loop or not isinstance(collection, str) or variable is None:
        return ""
    expression = format_expression(writer, member.parent, collection)
    if expression is None:
        return ""
    variable.is_declared = True
    writer.collection_loops.add(element.id)
    if variable.element is not None:
        writer.expressed.add(variable.element.id)
    return f"for {quote_name(variable.name)} in {expression}"


def _is_variable(member: Member) -> bool:
    return member.element is not None and member.element.subkind == "variable"
