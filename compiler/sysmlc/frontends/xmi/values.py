"""Value specifications: literals as JSON values, expressions as text (UML 2.5.1 clause 8)."""

import re
from math import isfinite
from typing import NamedTuple

from sysmlc.frontends.xmi.document import Document
from sysmlc.frontends.xmi.metaclasses import LITERALS
from sysmlc.frontends.xmi.vocabulary import TRUE
from sysmlc.ir import AttrValue, Element

_LANGUAGE_RANKS = (
    frozenset({"", "kerml", "sysml", "sysmlv2", "sysml v2", "ocl", "ocl2.0", "ltl", "promela"}),
    frozenset({"english", "natural language", "text", "plain text"}),
)
"""Languages by preference, in lower case: of expressions, then natural ones; others are last."""
_TIMES = ("TimeExpression", "Duration")
_INTERVALS = ("Interval", "TimeInterval", "DurationInterval")
_EXPRESSIONS = ("Expression", "StringExpression")
_NESTING = frozenset((*_TIMES, *_INTERVALS, *_EXPRESSIONS))
_REFERRING = {"InstanceValue": "instance", "ElementValue": "element"}
"""Values that refer to an element, and their feature; ``ElementValue`` is MagicDraw's own."""
_INFIX_WORDS = frozenset({"and", "or", "xor", "implies"})
"""Operators of the expression grammar that are words and stand between their operands."""
_TRUTH_VALUES = {**dict.fromkeys(TRUE, True), **dict.fromkeys(("", "false", "0"), False)}
_INTEGER = re.compile(r"[+-]?[0-9]{1,4000}$")


class Value(NamedTuple):
    """A JSON literal or a text; ``language`` is set for expressions."""

    value: AttrValue
    language: str = ""
    is_literal: bool = False
    instance: str = ""
    """Local id or href of the instance that the value refers to."""
    bodies: tuple[str, ...] = ()
    """All alternative texts of an opaque expression with several; ``value`` is one of them."""
    languages: tuple[str, ...] = ()
    """Languages of ``bodies``, one each, empty where the source gives none."""

    @property
    def text(self) -> str:
        """The value as text: ``true`` and ``false`` for truth values."""
        if isinstance(self.value, bool):
            return "true" if self.value else "false"
        return "" if self.value is None else str(self.value)


def store_alternatives(element: Element, value: Value, key: str = "") -> None:
    """Store all bodies and languages of an expression that has several."""
    if value.bodies:
        prefix = f"{key}_" if key else ""
        element.attrs[f"{prefix}bodies"] = value.bodies
        element.attrs[f"{prefix}languages"] = value.languages


_NestedValues = dict[int, Value]
"""Values inside other values, by row."""


def read_value(document: Document, row: int) -> Value:
    """Return the value of the value specification in this row."""
    nested: _NestedValues = {}
    if document.types[row] in _NESTING:
        # From the innermost outwards: recursion as deep as a file may nest would overflow.
        for inner in range(document.ends[row] - 1, row, -1):
            if document.types[inner] in _NESTING:
                nested[inner] = _read(document, inner, nested)
    return _read(document, row, nested)


def _read(document: Document, row: int, nested: _NestedValues) -> Value:
    type_name = document.types[row]
    if type_name in LITERALS:
        return Value(_read_literal(type_name, document.get(row, "value")), is_literal=True)
    if type_name in _REFERRING:
        return _read_instance(document, row, _REFERRING[type_name])
    if type_name in _EXPRESSIONS:
        return Value(_read_expression(document, row, nested), language="UML")
    if type_name in _TIMES:
        return _read_time(document, row, nested)
    if type_name in _INTERVALS:
        return Value(_read_interval(document, row, nested))
    return read_opaque(document, row)


def _read_nested(document: Document, row: int, nested: _NestedValues) -> Value:
    return nested[row] if row in nested else _read(document, row, nested)


# -- opaque expressions ----------------------------------------------------------------------------


def read_opaque(document: Document, row: int) -> Value:
    """Return body and language of an opaque expression, action or behaviour.

    All bodies have the same meaning (UML 2.5.1, 8.3.3). The first in a language of expressions
    counts, else the first in a natural language, else the first.
    """
    bodies, languages = _read_bodies(document, row)
    if len(bodies) < 2:
        body = bodies[0] if bodies else document.get(row, "value")
        return Value(body, languages[0] if languages else "")
    padded = (*languages, *[""] * len(bodies))[: len(bodies)]
    best = min(range(len(bodies)), key=lambda i: _rank(bodies[i], padded[i]))
    return Value(bodies[best], padded[best], bodies=tuple(bodies), languages=padded)


def _rank(body: str, language: str) -> int:
    if not body:
        return len(_LANGUAGE_RANKS) + 1
    ranks = (rank for rank, names in enumerate(_LANGUAGE_RANKS) if language.lower() in names)
    return next(ranks, len(_LANGUAGE_RANKS))


def _read_bodies(document: Document, row: int) -> tuple[list[str], list[str]]:
    """Return bodies and languages, each written as an attribute or as children."""
    values = document.attributes[row]
    texts: dict[str, list[str]] = {"body": [], "language": []}
    for child in document.children(row):
        if document.features[child] in texts:
            texts[document.features[child]].append(document.texts.get(child, ""))
    for feature in texts:
        if feature in values:
            texts[feature] = [values[feature]]
    return texts["body"], texts["language"]


# -- literals and bounds ---------------------------------------------------------------------------


def _read_literal(type_name: str, text: str) -> AttrValue:
    if type_name == "LiteralBoolean":
        # A text that is no truth value is not false: it is unknown.
        return _TRUTH_VALUES.get(text.lower(), text)
    if type_name == "LiteralString":
        return text
    if type_name == "LiteralNull":
        return "null"
    if type_name == "LiteralReal":
        return _parse_real(text or "0")
    if text in ("*", "-1") and type_name == "LiteralUnlimitedNatural":
        return "*"
    return int(text or "0") if not text or _INTEGER.match(text) else text


def _parse_real(text: str) -> AttrValue:
    """Return a number, or the text itself if JSON has no such number (``INF``)."""
    try:
        number = float(text)
    except ValueError:
        return text
    return number if isfinite(number) else text


def parse_bound(text: str) -> AttrValue:
    """Return a bound written as text: a number, ``*`` for unlimited or -1, or an expression."""
    if text in ("*", "-1"):
        return "*"
    return int(text) if text.isascii() and text.isdigit() else text


def is_natural(value: AttrValue) -> bool:
    """Whether a bound is a natural number; the type of its literal does not matter."""
    if isinstance(value, str):
        return value.isascii() and value.isdigit()
    return value.__class__ is int and value >= 0


# -- times and intervals ---------------------------------------------------------------------------


def _read_time(document: Document, row: int, nested: _NestedValues) -> Value:
    """Return the expression of a time or duration, else the names of its observations."""
    expression = next(document.children(row, "expr"), None)
    if expression is not None:
        return _read_nested(document, expression, nested)
    observations = (document.ids.get(target) for target in document.targets(row, "observation"))
    names = (_name(document, inner) for inner in observations if inner is not None)
    return Value(", ".join(names))


def _read_interval(document: Document, row: int, nested: _NestedValues) -> str:
    """Return ``min..max``; MagicDraw nests the bounds, Papyrus writes them elsewhere."""
    lower, upper = (_read_limit(document, row, feature, nested) for feature in ("min", "max"))
    return lower if lower == upper else f"{lower}..{upper}"


def _read_limit(document: Document, row: int, feature: str, nested: _NestedValues) -> str:
    for child in document.children(row, feature):
        if document.types[child]:
            return _read_nested(document, child, nested).text
    for target in document.targets(row, feature):
        target_row = document.ids.get(target)
        return _read_leaf(document, target_row).text if target_row is not None else target
    return ""


def _read_leaf(document: Document, row: int) -> Value:
    """Return a value that an id refers to. Only leaves are read: references may form a cycle."""
    expression = next(document.children(row, "expr"), None)
    if expression is None and document.types[row] in _TIMES:
        return _read_time(document, row, {})
    leaf = row if expression is None else expression
    if document.types[leaf] in LITERALS:
        return _read(document, leaf, {})
    return read_opaque(document, leaf)


# -- instances and expression trees ----------------------------------------------------------------


def _read_instance(document: Document, row: int, feature: str) -> Value:
    targets = document.targets(row, feature)
    hrefs = [document.href(child) for child in document.children(row, feature)]
    target = next((target for target in [*targets, *hrefs] if target), "")
    target_row = document.ids.get(target)
    name = _name(document, target_row) if target_row is not None else ""
    return Value(name or _name(document, row), instance=target)


def _read_expression(document: Document, row: int, nested: _NestedValues) -> str:
    """Return ``symbol(operand, ...)``; without a symbol the operands joined (StringExpression)."""
    children = [*document.children(row, "operand"), *document.children(row, "subExpression")]
    operands = [_read_nested(document, child, nested).text for child in children]
    symbol = document.attributes[row].get("symbol", "")
    if not symbol:
        return "".join(operands)
    is_infix = symbol in _INFIX_WORDS or (len(operands) == 2 and not symbol[:1].isalnum())
    if is_infix and len(operands) > 1:
        return f"({f' {symbol} '.join(operands)})"
    return f"{symbol}({', '.join(operands)})" if operands else symbol


def _name(document: Document, row: int) -> str:
    return document.attributes[row].get("name", "")
