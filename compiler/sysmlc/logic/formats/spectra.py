"""The GR(1) part of Spectra: variables, defines, predicates, patterns, monitors, counters, past.

Source: the Spectra language (S. Maoz, J. O. Ringert) as in its examples. Arrays, quantifiers,
regular expressions, existential guarantees, weights and imported modules are named as outside.
"""

from collections.abc import Callable
from pathlib import PurePath

from msgspec import Struct

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    Class,
    Contract,
    IntegerDomain,
    Owner,
)
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.draft import Draft
from sysmlc.logic.formats.file import File
from sysmlc.logic.formats.spectra_counter import counter_rules
from sysmlc.logic.formats.spectra_reader import SYNTAX, Meaning, SpectraReader
from sysmlc.logic.formats.spectra_types import Types
from sysmlc.logic.formula import Const, Formula, Op, Var
from sysmlc.logic.infix import Part, kind_of
from sysmlc.logic.reduction.history import History
from sysmlc.logic.spelling import Cursor, FormulaError, Token, tokens

_OWNERS = {"env": Owner.ENVIRONMENT, "input": Owner.ENVIRONMENT, "sys": Owner.SYSTEM}
_OWNERS |= {"output": Owner.SYSTEM, "aux": Owner.SYSTEM, "auxvar": Owner.SYSTEM}
_SIDES = {"assumption": Owner.ENVIRONMENT, "asm": Owner.ENVIRONMENT}
_SIDES |= {"guarantee": Owner.SYSTEM, "gar": Owner.SYSTEM}
_CLASSES = {
    **dict.fromkeys(("G", "alw", "always", "trans"), Class.SAFETY),
    **dict.fromkeys(("GF", "alwEv", "alwaysEventually"), Class.LIVENESS),
    **dict.fromkeys(("ini", "initially"), Class.INIT),
}
_OUTSIDE = ("import", "regexp", "weight", "GE", "forall", "exists", "separated", "trig")


class Pattern(Struct, frozen=True):
    """A pattern: its parameters, and where its body begins."""

    parameters: tuple[str, ...]
    body: int


def read(file: File) -> tuple[Contract, ...]:
    """The contract of the file's module."""
    return _Module(file).read()


class _Module:
    """Reads a module: first what is declared anywhere in it, then what is said."""

    def __init__(self, file: File) -> None:
        self._draft = Draft(file, "Spectra")
        self._cursor = Cursor(tokens(file.text, SYNTAX))
        self._types = Types(self._cursor)
        self._defined: dict[str, Meaning] = {}
        self._patterns: dict[str, Pattern] = {}
        self._said: list[tuple[Owner, int]] = []
        self._later: list[Callable[[], None]] = []
        self._name = PurePath(file.path).stem
        self._history = History(())
        self._instances = 0

    def read(self) -> tuple[Contract, ...]:
        """The contract, unless something is wrong with it."""
        cursor = self._cursor
        while cursor.next.kind != "end":
            self._draft.statement(cursor, self._element, ";")
        if self._draft.is_broken:
            return ()
        self._history = History([*self._draft.domains, *self._defined])
        for one in self._later:
            self._draft.statement(cursor, one)
        for owner, mark in self._said:
            cursor.back_to(mark)
            self._statement(owner, {}, owner)
        return self._with_history()

    def _with_history(self) -> tuple[Contract, ...]:
        for variable in self._history.variables:
            self._draft.declare(variable.name, 0, Owner.SYSTEM, variable.domain)
        for one in self._history.conjuncts:
            self._draft.add_made(Owner.SYSTEM, one)
        return self._draft.contracts(self._name)

    # -- declarations ----------------------------------------------------------------------------

    def _element(self) -> None:
        token = self._cursor.expect_kind("name", "a declaration")
        word = token.text
        if word in ("module", "spec"):
            self._name = self._cursor.expect_kind("name", "a name").text
        elif word in _OWNERS:
            self._variable(_OWNERS[word])
        elif word in _SIDES:
            self._said.append((_SIDES[word], self._cursor.mark()))
            self._cursor.skip_behind(";")
        elif word in _ELEMENTS:
            _ELEMENTS[word](self)
        elif word in _OUTSIDE:
            self._outside(token, f"'{word}'")
        else:
            raise FormulaError(f"'{word}' begins nothing that is known", token.at)

    def _outside(self, token: Token, what: str) -> None:
        self._draft.fault(rules.OUTSIDE, token.at, what=what, form="Spectra")
        self._cursor.skip_behind(";")

    def _variable(self, owner: Owner) -> None:
        domain = self._types.read(self._constant)
        if self._cursor.has("["):
            self._outside(self._cursor.next, "an array")
            return
        name = self._cursor.expect_kind("name", "a name")
        if self._cursor.has("["):
            self._outside(self._cursor.next, "an array")
            return
        self._cursor.expect(";")
        self._draft.declare(name.text, name.at, owner, domain)

    def _constant(self) -> Part:
        return self._reader({}, self._cursor.next.at).part(_SUM)

    def _type_definition(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect("=")
        self._types.named[name.text] = self._types.read(self._constant)
        self._cursor.expect(";")

    def _definitions(self) -> None:
        cursor = self._cursor
        while cursor.next.kind == "name" and cursor.after_next.text == ":=":
            name = cursor.take()
            cursor.take()
            self._define(name, self._defined_at(cursor.mark()))
            cursor.skip_behind(";")

    def _defined_at(self, mark: int) -> Meaning:
        return lambda reader, token: self._expanded(reader, token, mark)

    def _define(self, name: Token, meaning: Meaning) -> None:
        if name.text in self._defined:
            self._draft.fault(rules.DECLARED_TWICE, name.at, name=name.text)
        self._defined[name.text] = meaning

    def _expanded(
        self, reader: SpectraReader, token: Token, mark: int, local: dict[str, Part] | None = None
    ) -> Part:
        """What a define or a predicate says, at the place where it is named."""
        cursor = self._cursor
        self._instances += 1
        if self._instances > _MOST:
            raise FormulaError(f"'{token.text}' is defined by itself", token.at)
        behind = cursor.mark()
        cursor.back_to(mark)
        defined = {k: v for k, v in reader.defined.items() if k != token.text}
        inner = self._reader(local or {}, token.at, defined).part(0)
        if not cursor.has(";", "}"):
            cursor.fail("';' is expected")
        cursor.back_to(behind)
        return Part(inner.formula, inner.kind, token.at)

    def _predicate(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        parameters = self._parameters()
        end = self._cursor.expect(":", "{").text
        mark = self._cursor.mark()

        def meaning(reader: SpectraReader, token: Token) -> Part:
            given = reader.arguments()
            local = _bound_to(parameters, given, token)
            return self._expanded(reader, token, mark, local)

        self._define(name, meaning)
        self._cursor.skip_behind(";" if end == ":" else "}")

    def _parameters(self) -> tuple[str, ...]:
        """Names of parameters, with or without types."""
        cursor = self._cursor
        cursor.expect("(")
        found: list[str] = []
        while not cursor.took(")"):
            if cursor.after_next.text not in (",", ")"):
                self._types.read(self._constant)
            found.append(cursor.expect_kind("name", "a parameter").text)
            cursor.took(",")
        return tuple(found)

    def _pattern(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        parameters = self._parameters()
        self._cursor.expect("{")
        self._patterns[name.text] = Pattern(parameters, self._cursor.mark())
        self._cursor.skip_behind("}")

    def _monitor(self) -> None:
        domain = self._types.read(self._constant)
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect("{")
        mark = self._cursor.mark()
        self._draft.declare(name.text, name.at, Owner.SYSTEM, domain)
        self._later.append(lambda: self._block(mark, {}, Owner.SYSTEM, Owner.SYSTEM))
        self._cursor.skip_behind("}")

    def _counter(self) -> None:
        name = self._cursor.expect_kind("name", "a name")
        self._cursor.expect("(")
        domain = self._types.range(self._constant, ")")
        self._cursor.expect("{")
        mark = self._cursor.mark()
        self._draft.declare(name.text, name.at, Owner.SYSTEM, domain)
        if isinstance(domain, IntegerDomain):
            self._later.append(lambda: self._counting(mark, name, domain))
        self._cursor.skip_behind("}")

    # -- what is said ----------------------------------------------------------------------------

    def _reader(
        self, local: dict[str, Part], at: int, defined: dict[str, Meaning] | None = None
    ) -> SpectraReader:
        origin = self._draft.file.origin(at)
        names = self._defined if defined is None else defined
        return SpectraReader(self._cursor, self._draft.domains, self._history, local, names, origin)

    def _statement(self, owner: Owner, local: dict[str, Part], rules_of: Owner) -> None:
        """One statement; ``rules_of`` is the side that what is not liveness belongs to."""
        cursor = self._cursor
        if cursor.next.kind == "name" and cursor.after_next.text == ":":
            cursor.take()
            cursor.take()
        token = cursor.next
        class_ = _CLASSES.get(token.text, Class.INIT)
        if token.text in _CLASSES:
            cursor.take()
            if class_ is Class.SAFETY and cursor.took("F"):
                class_ = Class.LIVENESS
        side = owner if class_ is Class.LIVENESS else rules_of

        def read_one() -> None:
            if cursor.next.text in self._patterns and cursor.after_next.text == "(":
                self._instance(owner, token, local)
                return
            formula = self._reader(local, token.at).formula()
            if not cursor.has(";", "}"):
                cursor.fail("';' is expected")
            self._draft.add(side, class_, formula, token.at)

        if not self._draft.formula(side, class_, read_one):
            cursor.skip_to(";")
        cursor.took(";")

    def _instance(self, owner: Owner, token: Token, local: dict[str, Part]) -> None:
        """A pattern with its arguments: its variables are new, and belong to the system."""
        cursor = self._cursor
        name = cursor.take()
        pattern = self._patterns[name.text]
        given = _bound_to(pattern.parameters, self._reader(local, token.at).arguments(), name)
        behind = cursor.mark()
        self._instances += 1
        if self._instances > _MOST:
            raise FormulaError(f"'{name.text}' uses itself", name.at)
        cursor.back_to(pattern.body)
        own = self._own_variables(given, token)
        self._block(cursor.mark(), given, owner, Owner.SYSTEM if own else owner)
        cursor.back_to(behind)

    def _own_variables(self, local: dict[str, Part], token: Token) -> bool:
        found = False
        while self._cursor.took("var"):
            domain = self._types.read(self._constant)
            name = self._cursor.expect_kind("name", "a name").text
            self._cursor.expect(";")
            number = 1
            while f"{name}_{number}" in self._draft.domains:
                number += 1
            made = f"{name}_{number}"
            self._draft.declare(made, token.at, Owner.SYSTEM, domain)
            local[name] = Part(Var(made), kind_of(domain), token.at)
            found = True
        return found

    def _block(self, mark: int, local: dict[str, Part], owner: Owner, rules_of: Owner) -> None:
        self._cursor.back_to(mark)
        while not self._cursor.took("}"):
            if self._cursor.next.kind == "end":
                self._cursor.fail("'}' is expected")
            self._statement(owner, local, rules_of)

    def _counting(self, mark: int, name: Token, domain: IntegerDomain) -> None:
        """A counter: reset before counting, one up, one down, and what happens at its ends."""
        self._cursor.back_to(mark)
        parts: dict[str, Formula] = dict.fromkeys(("reset", "inc", "dec"), f.FALSE)
        ends = {"overflow": "false", "underflow": "false"}
        start: Formula = f.eq(Var(name.text), Const(domain.low))
        while not self._cursor.took("}"):
            token = self._cursor.next
            if token.text in parts and self._cursor.after_next.text == ":":
                self._cursor.take()
                self._cursor.take()
                parts[token.text] = self._reader({}, token.at).formula()
            elif token.text in ends:
                self._cursor.take()
                self._cursor.expect(":")
                ends[token.text] = self._cursor.expect("false", "keep", "modulo").text
            else:
                self._cursor.took("ini")
                start = self._reader({}, token.at).formula()
            self._cursor.expect(";")
        self._draft.add(Owner.SYSTEM, Class.INIT, start, name.at)
        for rule in counter_rules(name.text, domain, parts, ends):
            self._draft.add(Owner.SYSTEM, Class.SAFETY, rule, name.at)


_ELEMENTS: dict[str, Callable[[_Module], None]] = {
    "define": _Module._definitions,
    "predicate": _Module._predicate,
    "pattern": _Module._pattern,
    "monitor": _Module._monitor,
    "counter": _Module._counter,
    "type": _Module._type_definition,
}
_SUM = SYNTAX.strength[Op.ADD]
_MOST = 20_000
"""Uses of defines and patterns in one file."""


def _bound_to(names: tuple[str, ...], given: list[Part], token: Token) -> dict[str, Part]:
    if len(names) != len(given):
        reason = f"'{token.text}' takes {len(names)} arguments, not {len(given)}"
        raise FormulaError(reason, token.at)
    return dict(zip(names, given, strict=True))
