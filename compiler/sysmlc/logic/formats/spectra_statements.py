"""Assumptions, guarantees, patterns, counters and types of Spectra.

Types are ``boolean``, ``{A, B}``, ``Int(0..7)``, arrays of them and names for them.
"""

from collections.abc import Callable, Mapping
from graphlib import CycleError, TopologicalSorter
from itertools import product

from msgspec import Struct

from sysmlc.logic import domains
from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
)
from sysmlc.logic.evaluate import value_of
from sysmlc.logic.formats.draft import ContractDraft, SpecificationFile
from sysmlc.logic.formats.spectra_expressions import (
    SYNTAX,
    Array,
    Meaning,
    Parameter,
    Scope,
    SpectraReader,
)
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.infix import NUMBER, Term, kind_of
from sysmlc.logic.reduction.history import History
from sysmlc.logic.syntax import Cursor, FormulaError, Token, tokenize
from sysmlc.support.counts import count

_CLASSES = {
    **dict.fromkeys(("G", "alw", "always", "trans"), Class.SAFETY),
    **dict.fromkeys(("GF", "alwEv", "alwaysEventually"), Class.LIVENESS),
    **dict.fromkeys(("ini", "initially"), Class.INIT),
}
_UNSUPPORTED_STATEMENTS = ("GE", "GEF", "trig")
_SUM_PRECEDENCE = SYNTAX.precedence[Op.ADD]
_MAX_EXPANSIONS = 20_000
"""Most expansions of defines, predicates, patterns and quantifiers in one file."""
_TOO_MANY = (
    f"with '{{}}', more than {_MAX_EXPANSIONS:,} texts of defines, predicates and quantifiers are "
    "inserted; declare a variable for one that is used often"
)
_MAX_DEPTH = 50
"""Most levels of predicates that use one another."""

_END_STEPS: dict[str, Callable[[Formula, Formula, Formula], Formula]] = {
    "keep": lambda following, end, other_end: f.eq(following, end),
    "modulo": lambda following, end, other_end: f.eq(following, other_end),
    "false": lambda following, end, other_end: f.FALSE,
}


_NO_ARRAYS: Mapping[str, Array] = {}


class Pattern(Struct, frozen=True):
    """A pattern: its parameters, and the position where its body begins."""

    parameters: tuple[Parameter, ...]
    body: int


class StatementReader:
    """Reads statements of a module whose names are declared."""

    def __init__(self, file: SpecificationFile) -> None:
        self._draft = ContractDraft(file, "Spectra")
        self._cursor = Cursor(tokenize(file.text, SYNTAX))
        self._types = TypeReader(self._cursor, self._read_constant)
        self._definitions: dict[str, Meaning] = {}
        self._arrays: dict[str, Array] = {}
        self._patterns: dict[str, Pattern] = {}
        self._history = History(())
        self._choices: dict[str, tuple[tuple[Formula, Formula], ...]] = {}
        self._define_marks: dict[str, int] = {}
        """Where the body of each define begins."""
        self._defines: dict[int, Term] = {}
        """Terms of defines by the positions of their bodies."""
        self._sizes: dict[int, int] = {}
        """For each of these terms the number of bodies in it; a body counts at each use."""
        self._expansions = 0
        self._depth = 0

    def _read_constant(self) -> Term:
        return self._create_reader({}, self._cursor.next.offset).read_term(_SUM_PRECEDENCE)

    def _create_predicate_meaning(self, body: int, parameters: tuple[Parameter, ...]) -> Meaning:
        """Return a function that expands a predicate with the arguments of its use."""

        def expand(reader: SpectraReader, token: Token) -> Term:
            terms, arrays = _bind(parameters, reader.read_arguments(), token)
            self._count_expansion(_TOO_MANY.format(token.text), token)
            return self._read_body(token, body, terms, arrays)

        return expand

    def _create_define_meaning(self, body: int) -> Meaning:
        """Return a function that returns the term of a define, or of an element of an array."""

        def expand(_reader: SpectraReader, token: Token) -> Term:
            pending = [] if body in self._defines else self._order_bodies(body, token)
            if self._depth == 0:
                self._count_expansion(_TOO_MANY.format(token.text), token, self._sizes[body])
            for inner in pending:
                self._defines[inner] = self._read_body(token, inner, {}, {})
            term = self._defines[body]
            return Term(term.formula, term.kind, token.offset)

        return expand

    def _order_bodies(self, body: int, token: Token) -> list[int]:
        """Return *body* and the bodies of the defines that it uses, each after those it uses.

        In this order a chain of defines of any length is read without recursion. Raises
        FormulaError for a define that uses itself.
        """
        used: dict[int, list[int]] = {}
        pending = [body]
        while pending:
            current = pending.pop()
            if current not in used and current not in self._defines:
                used[current] = [
                    self._define_marks[name]
                    for name in self._cursor.list_names(current, ";")
                    if name in self._define_marks
                ]
                pending += used[current]
        try:
            order = [each for each in TopologicalSorter(used).static_order() if each in used]
        except CycleError:
            raise FormulaError(f"'{token.text}' is defined by itself", token.offset) from None
        for current in order:
            self._sizes[current] = 1 + sum(self._sizes[inner] for inner in used[current])
        return order

    def _read_body(
        self, token: Token, body: int, terms: Mapping[str, Term], arrays: Mapping[str, Array]
    ) -> Term:
        """Read the body of a define or predicate where its name is used."""
        cursor = self._cursor
        if self._depth == _MAX_DEPTH:
            reason = f"predicates use one another in more than {_MAX_DEPTH} levels, or themselves"
            raise FormulaError(reason, token.offset)
        self._depth += 1
        after_use = cursor.mark()
        cursor.reset(body)
        try:
            term = self._create_reader(terms, token.offset, arrays).read_term(0)
            if not cursor.is_next(";", "}", ","):
                cursor.fail("';' is expected")
        finally:
            self._depth -= 1
        cursor.reset(after_use)
        return Term(term.formula, term.kind, token.offset)

    def _count_expansion(self, reason: str, token: Token, size: int = 1) -> None:
        """Count an expansion, which repeats *size* texts. Raises FormulaError above the limit."""
        self._expansions += size
        if self._expansions > _MAX_EXPANSIONS:
            raise FormulaError(reason, token.offset)

    def _create_reader(
        self, terms: Mapping[str, Term], offset: int, arrays: Mapping[str, Array] = _NO_ARRAYS
    ) -> SpectraReader:
        """Return a reader in whose formulas parameters have the values *terms* and *arrays*."""
        scope = Scope(
            variables=self._draft.domains,
            definitions=self._definitions,
            arrays={**self._arrays, **arrays} if arrays else self._arrays,
            patterns=self._patterns,
            history=self._history,
            read_type=self._types.read_type,
            choices=self._choices,
            count_expansion=self._count_expansion,
        )
        return SpectraReader(self._cursor, scope, terms, self._draft.file.origin_at(offset))

    def _read_statement(
        self, owner: Owner, parameters: Mapping[str, Term], rule_owner: Owner
    ) -> None:
        """Read a statement; liveness belongs to *owner*, other classes belong to *rule_owner*."""
        cursor = self._cursor
        if cursor.next.kind == "name" and cursor.after_next.text == ":":
            cursor.take()
            cursor.take()
        elif cursor.next.kind == "name" and cursor.after_next.text == "{":
            self._read_family(owner, parameters)
            return
        token = cursor.next
        if token.text in _UNSUPPORTED_STATEMENTS:
            self._draft.report_outside(token.offset, f"'{token.text}'")
            cursor.skip_past(";")
            return
        class_ = _CLASSES.get(token.text, Class.INIT)
        if token.text in _CLASSES:
            cursor.take()
            if class_ is Class.SAFETY and cursor.accept("F"):
                class_ = Class.LIVENESS
        side = owner if class_ is Class.LIVENESS else rule_owner

        def read() -> None:
            if cursor.next.text in self._patterns and cursor.after_next.text == "(":
                self._instantiate_pattern(owner, token, parameters)
                return
            formula = self._create_reader(parameters, token.offset).read_formula()
            if not cursor.is_next(";", "}"):
                cursor.fail("';' is expected")
            self._draft.add(side, class_, formula, token.offset)

        if not self._draft.read_formula(side, class_, read):
            cursor.skip_to(";")
        cursor.accept(";")

    def _read_family(self, owner: Owner, parameters: Mapping[str, Term]) -> None:
        """Read ``name{Int(0..3) i}: statement`` once for each value of the parameters."""
        cursor = self._cursor
        token = cursor.take()
        cursor.take()
        names: list[str] = []
        families: list[Domain] = []

        def read() -> None:
            while not cursor.accept("}"):
                families.append(self._types.read_type())
                names.append(cursor.expect_kind("name", "a parameter").text)
                cursor.accept(",")
            cursor.expect(":")

        if not self._draft.read_formula(owner, Class.SAFETY, read):
            cursor.skip_past(";")
            return
        mark = cursor.mark()
        for values in product(*map(domains.values, families)):
            self._count_expansion(f"'{token.text}' has too many values", token)
            constants = {
                name: Term(Const(value), kind_of(domain), token.offset)
                for name, value, domain in zip(names, values, families, strict=True)
            }
            cursor.reset(mark)
            self._read_statement(owner, {**parameters, **constants}, owner)

    def _instantiate_pattern(
        self, owner: Owner, token: Token, parameters: Mapping[str, Term]
    ) -> None:
        """Add the statements of a pattern with new variables, which belong to the system."""
        cursor = self._cursor
        name = cursor.take()
        pattern = self._patterns[name.text]
        arguments = self._create_reader(parameters, token.offset).read_arguments()
        scope, arrays = _bind(pattern.parameters, arguments, name)
        if arrays:
            raise FormulaError(f"an array parameter of '{name.text}' is not supported", name.offset)
        after_use = cursor.mark()
        self._count_expansion(f"'{name.text}' uses itself", name)
        cursor.reset(pattern.body)
        variables = self._declare_pattern_variables(token)
        # Rules about variables of the system are guarantees, also where the pattern is assumed.
        rule_owner = Owner.SYSTEM if variables else owner
        self._read_block(cursor.mark(), scope | variables, owner, rule_owner)
        cursor.reset(after_use)

    def _declare_pattern_variables(self, token: Token) -> dict[str, Term]:
        """Declare a copy of each variable of a pattern; return the copies by the original names."""
        copies: dict[str, Term] = {}
        while self._cursor.accept("var"):
            domain = self._types.read_type()
            name = self._cursor.expect_kind("name", "a name").text
            self._cursor.expect(";")
            number = 1
            while f"{name}_{number}" in self._draft.domains:
                number += 1
            copy = f"{name}_{number}"
            self._draft.declare(copy, token.offset, Owner.SYSTEM, domain)
            copies[name] = Term(Var(copy), kind_of(domain), token.offset)
        return copies

    def _read_block(
        self, body: int, parameters: Mapping[str, Term], owner: Owner, rule_owner: Owner
    ) -> None:
        """Read the statements of a monitor or a pattern."""
        self._cursor.reset(body)
        while not self._cursor.accept("}"):
            if self._cursor.is_at_end:
                self._cursor.fail("'}' is expected")
            self._read_statement(owner, parameters, rule_owner)

    def _read_counter_body(self, body: int, name: Token, domain: IntegerDomain) -> None:
        self._cursor.reset(body)
        conditions: dict[str, Formula] = dict.fromkeys(("reset", "inc", "dec"), f.FALSE)
        ends = {"overflow": "false", "underflow": "false"}
        initial: Formula = f.eq(Var(name.text), Const(domain.low))
        while not self._cursor.accept("}"):
            token = self._cursor.next
            if token.text in conditions and self._cursor.after_next.text == ":":
                self._cursor.take()
                self._cursor.take()
                conditions[token.text] = self._create_reader({}, token.offset).read_formula()
            elif token.text in ends:
                self._cursor.take()
                self._cursor.expect(":")
                ends[token.text] = self._cursor.expect("false", "keep", "modulo").text
            else:
                self._cursor.accept("ini")
                initial = self._create_reader({}, token.offset).read_formula()
            self._cursor.expect(";")
        self._draft.add(Owner.SYSTEM, Class.INIT, initial, name.offset)
        for rule in _build_counter_rules(name.text, domain, conditions, ends):
            self._draft.add(Owner.SYSTEM, Class.SAFETY, rule, name.offset)


def _bind(
    parameters: tuple[Parameter, ...], arguments: list[Term | Array], token: Token
) -> tuple[dict[str, Term], dict[str, Array]]:
    """Return the arguments of a use by the names of the parameters. Raises FormulaError."""
    if len(parameters) != len(arguments):
        reason = f"'{token.text}' takes {count(len(parameters), 'argument')}, not {len(arguments)}"
        raise FormulaError(reason, token.offset)
    terms: dict[str, Term] = {}
    arrays: dict[str, Array] = {}
    for parameter, argument in zip(parameters, arguments, strict=True):
        if isinstance(argument, Array) != parameter.is_array:
            what = "an array" if parameter.is_array else "a value and no array"
            reason = f"the parameter '{parameter.name}' of '{token.text}' is {what}"
            raise FormulaError(reason, token.offset)
        if isinstance(argument, Array):
            arrays[parameter.name] = argument
        else:
            terms[parameter.name] = argument
    return terms, arrays


def _build_counter_rules(
    name: str, domain: IntegerDomain, conditions: Mapping[str, Formula], ends: Mapping[str, str]
) -> list[Formula]:
    """Return the steps of a counter with the conditions ``reset``, ``inc`` and ``dec``.

    ``reset`` takes precedence, and ``inc`` with ``dec`` changes nothing. For ``overflow`` and
    ``underflow``, *ends* is ``keep`` (the value), ``modulo`` (continue at the other end) or
    ``false`` (forbidden).
    """
    current, following = Var(name), Var(name, primed=True)
    low, high = Const(domain.low), Const(domain.high)
    reset, increment, decrement = (conditions[word] for word in ("reset", "inc", "dec"))
    is_counting = f.negate(reset)
    goes_up = f.both(is_counting, increment, f.negate(decrement))
    goes_down = f.both(is_counting, decrement, f.negate(increment))
    is_low, is_high = f.eq(current, low), f.eq(current, high)
    plus_one = f.eq(following, Apply(Op.ADD, (current, Const(1))))
    minus_one = f.eq(following, Apply(Op.SUB, (current, Const(1))))
    overflow = _END_STEPS[ends["overflow"]](following, high, low)
    underflow = _END_STEPS[ends["underflow"]](following, low, high)
    return [
        f.implies(reset, f.eq(following, low)),
        f.implies(f.both(is_counting, f.iff(increment, decrement)), f.eq(following, current)),
        f.implies(f.both(goes_up, f.negate(is_high)), plus_one),
        f.implies(f.both(goes_up, is_high), overflow),
        f.implies(f.both(goes_down, f.negate(is_low)), minus_one),
        f.implies(f.both(goes_down, is_low), underflow),
    ]


# -- types -------------------------------------------------------------------------------------


class Type(Struct, frozen=True):
    """The domain of a variable or of the elements of an array, and the sizes of the array."""

    domain: Domain
    dimensions: tuple[int, ...] = ()


class TypeReader:
    """Reads types from a cursor. Names of types may be used before they are defined."""

    def __init__(self, cursor: Cursor, read_constant: Callable[[], Term]) -> None:
        """*read_constant* reads a size or bound that is no number, such as the name of a define."""
        self._cursor = cursor
        self._read_constant = read_constant
        self._marks: dict[str, int] = {}
        self._types: dict[str, Type] = {}
        self._unfinished: set[str] = set()

    def define(self, name: str) -> None:
        """Record that the type *name* is defined at the current position."""
        self._marks[name] = self._cursor.mark()

    def check_definitions(self) -> None:
        """Read all named types. Raises FormulaError."""
        for name in self._marks:
            self._resolve(Token("name", name, self._cursor.next.offset))

    def read_type(self) -> Domain:
        """Read a type that is no array. Raises FormulaError."""
        offset = self._cursor.next.offset
        type_ = self.read_array_type()
        if type_.dimensions:
            raise FormulaError("an array is not supported here", offset)
        return type_.domain

    def read_array_type(self) -> Type:
        """Read a type and the sizes of arrays after it. Raises FormulaError."""
        type_ = self._read_named_type()
        return Type(type_.domain, (*self.read_dimensions(), *type_.dimensions))

    def read_dimensions(self) -> tuple[int, ...]:
        """Read sizes such as ``[4][N]``. Raises FormulaError."""
        sizes: list[int] = []
        while self._cursor.accept("["):
            offset = self._cursor.next.offset
            sizes.append(self._read_bound())
            if sizes[-1] < 1:
                raise FormulaError(f"an array cannot have {sizes[-1]} elements", offset)
            self._cursor.expect("]")
        return tuple(sizes)

    def _read_named_type(self) -> Type:
        cursor = self._cursor
        if cursor.accept("boolean"):
            return Type(BooleanDomain())
        if cursor.accept("{"):
            return Type(self._read_literals())
        if cursor.accept("Int"):
            cursor.expect("(")
            return Type(self.read_range(")"))
        return self._resolve(cursor.expect_kind("name", "a type"))

    def _resolve(self, name: Token) -> Type:
        if name.text not in self._marks:
            raise FormulaError(f"'{name.text}' is not a type", name.offset)
        if name.text in self._unfinished:
            raise FormulaError(f"'{name.text}' is defined by itself", name.offset)
        if name.text not in self._types:
            self._unfinished.add(name.text)
            after_use = self._cursor.mark()
            self._cursor.reset(self._marks[name.text])
            self._types[name.text] = self.read_array_type()
            self._cursor.expect(";")
            self._cursor.reset(after_use)
            self._unfinished.discard(name.text)
        return self._types[name.text]

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

    def read_range(self, end: str) -> IntegerDomain:
        """Read ``0..7`` and the closing bracket after it. Raises FormulaError."""
        offset = self._cursor.next.offset
        low = self._read_bound()
        self._cursor.expect("..")
        high = self._read_bound()
        self._cursor.expect(end)
        if low > high:
            raise FormulaError(f"the range {low}..{high} is empty", offset)
        return IntegerDomain(low, high)

    def _read_bound(self) -> int:
        token = self._cursor.next
        if token.kind == "number" or token.text == "-":
            return self._cursor.read_integer()
        term = self._read_constant()
        if term.kind != NUMBER or f.variables(term.formula):
            raise FormulaError(f"'{token.text}' is not a number", token.offset)
        return int(value_of(term.formula, {}))
