"""Value specifications: literals as JSON values, expressions as text."""

import re
from math import isfinite
from typing import NamedTuple

from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.vocabulary import TRUE
from sysmlc.ir import AttrValue

_LITERALS = frozenset(
    {
        "LiteralBoolean",
        "LiteralInteger",
        "LiteralReal",
        "LiteralString",
        "LiteralUnlimitedNatural",
        "LiteralNull",
    }
)


_LEGIBLE = (
    frozenset({"", "kerml", "sysml", "sysmlv2", "sysml v2", "ocl", "ocl2.0", "ltl", "promela"}),
    frozenset({"english", "natural language", "text", "plain text"}),
)
"""Languages by how well the expression grammar reads them, lower case; programs come last."""


_OF_TIME = ("TimeExpression", "Duration")
_INTERVALS = ("Interval", "TimeInterval", "DurationInterval")
_EXPRESSIONS = ("Expression", "StringExpression")
_NAMES = {"InstanceValue": "instance", "ElementValue": "element"}
"""Values that name an element, and the feature that leads to it; the second is MagicDraw's own."""
_BETWEEN = frozenset({"and", "or", "xor", "implies"})
"""Operators of the grammar of expressions that are words, and stand between their operands."""
_NESTING = frozenset((*_OF_TIME, *_INTERVALS, *_EXPRESSIONS))
_INTEGER = re.compile(r"[+-]?[0-9]{1,4000}$")


class ValueText(NamedTuple):
    """A value: a JSON literal or text; ``language`` is set when it is an expression."""

    value: AttrValue
    language: str = ""
    is_literal: bool = False
    instance: str = ""
    """Local id or href of the instance that it names."""
    bodies: tuple[str, ...] = ()
    """All texts, when there are several that say the same; ``value`` is one of them."""
    languages: tuple[str, ...] = ()
    """Languages of ``bodies``, one each, empty where the source gives none."""


_Inner = dict[int, ValueText]
"""Values by row that stand inside others."""


def value_of(document: Document, row: int) -> ValueText:
    """The value that the value specification in this row means (UML 2.5.1 clause 8)."""
    inner: _Inner = {}
    if document.types[row] == "OpaqueExpression":
        return opaque(document, row)
    if document.types[row] in _NESTING:
        # From the innermost outwards: calls that nest as deep as a file may would not end well.
        for at in range(document.ends[row] - 1, row, -1):
            if document.types[at] in _NESTING:
                inner[at] = _value(document, at, inner)
    return _value(document, row, inner)


def _value(document: Document, row: int, inner: _Inner) -> ValueText:
    type_name = document.types[row]
    if type_name in _LITERALS:
        return ValueText(_literal(type_name, document.get(row, "value")), is_literal=True)
    if type_name in _NAMES:
        return _instance(document, row, _NAMES[type_name])
    if type_name in _EXPRESSIONS:
        return ValueText(_expression(document, row, inner), language="UML")
    if type_name in _OF_TIME:
        return _time(document, row, inner)
    if type_name in _INTERVALS:
        return ValueText(_interval(document, row, inner))
    return opaque(document, row)


def _part(document: Document, row: int, inner: _Inner) -> ValueText:
    return inner[row] if row in inner else _value(document, row, inner)


def text_of(value: ValueText) -> str:
    """The value as text: ``true`` and ``false`` for truth values."""
    if isinstance(value.value, bool):
        return "true" if value.value else "false"
    return "" if value.value is None else str(value.value)


def opaque(document: Document, row: int) -> ValueText:
    """Body and language of an opaque expression, action or behaviour.

    Of several bodies the first counts whose language is a language of expressions, else the
    first in a natural language, else the first (UML 2.5.1, 8.3.3: they mean the same).
    """
    bodies, languages = _texts(document, row)
    if len(bodies) < 2:
        body = bodies[0] if bodies else document.get(row, "value")
        return ValueText(body, languages[0] if languages else "")
    spoken = (*languages, *[""] * len(bodies))[: len(bodies)]
    best = min(range(len(bodies)), key=lambda i: _rank(bodies[i], spoken[i]))
    return ValueText(bodies[best], spoken[best], bodies=tuple(bodies), languages=spoken)


def _rank(body: str, language: str) -> int:
    if not body:
        return len(_LEGIBLE) + 1
    known = (i for i, names in enumerate(_LEGIBLE) if language.lower() in names)
    return next(known, len(_LEGIBLE))


def bound(text: str) -> AttrValue:
    """A bound written as text: a number, ``*`` for unlimited (``-1`` too), or an expression."""
    if text in ("*", "-1"):
        return "*"
    return int(text) if text.isascii() and text.isdigit() else text


def is_natural(value: AttrValue) -> bool:
    """Whether a bound is a number, as a literal of any type may say it."""
    if isinstance(value, str):
        return value.isascii() and value.isdigit()
    return value.__class__ is int and value >= 0


def name_of_instance(document: Document, row: int) -> str:
    """Name of a row of the same document."""
    return document.attributes[row].get("name", "")


def _texts(document: Document, row: int) -> tuple[list[str], list[str]]:
    """Bodies and languages, each written as an attribute or as children."""
    bodies: list[str] = []
    languages: list[str] = []
    features, texts, ends = document.features, document.texts, document.ends
    child, end = row + 1, ends[row]
    while child < end:
        if features[child] == "body":
            bodies.append(texts.get(child, ""))
        elif features[child] == "language":
            languages.append(texts.get(child, ""))
        child = ends[child]
    values = document.attributes[row]
    if "body" in values:
        bodies = [values["body"]]
    if "language" in values:
        languages = [values["language"]]
    return bodies, languages


def _literal(type_name: str, text: str) -> AttrValue:
    if type_name == "LiteralBoolean":
        return text in TRUE
    if type_name == "LiteralString":
        return text
    if type_name == "LiteralNull":
        return "null"
    if type_name == "LiteralReal":
        return _real(text or "0")
    if text in ("*", "-1") and type_name == "LiteralUnlimitedNatural":
        return "*"
    return int(text or "0") if not text or _INTEGER.match(text) else text


def _real(text: str) -> AttrValue:
    """A number; text that JSON has no number for stays as it is (``INF``)."""
    try:
        number = float(text)
    except ValueError:
        return text
    return number if isfinite(number) else text


def _time(document: Document, row: int, inner: _Inner) -> ValueText:
    """A time or duration: what it is, else the observations that it is said of."""
    expression = next(document.children(row, "expr"), None)
    if expression is not None:
        return _part(document, expression, inner)
    found = (document.ids.get(target) for target in document.targets(row, "observation"))
    return ValueText(", ".join(name_of_instance(document, at) for at in found if at is not None))


def _interval(document: Document, row: int, inner: _Inner) -> str:
    """``min..max``; the bounds stand inside (MagicDraw), or elsewhere in the file (Papyrus)."""
    bounds = [_bound(document, row, feature, inner) for feature in ("min", "max")]
    return bounds[0] if bounds[0] == bounds[1] else "..".join(bounds)


def _bound(document: Document, row: int, feature: str, inner: _Inner) -> str:
    for child in document.children(row, feature):
        if document.types[child]:
            return text_of(_part(document, child, inner))
    for target in document.targets(row, feature):
        at = document.ids.get(target)
        return text_of(_elsewhere(document, at)) if at is not None else target
    return ""


def _elsewhere(document: Document, row: int) -> ValueText:
    """A value that an id leads to: only a leaf is read, for the way could lead in a circle."""
    inner = next(document.children(row, "expr"), None)
    if inner is None and document.types[row] in _OF_TIME:
        return _time(document, row, {})
    leaf = row if inner is None else inner
    return (
        _value(document, leaf, {}) if document.types[leaf] in _LITERALS else opaque(document, leaf)
    )


def _instance(document: Document, row: int, feature: str) -> ValueText:
    targets = document.targets(row, feature)
    hrefs = [document.attributes[c].get("href", "") for c in document.children(row, feature)]
    target = next((t for t in [*targets, *hrefs] if t), "")
    known = document.ids.get(target)
    name = name_of_instance(document, known) if known is not None else ""
    return ValueText(name or document.attributes[row].get("name", ""), instance=target)


def _expression(document: Document, row: int, inner: _Inner) -> str:
    """``symbol(operand, ...)``; without a symbol the operands joined (StringExpression)."""
    inside = [*document.children(row, "operand"), *document.children(row, "subExpression")]
    operands = [text_of(_part(document, child, inner)) for child in inside]
    symbol = document.attributes[row].get("symbol", "")
    if not symbol:
        return "".join(operands)
    is_between = symbol in _BETWEEN or (len(operands) == 2 and not symbol[:1].isalnum())
    if is_between and len(operands) > 1:
        return f"({f' {symbol} '.join(operands)})"
    return f"{symbol}({', '.join(operands)})" if operands else symbol
