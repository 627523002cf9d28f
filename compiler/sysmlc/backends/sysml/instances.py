"""Instances and their slots: usages with bound values."""

from sysmlc.backends.sysml import annotations
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.declarations import type_name, visibility
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.values import value as value_text
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element, Kind


def instance(book: Book, entry: Entry) -> list[Line]:
    """An instance: a usage of its classifiers; one below a top instance redefines its part."""
    element = entry.element
    assert element is not None
    if element.role in ("unit", "quantity kind"):
        return [_unit(book, entry, element)]
    part = book.graph.target(element, Edge.REPRESENTS)
    if element.subkind == "part" and part is not None:
        return _part(book, entry, element, part)
    return [Line(_head(book, entry, element), _contents(book, entry, element))]


def _head(book: Book, entry: Entry, element: Element) -> str:
    keyword = entry.shape.keyword
    words = [*visibility(book, element), keyword, quoted(entry.name) if entry.name else ""]
    text = " ".join(word for word in words if word)
    types: list[str] = []
    subsets: list[str] = []
    for one in book.graph.targets(element, Edge.INSTANCE_OF):
        name = type_name(book, entry.parent, element, one)
        other = book.plan.entry(one)
        if name is not None:
            is_type = other is None or other.shape.is_definition
            (types if is_type else subsets).append(name)
    text += f" : {', '.join(types)}" if types else ""
    return text + (f" :> {', '.join(subsets)}" if subsets else "")


def _part(book: Book, entry: Entry, element: Element, part: Element) -> list[Line]:
    """Values for a part, below the parts that lead to it."""
    body = _contents(book, entry, element)
    ids = element.attrs.get("path", ())
    path = [book.graph.get(str(id)) for id in ids] if isinstance(ids, tuple) else []
    steps = [one for one in path if one is not None and one is not part]
    name = book.redefined(entry.parent, steps[0] if steps else part)
    if name is None:
        return book.drop(entry, "represents")
    names = [name, *(quoted(one.name) for one in (*steps, part)[1:])]
    for one in reversed(names[1:]):
        body = [Line(f"part :>> {one}", body)]
    return [Line(f"part {_mark(book, entry, element, steps[0] if steps else part)} {name}", body)]


def _mark(book: Book, entry: Entry, element: Element, part: Element) -> str:
    """A member cannot redefine another one of its own owner: it is one of its values."""
    other = book.plan.entry(part)
    if other is None or other.parent is None or other.parent is not entry.parent:
        return ":>>"
    book.approximated(element, "values of a part beside it", "a subset of the part")
    return ":>"


def _contents(book: Book, entry: Entry, element: Element) -> list[Line]:
    lines = annotations.of(book, entry)
    for one in book.graph.owned(element):
        if one.kind is Kind.SLOT:
            book.said.add(one.id)
            lines += _slot(book, entry, one)
    return lines + book.members(entry)


def _slot(book: Book, entry: Entry, slot: Element) -> list[Line]:
    """The value of one feature; a list when there are several."""
    feature = book.graph.target(slot, Edge.INSTANCE_OF)
    name = None if feature is None else book.redefined(entry, feature)
    inner = [line for one in book.graph.owned(slot) for line in _owned(book, one)]
    if name is None or feature is None:
        if not _is_library(book, slot):
            book.lost(slot, "instance-of")
        return inner
    value = _value(book, entry, slot, feature)
    keyword = "port " if feature.kind is Kind.PORT else ""
    given = tuple(
        f"{key.removeprefix('value.')}={one}"
        for key, one in slot.attrs.items()
        if key.startswith("value.")
    )
    body = [annotations.ours(book, entry, "AutomationML", {"values": given})] if given else []
    return [Line(f"{keyword}:>> {name}{value}", body), *inner]


def _owned(book: Book, element: Element) -> list[Line]:
    found = book.plan.entry(element)
    return [] if found is None else book.member(found)


def _is_library(book: Book, slot: Element) -> bool:
    feature = book.graph.target(slot, Edge.INSTANCE_OF)
    return feature is not None and bool(feature.attrs.get("library"))


def _value(book: Book, entry: Entry, slot: Element, feature: Element) -> str:
    names = book.names(entry, slot, Edge.REFERENCES)
    if "value" in slot.attrs:
        return f" = {value_text(book, entry, feature, slot)}"
    if not names:
        return ""
    return f" = {names[0] if len(names) == 1 else '(' + ', '.join(names) + ')'}"


def _unit(book: Book, entry: Entry, element: Element) -> Line:
    """A unit or quantity kind that the model defines itself."""
    symbol = element.attrs.get("symbol")
    names = {one.name for one in (entry.parent.members if entry.parent else book.plan.tops)}
    short = f"<{quoted(str(symbol))}> " if symbol and str(symbol) not in names else ""
    is_unit = element.role == "unit"
    type_ = "MeasurementReferences::SimpleUnit" if is_unit else "Quantities::QuantityDimension"
    for one in book.graph.owned(element):
        book.said.add(one.id)
    body = annotations.of(book, entry) + book.members(entry)
    return Line(
        f"attribute {short}{quoted(entry.name)} : {book.library(entry.parent, type_)}", body
    )
