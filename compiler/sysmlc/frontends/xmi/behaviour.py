"""Parts of behaviours that are no elements: guards, weights, events, and records of their owner."""

import re
from graphlib import CycleError, TopologicalSorter

from sysmlc.diagnostics import Subject, Verdict
from sysmlc.frontends.xmi import metaclasses, rules, uml_features
from sysmlc.frontends.xmi.context import Context, RowHandler, check_references_inside
from sysmlc.frontends.xmi.document import Document, WrittenReference
from sysmlc.frontends.xmi.folded_elements import report_losses
from sysmlc.frontends.xmi.unit import Target
from sysmlc.frontends.xmi.value_features import (
    lower_single_value,
    lower_value,
    store_alternatives,
)
from sysmlc.frontends.xmi.values import Value, read_opaque, read_value
from sysmlc.frontends.xmi.vocabulary import TRUE
from sysmlc.ir import AttrValue, Edge, Element, list_items
from sysmlc.support.units import read_time

_RECORD_COLUMNS = {
    "clauses": ("test", "body"),
    "clause_outputs": ("decider", "bodyOutput"),
    "handlers": ("handlerBody", "exceptionInput", "exceptionType"),
    "link_ends": ("end", "value"),
}
"""Attributes that hold a tuple of ids for each row, and the features of the row's ids."""
_RECORD_FEATURES = frozenset(name for names in _RECORD_COLUMNS.values() for name in names)

_EVENT_VALUES = {"when": "when", "changeExpression": "condition"}
"""Attributes of triggers, by the feature of the event that holds the value."""

_ANY_EVENT = re.compile(
    r"(any|all|any ?receive( ?event)?)[ _]?\d*|\*|else|otherwise", re.IGNORECASE
)
"""Names of events that mean any message, and those that tools generate."""

_GUARD_ATTRIBUTES = {
    "body": "guard",
    "language": "guard_language",
    "bodies": "guard_bodies",
    "languages": "guard_languages",
}
"""Attributes of a transition, by the attribute of the constraint that is its guard."""


# -- handlers of rows ------------------------------------------------------------------------------


def _lower_guard(context: Context, row: int) -> None:
    owner = context.find_owner(row)
    value = lower_value(context, row)
    if owner is None:
        return
    owner.attrs["guard"] = value.text
    if value.language:
        owner.attrs["guard_language"] = value.language
    store_alternatives(owner, value, "guard")
    if value.is_literal or value.instance:
        owner.attrs["guard_literal"] = True


def _lower_weight(context: Context, row: int) -> None:
    owner = context.find_owner(row)
    value = lower_single_value(context, row).value
    if owner is not None and value not in (1, 0):
        owner.attrs["weight"] = value


def _make_record_handler(key: str) -> RowHandler:
    """Return a handler of rows that become records: tuples of ids in an attribute of the owner."""

    def lower(context: Context, row: int) -> None:
        owner = context.find_owner(row)
        context.mark_subtree(row, Verdict.MAPPED)
        check_references_inside(context, row, _RECORD_FEATURES)
        report_losses(context, row, uml_features.NAMING | _RECORD_FEATURES)
        if owner is not None:
            context.record_rows.setdefault(key, []).append((owner, row))

    return lower


def _defer_event(context: Context, row: int) -> None:
    # The triggers that refer to an event read it when all documents are lowered.
    context.mark_subtree(row, Verdict.MAPPED)
    context.event_rows.append(row)


FEATURES: dict[str, RowHandler] = {
    "guard": _lower_guard,
    "weight": _lower_weight,
    "clause": _make_record_handler("clauses"),
    "handler": _make_record_handler("handlers"),
    "endData": _make_record_handler("link_ends"),
}

TYPES: dict[str, RowHandler] = dict.fromkeys(metaclasses.EVENT_TYPES, _defer_event)


# -- completion when all documents are lowered -----------------------------------------------------


def complete_behaviour(context: Context) -> None:
    """Lower the parts of behaviours that refer to later rows or to other files."""
    for key, rows in context.record_rows.items():
        for element, row in _sort_clauses(context, rows) if key == "clauses" else rows:
            _add_record(context, key, element, row)
            if key == "clauses":
                _add_record(context, "clause_outputs", element, row)
    for element, row in context.triggers:
        _complete_trigger(context, element, row)
    for complete, element, row in context.completions:
        complete(context, element, row)
    _check_unused_events(context)
    for element, guard, _ in context.guards:
        _complete_guard(context, element, guard)
    _set_parameter_directions(context)
    for element, row in context.opaque_elements.values():
        _set_body(element, read_opaque(context.document, row))


def _set_body(element: Element, value: Value) -> None:
    for key, text in (("body", value.value), ("language", value.language)):
        element.attrs.pop(key, None)
        if text:
            element.attrs[key] = text
    store_alternatives(element, value)


def _find_first_target(context: Context, row: int, feature: str) -> Target | None:
    for reference in context.document.references(row, feature):
        return context.unit.find_target(context.file, reference.target, reference.is_href)
    return None


# -- records ---------------------------------------------------------------------------------------


def _sort_clauses(context: Context, rows: list[tuple[Element, int]]) -> list[tuple[Element, int]]:
    """Return clauses after their predecessors (UML 2.5.1, 16.11.3.3); the file order if cyclic."""
    document = context.document
    sorter: TopologicalSorter[int] = TopologicalSorter()
    for _, row in rows:
        sorter.add(row, *_find_rows(document, row, "predecessorClause"))
        for successor in _find_rows(document, row, "successorClause"):
            sorter.add(successor, row)
    owners = {row: owner for owner, row in rows}
    try:
        return [(owners[row], row) for row in sorter.static_order() if row in owners]
    except CycleError:
        return rows


def _find_rows(document: Document, row: int, feature: str) -> list[int]:
    rows = (document.ids.get(target) for target in document.targets(row, feature))
    return [target_row for target_row in rows if target_row is not None]


def _add_record(context: Context, key: str, element: Element, row: int) -> None:
    record: tuple[AttrValue, ...] = tuple(
        tuple(_find_ids(context, row, feature)) for feature in _RECORD_COLUMNS[key]
    )
    element.attrs[key] = (*list_items(element.attrs.get(key)), record)


def _find_ids(context: Context, row: int, feature: str) -> list[str]:
    ids = (
        context.unit.find_target_id(context.file, target, False)
        for target in context.document.targets(row, feature)
    )
    return [id for id in ids if id is not None]


# -- triggers and events ---------------------------------------------------------------------------


def _complete_trigger(context: Context, trigger: Element, row: int) -> None:
    """Give a trigger the content of its event, which many triggers can share."""
    event = _find_first_target(context, row, "event")
    if event is None:
        _refer_to_unknown_event(context, trigger, row)
        return
    subkind = metaclasses.EVENT_TYPES.get(event.type)
    if subkind is None:
        return
    trigger.attrs["subkind"] = subkind
    if not trigger.name:
        context.graph.rename(trigger, event.name)
    if subkind == "any" and trigger.name and not _ANY_EVENT.fullmatch(trigger.name.strip()):
        _read_name_as_event(context, trigger, row)
    context.used_events.add((event.document.name, event.row))
    document = event.document
    for feature in ("signal", "operation"):
        for reference in document.references(event.row, feature):
            context.add_reference(Edge.TYPED_BY, trigger.id, reference, feature, file=event.file)
    for feature, key in _EVENT_VALUES.items():
        for child in document.children(event.row, feature):
            value = read_value(document, child)
            if value.text.strip():
                trigger.attrs[key] = value.text
                store_alternatives(trigger, value, key)
    if subkind == "time" and document.attributes[event.row].get("isRelative") in TRUE:
        trigger.attrs["relative"] = True
    _read_text_in_name(trigger, event.name)


def _read_name_as_event(context: Context, trigger: Element, row: int) -> None:
    """Let a trigger wait for the event of its name, not for any message.

    StarUML gives triggers an any-receive event where the modeller chose no kind.
    """
    trigger.attrs["subkind"] = ""
    name = context.qualified_name(row)
    subject = Subject(name, trigger.id, context.locate(row))
    context.sink.report(rules.ANY_EVENT_WITH_NAME, subject, event=trigger.name)


def _read_text_in_name(trigger: Element, event_name: str) -> None:
    """Set the time or condition of an event that has it only in its name (``after 5 s``)."""
    for name in (event_name, trigger.name):
        word, _, text = name.strip().partition(" ")
        if trigger.subkind == "change" and word == "when" and text:
            trigger.attrs.setdefault("condition", text.strip())
        time = read_time(name)
        is_time = trigger.subkind == "time" and time.text != name.strip()
        if is_time and "when" not in trigger.attrs:
            trigger.attrs["when"] = time.text
            if time.is_relative:
                trigger.attrs["relative"] = True


def _refer_to_unknown_event(context: Context, trigger: Element, row: int) -> None:
    """Refer to an event in no file of the unit; the pass ``resolve`` reports it.

    The href may state its metaclass.
    """
    document = context.document
    for reference in document.references(row, "event"):
        subkind = metaclasses.EVENT_TYPES.get(document.types[reference.row])
        if subkind is not None and reference.is_href:
            trigger.attrs["subkind"] = subkind
        context.add_reference(Edge.REFERENCES, trigger.id, reference, "event")


def _check_unused_events(context: Context) -> None:
    """Note the references of events that no trigger of this document reads."""
    for row in context.event_rows:
        # UML before 2.4: messages read the signature of such an event, and report it.
        is_legacy = context.document.types[row].startswith(("Send", "Receive"))
        if not is_legacy and (context.document.name, row) not in context.used_events:
            check_references_inside(context, row, ("signal", "operation"))


# -- guards and parameters -------------------------------------------------------------------------


def _complete_guard(
    context: Context, transition: Element, guard: Element | WrittenReference
) -> None:
    """Give a transition the text of its guard; the text is empty if nothing can be read.

    A constraint without a value has the text in its name, as modellers write it in diagrams.
    """
    transition.attrs["guard"] = ""
    if isinstance(guard, WrittenReference):
        id = context.unit.find_target_id(context.file, guard.target, guard.is_href)
        constraint = context.graph.get(id)
        if constraint is None:
            context.add_reference(Edge.GUARD, transition.id, guard, "guard")
            return
        guard = constraint
    context.graph.connect(Edge.GUARD, transition, guard)
    transition.attrs["guard"] = guard.name
    if str(guard.attrs.get("body", "")).strip():
        for key, guard_key in _GUARD_ATTRIBUTES.items():
            value = guard.attrs.get(key)
            if value is not None:
                transition.attrs[guard_key] = value


def _set_parameter_directions(context: Context) -> None:
    """Set the directions of activity parameter nodes.

    A parameter with direction ``inout`` has two nodes; the one that flows lead to is ``out``.
    """
    flow_targets: frozenset[str] | None = None
    for node, row in context.parameter_nodes:
        parameter = _find_first_target(context, row, "parameter")
        if parameter is None:
            continue
        direction = parameter.document.get(parameter.row, "direction") or "in"
        if direction == "inout":
            if flow_targets is None:
                flow_targets = _find_flow_targets(context)
            direction = "out" if node.id in flow_targets else "in"
        node.attrs["direction"] = "out" if direction in ("out", "return") else "in"


def _find_flow_targets(context: Context) -> frozenset[str]:
    """Return the ids of the targets of all flows of the unit."""
    return frozenset(
        context.unit.find_target_id(reference.file, reference.target, reference.is_href) or ""
        for reference in context.unit.references
        if reference.edge is Edge.FLOW_TARGET
    )
