"""Comparisons of sums in texts of formulas and sentences, and the features that they name."""

import re
from collections.abc import Iterator

from sysmlc.ir.expressions import Expression, ExpressionError
from sysmlc.logic.expressions.parsing import parse_expression

_OPERAND = r"(?:-\s*)?{atom}(?:\s*[-+*/]\s*{atom})*".format(
    atom=r"(?:\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?:\s*\[[^\]\n]+\])?|[^\W\d]\w*(?:(?:\.|::)[^\W\d]\w*)*)"
)
COMPARISON = re.compile(rf"(?<![\w.]){_OPERAND}\s*(?:<=|>=|==|!=|=|<|>)\s*{_OPERAND}(?![\w.(])")
"""A comparison of sums in a formula or a sentence, without parentheses."""
_CALCULATED = re.compile(
    r"(?<![\w.:])((?:\w|\.|::)*\w)[')\s]*[-+*/%<>=]|[-+*/%<>=][(\s]*([^\W\d](?:\w|\.|::)*)"
)
"""A name beside an operator, in the rest of a formula."""
MAX_LENGTH = 4_000
"""Longest text whose comparisons of numbers are read: the search takes quadratic time."""


def parse_comparison(text: str) -> Expression | None:
    """Return the comparison in a formula, in which ``=`` and ``==`` are the same; None if none."""
    try:
        return parse_expression(text)
    except ExpressionError:
        return None


def iter_calculated_names(text: str) -> Iterator[str]:
    """Yield the names beside operators in what is no comparison of plain sums."""
    for match in _CALCULATED.finditer(COMPARISON.sub(" ", text)):
        yield match[1] or match[2]
