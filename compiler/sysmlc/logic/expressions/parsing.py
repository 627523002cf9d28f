"""Parsing of expressions and effects, memoised by text."""

from collections.abc import Callable
from functools import lru_cache
from typing import TypeVar

from sysmlc.logic.expressions.expression import Expression, ExpressionError, Statement

_T = TypeVar("_T")
_DEEPEST = 150
"""Levels of nesting that are read; a tuple of arguments is one."""
_CACHE_SIZE = 4096
"""Texts whose expressions are cached: every pass parses the same guards and ranges."""


@lru_cache(_CACHE_SIZE)
def parse_expression(text: str) -> Expression:
    """Parse an expression. Raises ExpressionError."""
    # The reader imports Lark, which takes 0.1 s, for the first expression of a process.
    from sysmlc.logic.expressions.reader import read_expression

    return _read(text, read_expression)


@lru_cache(_CACHE_SIZE)
def parse_effect(text: str) -> tuple[Statement, ...]:
    """Parse the statements of an effect, which semicolons separate. Raises ExpressionError."""
    from sysmlc.logic.expressions.reader import read_effect

    return _read(text, read_effect)


def _read(text: str, read: Callable[[str], _T]) -> _T:
    try:
        value = read(text)
    except RecursionError:
        raise ExpressionError("the expression is nested too deeply", 0) from None
    # A shorter text cannot be nested so deeply. Functions recurse over the tree.
    if len(text) > _DEEPEST and _is_deep(value):
        raise ExpressionError("the expression is nested too deeply", 0)
    return value


def _is_deep(expression: object) -> bool:
    """Whether more than ``_DEEPEST`` expressions are nested in one another."""
    level = [expression]
    for _ in range(_DEEPEST):
        children = [part for parent in level for part in _list_parts(parent)]
        level = [part for part in children if not isinstance(part, str | int | float | None)]
        if not level:
            return False
    return True


def _list_parts(value: object) -> list[object]:
    if isinstance(value, tuple | list):
        return list(value)
    return [getattr(value, name) for name in getattr(type(value), "__match_args__", ())]
