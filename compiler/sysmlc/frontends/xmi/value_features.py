"""Rows that hold values: bounds, defaults, bodies of constraints, arguments."""

from collections.abc import Callable

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.dangling import look_inside
from sysmlc.frontends.xmi.values import ValueText, bound, text_of, value_of
from sysmlc.ir import AttrValue, Edge, Element, Kind

_Reader = Callable[[Context, int], None]


def value_in(context: Context, row: int) -> ValueText:
    """The value in a row; it and its content are mapped."""
    context.subtree(row, Verdict.MAPPED)
    if not context.document.types[row].startswith("Literal"):
        look_inside(context, row, ("instance", "element", "observation"))
    return value_of(context.document, row)


def lone_value_in(context: Context, row: int) -> ValueText:
    """The value in a row, where the graph has no room for alternatives: they are reported."""
    value = value_in(context, row)
    if value.bodies:
        context.approximate(row, "its alternative bodies")
    return value


def keep_alternatives(element: Element, value: ValueText, key: str = "") -> None:
    """Note all bodies and languages of an expression that has several."""
    if value.bodies:
        prefix = f"{key}_" if key else ""
        element.attrs[f"{prefix}bodies"] = value.bodies
        element.attrs[f"{prefix}languages"] = value.languages


def _lower(context: Context, row: int) -> None:
    context.bound(row, 0, _bound(context, row))


def _upper(context: Context, row: int) -> None:
    context.bound(row, 1, _bound(context, row))


def _bound(context: Context, row: int) -> AttrValue:
    value = lone_value_in(context, row)
    if not value.is_literal:
        context.computed.add(context.gids[row])
    return value.value


def _written(index: int) -> _Reader:
    """A derived bound, which Enterprise Architect writes instead of a value specification."""

    def read(context: Context, row: int) -> None:
        context.subtree(row, Verdict.MAPPED)
        document = context.document
        text = document.attributes[row].get("value") or document.texts.get(row, "")
        context.bound(row, index, bound(text.strip()))

    return read


def _default(context: Context, row: int) -> None:
    _put(context, row, "default")


def _specification(context: Context, row: int) -> None:
    owner = context.owner(row)
    if owner is None or owner.kind is not Kind.CONSTRAINT:
        _put(context, row, "value")
        return
    value = value_in(context, row)
    owner.attrs["body"] = text_of(value)
    if value.language:
        owner.attrs["language"] = value.language
    keep_alternatives(owner, value)


def _value(context: Context, row: int) -> None:
    owner = context.owner(row)
    if owner is None or owner.kind is not Kind.SLOT:
        _put(context, row, "value")
        return
    value = value_in(context, row)
    if value.instance:
        is_href = value.instance not in context.document.ids
        child = next(context.document.children(row, "instance"), row)
        context.link(Edge.REFERENCES, owner.id, value.instance, child, "instance", is_href)
    else:
        _append(owner, "value", value.value)


def _append(element: Element, key: str, value: AttrValue) -> None:
    known = element.attrs.get(key)
    if known is None:
        element.attrs[key] = value
    else:
        element.attrs[key] = (*known, value) if isinstance(known, tuple) else (known, value)


def _put(context: Context, row: int, key: str) -> None:
    owner = context.owner(row)
    value = value_in(context, row)
    if owner is None:
        return
    owner.attrs[key] = value.value
    if value.instance:
        is_href = value.instance not in context.document.ids
        context.keep_ids(owner, f"{key}_instance", [value.instance], is_href)
    elif not value.is_literal:
        owner.attrs[f"{key}_language"] = value.language
        keep_alternatives(owner, value, key)


def _text(key: str, unless: str = "") -> _Reader:
    def read(context: Context, row: int) -> None:
        owner = context.owner(row)
        value = value_in(context, row)
        text = text_of(value)
        if owner is not None and text != unless:
            owner.attrs[key] = text
            keep_alternatives(owner, value, key)

    return read


def _argument(context: Context, row: int) -> None:
    owner = context.owner(row)
    text = text_of(lone_value_in(context, row))
    if owner is not None:
        _append(owner, "arguments", text)


FEATURES: dict[str, _Reader] = {
    "lowerValue": _lower,
    "upperValue": _upper,
    "lower": _written(0),
    "upper": _written(1),
    "defaultValue": _default,
    "specification": _specification,
    "value": _value,
    "joinSpec": _text("join_spec"),
    "upperBound": _text("upper_bound", unless="*"),
    "nameExpression": _text("name_expression"),
    "argument": _argument,
}
