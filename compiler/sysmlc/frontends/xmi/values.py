"""Value specifications: literals as JSON values, expressions as text."""

from typing import NamedTuple

from sysmlc.frontends.xmi.document import Document
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


def value_of(document: Document, row: int) -> ValueText:
    """The value that the value specification in this row means (UML 2.5.1 clause 8)."""
    type_name = document.types[row]
    if type_name in _LITERALS:
        return ValueText(_literal(type_name, document.get(row, "value")), is_literal=True)
    if type_name == "InstanceValue":
        return _instance(document, row)
    if type_name in ("Expression", "StringExpression"):
        return ValueText(_expression(document, row), language="UML")
    if type_name in _OF_TIME:
        return _time(document, row)
    if type_name in _INTERVALS:
        return ValueText(_interval(document, row))
    return opaque(document, row)


def opaque(document: Document, row: int) -> ValueText:
    """Body and language of an opaque expression, action or behaviour.

    Of several bodies the first counts whose language is a language of expressions, else the
    first in a natural language, else the first (UML 2.5.1, 8.3.3: they mean the same).
    """
    bodies = _texts(document, row, "body")
    languages = _texts(document, row, "language")
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


def name_of_instance(document: Document, row: int) -> str:
    """Name of a row of the same document."""
    return document.attributes[row].get("name", "")


def _texts(document: Document, row: int, feature: str) -> list[str]:
    attribute = document.attributes[row].get(feature)
    if attribute is not None:
        return [attribute]
    return [document.texts.get(child, "") for child in document.children(row, feature)]


def _literal(type_name: str, text: str) -> AttrValue:
    if type_name == "LiteralBoolean":
        return text == "true"
    if type_name == "LiteralString":
        return text
    if type_name == "LiteralNull":
        return "null"
    try:
        return _number(type_name, text)
    except ValueError:
        return text


def _number(type_name: str, text: str) -> AttrValue:
    if type_name == "LiteralReal":
        return float(text or "0")
    if text in ("*", "-1") and type_name == "LiteralUnlimitedNatural":
        return "*"
    return int(text or "0")


def _time(document: Document, row: int) -> ValueText:
    """A time or duration: what it is, else the observations that it is said of."""
    inner = next(document.children(row, "expr"), None)
    if inner is not None:
        return value_of(document, inner)
    found = (document.ids.get(target) for target in document.targets(row, "observation"))
    return ValueText(", ".join(name_of_instance(document, at) for at in found if at is not None))


def _interval(document: Document, row: int) -> str:
    """``min..max``; the bounds stand inside (MagicDraw), or elsewhere in the file (Papyrus)."""
    bounds = [_bound(document, row, feature) for feature in ("min", "max")]
    return bounds[0] if bounds[0] == bounds[1] else "..".join(bounds)


def _bound(document: Document, row: int, feature: str) -> str:
    for child in document.children(row, feature):
        if document.types[child]:
            return str(value_of(document, child).value)
    for target in document.targets(row, feature):
        at = document.ids.get(target)
        return str(_elsewhere(document, at).value) if at is not None else target
    return ""


def _elsewhere(document: Document, row: int) -> ValueText:
    """A value that an id leads to: only a leaf is read, for the way could lead in a circle."""
    inner = next(document.children(row, "expr"), None)
    if inner is None and document.types[row] in _OF_TIME:
        return _time(document, row)
    leaf = row if inner is None else inner
    return value_of(document, leaf) if document.types[leaf] in _LITERALS else opaque(document, leaf)


def _instance(document: Document, row: int) -> ValueText:
    targets = document.targets(row, "instance")
    hrefs = [document.attributes[c].get("href", "") for c in document.children(row, "instance")]
    target = next((t for t in [*targets, *hrefs] if t), "")
    known = document.ids.get(target)
    name = name_of_instance(document, known) if known is not None else ""
    return ValueText(name or document.attributes[row].get("name", ""), instance=target)


def _expression(document: Document, row: int) -> str:
    """``symbol(operand, ...)``; without a symbol the operands joined (StringExpression)."""
    inside = [*document.children(row, "operand"), *document.children(row, "subExpression")]
    operands = [str(value_of(document, child).value) for child in inside]
    symbol = document.attributes[row].get("symbol", "")
    if not symbol:
        return "".join(operands)
    if len(operands) == 2 and not symbol[:1].isalnum():
        return f"({operands[0]} {symbol} {operands[1]})"
    return f"{symbol}({', '.join(operands)})" if operands else symbol
