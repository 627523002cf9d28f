"""Pass ``expressions``: parses the texts of expressions and effects, and resolves their names.

Texts of UML, of AutomationML and of overlays are parsed here. The front end of SysML v2 has already
attached the trees with resolved names; only names of elements that it made of a part of the text,
such as the payload of a trigger, are left. A text in a language that sysmlc does not read stays
without a tree.
"""

from collections.abc import Callable, Iterator
from functools import cache
from typing import ClassVar

from msgspec import Struct

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, Kind
from sysmlc.ir.expressions import ExpressionText, ParsedText
from sysmlc.logic.expressions.parsing import (
    attach_statements,
    attach_tree,
    regroup_negations,
    split_chains,
)
from sysmlc.logic.expressions.resolution import NameResolver

_CONDITIONS = ("guard", "condition")
_VALUES = ("default", "value")
"""Attributes that are expressions only if they have a language."""


class Expressions(Struct, frozen=True):
    """Attach syntax trees with resolved names to the texts of expressions and effects."""

    name: ClassVar[str] = "expressions"
    after: ClassVar[tuple[str, ...]] = ("kept", "overlay", "guards", "behaviours")

    def run(self, graph: Graph, _sink: Sink) -> None:
        """Attach a tree to each text that is an expression or an effect, and resolve its names."""
        # Models repeat guards.
        attach_to_expression, attach_to_effect = cache(attach_tree), cache(attach_statements)
        resolver = NameResolver(graph)
        for element in graph:
            for key in _list_expressions(element):
                _attach(graph, element, key, attach_to_expression)
            if element.kind in (Kind.ACTIVITY, Kind.ACTION):
                _attach(graph, element, "body", attach_to_effect)
            for key, text in element.attrs.items():
                if isinstance(text, ParsedText):
                    tree = resolver.resolve(element, text.tree)
                    if isinstance(text, ExpressionText) and _is_python(element, key):
                        tree = split_chains(regroup_negations(tree))
                    graph.set(element, **{key: type(text)(text, tree)})


def _list_expressions(element: Element) -> Iterator[str]:
    """Yield the attributes of an element that are expressions."""
    yield from _CONDITIONS
    yield from (key for key in _VALUES if f"{key}_language" in element.attrs)
    if element.kind is Kind.PIN:
        yield "value"
    elif element.kind is Kind.CONSTRAINT:
        yield "body"


def _is_python(element: Element, key: str) -> bool:
    """Whether the text of an attribute is written in Python."""
    language = element.attrs.get("language" if key == "body" else f"{key}_language", "")
    return "python" in str(language).lower()


def _attach(graph: Graph, element: Element, key: str, attach: Callable[[str], str]) -> None:
    text = element.attrs.get(key)
    if isinstance(text, str) and not isinstance(text, ParsedText) and text != "else":
        graph.set(element, **{key: attach(text)})
