"""Features that hold values: bounds, defaults, slots, bodies of constraints, arguments."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi import metaclasses, rules
from sysmlc.frontends.xmi.attributes import defer_ids, set_bound
from sysmlc.frontends.xmi.dangling import check_references_inside
from sysmlc.frontends.xmi.document import WrittenReference
from sysmlc.frontends.xmi.elements import add_element
from sysmlc.frontends.xmi.unit import File, RowHandler
from sysmlc.frontends.xmi.values import (
    Value,
    is_natural,
    parse_bound,
    read_value,
    store_alternatives,
)
from sysmlc.ir import AttrValue, Edge, Element, Kind, as_items


def lower_value(file: File, row: int) -> Value:
    """Return the value in a row, and mark the row and its content as mapped."""
    file.mark_subtree(row, Verdict.MAPPED)
    if not file.document.types[row].startswith("Literal"):
        check_references_inside(file, row, ("instance", "element", "observation"))
    return read_value(file.document, row)


def lower_single_value(file: File, row: int) -> Value:
    """Return the value in a row; report alternative bodies, which the graph cannot store here."""
    value = lower_value(file, row)
    if value.bodies:
        file.approximate(row, rules.APPROXIMATED, "its alternative bodies")
    return value


def _append(element: Element, key: str, value: AttrValue) -> None:
    stored = element.attrs.get(key)
    if stored is None:
        element.attrs[key] = value
    else:
        element.attrs[key] = (*as_items(stored), value)


# -- multiplicities --------------------------------------------------------------------------------


def _make_bound_handler(index: int) -> RowHandler:
    """Return a handler of the lower (0) or upper (1) bound."""

    def lower(file: File, row: int) -> None:
        value = lower_single_value(file, row)
        set_bound(file, row, index, value.value, is_computed=not value.is_literal)

    return lower


def _make_derived_bound_handler(index: int) -> RowHandler:
    """Return a handler of the derived bound that Enterprise Architect writes."""

    def lower(file: File, row: int) -> None:
        file.mark_subtree(row, Verdict.MAPPED)
        document = file.document
        text = document.attributes[row].get("value") or document.texts.get(row, "")
        set_bound(file, row, index, parse_bound(text.strip()))

    return lower


def set_multiplicities(file: File) -> None:
    """Set the multiplicities of the document's elements, and report bounds that are invalid."""
    graph = file.unit.graph
    for id, (lower, upper, is_computed) in file.bounds.items():
        text = _format_multiplicity(lower, upper)
        if text:
            element = graph[id]
            element.attrs["multiplicity"] = text
            is_valid = is_natural(lower) and (upper == "*" or is_natural(upper))
            # A bound may be an expression, such as ``size``, but not a text or a negative number.
            if not is_valid and text != "*" and not is_computed:
                subject, name = graph.subject(element), graph.qualified_name(element)
                file.unit.sink.report(rules.BAD_BOUND, subject, multiplicity=text, element=name)


def _format_multiplicity(lower: AttrValue, upper: AttrValue) -> str:
    """Return two bounds in the notation of UML; the empty string for exactly 1."""
    if lower == upper:
        return "" if lower == 1 else str(lower)
    return "*" if lower == 0 and upper == "*" else f"{lower}..{upper}"


# -- values of owners ------------------------------------------------------------------------------


def _lower_default(file: File, row: int) -> None:
    _store_value(file, row, "default")


def _lower_specification(file: File, row: int) -> None:
    owner = file.find_owner(row)
    if owner is None or owner.kind is not Kind.CONSTRAINT:
        _store_value(file, row, "value")
        return
    value = lower_value(file, row)
    owner.attrs["body"] = value.text
    if value.language:
        owner.attrs["language"] = value.language
    store_alternatives(owner, value)


def _lower_slot_value(file: File, row: int) -> None:
    owner = file.find_owner(row)
    if owner is None or owner.kind is not Kind.SLOT:
        _store_value(file, row, "value")
        return
    value = lower_value(file, row)
    if value.instance:
        # An id that is missing is no file.
        is_href = value.instance not in file.document.ids and "#" in value.instance
        child = next(file.document.children(row, "instance"), row)
        reference = WrittenReference(value.instance, child, is_href)
        file.add_reference(Edge.REFERENCES, owner.id, reference, "instance")
    else:
        _append(owner, "value", value.value)


def _store_value(file: File, row: int, key: str) -> None:
    owner = file.find_owner(row)
    value = lower_value(file, row)
    if owner is None:
        return
    owner.attrs[key] = value.value
    if value.instance:
        is_href = value.instance not in file.document.ids
        defer_ids(file, owner, f"{key}_instance", [value.instance], is_href)
    elif not value.is_literal:
        owner.attrs[f"{key}_language"] = value.language
        store_alternatives(owner, value, key)


def _make_text_handler(key: str, default: str | None = "") -> RowHandler:
    """Return a handler that stores a value as text unless it is the default.

    With the default None an empty text is stored, too, because an unreadable value is not the
    default.
    """

    def lower(file: File, row: int) -> None:
        owner = file.find_owner(row)
        value = lower_value(file, row)
        if owner is not None and value.text != default:
            owner.attrs[key] = value.text
            store_alternatives(owner, value, key)

    return lower


def _lower_argument(file: File, row: int) -> None:
    owner = file.find_owner(row)
    text = lower_single_value(file, row).text
    if owner is not None:
        _append(owner, "arguments", text)


FEATURES: dict[str, RowHandler] = {
    "lowerValue": _make_bound_handler(0),
    "upperValue": _make_bound_handler(1),
    "lower": _make_derived_bound_handler(0),
    "upper": _make_derived_bound_handler(1),
    "defaultValue": _lower_default,
    "specification": _lower_specification,
    "value": _lower_slot_value,
    "joinSpec": _make_text_handler("join_spec", default=None),
    "upperBound": _make_text_handler("upper_bound", default="*"),
    "nameExpression": _make_text_handler("name_expression"),
    "argument": _lower_argument,
}


# -- values that packages own ----------------------------------------------------------------------


def _make_packaged_value_handler(type_name: str) -> RowHandler:
    """Return a handler of values that packages own.

    They are elements, because constraints and observations refer to them.
    """

    def lower(file: File, row: int) -> None:
        if file.document.features[row] != "packagedElement":
            file.mark_subtree(row, Verdict.UNSUPPORTED)
            return
        subkind = metaclasses.to_kebab_case(type_name)
        add_element(file, row, Kind.EXPRESSION, subkind, type_name)
        element = file.unit.graph[file.element_ids[row]]
        value = lower_value(file, row)
        element.attrs["value"] = value.value
        if value.language:
            element.attrs["value_language"] = value.language

    return lower


TYPES: dict[str, RowHandler] = {
    name: _make_packaged_value_handler(name) for name in metaclasses.VALUE_TYPES
}
