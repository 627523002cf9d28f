"""Texts and numbers that a behaviour compares its values with, or gives them."""

from collections.abc import Iterable, Iterator, Mapping

from sysmlc.ir import Element, Graph, Kind
from sysmlc.logic.expressions.enumerations import Enumerations
from sysmlc.patterns import pattern
from sysmlc.values import dataclass

BEHAVIOURS = frozenset([Kind.ACTIVITY, Kind.STATE_MACHINE])
_KEYS = ("guard", "body", "condition", "value")
_TEXT = pattern(r'"((?:[^"\\]|\\.)*)"')
_NAME = r"[^\W\d][\w.]*"
_VALUE = rf"-?\d+(?![\w.])|{_NAME}::\w+"
_AFTER = pattern(rf"({_NAME})\s*(?:==|!=|<=|>=|<|>|:=)\s*({_VALUE})")
_BEFORE = pattern(rf"(?<![\w.:])({_VALUE})\s*(?:==|!=|<=|>=|<|>)\s*({_NAME})")
_GREATEST = 255
"""Numbers further from zero widen no range: a domain has a place for each of its values."""


@dataclass(frozen=True, slots=True)
class Mentioned:
    """Texts of a behaviour in their order, and the numbers beside each name."""

    texts: tuple[str, ...]
    numbers: Mapping[str, tuple[int, ...]]


def mentioned(graph: Graph, behaviour: Element, known: Enumerations) -> Mentioned:
    """What the guards, effects and conditions of a behaviour mention."""
    written = list(_written(graph, behaviour))
    texts = dict.fromkeys(one for text in written for one in _TEXT.findall(text))
    numbers: dict[str, dict[int, None]] = {}
    for name, value in _beside(written):
        number = known.numbers.get(value) if "::" in value else int(value)
        if number is not None and abs(number) <= _GREATEST:
            numbers.setdefault(name, {})[number] = None
    return Mentioned(tuple(texts), {name: tuple(found) for name, found in numbers.items()})


def _written(graph: Graph, behaviour: Element) -> Iterator[str]:
    for one in (behaviour, *graph.subtree(behaviour)):
        for key in _KEYS if one.kind is not Kind.COMMENT else ():
            text = one.attrs.get(key)
            if isinstance(text, str):
                yield text


def _beside(written: Iterable[str]) -> Iterator[tuple[str, str]]:
    for text in written:
        yield from _AFTER.findall(text)
        yield from ((name, value) for value, name in _BEFORE.findall(text))
