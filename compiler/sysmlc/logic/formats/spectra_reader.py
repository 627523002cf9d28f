"""Expressions of Spectra: next, the past, defines, predicates, enumerations with common names."""

from collections.abc import Callable, Mapping

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain
from sysmlc.logic.formula import Formula, Op
from sysmlc.logic.infix import TRUTH, Part, Reader
from sysmlc.logic.reduction.history import History
from sysmlc.logic.spelling import (
    COMPARING,
    CONNECTIVES,
    COUNTING,
    STRENGTH,
    TRUTHS,
    Cursor,
    FormulaError,
    Syntax,
    Token,
)

SYNTAX = Syntax(
    {"!": Op.NOT, "not": Op.NOT},
    {
        **CONNECTIVES,
        "implies": Op.IMPLIES,
        "iff": Op.IFF,
        "and": Op.AND,
        "or": Op.OR,
        **COMPARING,
        **COUNTING,
    },
    TRUTHS,
    {"(": ")"},
    STRENGTH | {Op.IMPLIES: 1, Op.IFF: 2},
    (";", ":", ":=", ",", "{", "}", "[", "]", ".."),
    r"--[^\n]*|//[^\n]*|/\*[\s\S]*?\*/",
)
_BEFORE = ("PREV", "Y", "ONCE", "O", "HISTORICALLY", "H")
_SINCE = ("SINCE", "TRIGGERED")
_UNARY = STRENGTH[Op.NOT]
Meaning = Callable[["SpectraReader", Token], Part]
"""What a name means that is no variable: reads the arguments of a call, too."""


class SpectraReader(Reader):
    """Reads with the names of one place: parameters first, then what the file defines."""

    negates_operands = True

    def __init__(
        self,
        cursor: Cursor,
        variables: Mapping[str, Domain],
        history: History,
        local: Mapping[str, Part],
        defined: Mapping[str, Meaning],
        origin: str,
    ) -> None:
        super().__init__(cursor, SYNTAX, variables)
        self.history = history
        self.defined = defined
        self.origin = origin
        self._local = local

    def part(self, weakest: int) -> Part:
        left = super().part(weakest)
        while True:
            token = self.cursor.next
            if weakest <= STRENGTH[Op.UNTIL] and self.cursor.took(*_SINCE):
                right = self.part(STRENGTH[Op.UNTIL] + 1)
                made = self._since(token, self.truth(left), self.truth(right))
            elif weakest <= STRENGTH[Op.OR] and self.cursor.took("xor"):
                right = self.part(STRENGTH[Op.OR] + 1)
                made = f.negate(f.iff(self.truth(left), self.truth(right)))
            else:
                return left
            left = self._continued(Part(made, TRUTH, left.at), weakest)

    def _continued(self, left: Part, weakest: int) -> Part:
        """More operators behind what was joined."""
        while (op := self._operator(weakest)) is not None:
            left = self._applied(op, left)
        return left

    def _since(self, token: Token, left: Formula, right: Formula) -> Formula:
        if token.text == "SINCE":
            return self._past(token, self.history.since, left, right)
        since = self._past(token, self.history.since, f.negate(left), f.negate(right))
        return f.negate(since)

    def _past(self, token: Token, make: Callable[..., Formula], *args: Formula) -> Formula:
        try:
            return make(*args, self.origin)
        except ValueError as error:
            raise FormulaError(str(error), token.at) from None

    def word(self, token: Token) -> Part:
        if token.text in self._local:
            return self._local[token.text]
        if token.text == "next" and self.cursor.has("("):
            self.cursor.expect("(")
            inner = self.part(0)
            self.cursor.expect(")")
            return Part(f.primed(inner.formula), inner.kind, token.at)
        if token.text in self.variables:
            return self.variable(token, self.cursor.took("'"))
        if token.text in self.defined:
            return self.defined[token.text](self, token)
        if token.text in _BEFORE:
            return Part(self._before(token), TRUTH, token.at)
        return super().word(token)

    def _before(self, token: Token) -> Formula:
        inner = self.truth(self.part(_UNARY))
        make = {"P": self.history.previous, "Y": self.history.previous, "O": self.history.once}
        return self._past(token, make.get(token.text[0], self.history.historically), inner)

    def arguments(self) -> list[Part]:
        """The arguments of a call, in parentheses."""
        self.cursor.expect("(")
        if self.cursor.took(")"):
            return []
        found = [self.part(0)]
        while self.cursor.took(","):
            found.append(self.part(0))
        self.cursor.expect(")")
        return found
