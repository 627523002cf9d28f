"""Pass ``expressions``: parses the texts of expressions and effects, each text once.

Texts of UML, of AutomationML and of overlays are parsed here. The front end of SysML v2 has already
attached the trees. A text in a language that sysmlc does not read stays without a tree.
"""

from collections.abc import Callable, Iterator
from functools import cache
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.expressions import ParsedText
from sysmlc.logic.expressions.parsing import attach_statements, attach_tree

_CONDITIONS = ("guard", "condition")
_VALUES = ("default", "value")
"""Attributes that are expressions only if they have a language."""


class Expressions(Struct, frozen=True):
    """Attach syntax trees to the texts of expressions and effects."""

    name: ClassVar[str] = "expressions"
    after: ClassVar[tuple[str, ...]] = ("kept", "overlay", "guards", "behaviours")

    def run(self, graph: Graph, _sink: Sink) -> None:
        """Attach a tree to each text that has none and is an expression or an effect."""
        # Models repeat guards, and equal texts share their tree.
        attach_to_expression, attach_to_effect = cache(attach_tree), cache(attach_statements)
        for element in graph:
            for key in _list_expressions(element):
                _attach(graph, element, key, attach_to_expression)
            if element.kind in (Kind.ACTIVITY, Kind.ACTION):
                _attach(graph, element, "body", attach_to_effect)


def _list_expressions(element: Element) -> Iterator[str]:
    """Yield the attributes of an element that are expressions."""
    yield from _CONDITIONS
    yield from (key for key in _VALUES if f"{key}_language" in element.attrs)
    if element.kind is Kind.PIN:
        yield "value"
    elif element.kind is Kind.CONSTRAINT:
        yield "body"


def _attach(graph: Graph, element: Element, key: str, attach: Callable[[str], str]) -> None:
    text = element.attrs.get(key)
    if isinstance(text, str) and not isinstance(text, ParsedText) and text != "else":
        graph.set(element, **{key: attach(text)})
