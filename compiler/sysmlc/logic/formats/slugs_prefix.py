"""The prefix notation of slugsin: reader of its lines.

Source: slugs, doc/input_formats.md and examples.
"""

from collections.abc import Mapping

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain
from sysmlc.logic.formula import Const, Formula, Var
from sysmlc.logic.infix import DEEPEST
from sysmlc.support.recursion import allow_recursion

_JOINS = {"&": f.both, "|": f.either}


class PrefixError(ValueError):
    """A line that is no formula in prefix notation."""


def from_prefix(line: str, domains: Mapping[str, Domain]) -> Formula:
    """The formula that a line is. Raises PrefixError."""
    reader = _Prefix(line.split(), domains)
    with allow_recursion(DEEPEST):
        found = reader.formula(0)
    if reader.has_more():
        raise PrefixError
    return found


class _Prefix:
    """Reads from the words of a line; what ``$`` remembers is known to what is inside of it."""

    def __init__(self, words: list[str], domains: Mapping[str, Domain]) -> None:
        self._words = words
        self._at = 0
        self._domains = domains
        self._memory: list[Formula] = []

    def has_more(self) -> bool:
        return self._at < len(self._words)

    def _next(self) -> str:
        if not self.has_more():
            raise PrefixError
        return self._words[self._at]

    def _take(self) -> str:
        word = self._next()
        self._at += 1
        return word

    def formula(self, depth: int) -> Formula:
        if depth > DEEPEST:
            raise PrefixError
        word = self._take()
        if word in _JOINS:
            return self._joined(word, depth)
        if word == "^":
            return f.negate(f.iff(self.formula(depth + 1), self.formula(depth + 1)))
        if word == "!":
            return f.negate(self.formula(depth + 1))
        if word in ("$", "?"):
            return self._remembered(word, depth)
        return self._atom(word)

    def _joined(self, word: str, depth: int) -> Formula:
        """All operands of a chain, which has one more than it has operators, however nested."""
        parts: list[Formula] = []
        operators = 1
        while len(parts) <= operators:
            if self._next() == word:
                self._at += 1
                operators += 1
            else:
                parts.append(self.formula(depth + 1))
        return _JOINS[word](*parts)

    def _remembered(self, word: str, depth: int) -> Formula:
        number = self._take()
        if not number.isdecimal() or len(number) > 6:
            raise PrefixError
        if word == "?":
            if int(number) >= len(self._memory):
                raise PrefixError
            return self._memory[int(number)]
        outer, self._memory = self._memory, []
        for _ in range(int(number)):
            self._memory.append(self.formula(depth + 1))
        last = self._memory[-1] if self._memory else f.TRUE
        self._memory = outer
        return last

    def _atom(self, word: str) -> Formula:
        if word in ("0", "1"):
            return Const(word == "1")
        name = word.removesuffix("'")
        if not isinstance(self._domains.get(name), BooleanDomain):
            raise PrefixError
        return Var(name, word != name)
