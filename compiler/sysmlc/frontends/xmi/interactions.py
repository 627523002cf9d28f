"""Interactions: fragments in their order, ends of messages, times (UML 2.5.1 clauses 17, 8.4)."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi.context import Context, RowHandler
from sysmlc.frontends.xmi.elements import make_handler
from sysmlc.frontends.xmi.unit import LoweredDocument, Target
from sysmlc.frontends.xmi.value_features import lower_value
from sysmlc.ir import Edge, Element, Kind

_MESSAGE_ENDS = (("sendEvent", Edge.FLOW_SOURCE), ("receiveEvent", Edge.FLOW_TARGET))
"""Features that refer to the ends of a message, and the edge to the lifeline that each covers."""
_KIND_BY_ENDS = {
    (True, True): "",
    (True, False): "lost",
    (False, True): "found",
    (False, False): "unknown",
}
"""The derived ``messageKind``, by the presence of a send and of a receive event (17.4.4)."""


# -- handlers of rows ------------------------------------------------------------------------------


def _complete_fragment(context: Context, fragment: Element, row: int) -> None:
    operator = context.document.get(row, "interactionOperator") or "seq"
    fragment.attrs["subkind"] = metaclasses.to_kebab_case(operator)
    context.add_references(Edge.REFERENCES, fragment.id, row, "message")


def _complete_message(context: Context, message: Element, row: int) -> None:
    document = context.document
    sort = document.get(row, "messageSort") or "synchCall"
    message.attrs["subkind"] = metaclasses.to_kebab_case(sort)
    is_sent, is_received = (bool(document.references(row, end)) for end, _ in _MESSAGE_ENDS)
    kind = _KIND_BY_ENDS[is_sent, is_received]
    if kind:
        message.attrs["message_kind"] = kind
    context.completions.append((_connect_lifelines, message, row))


def _complete_observation(context: Context, observation: Element, row: int) -> None:
    context.add_references(Edge.REFERENCES, observation.id, row, "event")
    _store_first_event(context, observation, row)


def _store_first_event(context: Context, element: Element, row: int) -> None:
    """Store ``firstEvent``: whether an observed event counts at its beginning (default) or end."""
    document = context.document
    flags = document.attributes[row].get("firstEvent", "").split()
    flags += [document.texts.get(child, "") for child in document.children(row, "firstEvent")]
    if "false" in flags:
        values = tuple(flag == "true" for flag in flags)
        element.attrs["first_event"] = values if len(values) > 1 else values[0]


def _complete_time_constraint(context: Context, constraint: Element, row: int) -> None:
    """Store the observations that the bounds refer to; the bounds themselves are text."""
    document = context.document
    observations = [
        target
        for inner in range(row + 1, document.ends[row])
        for target in document.targets(inner, "observation")
    ]
    context.defer_ids(constraint, "observations", observations)
    _store_first_event(context, constraint, row)


def _complete_occurrence(context: Context, occurrence: Element, row: int) -> None:
    if context.document.attributes[row].get("event"):
        context.completions.append((_mark_destruction, occurrence, row))


def _make_loop_bound_handler(key: str) -> RowHandler:
    """Return a handler of the bounds of a loop, which the guard of its operand contains."""

    def lower(context: Context, row: int) -> None:
        guard = context.find_owner(row)
        value = lower_value(context, row).value
        operand = context.graph.owner(guard) if guard is not None else None
        if operand is not None and operand.kind is Kind.OPERAND:
            operand.attrs[key] = value
        elif guard is not None:
            guard.attrs[key] = value

    return lower


def _make_text_handler(key: str) -> RowHandler:
    """Return a handler that stores a value as text."""

    def lower(context: Context, row: int) -> None:
        owner = context.find_owner(row)
        text = lower_value(context, row).text
        if owner is not None:
            owner.attrs[key] = text

    return lower


def _omit_event(context: Context, row: int) -> None:
    # Messages and executions state what these events of UML before 2.4 state.
    context.mark_subtree(row, Verdict.MAPPED)


FEATURES: dict[str, RowHandler] = {
    "minint": _make_loop_bound_handler("min"),
    "maxint": _make_loop_bound_handler("max"),
    "selector": _make_text_handler("selector"),
    "returnValue": _make_text_handler("return_value"),
}

_COMPLETIONS = {
    "CombinedFragment": _complete_fragment,
    "ConsiderIgnoreFragment": _complete_fragment,
    "Message": _complete_message,
    "OccurrenceSpecification": _complete_occurrence,
    "MessageOccurrenceSpecification": _complete_occurrence,
    "TimeObservation": _complete_observation,
    "DurationObservation": _complete_observation,
    "TimeConstraint": _complete_time_constraint,
    "DurationConstraint": _complete_time_constraint,
}

TYPES: dict[str, RowHandler] = {
    **{name: make_handler(name, complete) for name, complete in _COMPLETIONS.items()},
    **dict.fromkeys(("ExecutionEvent", "DestructionEvent", "CreationEvent"), _omit_event),
}


# -- completion when all documents are lowered -----------------------------------------------------


def _connect_lifelines(context: Context, message: Element, row: int) -> None:
    """Add edges from a message to the lifelines that its send and receive occurrence cover."""
    has_signature = bool(context.document.references(row, "signature"))
    for feature, edge in _MESSAGE_ENDS:
        for reference in context.document.references(row, feature):
            end = context.unit.find_target(context.file, reference.target, reference.is_href)
            if end is not None:
                _connect_end(context, message, edge, end)
                has_signature = has_signature or _add_legacy_signature(context, message, end)


def _connect_end(context: Context, message: Element, edge: Edge, end: Target) -> None:
    for reference in end.document.references(end.row, "covered"):
        context.add_reference(edge, message.id, reference, "covered", file=end.file)
    occurrence = context.graph.get(end.element_id)
    if occurrence is not None and occurrence.kind is Kind.OCCURRENCE and not occurrence.subkind:
        # Enterprise Architect writes the general metaclass OccurrenceSpecification.
        occurrence.attrs["subkind"] = "message"


def _add_legacy_signature(context: Context, message: Element, end: Target) -> bool:
    """Refer to the signature, which UML before 2.4 writes at the event of the occurrence.

    Return whether the event has a signature.
    """
    event = _find_event(context, end.file, end.row)
    if event is None:
        return False
    document, row = event.document, event.row
    signatures = [*document.references(row, "operation"), *document.references(row, "signal")]
    for signature in signatures[:1]:
        context.add_reference(Edge.CALLS, message.id, signature, "signature", file=event.file)
    return bool(signatures)


def _mark_destruction(context: Context, occurrence: Element, row: int) -> None:
    """Set the subkind of an occurrence with a destruction event (UML before 2.4)."""
    event = _find_event(context, context.file, row)
    if event is not None and event.type == "DestructionEvent":
        occurrence.attrs["subkind"] = "destruction"


def _find_event(context: Context, file: LoweredDocument, row: int) -> Target | None:
    for reference in file.document.references(row, "event"):
        return context.unit.find_target(file, reference.target, reference.is_href)
    return None
