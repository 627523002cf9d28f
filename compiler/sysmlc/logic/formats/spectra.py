"""The GR(1) part of Spectra: variables, defines, predicates, patterns, monitors, counters, past.

Source: the Spectra language (S. Maoz, J. O. Ringert) as in its examples. Arrays, quantifiers,
regular expressions, existential guarantees, weights and imports are reported as not supported.
"""

from collections.abc import Callable, Mapping
from pathlib import PurePath

from msgspec import Struct

from sysmlc.logic import formula as f
from sysmlc.logic.contract import Class, Contract, IntegerDomain, Owner
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.draft import ContractDraft, SpecificationFile
from sysmlc.logic.formats.spectra_expressions import SYNTAX, Meaning, SpectraReader, TypeReader
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.infix import Term, kind_of
from sysmlc.logic.reduction.history import History
from sysmlc.logic.syntax import Cursor, FormulaError, Token, tokenize

_OWNERS = {
    **dict.fromkeys(("env", "input"), Owner.ENVIRONMENT),
    **dict.fromkeys(("sys", "output", "aux", "auxvar"), Owner.SYSTEM),
}
_SIDES = {
    **dict.fromkeys(("assumption", "asm"), Owner.ENVIRONMENT),
    **dict.fromkeys(("guarantee", "gar"), Owner.SYSTEM),
}
_CLASSES = {
    **dict.fromkeys(("G", "alw", "always", "trans"), Class.SAFETY),
    **dict.fromkeys(("GF", "alwEv", "alwaysEventually"), Class.LIVENESS),
    **dict.fromkeys(("ini", "initially"), Class.INIT),
}
_UNSUPPORTED = ("import", "regexp", "weight", "GE", "forall", "exists", "separated", "trig")
_SUM_PRECEDENCE = SYNTAX.precedence[Op.ADD]
_MAX_EXPANSIONS = 20_000
"""Most expansions of defines, predicates and patterns in one file."""
_END_STEPS: dict[str, Callable[[Formula, Formula, Formula], Formula]] = {
    "keep": lambda following, end, other_end: f.eq(following, end),
    "modulo": lambda following, end, other_end: f.eq(following, other_end),
    "false": lambda following, end, other_end: f.FALSE,
}


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract of the file's module, or nothing if a fault was reported."""
    return _ModuleReader(file).read()


class _Pattern(Struct, frozen=True):
    """A pattern: its parameters, and the position where its body begins."""

    parameters: tuple[str, ...]
    body: int


class _ModuleReader:
    """Reads a module in two rounds: all declarations, then assumptions and guarantees.

    A statement may use a name that is declared below it. The first round therefore records the
    positions of bodies, and the second returns to them.
    """

    def __init__(self, file: SpecificationFile) -> None:
        self._draft = ContractDraft(file, "Spectra")
        self._cursor = Cursor(tokenize(file.text, SYNTAX))
        self._types = TypeReader(self._cursor)
        self._definitions: dict[str, Meaning] = {}
        self._patterns: dict[str, _Pattern] = {}
        self._statements: list[tuple[Owner, int]] = []
        self._deferred: list[Callable[[], None]] = []
        """Reads the bodies of monitors and counters in the second round."""
        self._name = PurePath(file.path).stem
        self._history = History(())
        self._expansions = 0

    def read(self) -> tuple[Contract, ...]:
        """Return the contract, or nothing if a fault was reported."""
        cursor = self._cursor
        while not cursor.is_at_end:
            self._draft.read_statement(cursor, self._read_element, ";")
        if self._draft.is_broken:
            return ()
        self._history = History([*self._draft.domains, *self._definitions])
        for read_body in self._deferred:
            self._draft.read_statement(cursor, read_body)
        for owner, mark in self._statements:
            cursor.reset(mark)
            self._read_statement(owner, {}, owner)
        for variable in self._history.variables:
            self._draft.declare(variable.name, 0, Owner.SYSTEM, variable.domain)
        for conjunct in self._history.conjuncts:
            self._draft.add_derived(Owner.SYSTEM, conjunct)
        return self._draft.build(self._name)

    # -- first round: declarations -----------------------------------------------------------------

    def _read_element(self) -> None:
        token = self._cursor.expect_kind("name", "a declaration")
        word = token.text
        if word in ("module", "spec"):
            self._name = self._cursor.expect_kind("name", "a name").text
        elif word in _OWNERS:
            self._read_variable(_OWNERS[word])
        elif word in _SIDES:
            self._statements.append((_SIDES[word], self._cursor.mark()))
            self._cursor.skip_past(";")
        elif word in _ELEMENT_READERS:
            _ELEMENT_READERS[word](self)
        elif word in _UNSUPPORTED:
            self._skip_unsupported(token, f"'{word}'")
        else:
            raise FormulaError(f"'{word}' begins nothing that is known", token.offset)

    def _skip_unsupported(self, token: Token, what: str) -> None:
        self._draft.report_outside(token.offset, what)
        self._cursor.skip_past(";")

    def _read_variable(self, owner: Owner) -> None:
        domain = self._types.read_type(self._read_constant)
        if self._cursor.is_next("["):
            self._skip_unsupported(self._cursor.next, "an array")
            return
        name = self._cursor.expect_kind("name", "a name")
        if self._cursor.is_next("["):
            self._skip_unsupported(self._cursor.next, "an array")
            return
        self._cursor.expect(";")
        self._draft.declare(name.text, name.offset, owner, domain)

    def _read_constant(self) -> Term:
        return self._create_reader({}, self._cursor.next.offset).read_term(_SUM_PRECEDENCE)

    def _read_type_definition(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect("=")
        self._types.named[name.text] = self._types.read_type(self._read_constant)
        self._cursor.expect(";")

    def _read_defines(self) -> None:
        cursor = self._cursor
        while cursor.next.kind == "name" and cursor.after_next.text == ":=":
            name = cursor.take()
            cursor.take()
            self._define(name, self._create_meaning(cursor.mark(), None))
            cursor.skip_past(";")

    def _read_predicate(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        parameters = self._read_parameters()
        opening = self._cursor.expect(":", "{").text
        self._define(name, self._create_meaning(self._cursor.mark(), parameters))
        self._cursor.skip_past(";" if opening == ":" else "}")

    def _define(self, name: Token, meaning: Meaning) -> None:
        if name.text in self._definitions:
            self._draft.report_fault(rules.DECLARED_TWICE, name.offset, name=name.text)
        self._definitions[name.text] = meaning

    def _create_meaning(self, body: int, parameters: tuple[str, ...] | None) -> Meaning:
        """Return a function that expands a define (without *parameters*) or a predicate."""

        def expand(reader: SpectraReader, token: Token) -> Term:
            arguments: Mapping[str, Term] = {}
            if parameters is not None:
                arguments = _bind(parameters, reader.read_arguments(), token)
            return self._expand(reader, token, body, arguments)

        return expand

    def _expand(
        self, reader: SpectraReader, token: Token, body: int, arguments: Mapping[str, Term]
    ) -> Term:
        """Read the body of a define or predicate where its name is used."""
        cursor = self._cursor
        self._count_expansion(f"'{token.text}' is defined by itself", token)
        after_use = cursor.mark()
        cursor.reset(body)
        definitions = {
            name: meaning for name, meaning in reader.definitions.items() if name != token.text
        }
        term = self._create_reader(arguments, token.offset, definitions).read_term(0)
        if not cursor.is_next(";", "}"):
            cursor.fail("';' is expected")
        cursor.reset(after_use)
        return Term(term.formula, term.kind, token.offset)

    def _count_expansion(self, reason: str, token: Token) -> None:
        """Count an expansion. Raises FormulaError above the limit."""
        self._expansions += 1
        if self._expansions > _MAX_EXPANSIONS:
            raise FormulaError(reason, token.offset)

    def _read_parameters(self) -> tuple[str, ...]:
        """Read the names of parameters; a type may precede each name."""
        cursor = self._cursor
        cursor.expect("(")
        names: list[str] = []
        while not cursor.accept(")"):
            if cursor.after_next.text not in (",", ")"):
                self._types.read_type(self._read_constant)
            names.append(cursor.expect_kind("name", "a parameter").text)
            cursor.accept(",")
        return tuple(names)

    def _read_pattern(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        parameters = self._read_parameters()
        self._cursor.expect("{")
        self._patterns[name.text] = _Pattern(parameters, self._cursor.mark())
        self._cursor.skip_past("}")

    def _read_monitor(self) -> None:
        domain = self._types.read_type(self._read_constant)
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect("{")
        body = self._cursor.mark()
        self._draft.declare(name.text, name.offset, Owner.SYSTEM, domain)
        self._deferred.append(lambda: self._read_block(body, {}, Owner.SYSTEM, Owner.SYSTEM))
        self._cursor.skip_past("}")

    def _read_counter(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect("(")
        domain = self._types.read_range(self._read_constant, ")")
        self._cursor.expect("{")
        body = self._cursor.mark()
        self._draft.declare(name.text, name.offset, Owner.SYSTEM, domain)
        self._deferred.append(lambda: self._read_counter_body(body, name, domain))
        self._cursor.skip_past("}")

    # -- second round: statements ------------------------------------------------------------------

    def _create_reader(
        self,
        parameters: Mapping[str, Term],
        offset: int,
        definitions: Mapping[str, Meaning] | None = None,
    ) -> SpectraReader:
        return SpectraReader(
            self._cursor,
            self._draft.domains,
            self._history,
            parameters,
            self._definitions if definitions is None else definitions,
            self._draft.file.origin_at(offset),
        )

    def _read_statement(
        self, owner: Owner, parameters: Mapping[str, Term], rule_owner: Owner
    ) -> None:
        """Read a statement; liveness belongs to *owner*, other classes belong to *rule_owner*."""
        cursor = self._cursor
        if cursor.next.kind == "name" and cursor.after_next.text == ":":
            cursor.take()
            cursor.take()
        token = cursor.next
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

    def _instantiate_pattern(
        self, owner: Owner, token: Token, parameters: Mapping[str, Term]
    ) -> None:
        """Add the statements of a pattern with new variables, which belong to the system."""
        cursor = self._cursor
        name = cursor.take()
        pattern = self._patterns[name.text]
        arguments = self._create_reader(parameters, token.offset).read_arguments()
        scope = _bind(pattern.parameters, arguments, name)
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
            domain = self._types.read_type(self._read_constant)
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


_ELEMENT_READERS: dict[str, Callable[[_ModuleReader], None]] = {
    "define": _ModuleReader._read_defines,
    "predicate": _ModuleReader._read_predicate,
    "pattern": _ModuleReader._read_pattern,
    "monitor": _ModuleReader._read_monitor,
    "counter": _ModuleReader._read_counter,
    "type": _ModuleReader._read_type_definition,
}


def _bind(names: tuple[str, ...], arguments: list[Term], token: Token) -> dict[str, Term]:
    if len(names) != len(arguments):
        reason = f"'{token.text}' takes {len(names)} arguments, not {len(arguments)}"
        raise FormulaError(reason, token.offset)
    return dict(zip(names, arguments, strict=True))


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
