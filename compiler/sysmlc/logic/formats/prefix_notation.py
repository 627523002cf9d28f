"""Prefix notation of slugsin: ``& a | ! b c'``; ``$ n`` and ``? i`` share subformulas.

``$ n`` stores the n formulas that follow it in a list. Each formula may refer to the i-th entry of
the list as ``? i`` if that precedes it; the value of ``$ n`` is the last formula.

Source: slugs, doc/input_formats.md and examples.
"""

from collections.abc import Mapping

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.infix import MAX_DEPTH
from sysmlc.logic.simplification import rebuild
from sysmlc.support.interpreter import allow_recursion

_CHAINS = {"&": f.both, "|": f.either}
_MAX_INDEX_DIGITS = 6


class PrefixError(ValueError):
    """A line that is not a formula in prefix notation."""


def parse_prefix(line: str, domains: Mapping[str, Domain]) -> Formula:
    """Parse a formula over Boolean variables. Raises PrefixError."""
    reader = _PrefixReader(line.split(), domains)
    with allow_recursion(MAX_DEPTH):
        formula = reader.read_formula(0)
    if reader.has_more():
        raise PrefixError
    return formula


class _PrefixReader:
    """Reads from the words of a line."""

    def __init__(self, words: list[str], domains: Mapping[str, Domain]) -> None:
        self._words = words
        self._index = 0
        self._domains = domains
        self._memory: list[Formula] = []

    def has_more(self) -> bool:
        return self._index < len(self._words)

    def _peek(self) -> str:
        if not self.has_more():
            raise PrefixError
        return self._words[self._index]

    def _take(self) -> str:
        word = self._peek()
        self._index += 1
        return word

    def read_formula(self, depth: int) -> Formula:
        if depth > MAX_DEPTH:
            raise PrefixError
        word = self._take()
        if word in _CHAINS:
            return self._read_chain(word, depth)
        if word == "^":
            left, right = self.read_formula(depth + 1), self.read_formula(depth + 1)
            return f.negate(f.iff(left, right))
        if word == "!":
            return f.negate(self.read_formula(depth + 1))
        if word == "$":
            return self._read_memory(depth)
        if word == "?":
            return self._read_reference()
        return self._read_atom(word)

    def _read_chain(self, word: str, depth: int) -> Formula:
        """Read all operands of nested operators of one kind: one more than there are operators."""
        # A conjunction of n operands nests n - 1 operators; recursion would exceed MAX_DEPTH.
        operands: list[Formula] = []
        operators = 1
        while len(operands) <= operators:
            if self._peek() == word:
                self._take()
                operators += 1
            else:
                operands.append(self.read_formula(depth + 1))
        return _CHAINS[word](*operands)

    def _read_memory(self, depth: int) -> Formula:
        """Read ``$ n`` and its formulas, which cannot refer to entries of an enclosing ``$``."""
        count = self._read_index()
        outer, self._memory = self._memory, []
        for _ in range(count):
            self._memory.append(self.read_formula(depth + 1))
        value = self._memory[-1] if self._memory else f.TRUE
        self._memory = outer
        return value

    def _read_reference(self) -> Formula:
        index = self._read_index()
        if index >= len(self._memory):
            raise PrefixError
        return self._memory[index]

    def _read_index(self) -> int:
        number = self._take()
        if not number.isdecimal() or len(number) > _MAX_INDEX_DIGITS:
            raise PrefixError
        return int(number)

    def _read_atom(self, word: str) -> Formula:
        if word in ("0", "1"):
            return Const(word == "1")
        name = word.removesuffix("'")
        if not isinstance(self._domains.get(name), BooleanDomain):
            raise PrefixError
        return Var(name, word != name)


def eliminate_implications(formula: Formula) -> Formula:
    """Replace ``a -> b`` by ``!a | b``: prefix notation has no implication."""
    match formula:
        case Apply(Op.IMPLIES, (left, right)):
            left, right = eliminate_implications(left), eliminate_implications(right)
            return f.either(f.negate(left), right)
        case Apply(op, args):
            return rebuild(op, tuple(map(eliminate_implications, args)))
        case _:
            return formula


def print_prefix(formula: Formula) -> str:
    """Return a formula over Booleans without implications in prefix notation."""
    match formula:
        case Const(value):
            return "1" if value else "0"
        case Var(name, primed):
            return f"{name}'" if primed else name
        case Apply(op, args):
            return _print_operator(op, [print_prefix(arg) for arg in args])


def _print_operator(op: Op, operands: list[str]) -> str:
    match op:
        case Op.NOT:
            return f"! {operands[0]}"
        case Op.IFF:
            return f"! ^ {operands[0]} {operands[1]}"
        case _:
            return f"{f'{op} ' * (len(operands) - 1)}{' '.join(operands)}"
