"""Interactions: fragments in their order, ends of messages, times (UML 2.5.1 clauses 17, 8.4)."""

from functools import partial

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi.attributes import defer_ids
from sysmlc.frontends.xmi.elements import make_handler
from sysmlc.frontends.xmi.unit import File, RowHandler, Stage, Target
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


def _complete_fragment(file: File, fragment: Element, row: int) -> None:
    operator = file.document.get(row, "interactionOperator") or "seq"
    fragment.attrs["subkind"] = metaclasses.to_kebab_case(operator)
    file.add_references(Edge.REFERENCES, fragment.id, row, "message")


def _complete_message(file: File, message: Element, row: int) -> None:
    document = file.document
    sort = document.get(row, "messageSort") or "synchCall"
    message.attrs["subkind"] = metaclasses.to_kebab_case(sort)
    is_sent, is_received = (bool(document.references(row, end)) for end, _ in _MESSAGE_ENDS)
    kind = _KIND_BY_ENDS[is_sent, is_received]
    if kind:
        message.attrs["message_kind"] = kind
    file.defer(Stage.BEHAVIOURS, partial(_connect_lifelines, file, message, row))


def _complete_observation(file: File, observation: Element, row: int) -> None:
    file.add_references(Edge.REFERENCES, observation.id, row, "event")
    _store_first_event(file, observation, row)


def _store_first_event(file: File, element: Element, row: int) -> None:
    """Store ``firstEvent``: whether an observed event counts at its beginning (default) or end."""
    document = file.document
    flags = document.attributes[row].get("firstEvent", "").split()
    flags += [document.texts.get(child, "") for child in document.children(row, "firstEvent")]
    if "false" in flags:
        values = tuple(flag == "true" for flag in flags)
        element.attrs["first_event"] = values if len(values) > 1 else values[0]


def _complete_time_constraint(file: File, constraint: Element, row: int) -> None:
    """Store the observations that the bounds refer to; the bounds themselves are text."""
    document = file.document
    observations = [
        target
        for inner in range(row + 1, document.ends[row])
        for target in document.targets(inner, "observation")
    ]
    defer_ids(file, constraint, "observations", observations)
    _store_first_event(file, constraint, row)


def _complete_occurrence(file: File, occurrence: Element, row: int) -> None:
    if file.document.attributes[row].get("event"):
        file.defer(Stage.BEHAVIOURS, partial(_mark_destruction, file, occurrence, row))


def _make_loop_bound_handler(key: str) -> RowHandler:
    """Return a handler of the bounds of a loop, which the guard of its operand contains."""

    def lower(file: File, row: int) -> None:
        guard = file.find_owner(row)
        value = lower_value(file, row).value
        operand = file.unit.graph.owner(guard) if guard is not None else None
        if operand is not None and operand.kind is Kind.OPERAND:
            operand.attrs[key] = value
        elif guard is not None:
            guard.attrs[key] = value

    return lower


def _make_text_handler(key: str) -> RowHandler:
    """Return a handler that stores a value as text."""

    def lower(file: File, row: int) -> None:
        owner = file.find_owner(row)
        text = lower_value(file, row).text
        if owner is not None:
            owner.attrs[key] = text

    return lower


def _omit_event(file: File, row: int) -> None:
    # Messages and executions state what these events of UML before 2.4 state.
    file.mark_subtree(row, Verdict.MAPPED)


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


def _connect_lifelines(file: File, message: Element, row: int) -> None:
    """Add edges from a message to the lifelines that its send and receive occurrence cover."""
    has_signature = bool(file.document.references(row, "signature"))
    for feature, edge in _MESSAGE_ENDS:
        for reference in file.document.references(row, feature):
            end = file.find_target(reference)
            if end is not None:
                _connect_end(file, message, edge, end)
                has_signature = has_signature or _add_legacy_signature(message, end)


def _connect_end(file: File, message: Element, edge: Edge, end: Target) -> None:
    for reference in end.document.references(end.row, "covered"):
        end.file.add_reference(edge, message.id, reference, "covered")
    occurrence = file.unit.graph.get(end.element_id)
    if occurrence is not None and occurrence.kind is Kind.OCCURRENCE and not occurrence.subkind:
        # Enterprise Architect writes the general metaclass OccurrenceSpecification.
        occurrence.attrs["subkind"] = "message"


def _add_legacy_signature(message: Element, end: Target) -> bool:
    """Refer to the signature, which UML before 2.4 writes at the event of the occurrence.

    Return whether the event has a signature.
    """
    event = end.file.find_first_target(end.row, "event")
    if event is None:
        return False
    document, row = event.document, event.row
    signatures = [*document.references(row, "operation"), *document.references(row, "signal")]
    for signature in signatures[:1]:
        event.file.add_reference(Edge.CALLS, message.id, signature, "signature")
    return bool(signatures)


def _mark_destruction(file: File, occurrence: Element, row: int) -> None:
    """Set the subkind of an occurrence with a destruction event (UML before 2.4)."""
    event = file.find_first_target(row, "event")
    if event is not None and event.type == "DestructionEvent":
        occurrence.attrs["subkind"] = "destruction"
