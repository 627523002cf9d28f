"""Constraints of attributes: bounds and lists of values from expressions, the rest as text."""

import json
import re
from collections.abc import Iterator

from sysmlc.backends.aml import header
from sysmlc.backends.aml.book import Book
from sysmlc.backends.aml.node import Node
from sysmlc.backends.aml.rules import APPROXIMATED
from sysmlc.backends.aml.values import text_of
from sysmlc.ir import Edge, Element, Kind

_BOUNDS = {"<=": "RequiredMaxValue", "==": "RequiredValue", ">=": "RequiredMinValue"}
"""In the order of the schema."""
_TERM = re.compile(r"(?P<name>[^\W\d]\w*|'.*?') (?P<sign><=|>=|==) ", re.DOTALL)
_DECODER = json.JSONDecoder()
_Term = tuple[str, str]


def write(book: Book, subject: Element, node: Node) -> None:
    """Add the constraints that are about an attribute or attribute type."""
    for one in book.graph.sources(subject, Edge.REFERENCES):
        if one.kind is Kind.CONSTRAINT and one.id not in book.said:
            book.say(Edge.REFERENCES, one, subject)
            made = node.add(book.put(one, Node("Constraint", {"Name": one.name})))
            header.write(book, one, made)
            made.add(_scale(book, one, subject.name))


def _scale(book: Book, constraint: Element, name: str) -> Node:
    body = str(constraint.attrs.get("body", ""))
    if constraint.attrs.get("language") == "sysmlc":
        found = _scaled(body, name)
        if found is not None:
            return found
    elif constraint.attrs.get("language"):
        said = f"a constraint in {constraint.attrs['language']}"
        book.losses.note(APPROXIMATED, constraint, said=said, written="text of unknown type")
    node = Node("UnknownType")
    node.say("Requirements", body)
    return node


def _scaled(body: str, name: str) -> Node | None:
    """Bounds, or the values that are allowed; None when the expression says more than that."""
    ordinal = Node("OrdinalScaledType")
    if not body:
        return ordinal
    terms = list(_terms(body, name, " && "))
    signs = [sign for sign, _ in terms]
    if terms and len(set(signs)) == len(signs) and "" not in signs:
        for sign, tag in _BOUNDS.items():
            for text in (text for one, text in terms if one == sign):
                ordinal.say(tag, text)
        return ordinal
    terms = list(_terms(body, name, " || "))
    if not terms or {sign for sign, _ in terms} != {"=="}:
        return None
    nominal = Node("NominalScaledType")
    for _, text in terms:
        nominal.say("RequiredValue", text)
    return nominal


def _terms(body: str, name: str, between: str) -> Iterator[_Term]:
    """Comparisons of the attribute with literals; ("", "") for what is none."""
    at = 0
    while at < len(body):
        found = _TERM.match(body, at)
        if found is None or found["name"].strip("'") != name:
            yield "", ""
            return
        try:
            value, at = _DECODER.raw_decode(body, found.end())
        except ValueError:
            yield "", ""
            return
        yield found["sign"], text_of(value)
        if at < len(body) and not body.startswith(between, at):
            yield "", ""
            return
        at += len(between)
