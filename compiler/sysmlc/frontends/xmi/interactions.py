"""Interactions: fragments in their order, ends of messages, times (UML 2.5.1 clauses 17, 8.4)."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi.behaviour import references
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.elements import Reader, reading
from sysmlc.frontends.xmi.unit import Lowered
from sysmlc.frontends.xmi.value_features import value_in
from sysmlc.frontends.xmi.values import text_of
from sysmlc.ir import Edge, Element, Kind

_ENDS = (("sendEvent", Edge.FLOW_SOURCE), ("receiveEvent", Edge.FLOW_TARGET))
"""Features that name the ends of a message, and the edge to the lifeline that each covers."""
_KIND_BY_ENDS = {
    (True, True): "",
    (True, False): "lost",
    (False, True): "found",
    (False, False): "unknown",
}
"""The derived ``messageKind``, by whether a send and a receive event are there (17.4.4)."""


# -- while walking -----------------------------------------------------------------------------


def _combined(context: Context, element: Element, row: int) -> None:
    operator = context.document.get(row, "interactionOperator") or "seq"
    element.attrs["subkind"] = metaclasses.hyphenated(operator)
    for target, at, is_href in references(context.document, row, "message"):
        context.link(Edge.REFERENCES, element.id, target, at, "message", is_href)


def _message(context: Context, element: Element, row: int) -> None:
    sort = context.document.get(row, "messageSort") or "synchCall"
    element.attrs["subkind"] = metaclasses.hyphenated(sort)
    ends = [bool(references(context.document, row, feature)) for feature, _ in _ENDS]
    kind = _KIND_BY_ENDS[ends[0], ends[1]]
    if kind:
        element.attrs["message_kind"] = kind
    context.deferred.append((_message_ends, element, row))


def _events(context: Context, element: Element, row: int) -> None:
    """What is observed, and whether its beginning or its end counts."""
    for target, at, is_href in references(context.document, row, "event"):
        context.link(Edge.REFERENCES, element.id, target, at, "event", is_href)
    _first_event(context, element, row)


def _first_event(context: Context, element: Element, row: int) -> None:
    document = context.document
    written = document.attributes[row].get("firstEvent", "").split()
    written += [document.texts.get(child, "") for child in document.children(row, "firstEvent")]
    if "false" in written:
        values = tuple(value == "true" for value in written)
        element.attrs["first_event"] = values if len(values) > 1 else values[0]


def _time_constraint(context: Context, element: Element, row: int) -> None:
    """Besides the bounds, which are text, the observations that they are told by."""
    document = context.document
    inside = range(row + 1, document.ends[row])
    found = [target for at in inside for target in document.targets(at, "observation")]
    context.keep_ids(element, "observations", found)
    _first_event(context, element, row)


def _occurrence(context: Context, element: Element, row: int) -> None:
    if context.document.attributes[row].get("event"):
        context.deferred.append((_occurrence_event, element, row))


def _times(name: str) -> Reader:
    """A bound of a loop is said by the constraint of its operand, and means the operand."""

    def read(context: Context, row: int) -> None:
        constraint = context.owner(row)
        value = value_in(context, row).value
        operand = context.graph.owner(constraint) if constraint is not None else None
        if operand is not None and operand.kind is Kind.OPERAND:
            operand.attrs[name] = value
        elif constraint is not None:
            constraint.attrs[name] = value

    return read


def _value(key: str) -> Reader:
    def read(context: Context, row: int) -> None:
        owner = context.owner(row)
        text = text_of(value_in(context, row))
        if owner is not None:
            owner.attrs[key] = text

    return read


def _part_of_others(context: Context, row: int) -> None:
    """Events of occurrences say what the messages and executions say."""
    context.subtree(row, Verdict.MAPPED)


FEATURES: dict[str, Reader] = {
    "minint": _times("min"),
    "maxint": _times("max"),
    "selector": _value("selector"),
    "returnValue": _value("return_value"),
}

TYPES: dict[str, Reader] = {
    "CombinedFragment": reading("CombinedFragment", _combined),
    "ConsiderIgnoreFragment": reading("ConsiderIgnoreFragment", _combined),
    "Message": reading("Message", _message),
    "OccurrenceSpecification": reading("OccurrenceSpecification", _occurrence),
    "MessageOccurrenceSpecification": reading("MessageOccurrenceSpecification", _occurrence),
    "TimeObservation": reading("TimeObservation", _events),
    "DurationObservation": reading("DurationObservation", _events),
    "TimeConstraint": reading("TimeConstraint", _time_constraint),
    "DurationConstraint": reading("DurationConstraint", _time_constraint),
    **dict.fromkeys(("ExecutionEvent", "DestructionEvent", "CreationEvent"), _part_of_others),
}


# -- when all documents are read ---------------------------------------------------------------


def _message_ends(context: Context, element: Element, row: int) -> None:
    """The lifelines that the occurrences cover are the ends of the message."""
    is_signed = bool(references(context.document, row, "signature"))
    for feature, edge in _ENDS:
        for target, _, is_href in references(context.document, row, feature):
            found = context.unit.find(context.lowered, target, is_href)
            if found is not None:
                _message_end(context, element, edge, *found)
                is_signed = is_signed or _legacy_signature(context, element, *found)


def _message_end(context: Context, element: Element, edge: Edge, holder: Lowered, row: int) -> None:
    for target, at, is_href in references(holder.document, row, "covered"):
        context.link_from(holder, edge, element.id, target, at, "covered", is_href)
    end = context.graph.get(holder.gids[row])
    if end is not None and end.kind is Kind.OCCURRENCE and not end.subkind:
        end.attrs["subkind"] = "message"  # Enterprise Architect writes the general metaclass.


def _legacy_signature(context: Context, element: Element, holder: Lowered, row: int) -> bool:
    """UML before 2.4 says what is sent by the event of the occurrence; whether it does so."""
    event = _event(context, holder, row)
    if event is None:
        return False
    file, at = event
    sent = [*references(file.document, at, "operation"), *references(file.document, at, "signal")]
    for target, place, is_href in sent[:1]:
        context.link_from(file, Edge.CALLS, element.id, target, place, "signature", is_href)
    return bool(sent)


def _occurrence_event(context: Context, element: Element, row: int) -> None:
    """UML before 2.4 says by its event that an occurrence destroys the lifeline."""
    found = _event(context, context.lowered, row)
    if found is not None and found[0].document.types[found[1]] == "DestructionEvent":
        element.attrs["subkind"] = "destruction"


def _event(context: Context, holder: Lowered, row: int) -> tuple[Lowered, int] | None:
    for target, _, is_href in references(holder.document, row, "event"):
        return context.unit.find(holder, target, is_href)
    return None
