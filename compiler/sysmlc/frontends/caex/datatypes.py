"""XML Schema data types of attributes: what UML calls them, and what their values are."""

import re
from collections.abc import Callable
from functools import lru_cache

from sysmlc.ir import AttrValue

Reader = Callable[[str], AttrValue]
"""The value that a text means. Raises ValueError for a text that the data type does not have."""

_BOUNDS: dict[str, tuple[int | None, int | None]] = {
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
"""Least and largest value of the types of integers."""

PRIMITIVES = {
    **dict.fromkeys(("double", "float", "decimal"), "Real"),
    **dict.fromkeys(_BOUNDS, "Integer"),
    "boolean": "Boolean",
}
"""UML primitive of an XML Schema data type; every other one holds text."""

_ZONE = r"(Z|[+-]\d\d:\d\d)?"
_DATE = r"-?\d{4,}-(0[1-9]|1[0-2])-(0[1-9]|[12]\d|3[01])"
_TIME = r"(([01]\d|2[0-3]):[0-5]\d:[0-5]\d(\.\d+)?|24:00:00(\.0+)?)"
_DAYS, _CLOCK = r"(\d+D)?", r"(T(?=\d)(\d+H)?(\d+M)?(\d+(\.\d+)?S)?)?"
_MONTHS = r"(\d+Y)?(\d+M)?"
_FORMS = {
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
"""What texts of the other types look like that do not hold any text (XML Schema 1.1, part 2)."""

NAMES = frozenset(
    {
        *PRIMITIVES,
        *_FORMS,
        *("anyType", "anySimpleType", "anyAtomicType", "string", "normalizedString", "token"),
        *("Name", "NCName", "QName", "NMTOKEN", "NMTOKENS", "NOTATION", "anyURI"),
        *("ID", "IDREF", "IDREFS", "ENTITY", "ENTITIES"),
    }
)
"""All data types of XML Schema. Any text counts as a value of those that tell names apart: what
tools write there are GUIDs, which may start with a digit."""

_DECIMAL = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)", re.ASCII)
_SPECIAL = frozenset({"INF", "+INF", "-INF", "NaN"})
_TRUTH = {"true": True, "1": True, "false": False, "0": False}


def local(data_type: str) -> str:
    """The name of a data type without its prefix."""
    return data_type.rpartition(":")[2].strip()


@lru_cache(1024)
def reader_of(data_type: str) -> Reader | None:
    """How values of a data type are read; None where any text is one."""
    name = local(data_type)
    if name in _BOUNDS:
        return _integer(*_BOUNDS[name])
    if name in _FORMS:
        return _formed(re.compile(_FORMS[name], re.ASCII))
    return _READERS.get(name)


def meant(text: str, data_type: str) -> AttrValue:
    """What is meant by a text that is no value of its data type; the text where that is open."""
    read = _LENIENT.get(PRIMITIVES.get(local(data_type), ""))
    try:
        return text if read is None else read(text)
    except ValueError:
        return text


def _real(text: str) -> AttrValue:
    value = float(text)
    # Python takes infinities in words and digits in groups.
    if value - value != 0 or "_" in text:
        _demand(text.strip() in _SPECIAL)
    return value


def _decimal(text: str) -> AttrValue:
    _demand(_DECIMAL.fullmatch(text.strip()) is not None)
    return float(text)


def _integer(least: int | None, largest: int | None) -> Reader:
    def read(text: str) -> AttrValue:
        value = int(text)
        is_small = least is not None and value < least
        if is_small or (largest is not None and value > largest) or "_" in text:
            raise ValueError
        return value

    return read


def _boolean(text: str) -> AttrValue:
    found = _TRUTH.get(text.strip())
    if found is None:
        raise ValueError
    return found


def _formed(form: re.Pattern[str]) -> Reader:
    def read(text: str) -> AttrValue:
        _demand(form.fullmatch(text.strip()) is not None)
        return text

    return read


def _demand(holds: bool) -> None:
    if not holds:
        raise ValueError


def _truth(text: str) -> AttrValue:
    return _TRUTH.get(text.strip().lower(), text)


_READERS: dict[str, Reader] = {
    "double": _real,
    "float": _real,
    "decimal": _decimal,
    "boolean": _boolean,
}
_LENIENT: dict[str, Reader] = {"Real": float, "Integer": int, "Boolean": _truth}
