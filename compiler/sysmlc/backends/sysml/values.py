"""Values of features: literals, enumeration literals, quantities, expressions."""

from sysmlc.backends.sysml.book import Book
from sysmlc.backends.sysml.entry import Entry
from sysmlc.backends.sysml.expressions import expression
from sysmlc.backends.sysml.library import quantity_of, unit_name
from sysmlc.backends.sysml.words import string
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.query import generals, type_of
from sysmlc.ir.query.classifiers import unit_of

_NUMBERS = frozenset({"Integer", "Real", "UnlimitedNatural", "Number"})


def value(
    book: Book, scope: Entry | None, feature: Element, holder: Element, key: str = "value"
) -> str:
    """The value that an attribute of ``holder`` gives to a feature; empty when there is none."""
    given = holder.attrs.get(key)
    if given is None and key not in holder.attrs:
        return ""
    instance = book.graph.get(str(holder.attrs.get(f"{key}_instance", "")))
    if instance is not None:
        return book.name(scope, holder, Edge.REFERENCES, instance) or string(instance.name)
    if f"{key}_language" in holder.attrs and isinstance(given, str):
        found = expression(book, scope, given)
        if found is not None:
            return found
    return literal(book, scope, feature, given)


def literal(book: Book, scope: Entry | None, feature: Element, given: AttrValue) -> str:
    """A value as a literal of the feature's type."""
    if isinstance(given, tuple):
        return f"({', '.join(literal(book, scope, feature, one) for one in given)})"
    if given is None:
        return "null"
    if isinstance(given, bool):
        return "true" if given else "false"
    if isinstance(given, int | float):
        return _number(book, scope, feature, given)
    return _text(book, scope, feature, given)


def _number(book: Book, scope: Entry | None, feature: Element, given: float) -> str:
    type_ = type_of(book.graph, feature)
    text = repr(given)
    if text in ("inf", "-inf", "nan"):
        return string(text)
    unit_ = feature.attrs.get("value_unit")
    if isinstance(unit_, str) and unit_.isidentifier():
        return f"{text} [{book.library(scope, f'SI::{unit_}')}]"
    if type_ is None or quantity_of(book.graph, type_) is None:
        return text
    unit = unit_name(unit_of(book.graph, type_))
    return text if unit is None else f"{text} [{book.library(scope, unit)}]"


def _text(book: Book, scope: Entry | None, feature: Element, text: str) -> str:
    type_ = type_of(book.graph, feature)
    for one in () if type_ is None else (type_, *generals(book.graph, type_)):
        if one.kind is Kind.ENUMERATION:
            for enum in book.graph.owned(one):
                if enum.kind is Kind.ENUMERATION_LITERAL and enum.name == text:
                    return book.name(scope, feature, Edge.REFERENCES, enum) or string(text)
        if one.name in _NUMBERS and one.attrs.get("external") and _is_number(text):
            return _number(book, scope, feature, float(text) if "." in text else int(text))
    return string(text)


def _is_number(text: str) -> bool:
    return text.isascii() and text.replace(".", "", 1).isdigit() and not text.endswith(".")
