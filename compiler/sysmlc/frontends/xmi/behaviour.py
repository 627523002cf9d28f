"""Parts of behaviours that are no elements: guards, weights, events, and records of their owner."""

from functools import partial
from graphlib import CycleError, TopologicalSorter

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import metaclasses, uml_features
from sysmlc.frontends.xmi.dangling import check_references_inside
from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.folded_elements import is_reference, report_losses
from sysmlc.frontends.xmi.unit import File, RowHandler, Stage
from sysmlc.frontends.xmi.value_features import lower_single_value, lower_value
from sysmlc.frontends.xmi.values import store_alternatives
from sysmlc.ir import AttrValue, Element, list_items

_RECORD_COLUMNS = {
    "clauses": ("test", "body"),
    "clause_outputs": ("decider", "bodyOutput"),
    "handlers": ("handlerBody", "exceptionInput", "exceptionType"),
    "link_ends": ("end", "value"),
}
"""Attributes that hold a tuple of ids for each row, and the features of the row's ids."""
_RECORD_FEATURES = frozenset(name for names in _RECORD_COLUMNS.values() for name in names)

# -- handlers of rows ------------------------------------------------------------------------------


def _lower_guard(file: File, row: int) -> None:
    owner = file.find_owner(row)
    value = lower_value(file, row)
    if owner is None:
        return
    owner.attrs["guard"] = value.text
    if value.language:
        owner.attrs["guard_language"] = value.language
    store_alternatives(owner, value, "guard")
    if value.is_literal or value.instance:
        owner.attrs["guard_literal"] = True


def _lower_weight(file: File, row: int) -> None:
    owner = file.find_owner(row)
    value = lower_single_value(file, row).value
    if owner is not None and value not in (1, 0):
        owner.attrs["weight"] = value


def _make_record_handler(key: str) -> RowHandler:
    """Return a handler of rows that become records: tuples of ids in an attribute of the owner."""

    def lower(file: File, row: int) -> None:
        owner = file.find_owner(row)
        _check_record(file, row)
        if owner is not None:
            file.defer(Stage.BEHAVIOURS, partial(_add_record, file, key, owner, row))

    return lower


def _lower_clause(file: File, row: int) -> None:
    owner = file.find_owner(row)
    _check_record(file, row)
    if owner is not None and "clauses" not in owner.attrs:
        # The first clause of its owner: all of them are read together, to sort them.
        owner.attrs["clauses"] = ()
        clauses = file.document.children(file.document.parents[row], "clause")
        rows = [clause for clause in clauses if not is_reference(file, clause)]
        file.defer(Stage.BEHAVIOURS, partial(_add_clauses, file, owner, rows))


def _check_record(file: File, row: int) -> None:
    file.mark_subtree(row, Verdict.MAPPED)
    check_references_inside(file, row, _RECORD_FEATURES)
    report_losses(file, row, uml_features.NAMING | _RECORD_FEATURES)


def _defer_event(file: File, row: int) -> None:
    # The triggers that refer to an event read it when all documents are lowered.
    file.mark_subtree(row, Verdict.MAPPED)
    file.defer(Stage.BEHAVIOURS, partial(_check_unused_event, file, row))


FEATURES: dict[str, RowHandler] = {
    "guard": _lower_guard,
    "weight": _lower_weight,
    "clause": _lower_clause,
    "handler": _make_record_handler("handlers"),
    "endData": _make_record_handler("link_ends"),
}

TYPES: dict[str, RowHandler] = dict.fromkeys(metaclasses.EVENT_TYPES, _defer_event)


# -- records ---------------------------------------------------------------------------------------


def _add_clauses(file: File, owner: Element, rows: list[int]) -> None:
    for row in _sort_clauses(file.document, rows):
        _add_record(file, "clauses", owner, row)
        _add_record(file, "clause_outputs", owner, row)


def _sort_clauses(document: Document, rows: list[int]) -> list[int]:
    """Return clauses after their predecessors (UML 2.5.1, 16.11.3.3); the file order if cyclic."""
    sorter: TopologicalSorter[int] = TopologicalSorter()
    for row in rows:
        sorter.add(row, *_find_rows(document, row, "predecessorClause"))
        for successor in _find_rows(document, row, "successorClause"):
            sorter.add(successor, row)
    members = set(rows)
    try:
        return [row for row in sorter.static_order() if row in members]
    except CycleError:
        return rows


def _find_rows(document: Document, row: int, feature: str) -> list[int]:
    rows = (document.ids.get(target) for target in document.targets(row, feature))
    return [target_row for target_row in rows if target_row is not None]


def _add_record(file: File, key: str, element: Element, row: int) -> None:
    record: tuple[AttrValue, ...] = tuple(
        tuple(_find_ids(file, row, feature)) for feature in _RECORD_COLUMNS[key]
    )
    element.attrs[key] = (*list_items(element.attrs.get(key)), record)


def _find_ids(file: File, row: int, feature: str) -> list[str]:
    ids = (
        file.unit.find_target_id(file, target, False)
        for target in file.document.targets(row, feature)
    )
    return [id for id in ids if id is not None]


def _check_unused_event(file: File, row: int) -> None:
    """Note the references of an event that no trigger of this document reads."""
    # UML before 2.4: messages read the signature of such an event, and report it.
    is_legacy = file.document.types[row].startswith(("Send", "Receive"))
    if not is_legacy and file.document.id(row) not in file.triggers_by_event:
        check_references_inside(file, row, ("signal", "operation"))
