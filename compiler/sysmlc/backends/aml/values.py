"""Values as the lexical forms of XML Schema, and the data types that they have."""

import math

from sysmlc.ir import AttrValue


def text_of(value: AttrValue) -> str:
    """The text of a value in CAEX."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and not math.isfinite(value):
        return "NaN" if math.isnan(value) else "INF" if value > 0 else "-INF"
    if isinstance(value, tuple):
        return " ".join(map(text_of, value))
    return "" if value is None else str(value)


def type_of(value: AttrValue) -> str:
    """The XML Schema type of a value; none is told for a text."""
    if isinstance(value, bool):
        return "xs:boolean"
    if isinstance(value, int):
        return "xs:integer"
    return "xs:double" if isinstance(value, float) else ""
