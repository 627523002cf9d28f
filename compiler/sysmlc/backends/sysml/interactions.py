"""Interactions: lifelines as references to parts, messages between them, fragments around them."""

from sysmlc.backends.sysml.annotations import make_annotation
from sysmlc.backends.sysml.compatibility import is_lifeline_subset
from sysmlc.backends.sysml.conditions import format_condition
from sysmlc.backends.sysml.declarations import refer_to_type
from sysmlc.backends.sysml.definitions import write_contents
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import Line, quote_name, quote_string
from sysmlc.backends.sysml.references import format_element_reference
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import AttrValue, Edge, Element, Kind, list_items
from sysmlc.ir.query import type_of

_LIFELINE_KEYWORDS = {"part def": "part ", "item def": "part ", "port def": "port "}
"""Keyword of a lifeline by that of its type; messages connect occurrences only."""


def write_lifeline(writer: Writer, member: Member) -> list[Line]:
    """Write a lifeline: a reference to a part of the type that it represents.

    The lifeline subsets the represented feature if that is a feature of a namespace around it.
    """
    element = member.require_element()
    head = f"ref part {quote_name(member.name)}"
    body = []
    for represented in writer.graph.targets(element, Edge.REPRESENTS):
        type_ = type_of(writer.graph, represented)
        type_member = writer.plan.find(type_)
        keyword = ""
        if type_member is not None:
            keyword = _LIFELINE_KEYWORDS.get(type_member.shape.keyword, "")
        if type_ is not None:
            type_name = refer_to_type(writer, member.parent, element, type_)
            if type_name is not None:
                head = f"ref {keyword}{quote_name(member.name)} : {type_name}"
                if not keyword:
                    body = [make_annotation(writer, member, "Kind", {"name": "lifeline"})]
        if is_lifeline_subset(writer.plan, member, represented):
            name = writer.refer_to(member.parent, element, Edge.REPRESENTS, represented)
            head += "" if name is None else f" :> {name}"
        else:
            construct = "what a lifeline represents"
            writer.record_approximation(element, construct, "a part of the same type")
    return [Line(head, body + write_contents(writer, member))]


# -- messages ------------------------------------------------------------------------------------


def write_message(writer: Writer, member: Member) -> list[Line]:
    """Write a message: a transfer from one lifeline to another."""
    element = member.require_element()
    source, target = (
        format_element_reference(writer.plan, member.parent, writer.graph.target(element, edge))
        for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)
    )
    head = f"message {quote_name(member.name)}{_format_payload(writer, member, element)}"
    if source is not None and target is not None:
        head += f" from {source} to {target}"
    elif source is not None or target is not None:
        construct = "a message with one end"
        writer.record_approximation(element, construct, "a message without ends")
    _record_events(writer, element)
    body = _write_message_facts(writer, member, element) + write_contents(writer, member)
    return [Line(head, body)]


def _format_payload(writer: Writer, member: Member, element: Element) -> str:
    """Return the payload of a message: a signal, or the call of an operation."""
    called = writer.graph.target(element, Edge.CALLS)
    called_member = writer.plan.find(called)
    if called is None or called_member is None:
        return ""
    if called_member.shape.is_definition:
        return f" of {writer.refer_to(member.parent, element, Edge.CALLS, called)}"
    return f" of {writer.refer_to_sysmlc(member.parent, 'Call')}"


def _record_events(writer: Writer, message: Element) -> None:
    """Mark the events of a message as expressed by its ends."""
    for edge in (Edge.SEND_EVENT, Edge.RECEIVE_EVENT):
        for event in writer.graph.targets(message, edge):
            writer.expressed.add(event.id)
            writer.record_approximation(event, "an event of a message", "its end")
            writer.record_approximation(message, "the events of a message", "its ends")


def _write_message_facts(writer: Writer, member: Member, element: Element) -> list[Line]:
    """Return the sort of a message and the operation that it calls as metadata, and arguments."""
    arguments = list_items(element.attrs.get("arguments"))
    lines = [
        Line(f"attribute argument{number} = {quote_string(str(argument))}")
        for number, argument in enumerate(arguments, 1)
    ]
    called = writer.graph.target(element, Edge.CALLS)
    called_member = writer.plan.find(called)
    is_operation = called_member is not None and not called_member.shape.is_definition
    operation_name = None
    if called is not None and is_operation:
        operation_name = writer.graph.qualified_name(called)
    facts: dict[str, AttrValue] = {
        "name": element.subkind or element.attrs.get("message_kind"),
        "calls": operation_name,
    }
    if any(facts.values()):
        return [make_annotation(writer, member, "Kind", facts), *lines]
    return lines


# -- fragments -----------------------------------------------------------------------------------


def write_fragment(writer: Writer, member: Member) -> list[Line]:
    """Write a combined fragment or one of its operands: an occurrence with its kind as metadata."""
    element = member.require_element()
    kind = element.subkind or str(element.kind).lower()
    body = [make_annotation(writer, member, "Kind", {"name": kind})]
    guard = element.attrs.get("guard")
    if guard is not None and str(guard) != "else":
        construct = "the guard of an operand"
        writer.record_approximation(element, construct, "a constraint in it")
        condition = format_condition(writer, member, element, str(guard))
        body.append(Line("assert constraint", [Line("", text=[condition])], is_short=True))
    for called in writer.graph.targets(element, Edge.CALLS):
        called_member = writer.plan.find(called)
        name = writer.refer_to(member, element, Edge.CALLS, called)
        if name is not None and called_member is not None:
            operator = ":" if called_member.shape.is_definition else ":>"
            body.append(Line(f"ref {operator} {name}"))
    if element.kind is Kind.FRAGMENT:
        construct = "a fragment of an interaction"
        writer.record_approximation(element, construct, "an occurrence of its kind")
    return [Line(f"occurrence {quote_name(member.name)}", body + write_contents(writer, member))]
