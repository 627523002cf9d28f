"""Formulas in infix notation, read by precedence; tables say how a language spells them.

grammars/ltl.lark is the grammar of the neutral spelling; the tests hold this reader against it
(decision 22: to import Lark and to build its tables takes 0.15 s in every run).
"""

from collections.abc import Callable, Mapping
from typing import ClassVar, NamedTuple, NoReturn

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.spelling import (
    ARITHMETIC,
    COMPARISONS,
    ORDERS,
    Cursor,
    FormulaError,
    Syntax,
    Token,
)
from sysmlc.support.recursion import allow_recursion

DEEPEST = 200
"""Levels of nesting that are read: what comes after walks through formulas by recursion."""
TRUTH, NUMBER, WORD = "truth", "number", "word"
"""Kinds of operands; the kind of an enumeration's values is its domain."""
Kind = str | EnumerationDomain


class Part(NamedTuple):
    """Part of a formula, what kind of value it has, and where it begins."""

    formula: Formula
    kind: Kind
    at: int


class Reader:
    """Reads formulas from a cursor; a language with more to an operand overrides ``word``."""

    counts_literals: ClassVar[bool] = False
    """Whether a number names the literal of an enumeration in that place, from 0."""

    negates_operands: ClassVar[bool] = False
    """Whether ``a = !b`` needs no parentheses."""

    def __init__(self, cursor: Cursor, syntax: Syntax, variables: Mapping[str, Domain]) -> None:
        self.cursor = cursor
        self.variables = variables
        self._syntax = syntax
        self._depth = 0

    def formula(self, weakest: int = 0) -> Formula:
        """The formula that comes next, which is true or false, and joined by no weaker operator.

        Raises FormulaError.
        """
        with allow_recursion(DEEPEST):
            return self.truth(self.part(weakest))

    def truth(self, part: Part) -> Formula:
        """The part's formula, which must be true or false. Raises FormulaError."""
        if part.kind != TRUTH:
            raise FormulaError(f"{self.told(part)} is not Boolean", part.at)
        return part.formula

    def number(self, part: Part) -> Formula:
        """The part's formula, which must be a number. Raises FormulaError."""
        if part.kind != NUMBER:
            raise FormulaError(f"{self.told(part)} is not a number", part.at)
        return part.formula

    def told(self, part: Part) -> str:
        """The part as messages call it."""
        match part.formula:
            case Var(name) | Const(name):
                return f"'{str(name).lower() if isinstance(name, bool) else name}'"
            case _:
                return {TRUTH: "a condition", NUMBER: "a sum"}.get(str(part.kind), "this")

    def part(self, weakest: int) -> Part:
        """What comes next, as far as its operators bind as strongly or more."""
        self._depth += 1
        if self._depth > DEEPEST:
            raise FormulaError(f"it is nested more than {DEEPEST} deep", self.cursor.next.at)
        left, steps = self._operand(weakest), 0
        while (op := self._operator(weakest)) is not None:
            steps += op not in (Op.AND, Op.OR)
            if self._depth + steps > DEEPEST:
                raise FormulaError(f"it has more than {DEEPEST} operands", self.cursor.next.at)
            left = self._applied(op, left)
        self._depth -= 1
        return left

    def _operator(self, weakest: int) -> Op | None:
        token = self.cursor.next
        if token.kind not in ("sign", "name"):
            return None
        op = self._syntax.infix.get(token.text)
        return op if op is not None and self._syntax.strength[op] >= weakest else None

    def _applied(self, op: Op, left: Part) -> Part:
        own = self._syntax.strength[op]
        if op in _GATHERED:
            return self._gathered(op, own, left)
        at = self.cursor.take().at
        right = self.part(own + (op not in self._syntax.from_the_right))
        if op in COMPARISONS:
            made = self._compared(op, left, right, at)
            if (further := self._operator(own)) in COMPARISONS and further is not None:
                self.cursor.fail()
            return made
        if op in ARITHMETIC:
            return Part(f.compare(op, self.number(left), self.number(right)), NUMBER, left.at)
        return Part(_joined(op, self.truth(left), self.truth(right)), TRUTH, left.at)

    def _gathered(self, op: Op, own: int, left: Part) -> Part:
        """All operands of a chain at once: one after the other would take the square of it."""
        found = [self.truth(left)]
        while self._operator(own) is op:
            self.cursor.take()
            found.append(self.truth(self.part(own + 1)))
        return Part(_GATHERED[op](*found), TRUTH, left.at)

    def _compared(self, op: Op, left: Part, right: Part, at: int) -> Part:
        right = self._as_literal(right, left)
        left = self._as_literal(left, right) if right.formula.__class__ is Var else left
        if op in ORDERS:
            return Part(f.compare(op, self.number(left), self.number(right)), TRUTH, left.at)
        if isinstance(left.kind, EnumerationDomain) and isinstance(right.kind, EnumerationDomain):
            return Part(_of_enumerations(op, left, right), TRUTH, left.at)
        if left.kind != right.kind or left.kind == WORD:
            self._mismatch(left, right, at)
        return Part(f.compare(op, left.formula, right.formula), TRUTH, left.at)

    def _as_literal(self, part: Part, other: Part) -> Part:
        """A name that the enumeration on the other side has is a literal of it."""
        if not isinstance(other.kind, EnumerationDomain):
            return part
        match part.formula, other.kind:
            case ((Var(name, False) | Const(str(name))), EnumerationDomain(literals)) if (
                name in literals
            ):
                return Part(Const(name), other.kind, part.at)
            case Const(int(index)), EnumerationDomain(literals) if (
                self.counts_literals and part.kind == NUMBER and 0 <= index < len(literals)
            ):
                return Part(Const(literals[index]), other.kind, part.at)
            case _:
                return part

    def _mismatch(self, left: Part, right: Part, at: int) -> NoReturn:
        for one, other in ((right, left), (left, right)):
            if isinstance(other.kind, EnumerationDomain):
                values = domains.describe(other.kind)
                reason = f"{self.told(one)} is no value of {self.told(other)} ({values})"
                raise FormulaError(reason, one.at)
        raise FormulaError(f"{self.told(left)} and {self.told(right)} cannot be compared", at)

    def _operand(self, weakest: int) -> Part:
        token = self.cursor.next
        op = self._syntax.prefix.get(token.text) if token.kind in ("sign", "name") else None
        if op is not None and not (token.kind == "name" and self._is_name(token)):
            return self._prefixed(op, weakest)
        return self.operand()

    def _is_name(self, token: Token) -> bool:
        """Whether a variable is meant that is called like an operator: nothing follows it."""
        behind = self.cursor.after_next
        opens = behind.text in self._syntax.prefix or behind.text in self._syntax.brackets
        is_operand = behind.kind in ("name", "number", "string") or opens
        is_infix = behind.kind == "name" and behind.text in self._syntax.infix
        return token.text in self.variables and (not is_operand or is_infix)

    def _prefixed(self, op: Op, weakest: int) -> Part:
        own = self._syntax.strength[op]
        if own < weakest and not (op is Op.NOT and self.negates_operands):
            self.cursor.fail()
        at = self.cursor.take().at
        inner = self.truth(self.part(max(own, weakest)))
        return Part(f.negate(inner) if op is Op.NOT else Apply(op, (inner,)), TRUTH, at)

    def operand(self) -> Part:
        """A value, a name, or something in brackets."""
        token = self.cursor.next
        if token.text in self._syntax.brackets and token.kind == "sign":
            return self._bracketed()
        if token.kind == "number" or token.text == "-":
            return Part(Const(self.cursor.integer()), NUMBER, token.at)
        if token.kind == "name":
            self.cursor.take()
            if token.text in self._syntax.truths:
                return Part(Const(self._syntax.truths[token.text]), TRUTH, token.at)
            return self.word(token)
        return self.cursor.fail()

    def _bracketed(self) -> Part:
        opening = self.cursor.take()
        inner = self.part(0)
        self.cursor.expect(self._syntax.brackets[opening.text])
        return Part(inner.formula, inner.kind, opening.at)

    def word(self, token: Token) -> Part:
        """What a name means that was just read."""
        if token.text in self.variables:
            return self.variable(token, self.cursor.took("'"))
        if any(domains.contains(domain, token.text) for domain in self.variables.values()):
            return Part(Const(token.text), WORD, token.at)
        raise FormulaError(f"'{token.text}' is neither a variable nor a literal", token.at)

    def variable(self, token: Token, is_primed: bool) -> Part:
        """A variable, now or in the next step."""
        return Part(Var(token.text, is_primed), kind_of(self.variables[token.text]), token.at)


def kind_of(domain: Domain) -> Kind:
    """The kind of the values of a domain."""
    if isinstance(domain, EnumerationDomain):
        return domain
    return TRUTH if isinstance(domain, BooleanDomain) else NUMBER


def _of_enumerations(op: Op, left: Part, right: Part) -> Formula:
    """A comparison of two; when they have different literals, by those that both have."""
    literals = [getattr(part.kind, "literals", ()) for part in (left, right)]
    if literals[0] == literals[1]:
        return f.compare(op, left.formula, right.formula)
    same = f.either(
        *(
            f.both(f.eq(left.formula, Const(one)), f.eq(right.formula, Const(one)))
            for one in literals[0]
            if one in literals[1]
        )
    )
    return same if op is Op.EQ else f.negate(same)


_GATHERED: dict[Op, Callable[..., Formula]] = {Op.AND: f.both, Op.OR: f.either}
_JOINS: dict[Op, Callable[[Formula, Formula], Formula]] = {Op.IMPLIES: f.implies, Op.IFF: f.iff}


def _joined(op: Op, left: Formula, right: Formula) -> Formula:
    return _JOINS[op](left, right) if op in _JOINS else Apply(op, (left, right))
