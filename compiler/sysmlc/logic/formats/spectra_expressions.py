"""Types and expressions of Spectra.

Types are ``boolean``, ``{A, B}``, ``Int(0..7)`` and names for them. Expressions have next values,
operators of the past, defines and predicates. Enumerations may share names of literals.
"""

from collections.abc import Callable, Mapping

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain, IntegerDomain
from sysmlc.logic.formula import Const, Formula, Op
from sysmlc.logic.infix import BOOLEAN, FormulaReader, Term
from sysmlc.logic.reduction.history import History
from sysmlc.logic.syntax import (
    ARITHMETIC_SIGNS,
    BOOLEANS,
    COMPARISON_SIGNS,
    CONNECTIVE_SIGNS,
    PRECEDENCE,
    Cursor,
    FormulaError,
    Syntax,
    Token,
)

SYNTAX = Syntax(
    {"!": Op.NOT, "not": Op.NOT},
    {
        **CONNECTIVE_SIGNS,
        "implies": Op.IMPLIES,
        "iff": Op.IFF,
        "and": Op.AND,
        "or": Op.OR,
        **COMPARISON_SIGNS,
        **ARITHMETIC_SIGNS,
    },
    BOOLEANS,
    {"(": ")"},
    # In Spectra "iff" binds more strongly than "implies".
    PRECEDENCE | {Op.IMPLIES: 1, Op.IFF: 2},
    signs=(";", ":", ":=", ",", "{", "}", "[", "]", ".."),
    comment=r"--[^\n]*|//[^\n]*|/\*[\s\S]*?\*/",
)
_PAST_PREFIX = ("PREV", "Y", "ONCE", "O", "HISTORICALLY", "H")
_PAST_INFIX = ("SINCE", "TRIGGERED")

ConstantReader = Callable[[], Term]
"""Reads the bound of a range that is an expression such as the name of a define."""


class TypeReader:
    """Reads types from a cursor; ``named`` are the types that the file defines."""

    def __init__(self, cursor: Cursor) -> None:
        self._cursor = cursor
        self.named: dict[str, Domain] = {}

    def read_type(self, read_constant: ConstantReader) -> Domain:
        """Read a type. Raises FormulaError."""
        cursor = self._cursor
        if cursor.accept("boolean"):
            return BooleanDomain()
        if cursor.accept("{"):
            return self._read_literals()
        if cursor.accept("Int"):
            cursor.expect("(")
            return self.read_range(read_constant, ")")
        name = cursor.expect_kind("name", "a type")
        if name.text not in self.named:
            raise FormulaError(f"'{name.text}' is not a type", name.offset)
        return self.named[name.text]

    def _read_literals(self) -> Domain:
        literals: list[str] = []
        while not literals or self._cursor.accept(","):
            token = self._cursor.next
            if token.kind not in ("name", "number"):
                self._cursor.fail("a value is expected")
            if token.text in literals:
                raise FormulaError(f"'{token.text}' is there twice", token.offset)
            literals.append(self._cursor.take().text)
        self._cursor.expect("}")
        return EnumerationDomain(tuple(literals))

    def read_range(self, read_constant: ConstantReader, end: str) -> IntegerDomain:
        """Read ``0..7`` and the closing bracket after it. Raises FormulaError."""
        offset = self._cursor.next.offset
        low = self._read_bound(read_constant)
        self._cursor.expect("..")
        high = self._read_bound(read_constant)
        self._cursor.expect(end)
        if low > high:
            raise FormulaError(f"the range {low}..{high} is empty", offset)
        return IntegerDomain(low, high)

    def _read_bound(self, read_constant: ConstantReader) -> int:
        token = self._cursor.next
        if token.kind != "name":
            return self._cursor.read_integer()
        term = read_constant()
        if not isinstance(term.formula, Const) or not isinstance(term.formula.value, int):
            raise FormulaError(f"'{token.text}' is not a number", token.offset)
        return term.formula.value


Meaning = Callable[["SpectraReader", Token], Term]
"""Returns the term that a define or predicate means; reads the arguments of a predicate."""


class SpectraReader(FormulaReader):
    """Reads expressions in one scope: parameters hide the names that the file defines."""

    allows_bare_negation = True

    def __init__(
        self,
        cursor: Cursor,
        variables: Mapping[str, Domain],
        history: History,
        parameters: Mapping[str, Term],
        definitions: Mapping[str, Meaning],
        origin: str,
    ) -> None:
        super().__init__(cursor, SYNTAX, variables)
        self.definitions = definitions
        self._history = history
        self._parameters = parameters
        self._origin = origin

    def read_term(self, min_precedence: int) -> Term:
        term = super().read_term(min_precedence)
        while True:
            token = self.cursor.next
            if min_precedence <= PRECEDENCE[Op.UNTIL] and self.cursor.accept(*_PAST_INFIX):
                right = self.read_term(PRECEDENCE[Op.UNTIL] + 1)
                formula = self._build_since(
                    token, self.require_boolean(term), self.require_boolean(right)
                )
            elif min_precedence <= PRECEDENCE[Op.OR] and self.cursor.accept("xor"):
                right = self.read_term(PRECEDENCE[Op.OR] + 1)
                formula = f.negate(f.iff(self.require_boolean(term), self.require_boolean(right)))
            else:
                return term
            term = Term(formula, BOOLEAN, term.offset)
            # The operators of the base class may follow: `a xor b & c`.
            while (op := self._peek_operator(min_precedence)) is not None:
                term = self._read_infix(op, term)

    def _build_since(self, token: Token, left: Formula, right: Formula) -> Formula:
        since = self._history.since
        if token.text == "SINCE":
            return self._track_past(token, since, left, right)
        # "Triggered" is the dual of "since".
        return f.negate(self._track_past(token, since, f.negate(left), f.negate(right)))

    def _track_past(
        self, token: Token, track: Callable[..., Formula], *operands: Formula
    ) -> Formula:
        """Return the history bit for an operator of the past. Raises FormulaError."""
        try:
            return track(*operands, self._origin)
        except ValueError as error:
            raise FormulaError(str(error), token.offset) from None

    def resolve_name(self, token: Token) -> Term:
        if token.text in self._parameters:
            return self._parameters[token.text]
        if token.text == "next" and self.cursor.accept("("):
            term = self.read_term(0)
            self.cursor.expect(")")
            return Term(f.prime(term.formula), term.kind, token.offset)
        if token.text in self.variables:
            return self.build_variable(token, self.cursor.accept("'"))
        if token.text in self.definitions:
            return self.definitions[token.text](self, token)
        if token.text in _PAST_PREFIX:
            return Term(self._read_past(token), BOOLEAN, token.offset)
        return super().resolve_name(token)

    def _read_past(self, token: Token) -> Formula:
        operand = self.require_boolean(self.read_term(PRECEDENCE[Op.NOT]))
        trackers = {
            "P": self._history.previous,
            "Y": self._history.previous,
            "O": self._history.once,
            "H": self._history.historically,
        }
        return self._track_past(token, trackers[token.text[0]], operand)

    def read_arguments(self) -> list[Term]:
        """Read the arguments of a call in parentheses. Raises FormulaError."""
        self.cursor.expect("(")
        if self.cursor.accept(")"):
            return []
        arguments = [self.read_term(0)]
        while self.cursor.accept(","):
            arguments.append(self.read_term(0))
        self.cursor.expect(")")
        return arguments
