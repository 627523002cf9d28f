"""Rows of behaviours that are no elements of their own, and what ties behaviours together."""

from collections.abc import Callable

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import feature_names as naming
from sysmlc.frontends.xmi import metaclasses
from sysmlc.frontends.xmi.context import Context, Event
from sysmlc.frontends.xmi.dangling import look_inside
from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.structure import tell_lost
from sysmlc.frontends.xmi.unit import Lowered, Unit
from sysmlc.frontends.xmi.value_features import keep_alternatives, lone_value_in, value_in
from sysmlc.frontends.xmi.values import ValueText, opaque, text_of, value_of
from sysmlc.ir import AttrValue, Edge, Element

_Reader = Callable[[Context, int], None]


# -- while walking -----------------------------------------------------------------------------


def _guard(context: Context, row: int) -> None:
    owner = context.owner(row)
    value = value_in(context, row)
    if owner is None:
        return
    owner.attrs["guard"] = text_of(value)
    if value.language:
        owner.attrs["guard_language"] = value.language
    keep_alternatives(owner, value, "guard")
    if value.is_literal or value.instance:
        owner.attrs["guard_literal"] = True


def _weight(context: Context, row: int) -> None:
    owner = context.owner(row)
    value = lone_value_in(context, row).value
    if owner is not None and value not in (1, 0):
        owner.attrs["weight"] = value


def _collected(name: str) -> _Reader:
    def read(context: Context, row: int) -> None:
        owner = context.owner(row)
        context.subtree(row, Verdict.MAPPED)
        look_inside(context, row, _RECORDED)
        tell_lost(context, row, naming.NAMING | _RECORDED)
        if owner is not None:
            context.rows_of.setdefault(name, []).append((owner, row))

    return read


def _part_of_others(context: Context, row: int) -> None:
    """Events are read by the triggers that name them."""
    context.subtree(row, Verdict.MAPPED)
    context.event_rows.append(row)


FEATURES: dict[str, _Reader] = {
    "guard": _guard,
    "weight": _weight,
    "clause": _collected("clauses"),
    "handler": _collected("handlers"),
    "endData": _collected("link_ends"),
}

TYPES: dict[str, _Reader] = {
    **dict.fromkeys(metaclasses.EVENT_TYPES, _part_of_others),
}

_COLUMNS = {
    "clauses": ("test", "body"),
    "clause_outputs": ("decider", "bodyOutput"),
    "handlers": ("handlerBody", "exceptionInput", "exceptionType"),
    "link_ends": ("end", "value"),
}


_RECORDED = frozenset(name for names in _COLUMNS.values() for name in names)


# -- when all documents are read ---------------------------------------------------------------


def finish(context: Context) -> None:
    """Tie together what refers forward or to other files."""
    for name, rows in context.rows_of.items():
        for element, row in _one_after_another(context, rows) if name == "clauses" else rows:
            _add_record(context, name, element, row)
            if name == "clauses":
                _add_record(context, "clause_outputs", element, row)
    for element, row in context.triggers:
        _trigger(context, element, row)
    for complete, element, row in context.deferred:
        complete(context, element, row)
    for row in context.event_rows:
        # Of UML before 2.4 messages know the signature, which is told there.
        is_old = context.document.types[row].startswith(("Send", "Receive"))
        if not is_old and (context.document.name, row) not in context.events:
            look_inside(context, row, ("signal", "operation"))
    for element, target, row in context.guards:
        _transition_guard(context, element, target, row)
    _parameter_directions(context)
    for element, row in context.opaque.values():
        _opaque(element, opaque(context.document, row))


def _one_after_another(
    context: Context, rows: list[tuple[Element, int]]
) -> list[tuple[Element, int]]:
    """Clauses in the order in which they are tried, that of the file where nothing is said.

    A clause is tried after its predecessors (UML 2.5.1, 16.11.3.3).
    """
    from graphlib import CycleError, TopologicalSorter

    document = context.document
    sorter: TopologicalSorter[int] = TopologicalSorter()
    for _, row in rows:
        sorter.add(row, *_rows(document, row, "predecessorClause"))
        for following in _rows(document, row, "successorClause"):
            sorter.add(following, row)
    owners = {row: owner for owner, row in rows}
    try:
        return [(owners[row], row) for row in sorter.static_order() if row in owners]
    except CycleError:
        return rows


def _rows(document: Document, row: int, feature: str) -> list[int]:
    found = (document.ids.get(target) for target in document.targets(row, feature))
    return [at for at in found if at is not None]


def _opaque(element: Element, value: ValueText) -> None:
    """An element with several bodies: that which can be read is the one that counts."""
    for key, text in (("body", value.value), ("language", value.language)):
        element.attrs.pop(key, None)
        if text:
            element.attrs[key] = text
    keep_alternatives(element, value)


def _add_record(context: Context, name: str, element: Element, row: int) -> None:
    record: tuple[AttrValue, ...] = tuple(
        tuple(_ids(context, row, feature)) for feature in _COLUMNS[name]
    )
    known = element.attrs.get(name, ())
    element.attrs[name] = (*known, record) if isinstance(known, tuple) else (record,)


def _ids(context: Context, row: int, feature: str) -> list[str]:
    found = (
        context.unit.target_id(context.lowered, target, False)
        for target in context.document.targets(row, feature)
    )
    return [id for id in found if id is not None]


def _trigger(context: Context, element: Element, row: int) -> None:
    event = _target(context.unit, context.lowered, row, "event")
    if event is None:
        _unknown_event(context, element, row)
        return
    holder, at = event
    subkind = metaclasses.EVENT_TYPES.get(holder.document.types[at])
    if subkind is None:
        return
    element.attrs["subkind"] = subkind
    if not element.name:
        context.graph.rename(element, holder.document.attributes[at].get("name", ""))
    known = context.events.get((holder.document.name, at))
    if known is None:
        known = context.events[holder.document.name, at] = _event(holder.document, at)
    _event_details(context, element, holder, known)


def _unknown_event(context: Context, element: Element, row: int) -> None:
    """The event is in no file of the unit: its metaclass may be known, and ``resolve`` asks."""
    document = context.document
    for target, at, is_href in references(document, row, "event"):
        subkind = metaclasses.EVENT_TYPES.get(document.types[at])
        if subkind is not None and is_href:
            element.attrs["subkind"] = subkind
        context.link(Edge.REFERENCES, element.id, target, at, "event", is_href)


def _event(document: Document, row: int) -> Event:
    """What an event says: many triggers can name one."""
    conditions = [
        (key, value_of(document, child))
        for feature, key in _CONDITIONS.items()
        for child in document.children(row, feature)
    ]
    is_timed = any(key == "when" for key, _ in conditions)
    is_relative = is_timed and document.attributes[row].get("isRelative") == "true"
    types = [
        (feature, *reference)
        for feature in ("signal", "operation")
        for reference in references(document, row, feature)
    ]
    return Event(types, conditions, is_relative)


def _event_details(context: Context, element: Element, holder: Lowered, event: Event) -> None:
    for feature, target, at, is_href in event.types:
        context.link_from(holder, Edge.TYPED_BY, element.id, target, at, feature, is_href)
    for key, value in event.conditions:
        _condition(element, key, value)
        if key == "when" and event.is_relative:
            element.attrs["relative"] = True


_CONDITIONS = {"when": "when", "changeExpression": "condition"}
"""Attributes of triggers, by the feature of the event that holds the value."""


def _condition(element: Element, key: str, value: ValueText) -> None:
    element.attrs[key] = text_of(value)
    keep_alternatives(element, value, key)


def references(document: Document, row: int, feature: str) -> list[tuple[str, int, bool]]:
    """Targets of a feature, each with the row that names it and whether it is an href."""
    written = document.attributes[row].get(feature)
    found = [(target, row, False) for target in document.tokens(written)] if written else []
    if feature not in document.referring:
        return found
    for child in document.children(row, feature):
        href = document.attributes[child].get("href", "")
        target = href or document.idref(child)
        if target:
            found.append((target, child, bool(href)))
    return found


def _target(unit: Unit, lowered: Lowered, row: int, feature: str) -> tuple[Lowered, int] | None:
    document = lowered.document
    if feature not in document.referring:
        at = document.ids.get(document.attributes[row].get(feature, ""))
        if at is not None:
            return lowered, at
    for target, _, is_href in references(document, row, feature):
        return unit.find(lowered, target, is_href)
    return None


def _transition_guard(context: Context, element: Element, target: str, row: int) -> None:
    at = context.document.ids.get(target)
    constraint = None if at is None else context.lowered.own[at]
    if constraint is None:
        id = context.unit.target_id(context.lowered, target, False)
        constraint = context.graph.get(id)
    if constraint is None:
        context.link(Edge.GUARD, element.id, target, row, "guard")
        return
    context.graph.connect(Edge.GUARD, element, constraint)
    for key, name in _GUARD.items():
        value = constraint.attrs.get(key)
        if value is not None:
            element.attrs[name] = value


_GUARD = {
    "body": "guard",
    "language": "guard_language",
    "bodies": "guard_bodies",
    "languages": "guard_languages",
}
"""What a transition says itself of the constraint that is its guard."""


def _parameter_directions(context: Context) -> None:
    """Direction of the nodes of parameters; ``inout`` has two nodes, told apart by their flows."""
    for element, row in context.parameters:
        found = _target(context.unit, context.lowered, row, "parameter")
        if found is None:
            continue
        holder, at = found
        written = holder.document.get(at, "direction") or "in"
        if written == "inout":
            written = "out" if element.id in _flow_targets(context) else "in"
        element.attrs["direction"] = "out" if written in ("out", "return") else "in"


def _flow_targets(context: Context) -> frozenset[str]:
    if context.flow_targets is None:
        context.flow_targets = frozenset(
            context.unit.target_id(link.lowered, link.target, link.is_href) or ""
            for link in context.unit.links
            if link.edge is Edge.FLOW_TARGET
        )
    return context.flow_targets
