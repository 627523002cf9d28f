"""Expressions of Spectra.

They have next values, operators of the past, defines, predicates, quantifiers over the values of a
type, and elements of arrays. Enumerations may share names of literals.
"""

from collections.abc import Callable, Collection, Iterable, Mapping
from itertools import product

from msgspec import Struct

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import Domain
from sysmlc.logic.evaluate import value_of
from sysmlc.logic.formula import Const, Formula, Op, Var
from sysmlc.logic.infix import BOOLEAN, NUMBER, FormulaReader, Term, kind_of
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
    signs=(";", ":", ":=", ",", "{", "}", "[", "]", ".", ".."),
    comment=r"--[^\n]*|//[^\n]*|/\*[\s\S]*?\*/",
)
_PAST_PREFIX = ("PREV", "Y", "ONCE", "O", "HISTORICALLY", "H")
_PAST_INFIX = ("SINCE", "S", "TRIGGERED", "T")
_MAX_CASES = 4_096
"""Most combinations of values of the indexes of one array element."""

Meaning = Callable[["SpectraReader", Token], Term]
"""Returns the term that a define or predicate means; reads the arguments of a predicate."""


class Array(Struct, frozen=True):
    """An array: the sizes of its dimensions, and the meaning of each element by its indexes."""

    dimensions: tuple[int, ...]
    elements: Mapping[tuple[int, ...], Meaning]


class Parameter(Struct, frozen=True):
    """A parameter of a predicate or pattern."""

    name: str
    is_array: bool = False


class Scope(Struct, frozen=True):
    """What names mean where an expression stands, and what all expressions of a file share."""

    variables: Mapping[str, Domain]
    definitions: Mapping[str, Meaning]
    arrays: Mapping[str, Array]
    patterns: Collection[str]
    """Names of patterns, which are statements and no parts of formulas."""
    history: History
    read_type: Callable[[], Domain]
    choices: dict[str, tuple[tuple[Formula, Formula], ...]]
    """Values that depend on conditions, such as ``a[x]``: pairs of condition and value, by the name
    of a variable that stands for the value until its comparison is complete."""
    count_expansion: Callable[[str, Token], None]
    """Counts an expansion; raises FormulaError with this reason at this token above a limit."""


class SpectraReader(FormulaReader):
    """Reads expressions in one scope: parameters hide the names that the file defines."""

    allows_bare_negation = True

    def __init__(
        self, cursor: Cursor, scope: Scope, parameters: Mapping[str, Term], origin: str
    ) -> None:
        super().__init__(cursor, SYNTAX, scope.variables)
        self.scope = scope
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
            elif min_precedence <= PRECEDENCE[Op.EQ] and self._is_membership():
                formula = self._read_membership(term)
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
        since = self.scope.history.since
        if token.text in ("SINCE", "S"):
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

    def _is_membership(self) -> bool:
        cursor = self.cursor
        return cursor.is_next("in") or (cursor.is_next("not") and cursor.after_next.text == "in")

    def _read_membership(self, term: Term) -> Formula:
        """Read ``in {A, B}``, ``in {1, 3-5}`` or ``not in {..}`` after a term."""
        is_negated = self.cursor.accept("not")
        offset = self.cursor.take().offset
        self.cursor.expect("{")
        equalities: list[Formula] = []
        while not equalities or self.cursor.accept(","):
            for value in self._read_listed_values():
                equalities.append(self._build_comparison(Op.EQ, term, value, offset).formula)
        self.cursor.expect("}")
        membership = f.either(*equalities)
        return f.negate(membership) if is_negated else membership

    def _read_listed_values(self) -> Iterable[Term]:
        low = self.read_operand()
        if not self.cursor.accept("-"):
            return [low]
        high = self.cursor.read_integer()
        first = value_of(self.require_number(low), {})
        return [Term(Const(value), NUMBER, low.offset) for value in range(int(first), high + 1)]

    def _build_comparison(self, op: Op, left: Term, right: Term, offset: int) -> Term:
        comparison = super()._build_comparison(op, left, right, offset)
        return Term(self._insert_choices(comparison.formula), BOOLEAN, comparison.offset)

    def resolve_name(self, token: Token) -> Term:
        if token.text in self._parameters:
            return self._parameters[token.text]
        if token.text in self.scope.arrays:
            return self._read_array(token, self.scope.arrays[token.text])
        if token.text in self.variables:
            return self.build_variable(token, self.cursor.accept("'"))
        if token.text in self.scope.patterns:
            reason = f"'{token.text}' is a pattern, which is a statement and no part of a formula"
            advice = f"write 'guarantee {token.text}(...);' without G"
            raise FormulaError(f"{reason}; {advice}", token.offset)
        if token.text in self.scope.definitions:
            return self.scope.definitions[token.text](self, token)
        read_operator = _OPERATOR_READERS.get(token.text)
        return read_operator(self, token) if read_operator else super().resolve_name(token)

    def _read_next(self, token: Token) -> Term:
        self.cursor.expect("(")
        term = self.read_term(0)
        self.cursor.expect(")")
        return Term(f.prime(term.formula), term.kind, token.offset)

    def _read_past(self, token: Token) -> Term:
        operand = self.require_boolean(self.read_term(PRECEDENCE[Op.NOT]))
        history = self.scope.history
        # PREV next(a) is about the step that ended now.
        previous = history.last_step if f.has_primes(operand) else history.previous
        trackers = {
            "P": previous,
            "Y": previous,
            "O": history.once,
            "H": history.historically,
        }
        formula = self._track_past(token, trackers[token.text[0]], operand)
        return Term(formula, BOOLEAN, token.offset)

    # -- quantifiers, arrays and case distinctions -------------------------------------------------

    def _read_quantifier(self, token: Token) -> Term:
        """Read ``i in Int(0..3). body``; the body is read once for each value of the type."""
        name = self.cursor.expect_kind("name", "a name").text
        self.cursor.expect("in")
        domain = self.scope.read_type()
        self.cursor.expect(".")
        body, outer_parameters = self.cursor.mark(), self._parameters
        parts: list[Formula] = []
        for value in domains.values(domain):
            self.scope.count_expansion("the quantifiers are too large", token)
            self.cursor.reset(body)
            constant = Term(Const(value), kind_of(domain), token.offset)
            self._parameters = {**outer_parameters, name: constant}
            parts.append(self.require_boolean(self.read_term(0)))
        self._parameters = outer_parameters
        formula = f.both(*parts) if token.text == "forall" else f.either(*parts)
        return Term(formula, BOOLEAN, token.offset)

    def _read_array(self, token: Token, array: Array) -> Term:
        """Read the indexes of an element, or ``.sum`` and the like, after the name of an array."""
        if self.cursor.accept("."):
            return self._read_reduction(token, array)
        positions: list[list[tuple[Formula, int]]] = []
        for size in array.dimensions:
            self.cursor.expect("[")
            positions.append(self._read_index(size))
            self.cursor.expect("]")
        combinations = list(product(*positions))
        if len(combinations) > _MAX_CASES:
            raise FormulaError(f"'{token.text}' has too many possible indexes", token.offset)
        cases = [
            (
                f.both(*(condition for condition, _ in combination)),
                array.elements[tuple(index for _, index in combination)](self, token),
            )
            for combination in combinations
        ]
        return cases[0][1] if len(cases) == 1 else self._choose(cases)

    def _read_index(self, size: int) -> list[tuple[Formula, int]]:
        """Read an index; return its possible values, each with the condition for it.

        No condition holds where the value of the index is outside of the array.
        """
        offset = self.cursor.next.offset
        term = self.read_term(0)
        index = self.require_number(term)
        if not f.variables(index):
            value = int(value_of(index, {}))
            if not 0 <= value < size:
                raise FormulaError(f"the index {value} is not below {size}", offset)
            return [(f.TRUE, value)]
        values = [Term(Const(value), NUMBER, offset) for value in range(size)]
        return [
            (self._build_comparison(Op.EQ, term, value, offset).formula, number)
            for number, value in enumerate(values)
        ]

    def _read_reduction(self, token: Token, array: Array) -> Term:
        word = self.cursor.expect("all", "any", "sum", "prod", "min", "max").text
        elements = [meaning(self, token) for meaning in array.elements.values()]
        if word in ("all", "any"):
            parts = [self.require_boolean(element) for element in elements]
            return Term((f.both if word == "all" else f.either)(*parts), BOOLEAN, token.offset)
        if word in ("min", "max"):
            op = Op.LE if word == "min" else Op.GE
            return self._choose(
                [
                    (f.both(*(self._compare(op, element, other) for other in elements)), element)
                    for element in elements
                ]
            )
        result = self.require_number(elements[0])
        for element in elements[1:]:
            operands = (result, self.require_number(element))
            result = f.compare(Op.ADD if word == "sum" else Op.MUL, *operands)
        return Term(result, NUMBER, token.offset)

    def _compare(self, op: Op, left: Term, right: Term) -> Formula:
        return self._build_comparison(op, left, right, left.offset).formula

    def _read_case_distinction(self, token: Token) -> Term:
        arguments = self.read_arguments()
        terms = [argument for argument in arguments if isinstance(argument, Term)]
        if len(arguments) != 3 or len(terms) != 3:
            raise FormulaError("'ite' takes three arguments that are no arrays", token.offset)
        condition = self.require_boolean(terms[0])
        return self._choose([(condition, terms[1]), (f.negate(condition), terms[2])])

    def _choose(self, cases: list[tuple[Formula, Term]]) -> Term:
        """Return the value of the first case whose condition holds."""
        kind, offset = cases[0][1].kind, cases[0][1].offset
        if kind == BOOLEAN:
            parts = [f.both(condition, self.require_boolean(term)) for condition, term in cases]
            return Term(f.either(*parts), BOOLEAN, offset)
        name = f"?{len(self.scope.choices)}"
        self.scope.choices[name] = tuple((condition, term.formula) for condition, term in cases)
        return Term(Var(name), kind, offset)

    def _insert_choices(self, atom: Formula) -> Formula:
        """Replace values that depend on conditions: ``a[x]=3`` is ``x=0 & a_0=3 | ..``."""
        choice = next((var for var in f.variables(atom) if var.name in self.scope.choices), None)
        if choice is None:
            return atom
        cases: list[Formula] = []
        for condition, value in self.scope.choices[choice.name]:
            if choice.primed:
                condition, value = f.prime(condition), f.prime(value)
            cases.append(f.both(condition, self._insert_choices(_replace(atom, choice, value))))
        return f.either(*cases)

    def read_arguments(self) -> list[Term | Array]:
        """Read the arguments of a call in parentheses. Raises FormulaError."""
        self.cursor.expect("(")
        if self.cursor.accept(")"):
            return []
        arguments = [self._read_argument()]
        while self.cursor.accept(","):
            arguments.append(self._read_argument())
        self.cursor.expect(")")
        return arguments

    def _read_argument(self) -> Term | Array:
        """Read a term, or the name of a whole array."""
        cursor = self.cursor
        if cursor.next.text in self.scope.arrays and cursor.after_next.text in (",", ")"):
            return self.scope.arrays[cursor.take().text]
        return self.read_term(0)


_OPERATOR_READERS: dict[str, Callable[[SpectraReader, Token], Term]] = {
    "next": SpectraReader._read_next,
    "ite": SpectraReader._read_case_distinction,
    **dict.fromkeys(("forall", "exists"), SpectraReader._read_quantifier),
    **dict.fromkeys(_PAST_PREFIX, SpectraReader._read_past),
}
"""Reads what follows an operator that is written like a function."""


def _replace(formula: Formula, variable: Var, value: Formula) -> Formula:
    """Return the formula with a value in place of a variable."""
    return f.replace_leaves(formula, lambda leaf: value if leaf == variable else leaf)
