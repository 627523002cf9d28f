"""Parser of infix formulas by operator precedence; a ``Syntax`` defines operators and spelling.

grammars/ltl.lark specifies the neutral form, and the tests compare this parser with it. The parser
does not run the grammar, because importing Lark and building its tables takes 0.15 s in every run
(decision 22).
"""

from collections.abc import Callable, Iterator, Mapping
from typing import ClassVar, NamedTuple, NoReturn

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Domain, EnumerationDomain
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.identifiers import identifier
from sysmlc.logic.syntax import (
    ARITHMETIC,
    COMPARISONS,
    NEUTRAL,
    ORDERINGS,
    Cursor,
    FormulaError,
    Syntax,
    Token,
    UnknownNameError,
    tokenize,
)
from sysmlc.support.interpreter import allow_recursion
from sysmlc.support.suggestions import find_similar

MAX_DEPTH = 200
"""Most levels of nesting; later steps walk through formulas recursively."""
BOOLEAN, NUMBER, WORD = "boolean", "number", "word"
"""Kinds of terms. A word is a literal whose enumeration is not known yet; a term whose enumeration
is known has the domain as its kind.
"""
Kind = str | EnumerationDomain
_CHAINS: dict[Op, Callable[..., Formula]] = {Op.AND: f.both, Op.OR: f.either}
_FOLDING: dict[Op, Callable[[Formula, Formula], Formula]] = {Op.IMPLIES: f.implies, Op.IFF: f.iff}
_REWRITTEN_FUNCTIONS = {
    "abs": "for 'abs(x) <= 3' write 'x >= -3 & x <= 3'",
    "max": "for 'max(x, y) <= 3' write 'x <= 3 & y <= 3'",
    "min": "for 'min(x, y) <= 3' write 'x <= 3 | y <= 3'",
}
"""Functions that authors use, and the nearest form that is a formula."""


class Term(NamedTuple):
    """A part of a formula, the kind of its value, and the offset where it begins."""

    formula: Formula
    kind: Kind
    offset: int


class FormulaReader:
    """Reads formulas from a cursor; a format overrides what its names and operands mean."""

    accepts_literal_numbers: ClassVar[bool] = False
    """Whether ``door = 1`` means the second literal of the enumeration of ``door``."""

    allows_bare_negation: ClassVar[bool] = False
    """Whether ``a = !b`` needs no parentheses."""

    def __init__(self, cursor: Cursor, syntax: Syntax, variables: Mapping[str, Domain]) -> None:
        self.cursor = cursor
        self.variables = variables
        self._syntax = syntax
        self._depth = 0

    def read_formula(self, min_precedence: int = 0) -> Formula:
        """Read a Boolean formula up to the first operator of a lower precedence.

        Raises FormulaError.
        """
        with allow_recursion(MAX_DEPTH):
            return self.require_boolean(self.read_term(min_precedence))

    def require_boolean(self, term: Term) -> Formula:
        """Return the formula of a term that must be Boolean. Raises FormulaError."""
        if term.kind != BOOLEAN:
            if self.cursor.next.kind in ("name", "number"):
                self.cursor.fail()  # "state is Idle": the operator is the fault
            reason = f"{self.describe(term)} is not Boolean{self._suggest_comparison(term)}"
            raise FormulaError(reason, term.offset)
        return term.formula

    def _suggest_comparison(self, term: Term) -> str:
        """Return the advice to compare a literal that stands where a condition is expected."""
        if isinstance(term.formula, Var):
            domain = self.variables.get(term.formula.name)
            values = () if domain is None else domains.values(domain)
            return f"; compare it: '{term.formula.name}={values[-1]}'" if values else ""
        if term.kind != WORD or not isinstance(term.formula, Const):
            return ""
        literal = str(term.formula.value)
        for name, domain in self.variables.items():
            if domains.contains(domain, literal):
                return f"; did you mean '{name}={literal}'?"
        return ""

    def require_number(self, term: Term) -> Formula:
        """Return the formula of a term that must be a number. Raises FormulaError."""
        if term.kind != NUMBER:
            raise FormulaError(f"{self.describe(term)} is not a number", term.offset)
        return term.formula

    def describe(self, term: Term) -> str:
        """Return the term for messages: its name or value, or else the kind of its value."""
        match term.formula:
            case Var(name) | Const(name):
                return f"'{str(name).lower() if isinstance(name, bool) else name}'"
            case _:
                return {BOOLEAN: "a condition", NUMBER: "a sum"}.get(str(term.kind), "this")

    def read_term(self, min_precedence: int) -> Term:
        """Read a term up to the first operator of a lower precedence. Raises FormulaError."""
        self._depth += 1
        if self._depth > MAX_DEPTH:
            reason = f"it is nested more than {MAX_DEPTH} deep"
            raise FormulaError(reason, self.cursor.next.offset)
        term, depth = self._read_prefix_or_operand(min_precedence), self._depth
        while (op := self._peek_operator(min_precedence)) is not None:
            # Chains of "and" and "or" become one flat formula; others nest at each operator.
            depth += op not in (Op.AND, Op.OR)
            if depth > MAX_DEPTH:
                reason = f"it has more than {MAX_DEPTH} operands"
                raise FormulaError(reason, self.cursor.next.offset)
            term = self._read_infix(op, term)
        self._depth -= 1
        return term

    def _peek_operator(self, min_precedence: int) -> Op | None:
        """Return the infix operator that comes next, unless its precedence is too low."""
        op = self._syntax.find_infix(self.cursor.next)
        is_strong = op is not None and self._syntax.precedence[op] >= min_precedence
        return op if is_strong else None

    def _read_infix(self, op: Op, left: Term) -> Term:
        """Read the operator and its right operand."""
        precedence = self._syntax.precedence[op]
        if op in _CHAINS:
            return self._read_chain(op, precedence, left)
        offset = self.cursor.take().offset
        right = self._read_reserved_literal(op, left)
        right = right or self.read_term(precedence + (op not in self._syntax.right_associative))
        if op in COMPARISONS:
            comparison = self._build_comparison(op, left, right, offset)
            if self._peek_operator(precedence) in COMPARISONS:
                self.cursor.fail()  # a < b < c
            return comparison
        if op in ARITHMETIC:
            formula = f.compare(op, self.require_number(left), self.require_number(right))
            return Term(formula, NUMBER, left.offset)
        operands = self.require_boolean(left), self.require_boolean(right)
        formula = _FOLDING[op](*operands) if op in _FOLDING else Apply(op, operands)
        return Term(formula, BOOLEAN, left.offset)

    def _read_reserved_literal(self, op: Op, left: Term) -> Term | None:
        """Read a literal by its name in the model, if that is a reserved word (``state=X``)."""
        token = self.cursor.next
        if op not in COMPARISONS or not isinstance(left.kind, EnumerationDomain):
            return None
        literal = identifier(token.text)
        if literal == token.text or literal not in left.kind.literals or token.kind != "name":
            return None
        self.cursor.take()
        return Term(Const(literal), left.kind, token.offset)

    def _read_chain(self, op: Op, precedence: int, left: Term) -> Term:
        """Read all operands of a chain of one operator."""
        operands = [self.require_boolean(left)]
        while self._peek_operator(precedence) is op:
            self.cursor.take()
            operands.append(self.require_boolean(self.read_term(precedence + 1)))
        # Flattening after each operand would take quadratic time.
        return Term(_CHAINS[op](*operands), BOOLEAN, left.offset)

    def _build_comparison(self, op: Op, left: Term, right: Term, offset: int) -> Term:
        right = self._convert_to_literal(right, left)
        if isinstance(right.formula, Var):
            left = self._convert_to_literal(left, right)
        if op in ORDERINGS:
            formula = f.compare(op, self.require_number(left), self.require_number(right))
            return Term(formula, BOOLEAN, left.offset)
        if isinstance(left.kind, EnumerationDomain) and isinstance(right.kind, EnumerationDomain):
            return Term(_compare_enumerations(op, left, right), BOOLEAN, left.offset)
        if left.kind != right.kind or left.kind == WORD:
            self._raise_mismatch(left, right, offset)
        return Term(f.compare(op, left.formula, right.formula), BOOLEAN, left.offset)

    def _convert_to_literal(self, term: Term, opposite: Term) -> Term:
        """Return *term* as a literal of the enumeration of *opposite*; unchanged if it is none."""
        if not isinstance(opposite.kind, EnumerationDomain):
            return term
        literals = opposite.kind.literals
        match term.formula:
            case Var(name, False) | Const(str(name)) if name in literals:
                return Term(Const(name), opposite.kind, term.offset)
            case Const(int(index)) if (
                self.accepts_literal_numbers and term.kind == NUMBER and 0 <= index < len(literals)
            ):
                return Term(Const(literals[index]), opposite.kind, term.offset)
            case _:
                return term

    def _raise_mismatch(self, left: Term, right: Term, offset: int) -> NoReturn:
        for value, variable in ((right, left), (left, right)):
            if isinstance(variable.kind, EnumerationDomain):
                values = domains.describe(variable.kind)
                value_text, variable_text = self.describe(value), self.describe(variable)
                reason = f"{value_text} is not a value of {variable_text} ({values})"
                raise FormulaError(reason, value.offset)
        texts = f"{self.describe(left)} and {self.describe(right)}"
        raise FormulaError(f"{texts} cannot be compared", offset)

    def _read_prefix_or_operand(self, min_precedence: int) -> Term:
        token = self.cursor.next
        op = self._syntax.find_prefix(token)
        if op is not None and not (token.kind == "name" and self._is_variable(token)):
            return self._read_prefix(op, min_precedence)
        return self.read_operand()

    def _is_variable(self, token: Token) -> bool:
        """Whether a word that is also an operator, such as ``G``, is a variable or literal here.

        It is if a variable or literal of this name is declared and no operand follows.
        """
        follower = self.cursor.after_next
        is_prefix = self._syntax.find_prefix(follower) is not None
        is_opening = is_prefix or follower.text in self._syntax.brackets
        is_operand = follower.kind in ("name", "number", "string") or is_opening
        is_infix = follower.kind == "name" and self._syntax.find_infix(follower) is not None
        return (not is_operand or is_infix) and self._is_declared(token.text)

    def _is_declared(self, name: str) -> bool:
        """Whether there is a variable or a literal with this name."""
        is_literal = any(domains.contains(domain, name) for domain in self.variables.values())
        return name in self.variables or is_literal

    def _read_prefix(self, op: Op, min_precedence: int) -> Term:
        """Read a prefix operator and its operand."""
        precedence = self._syntax.precedence[op]
        if precedence < min_precedence and not (op is Op.NOT and self.allows_bare_negation):
            self.cursor.fail()
        offset = self.cursor.take().offset
        operand = self.require_boolean(self.read_term(max(precedence, min_precedence)))
        formula = f.negate(operand) if op is Op.NOT else Apply(op, (operand,))
        return Term(formula, BOOLEAN, offset)

    def read_operand(self) -> Term:
        """Read a constant, a name, or a term in brackets. Raises FormulaError."""
        token = self.cursor.next
        if token.text in self._syntax.brackets and token.kind == "sign":
            return self._read_brackets()
        if token.kind == "number" or token.text == "-":
            return Term(Const(self.cursor.read_integer()), NUMBER, token.offset)
        if token.kind == "name":
            self.cursor.take()
            boolean = self._syntax.find_boolean(token)
            if boolean is not None and token.text not in self.variables:
                return Term(Const(boolean), BOOLEAN, token.offset)
            return self.resolve_name(token)
        return self.cursor.fail()

    def _read_brackets(self) -> Term:
        opening = self.cursor.take()
        term = self.read_term(0)
        self.cursor.expect(self._syntax.brackets[opening.text])
        return Term(term.formula, term.kind, opening.offset)

    def resolve_name(self, token: Token) -> Term:
        """Return the variable or literal that *token*, which is consumed already, denotes.

        Raises FormulaError.
        """
        if token.text in self.variables:
            return self.build_variable(token, self.cursor.accept("'"))
        if self._is_declared(token.text):
            return Term(Const(token.text), WORD, token.offset)
        if token.text in _REWRITTEN_FUNCTIONS and self.cursor.next.text == "(":
            advice = f"formulas have no functions: {_REWRITTEN_FUNCTIONS[token.text]}"
            raise FormulaError(advice, token.offset)
        similar = find_similar(token.text, self._iter_words())
        raise UnknownNameError(token.text, similar, token.offset)

    def _iter_words(self) -> Iterator[str]:
        """Yield the names of variables and the literals of enumerations."""
        for name, domain in self.variables.items():
            yield name
            if isinstance(domain, EnumerationDomain):
                yield from domain.literals

    def build_variable(self, token: Token, is_primed: bool) -> Term:
        """Return a variable as a term; primed, it is the variable's value in the next step."""
        kind = kind_of(self.variables[token.text])
        return Term(Var(token.text, is_primed), kind, token.offset)


def kind_of(domain: Domain) -> Kind:
    """Return the kind of the values of a domain."""
    if isinstance(domain, EnumerationDomain):
        return domain
    return BOOLEAN if isinstance(domain, BooleanDomain) else NUMBER


def _compare_enumerations(op: Op, left: Term, right: Term) -> Formula:
    """Compare values of two enumerations by the names of their literals.

    Values of different enumerations are equal if both are the same literal of both enumerations.
    """
    left_literals, right_literals = (getattr(term.kind, "literals", ()) for term in (left, right))
    if left_literals == right_literals:
        return f.compare(op, left.formula, right.formula)
    equality = f.either(
        *(
            f.both(f.eq(left.formula, Const(literal)), f.eq(right.formula, Const(literal)))
            for literal in left_literals
            if literal in right_literals
        )
    )
    return equality if op is Op.EQ else f.negate(equality)


def parse_formula(
    text: str, variables: Mapping[str, Domain], reader_class: type[FormulaReader] = FormulaReader
) -> Formula:
    """Parse a formula in the neutral form, which ``printing`` writes, or in SPIN's spelling.

    A name is a variable, or a literal where an enumeration is compared with it. Raises
    FormulaError with the offset of the fault.
    """
    reader = reader_class(Cursor(tokenize(text, NEUTRAL)), NEUTRAL, variables)
    formula = reader.read_formula()
    reader.cursor.expect_end()
    return formula
