"""Texts and numbers that a behaviour compares its values with, or gives them."""

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache

from msgspec import Struct

from sysmlc.ir import Element, Graph, Kind
from sysmlc.logic.expressions.enumerations import Enumerations

BEHAVIOURS = frozenset([Kind.ACTIVITY, Kind.STATE_MACHINE])
_KEYS = ("guard", "body", "condition", "value")
_TEXT = re.compile(r'"((?:[^"\\]|\\.)*)"')
_NAME = r"[^\W\d][\w.]*"
_VALUE = rf"-?\d+(?![\w.])|{_NAME}::\w+"
_AFTER = re.compile(rf"({_NAME})\s*(?:==|!=|<=|>=|<|>|:=)\s*({_VALUE})")
_BEFORE = re.compile(rf"(?<![\w.:])({_VALUE})\s*(?:==|!=|<=|>=|<|>)\s*({_NAME})")
_REMEMBERED = 4096
"""Texts that are kept: the same guards come again and again."""
_GREATEST = 255
"""Numbers further from zero widen no range: a domain has a place for each of its values."""


class Mentioned(Struct, frozen=True):
    """Texts of a behaviour in their order, and the numbers beside each name."""

    texts: tuple[str, ...]
    numbers: Mapping[str, tuple[int, ...]]


def mentioned(graph: Graph, behaviour: Element, known: Enumerations) -> Mentioned:
    """What the guards, effects and conditions of a behaviour mention."""
    found = [_said(text) for text in _written(graph, behaviour)]
    texts = dict.fromkeys(one for said, _ in found for one in said)
    numbers: dict[str, dict[int, None]] = {}
    for name, value in (pair for _, beside in found for pair in beside):
        number = known.number(value) if "::" in value else int(value)
        if number is not None and abs(number) <= _GREATEST:
            numbers.setdefault(name, {})[number] = None
    return Mentioned(tuple(texts), {name: tuple(some) for name, some in numbers.items()})


def _written(graph: Graph, behaviour: Element) -> Iterator[str]:
    for one in graph.subtree(behaviour):
        for key in _KEYS if one.kind is not Kind.COMMENT else ():
            text = one.attrs.get(key)
            if isinstance(text, str):
                yield text


@lru_cache(_REMEMBERED)
def _said(text: str) -> tuple[tuple[str, ...], tuple[tuple[str, str], ...]]:
    """Texts in an expression, and names with the numbers and literals beside them."""
    before = ((name, value) for value, name in _BEFORE.findall(text))
    return tuple(_TEXT.findall(text)), (*_AFTER.findall(text), *before)
