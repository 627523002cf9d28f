"""What of the model the text does not say: elements, edges and attributes that nobody wrote."""

from collections.abc import Mapping

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.kept import unsaid
from sysmlc.backends.sysml.relating import unsaid_edges
from sysmlc.backends.sysml.rules import (
    NAME_LEFT_OUT,
    UNSAID_ATTRIBUTE,
    UNSAID_EDGE,
    UNSAID_KIND,
)
from sysmlc.ir import Edge, Element, Kind

_SAID_ELSEWHERE = frozenset(
    {
        Kind.APPLICATION,
        Kind.CONNECTOR_END,
        Kind.SLOT,
        Kind.CONTROL_FLOW,
        Kind.OBJECT_FLOW,
        Kind.TRIGGER,
        Kind.VIEW,
        Kind.UNIT,
        Kind.QUANTITY_KIND,
    }
)
"""Kinds that are said with another element, or made by passes; their losses are told there."""
_TRANSPARENT = frozenset({Kind.REGION, Kind.ACTIVITY_PARAMETER, Kind.FINAL_STATE})
_NO_NAMES = {
    Kind.REGION: "a region that is the only one",
    Kind.FINAL_STATE: "a final state",
    Kind.PSEUDOSTATE: "an initial pseudostate",
    Kind.CONTROL: "an initial or final node",
    Kind.TRIGGER: "a trigger",
    Kind.ACTIVITY_PARAMETER: "a parameter node",
    Kind.OBJECT_FLOW: "an object flow between control nodes",
    Kind.SLOT: "a slot",
    Kind.CONNECTOR_END: "an end of a connector",
}


def account(book: Book, dropped: Mapping[str, str]) -> None:
    """Note all that is not said: first elements, then edges and attributes of those that are.

    ``dropped`` says by id what elements refer to that has no name.
    """
    for element in book.graph:
        if element.attrs.get("external") or _is_below(book, element, dropped):
            continue
        if element.id in dropped:
            book.lost(element, dropped[element.id])
            continue
        if _is_unsaid(book, element):
            book.losses.note(UNSAID_KIND, element, kind=str(element.kind))
        else:
            _name(book, element)
            _attributes(book, element)
    _edges(book)


def _is_below(book: Book, element: Element, dropped: Mapping[str, str]) -> bool:
    return bool(dropped) and any(one.id in dropped for one in book.graph.ancestors(element))


def _is_unsaid(book: Book, element: Element) -> bool:
    if element.id in book.said or element.kind in (_SAID_ELSEWHERE | _TRANSPARENT):
        return False
    if element.kind is Kind.PARTITION:
        return not book.graph.sources(element, Edge.IN_PARTITION)
    if element.kind in (Kind.CONTROL, Kind.PSEUDOSTATE) and element.subkind in _WORDS:
        return False
    owners = (element, *book.graph.ancestors(element))
    return not any(one.attrs.get("external") for one in owners)


_WORDS = frozenset({"initial", "final", "flow-final"})


def _name(book: Book, element: Element) -> None:
    said = _NO_NAMES.get(element.kind)
    if said is None or not element.name or (element.id, "name") in book.kept:
        return
    entry = book.plan.entry(element)
    if entry is not None and entry.name:
        return
    feature = book.graph.target(element, Edge.INSTANCE_OF) or book.graph.target(
        element, Edge.REFERENCES
    )
    if feature is None or feature.name != element.name:
        book.losses.note(NAME_LEFT_OUT, element, said=said)


# -- attributes --------------------------------------------------------------------------------


def _attributes(book: Book, element: Element) -> None:
    for key in unsaid(book, book.plan.entry(element), element):
        is_kept = (element.id, key) in book.kept
        if not is_kept and element.attrs[key] != "":
            book.losses.note(UNSAID_ATTRIBUTE, element, attribute=key, kind=str(element.kind))


# -- edges -------------------------------------------------------------------------------------


def _edges(book: Book) -> None:
    for one in book.graph:
        if one.id not in book.said:
            continue
        for edge, target in unsaid_edges(book, one):
            if (edge, one.id, target.id) not in book.kept_edges:
                facts = {"edge": str(edge.value), "kind": str(one.kind), "target": str(target.kind)}
                book.losses.note(UNSAID_EDGE, one, **facts)
