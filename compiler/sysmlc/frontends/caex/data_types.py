"""XML Schema data types of attributes: conversion of texts to values, and check of both.

A text that is not a value of its data type is reported once a file, and converted leniently.
"""

import re
from collections.abc import Callable
from functools import lru_cache

from sysmlc.diagnostics import Severity, rule
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.findings import Findings
from sysmlc.frontends.caex.types import Type
from sysmlc.ir import AttrValue
from sysmlc.support.suggestions import find_similar

INVALID_VALUE = rule(
    "SM631",
    "value-not-of-data-type",
    Severity.WARNING,
    "the value '{value}' of '{element}'{more} is not a valid {data_type}",
    help="{hint}",
)
UNKNOWN_DATA_TYPE = rule(
    "SM632",
    "unknown-data-type",
    Severity.WARNING,
    "the data type '{data_type}' of '{element}' is not defined by XML Schema; {hint}",
)

_HINTS = {
    "Real": "write a number with a decimal point and without a unit",
    "Integer": "write a whole number that the data type has room for",
    "Boolean": "write true or false",
    "": "write it in the form that XML Schema has for the data type, as 2026-11-21 for a date",
}
"""Help for a value that is not of its data type, by UML primitive."""

Converter = Callable[[str], AttrValue]
"""Converts a text to a value. Raises ValueError for a text that is not a value of the data type."""

_INTEGER_BOUNDS: dict[str, tuple[int | None, int | None]] = {
    "integer": (None, None),
    "negativeInteger": (None, -1),
    "nonPositiveInteger": (None, 0),
    "nonNegativeInteger": (0, None),
    "positiveInteger": (1, None),
    **{
        name: (-(1 << bits - 1), (1 << bits - 1) - 1)
        for name, bits in (("long", 64), ("int", 32), ("short", 16), ("byte", 8))
    },
    **{
        f"unsigned{name}": (0, (1 << bits) - 1)
        for name, bits in (("Long", 64), ("Int", 32), ("Short", 16), ("Byte", 8))
    },
}
"""Least and largest value of the integer types."""

PRIMITIVES = {
    **dict.fromkeys(("double", "float", "decimal"), "Real"),
    **dict.fromkeys(_INTEGER_BOUNDS, "Integer"),
    "boolean": "Boolean",
}
"""UML primitive types by XML Schema data type; all other data types are texts."""

_ZONE = r"(Z|[+-]\d\d:\d\d)?"
_DATE = r"-?\d{4,}-(0[1-9]|1[0-2])-(0[1-9]|[12]\d|3[01])"
_TIME = r"(([01]\d|2[0-3]):[0-5]\d:[0-5]\d(\.\d+)?|24:00:00(\.0+)?)"
_DAYS, _CLOCK = r"(\d+D)?", r"(T(?=\d)(\d+H)?(\d+M)?(\d+(\.\d+)?S)?)?"
_MONTHS = r"(\d+Y)?(\d+M)?"
_PATTERNS = {
    "dateTime": f"{_DATE}T{_TIME}{_ZONE}",
    "dateTimeStamp": rf"{_DATE}T{_TIME}(Z|[+-]\d\d:\d\d)",
    "date": f"{_DATE}{_ZONE}",
    "time": f"{_TIME}{_ZONE}",
    "duration": f"-?P(?=.){_MONTHS}{_DAYS}{_CLOCK}",
    "dayTimeDuration": f"-?P(?=.){_DAYS}{_CLOCK}",
    "yearMonthDuration": f"-?P(?=.){_MONTHS}",
    "gYear": r"-?\d{4,}" + _ZONE,
    "gYearMonth": r"-?\d{4,}-(0[1-9]|1[0-2])" + _ZONE,
    "gMonthDay": r"--(0[1-9]|1[0-2])-(0[1-9]|[12]\d|3[01])" + _ZONE,
    "gMonth": r"--(0[1-9]|1[0-2])" + _ZONE,
    "gDay": r"---(0[1-9]|[12]\d|3[01])" + _ZONE,
    "hexBinary": r"([0-9a-fA-F]{2})*",
    "base64Binary": r"([A-Za-z0-9+/]\s?){2,}(=\s?){0,2}",
    "language": r"[A-Za-z]{1,8}(-[A-Za-z0-9]{1,8})*",
}
"""Lexical forms of other data types that do not allow any text (XML Schema 1.1, part 2)."""

DATA_TYPES = frozenset(
    {
        *PRIMITIVES,
        *_PATTERNS,
        *("anyType", "anySimpleType", "anyAtomicType", "string", "normalizedString", "token"),
        *("Name", "NCName", "QName", "NMTOKEN", "NMTOKENS", "NOTATION", "anyURI"),
        *("ID", "IDREF", "IDREFS", "ENTITY", "ENTITIES"),
    }
)
"""All data types of XML Schema.

Any text counts as a value of ID, NCName and similar types: tools write GUIDs there, which may start
with a digit.
"""

_DECIMAL = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)", re.ASCII)
_SPECIAL_REALS = frozenset({"INF", "+INF", "-INF", "NaN"})
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}


# -- conversion ------------------------------------------------------------------------------------


def local_name(data_type: str) -> str:
    """Return the name of a data type without its prefix."""
    return data_type.rpartition(":")[2].strip()


@lru_cache(1024)
def find_converter(data_type: str) -> Converter | None:
    """Return the converter of a data type; None for a data type that allows any text."""
    name = local_name(data_type)
    if name in _INTEGER_BOUNDS:
        return _make_integer_converter(*_INTEGER_BOUNDS[name])
    if name in _PATTERNS:
        return _make_pattern_check(re.compile(_PATTERNS[name], re.ASCII))
    return _CONVERTERS.get(name)


def convert_leniently(text: str, data_type: str) -> AttrValue:
    """Return the likely value of a text that is not a value of its data type, else the text."""
    convert = _LENIENT_CONVERTERS.get(PRIMITIVES.get(local_name(data_type), ""))
    try:
        return text if convert is None else convert(text)
    except ValueError:
        return text


def _convert_float(text: str) -> AttrValue:
    value = float(text)
    # Python also accepts "infinity", "nan" and groups of digits ("1_000").
    is_finite = value - value == 0
    if (not is_finite or "_" in text) and text.strip() not in _SPECIAL_REALS:
        raise ValueError
    return value


def _convert_decimal(text: str) -> AttrValue:
    if _DECIMAL.fullmatch(text.strip()) is None:
        raise ValueError
    return float(text)


def _make_integer_converter(least: int | None, largest: int | None) -> Converter:
    def convert(text: str) -> AttrValue:
        value = int(text)
        is_too_small = least is not None and value < least
        is_too_large = largest is not None and value > largest
        if is_too_small or is_too_large or "_" in text:
            raise ValueError
        return value

    return convert


def _convert_boolean(text: str) -> AttrValue:
    value = _BOOLEANS.get(text.strip())
    if value is None:
        raise ValueError
    return value


def _make_pattern_check(pattern: re.Pattern[str]) -> Converter:
    def check(text: str) -> AttrValue:
        if pattern.fullmatch(text.strip()) is None:
            raise ValueError
        return text

    return check


def _convert_boolean_leniently(text: str) -> AttrValue:
    return _BOOLEANS.get(text.strip().lower(), text)


_CONVERTERS: dict[str, Converter] = {
    "double": _convert_float,
    "float": _convert_float,
    "decimal": _convert_decimal,
    "boolean": _convert_boolean,
}
_LENIENT_CONVERTERS: dict[str, Converter] = {
    "Real": float,
    "Integer": int,
    "Boolean": _convert_boolean_leniently,
}


# -- values of attributes --------------------------------------------------------------------------


def convert_value(
    findings: Findings, node: Node, text: str, stated: str, type: Type | None
) -> AttrValue:
    """Return the value of a text for an attribute with data type *stated* or attribute type *type*.

    If only the attribute type has a data type, the text is checked but stays a text. A text that
    is not a value of the data type is recorded for ``report_values``.
    """
    data_type = find_data_type(stated, type)
    convert = find_converter(data_type)
    if convert is None:
        return text
    try:
        value = convert(text)
    except ValueError:
        _record_invalid_value(findings, node, text, data_type)
        return convert_leniently(text, stated)
    return value if stated else text


def find_data_type(stated: str, type: Type | None) -> str:
    """Return the data type of an attribute: its own, else that of its attribute type."""
    if stated or type is None:
        return stated
    inherited = (base.node.attributes.get("AttributeDataType", "") for base in type.iter_chain())
    return next(filter(None, inherited), "")


def _record_invalid_value(findings: Findings, node: Node, text: str, data_type: str) -> None:
    """Record a text that is not a value of its data type; an empty text is no value at all."""
    if text.strip():
        rows = findings.invalid_values.setdefault((node.document, data_type, text), [])
        # Both bounds of a constraint may have the same text.
        if node.row not in rows[-1:]:
            rows.append(node.row)


def check_data_type(findings: Findings, document: Document, row: int, data_type: str) -> None:
    """Record the data type of a row if XML Schema does not have it."""
    if data_type and local_name(data_type) not in DATA_TYPES:
        findings.unknown_data_types.setdefault((document, data_type), row)


# -- diagnostics -----------------------------------------------------------------------------------


def report_values(findings: Findings) -> None:
    """Report each invalid value and each unknown data type once a file."""
    for (document, data_type, text), rows in findings.invalid_values.items():
        node = document.node(rows[0])
        count = f" and {len(rows) - 1} more" if len(rows) > 1 else ""
        hint = _HINTS[PRIMITIVES.get(local_name(data_type), "")]
        facts = {"value": text, "data_type": data_type, "hint": hint, "more": count}
        findings.report(INVALID_VALUE, document, node, element=node.name, **facts)
    for (document, data_type), row in findings.unknown_data_types.items():
        node = document.node(row)
        facts = {"data_type": data_type, "hint": _suggest_data_type(local_name(data_type))}
        findings.report(UNKNOWN_DATA_TYPE, document, node, element=node.name, **facts)


def _suggest_data_type(name: str) -> str:
    """Return the data type that is probably meant, if only the spelling is wrong."""
    similar = find_similar(name, DATA_TYPES)
    return f"did you mean 'xs:{similar}'?" if similar else "its values count as text"
