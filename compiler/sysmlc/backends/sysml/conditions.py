"""Conditions, times and triggers.

A text that is not an expression over the model becomes the name of a feature, which the nearest
namespace declares.
"""

from sysmlc.backends.sysml.annotations import make_annotation
from sysmlc.backends.sysml.expressions import format_expression, is_condition
from sysmlc.backends.sysml.library import IMPORTED, ROOTS, name_unit
from sysmlc.backends.sysml.plan import Member
from sysmlc.backends.sysml.printing import Line, quote_name
from sysmlc.backends.sysml.references import look_up
from sysmlc.backends.sysml.rules import TEXT_AS_NAME, WAITS_FOR_CHANGE
from sysmlc.backends.sysml.shapes import Shape
from sysmlc.backends.sysml.writer import Writer
from sysmlc.ir import Edge, Element, query

_WITHOUT_DECLARATIONS = frozenset({"transition", "succession", "flow", "constraint"})
"""Keywords of namespaces that declare no features; the namespace around them does."""
_ACCEPTING = frozenset({"accept", "accept-call"})
"""Actions whose features some tools do not find from their triggers."""


# -- conditions and times ------------------------------------------------------------------------


def format_condition(writer: Writer, scope: Member | None, element: Element, text: str) -> str:
    """Return a condition as an expression, else as the name of a Boolean attribute.

    A number, a text, or a feature whose type is not Boolean is no condition.
    """
    if is_condition(writer, scope, text):
        expression = format_expression(writer, scope, text)
        if expression is not None:
            return expression
    return declare_condition(writer, scope, element, text)


def _format_time(writer: Writer, scope: Member, trigger: Element) -> str:
    """Return a time as a quantity or an expression, else as the name of an attribute."""
    time = query.time_of(trigger)
    word, type_ = (
        ("after", "ISQ::DurationValue") if time.is_relative else ("at", "Time::TimeInstantValue")
    )
    unit = None if time.duration is None else name_unit(time.duration.unit.symbol)
    if time.duration is not None and unit is not None:
        return f"{word} {time.duration.digits} [{writer.refer_to_library(scope, unit)}]"
    expression = format_expression(writer, scope, time.text)
    return f"{word} {expression or _declare(writer, scope, trigger, time.text, type_)}"


def declare_condition(writer: Writer, scope: Member | None, element: Element, text: str) -> str:
    """Return the name of a Boolean attribute for a condition that is no Boolean expression."""
    return _declare(writer, scope, element, text, "ScalarValues::Boolean")


def _declare(writer: Writer, scope: Member | None, element: Element, text: str, type_: str) -> str:
    """Return the name of an attribute with this type for a text."""
    name = " ".join(text.split()) or "undefined"
    writer.losses.record(TEXT_AS_NAME, element, text=name)
    namespace = scope
    while namespace is not None and namespace.parent is not None:
        is_trigger = namespace.element is not None and namespace.element.subkind in _ACCEPTING
        if not is_trigger and namespace.shape.keyword not in _WITHOUT_DECLARATIONS:
            break
        namespace = namespace.parent
    if namespace is None:
        return quote_name(name)
    key = (namespace, text, type_)
    if key not in writer.condition_names:
        if scope is not None and name in scope.shape.library_names:
            # The feature that the scope inherits would hide the attribute.
            name = f"{name}_2"
        writer.condition_names[key] = _declare_attribute(writer, namespace, name, text, type_)
    return writer.condition_names[key]


def _declare_attribute(writer: Writer, namespace: Member, name: str, text: str, type_: str) -> str:
    """Declare an attribute for a text and return its name as written.

    Unless the name is the text and an identifier, a keyword tells readers that the attribute stands
    for a text; metadata states the text if the name is another one.
    """
    free_name, number = name, 2
    while free_name in ROOTS | IMPORTED or look_up(writer.plan, namespace, free_name) is not None:
        # The attribute must hide no name to which the text already refers.
        free_name, number = f"{name}_{number}", number + 1
    attribute = writer.plan.add(Shape("attribute"), namespace, free_name, None)
    attribute.is_declared = True
    namespace.visible_names = None
    words = f"attribute {quote_name(free_name)} : {writer.refer_to_library(namespace, type_)}"
    if free_name != text or not free_name.isidentifier():
        words = f"#{writer.refer_to_sysmlc(namespace, 'inWords')} {words}"
    facts = {"name": text}
    body = [make_annotation(writer, attribute, "Named", facts)] if free_name != text else []
    namespace.added_lines.append(Line(words, body))
    return quote_name(free_name)


# -- triggers ------------------------------------------------------------------------------------


def format_trigger(writer: Writer, scope: Member, trigger: Element) -> str:
    """Return ``accept`` with a payload, and with the port at which it arrives."""
    payload = _format_payload(writer, scope, trigger)
    name = writer.refer_to_port(scope, trigger)
    return f"accept {payload}{f' via {name}' if name else ''}"


def _format_payload(writer: Writer, scope: Member, trigger: Element) -> str:
    if trigger.subkind == "time":
        return _format_time(writer, scope, trigger)
    if trigger.subkind == "change":
        if query.waits_for_change(trigger):
            writer.losses.record(WAITS_FOR_CHANGE, trigger)
        text = str(trigger.attrs.get("condition", ""))
        return f"when {format_condition(writer, scope, trigger, text)}"
    return _format_message_payload(writer, scope, trigger)


def _format_message_payload(writer: Writer, scope: Member, trigger: Element) -> str:
    """Return the payload of a signal event, a call event, or an event of any message."""
    type_ = writer.graph.target(trigger, Edge.TYPED_BY)
    member = writer.plan.find(type_)
    if trigger.subkind == "call" and (type_ is None or member is None):
        return (
            f"{_declare_payload(writer, scope, 'call')} : {writer.refer_to_sysmlc(scope, 'Call')}"
        )
    if type_ is None or member is None:
        if trigger.subkind != "any":
            writer.record_approximation(trigger, "a trigger without an event", "any event")
        payload = _declare_payload(writer, scope, "any")
        return f"{payload} : {writer.refer_to_library(scope, 'Base::Anything')}"
    if member.shape.is_definition:
        name = writer.refer_to(scope, trigger, Edge.TYPED_BY, type_)
        if trigger.attrs.get("payload"):
            payload = _declare_payload(writer, scope, str(trigger.attrs["payload"]))
            return f"{payload} : {name}"
        # The OpenMBEE toolkit does not read a payload that starts with the root ('$::').
        return f": {name}" if str(name).startswith("$") else str(name)
    return (
        f"{_declare_payload(writer, scope, member.name)} : {writer.refer_to_sysmlc(scope, 'Call')}"
    )


def _declare_payload(writer: Writer, scope: Member, name: str) -> str:
    """Return the name of a payload as written; it hides other members of this name in *scope*."""
    payload = writer.plan.add(Shape("ref"), scope, name, None)
    payload.is_declared = True
    scope.visible_names = None
    return quote_name(name)
