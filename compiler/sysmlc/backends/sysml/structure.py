"""Packages, definitions, features, enumerations and operations."""

from sysmlc.backends.sysml import annotations, declarations
from sysmlc.backends.sysml.actors import actor_of
from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.declarations import Head, definition_head, feature_head, typing
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.library import (
    quantity_of,
    quantity_of_kind,
    scalar_of,
    unit_name,
)
from sysmlc.backends.sysml.printing import Line
from sysmlc.backends.sysml.references import qualified, visible
from sysmlc.backends.sysml.relating import differs_in_parameters
from sysmlc.backends.sysml.texts import opaque_lines
from sysmlc.backends.sysml.values import value
from sysmlc.backends.sysml.words import quoted
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.query import STRUCTURAL_FEATURES, flow_directions, type_of
from sysmlc.ir.query.classifiers import quantity_kind_of, unit_of


def package(book: Book, entry: Entry) -> list[Line]:
    """A package, of the model or one that holds what is outside of it."""
    body = [] if entry.element is None else annotations.of(book, entry)
    words = [] if entry.element is None else declarations.visibility(book, entry.element)
    head = " ".join([*words, entry.shape.keyword, quoted(entry.name)])
    body += book.members(entry)
    heads = {line.head.partition(" ")[2] for line in body}
    known = (one for one in book.plan.imports.get(id(entry), ()))
    imports = sorted(one for one in known if f"import {one}::*" not in heads)
    return [Line(head, [*(Line(f"private import {one}::*") for one in imports), *body])]


def classifier(book: Book, entry: Entry) -> list[Line]:
    """A definition with all its members."""
    return [Line(definition_head(book, entry).text(), contents(book, entry))]


def contents(book: Book, entry: Entry) -> list[Line]:
    """Annotations, members, and what realisations add to a definition."""
    body = annotations.of(book, entry) + book.members(entry)
    element = entry.element
    if element is not None and element.kind in STRUCTURAL_FEATURES:
        types = book.graph.targets(element, Edge.TYPED_BY)
        book.said.update(one.id for one in types if book.plan.entry(one) is entry)
    if element is not None:
        body += _realisations(book, entry, element) + book.extra.pop(id(entry), [])
    return body


def _realisations(book: Book, entry: Entry, element: Element) -> list[Line]:
    """Realised classifiers that no dependency tells of."""
    told = {
        one.id
        for dependency in book.graph.sources(element, Edge.CLIENT)
        for one in book.graph.targets(dependency, Edge.SUPPLIER)
    }
    lines = []
    for target in book.graph.targets(element, Edge.REALIZES):
        other = None if target.id in told else book.plan.entry(target)
        name = None if other is None else qualified(book.plan, entry, other)
        if name is not None:
            mark = book.ours(entry, "realization")
            lines.append(Line(f"#{mark} dependency from {quoted(entry.name)} to {name}"))
    return lines


def value_type(book: Book, entry: Entry) -> list[Line]:
    """An attribute definition; one with a known quantity specialises it and fixes its unit."""
    element = entry.element
    assert element is not None
    quantity = quantity_of(book.graph, element)
    head = definition_head(book, entry, is_quantity=quantity is not None)
    body = contents(book, entry)
    if quantity is not None:
        _note_quantity(book, element, quantity)
        kept = _non_scalar(book, entry, element)
        generals = book.graph.targets(element, Edge.SPECIALIZES)
        if not any(_has_quantity(book, one) for one in generals):
            kept.append(book.library(entry.parent, f"ISQ::{quantity}"))
        head.subsets = kept
        unit = unit_name(unit_of(book.graph, element))
        if unit is not None:
            body.insert(0, Line(f"attribute :>> mRef = {book.library(entry, unit)}"))
    elif unit_of(book.graph, element) is not None:
        body.insert(0, _unit(book, entry, unit_of(book.graph, element)))
    return [Line(head.text(), body)]


def _note_quantity(book: Book, element: Element, quantity: str) -> None:
    """Note a quantity kind that is not that of the unit: ISQ gives a unit of one kind only."""
    kind = quantity_kind_of(book.graph, element)
    own = None if kind is None else quantity_of_kind(kind)
    if own is not None and own != quantity:
        book.approximated(element, "a quantity kind that has other units", "that of the unit")


def _non_scalar(book: Book, entry: Entry, element: Element) -> list[str]:
    """Generals that are no numbers: a quantity value has its number inside."""
    generals = book.graph.targets(element, Edge.SPECIALIZES)
    names = (
        book.name(entry.parent, element, Edge.SPECIALIZES, one)
        for one in generals
        if scalar_of(one) is None
    )
    return [one for one in names if one is not None]


def _has_quantity(book: Book, general: Element) -> bool:
    return quantity_of(book.graph, general) is not None


def _unit(book: Book, entry: Entry, unit: Element | None) -> Line:
    assert unit is not None
    facts = {"name": unit.name, "symbol": unit.attrs.get("symbol")}
    quantity = quantity_kind_of(book.graph, entry.element) if entry.element else None
    facts["quantity"] = None if quantity is None else quantity.name
    return annotations.ours(book, entry, "Unit", facts)


def enumeration(book: Book, entry: Entry) -> list[Line]:
    """An enumeration definition, which holds its values and annotations only."""
    head = definition_head(book, entry)
    if head.subsets and entry.element is not None:
        book.approximated(entry.element, "generalization of Enumeration", "comment")
        note = ["/* :> " + ", ".join(head.subsets) + " */"]
        head.subsets = []
        return [Line(head.text(), [Line("", text=note), *contents(book, entry)])]
    return [Line(head.text(), contents(book, entry))]


def enumerated(book: Book, entry: Entry) -> list[Line]:
    """One value of an enumeration."""
    return [Line(f"enum {quoted(entry.name)}", contents(book, entry))]


def feature(book: Book, entry: Entry) -> list[Line]:
    """A property, or what is written as one."""
    element = entry.element
    assert element is not None
    head = feature_head(book, entry)
    if "default" in element.attrs:
        text = value(book, entry.parent, element, element, "default")
        head.value = f" default = {text}" if text else ""
    body = contents(book, entry)
    if element.attrs.get("aggregation") == "shared":
        body.insert(0, Line(f"@{book.ours(entry, 'shared')}", is_short=True))
    return [Line(head.text(), body)]


def port(book: Book, entry: Entry) -> list[Line]:
    """A port; what no port definition types holds a feature of its type."""
    element = entry.element
    assert element is not None
    head = feature_head(book, entry)
    if flow_directions(book.graph, element):
        head.prefixes = [one for one in head.prefixes if one not in ("in", "out", "inout")]
    body = contents(book, entry)
    if entry.shape.keyword == "part":
        mark = "fullPort" if element.role == "full port" else "port"
        name = "fullPort" if mark == "fullPort" else "blockPort"
        head.prefixes = [one for one in head.prefixes if one not in ("ref", "in", "out", "inout")]
        head.prefixes.append(f"#{book.ours(entry.parent, name)}")
        head.types = [one.removeprefix("~") for one in head.types or ()]
    elif not _is_port_type(book, element):
        body = _inner(element, head) + body
    if entry.shape.keyword != "part" and element.role == "full port":
        head.prefixes.append(f"#{book.ours(entry.parent, 'fullPort')}")
    return [Line(head.text(), body)]


def _is_port_type(book: Book, element: Element) -> bool:
    type_ = type_of(book.graph, element)
    entry = book.plan.entry(type_)
    if entry is not None and type_ is not None and entry.element is element:
        return type_.role == "interface block"
    return entry is not None and entry.shape.keyword == "port def"


def _inner(element: Element, head: Head) -> list[Line]:
    """What flows through a port that is typed by it (flow ports of SysML 1.2 and before)."""
    types = [one.removeprefix("~") for one in head.types or ()]
    head.types = []
    given = str(element.attrs.get("direction", ""))
    if not types:
        return []
    head.prefixes = [one for one in head.prefixes if one != given]
    return [Line(f"{given or 'ref'} : {', '.join(types)}")]


def operation(book: Book, entry: Entry) -> list[Line]:
    """An operation: an action of its owner; a method of another name is what it specialises."""
    element = entry.element
    assert element is not None
    head = definition_head(book, entry)
    if entry.parent is not None and entry.parent.shape.plain in ("port", "attribute"):
        head.prefixes.append("ref")
    body = contents(book, entry)
    for method in book.graph.targets(element, Edge.METHOD):
        other = book.plan.entry(method)
        if other is entry:
            book.said.add(method.id)
            body += opaque_lines(book, entry, method)
            continue
        if differs_in_parameters(book, element, method):
            continue
        name = book.name(entry.parent, element, Edge.METHOD, method)
        if name is not None and other is not None:
            if other.shape.is_definition:
                head.types = [*(head.types or ()), name]
            else:
                head.subsets = [*(head.subsets or ()), name]
    _redefines(book, entry, element, head)
    return [Line(head.text(), body)]


def _redefines(book: Book, entry: Entry, element: Element, head: Head) -> None:
    targets = book.graph.targets(element, Edge.REDEFINES)
    names = [book.redefined(entry.parent, one) for one in targets]
    head.redefines = [one for one in names if one is not None]
    if quoted(entry.name) in head.redefines:
        head.name = ""


def reception(book: Book, entry: Entry) -> list[Line]:
    """A reception: an action that accepts the signal."""
    element = entry.element
    assert element is not None
    types, _ = typing(book, entry.parent, element)
    accepted = f" accept : {types[0]}" if types else ""
    return [Line(f"action {quoted(entry.name)}{accepted}", contents(book, entry))]


def parameter(book: Book, entry: Entry) -> list[Line]:
    """A parameter of an operation or behaviour; without a direction it is ``in``."""
    element = entry.element
    assert element is not None
    head = feature_head(book, entry)
    if not any(one in head.prefixes for one in ("in", "out", "inout")):
        head.prefixes = ["in", *(one for one in head.prefixes if one != "ref")]
    if "default" in element.attrs:
        mark = ":=" if element.attrs.get("initial") else "default ="
        head.value = f" {mark} {value(book, entry.parent, element, element, 'default')}"
    return [Line(head.text(), contents(book, entry))]


def association(book: Book, entry: Entry) -> list[Line]:
    """A connection definition; ends that classes own are repeated in it."""
    element = entry.element
    assert element is not None
    if actor_of(book.graph, element) is not None:
        book.said.update(one.id for one in book.graph.owned(element))
        return []
    ends = []
    found = [(one, book.plan.entry(one)) for one in book.graph.targets(element, Edge.END)]
    repeated = [(end, own) for end, own in found if own is not None and own.parent is not entry]
    # A type that is called as an end is hidden by it.
    visible(book.plan, entry).update((own.name, own) for _, own in repeated)
    for end, own in repeated:
        types, _ = typing(book, entry, end)
        count = declarations.multiplicity(book, entry, end)
        keyword = own.shape.keyword if count or own.shape.keyword != "ref" else ""
        head = " ".join(word for word in ("end", count.strip(), keyword, quoted(own.name)) if word)
        ends.append(Line(head + (f" : {', '.join(types)}" if types else "")))
    head = definition_head(book, entry).text()
    return [Line(head, ends + contents(book, entry))]


def association_end(book: Book, entry: Entry) -> list[Line]:
    """An end that the association owns."""
    element = entry.element
    assert element is not None
    head = feature_head(book, entry)
    count, head.multiplicity = head.multiplicity, ""
    head.prefixes = ["end", *([count.strip()] if count else [])]
    if count and not head.keyword:
        head.keyword = "ref"
    return [Line(head.text(), contents(book, entry))]


def property_(book: Book, entry: Entry) -> list[Line]:
    """A property: an end of an association, else a feature."""
    element = entry.element
    above = None if entry.parent is None else entry.parent.element
    is_of_association = above is not None and above.kind is Kind.ASSOCIATION
    if is_of_association and above is not None and element in book.graph.targets(above, Edge.END):
        return association_end(book, entry)
    return feature(book, entry)
