"""SMV (NuSMV, nuXmv): variables with types, and the contract as one LTLSPEC.

A comment behind a variable, ``-- input`` or ``-- output``, says who decides it. NuSMV's LTL has
no next value inside of a comparison, so what compares a value with the next is written out.
"""

import re
from pathlib import PurePath

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Contract,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Variable,
)
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.base import lowered
from sysmlc.logic.formats.draft import Draft
from sysmlc.logic.formats.file import File
from sysmlc.logic.formats.lower import (
    each_conjunct,
    each_formula,
    known,
    renamed,
    without_weak_until,
    written_out,
)
from sysmlc.logic.formats.spelt import LTL, Spelling
from sysmlc.logic.formats.spot import implication, sides
from sysmlc.logic.formula import Apply, Formula, Op, Var
from sysmlc.logic.infix import Part, Reader
from sysmlc.logic.spelling import (
    COMPARING,
    CONNECTIVES,
    COUNTING,
    STRENGTH,
    TEMPORAL_WORDS,
    TRUTHS,
    Cursor,
    FormulaError,
    Syntax,
    Token,
    tokens,
)

SYNTAX = Syntax(
    {"!": Op.NOT, **TEMPORAL_WORDS},
    {**CONNECTIVES, "U": Op.UNTIL, "V": Op.RELEASE, **COMPARING, **COUNTING},
    TRUTHS,
    {"(": ")"},
    STRENGTH,
    (":", ";", "{", "}", ",", "..", ":="),
    r"--[^\n]*",
)
_SPELLING = Spelling({**LTL, Op.RELEASE: "V"}, lambda name: f"next({name})")
_OWNERS = {"input": Owner.ENVIRONMENT, "output": Owner.SYSTEM}
_SAYS = re.compile(r"[^\n]*?--\s*(input|output)\b")
_RULES = ("MODULE", "VAR", "IVAR", "LTLSPEC")


def read(file: File) -> tuple[Contract, ...]:
    """The contract of the file's main module."""
    draft = Draft(file, "SMV")
    cursor = Cursor(tokens(file.text, SYNTAX))
    name = [PurePath(file.path).stem]
    while cursor.next.kind != "end":
        draft.statement(cursor, lambda: _section(draft, cursor, name), ";")
    return draft.contracts(name[-1])


def _section(draft: Draft, cursor: Cursor, name: list[str]) -> None:
    title = cursor.expect_kind("name", "a section")
    if title.text == "MODULE":
        cursor.expect_kind("name", "a name")
    elif title.text in ("VAR", "IVAR"):
        while cursor.next.kind == "name" and cursor.after_next.text == ":":
            _declaration(draft, cursor)
    elif title.text == "LTLSPEC":
        _specification(draft, cursor, name)
    else:
        draft.fault(rules.OUTSIDE, title.at, what=f"'{title.text}'", form="SMV")
        cursor.skip_to(*_RULES)


def _declaration(draft: Draft, cursor: Cursor) -> None:
    name = cursor.take()
    cursor.expect(":")
    domain = _domain(cursor)
    end = cursor.expect(";").at
    found = _SAYS.match(draft.file.text, end)
    if found is None:
        reason = f"a comment '-- input' or '-- output' must say who decides '{name.text}'"
        raise FormulaError(reason, name.at)
    draft.declare(name.text, name.at, _OWNERS[found.group(1)], domain)


def _domain(cursor: Cursor) -> Domain:
    if cursor.took("boolean"):
        return BooleanDomain()
    at = cursor.next.at
    if cursor.took("{"):
        literals = [cursor.expect_kind("name", "a value").text]
        while cursor.took(","):
            literals.append(cursor.expect_kind("name", "a value").text)
        cursor.expect("}")
        if len(set(literals)) < len(literals):
            raise FormulaError("a value is there twice", at)
        return EnumerationDomain(tuple(literals))
    low = cursor.integer()
    cursor.expect("..")
    high = cursor.integer()
    if low > high:
        raise FormulaError(f"the range {low}..{high} is empty", at)
    return IntegerDomain(low, high)


def _specification(draft: Draft, cursor: Cursor, name: list[str]) -> None:
    if cursor.took("NAME"):
        name.append(cursor.expect_kind("name", "a name").text)
        cursor.expect(":=")

    def read_all() -> None:
        sides(draft, _Reader(cursor, SYNTAX, draft.domains))
        if not cursor.has(";") and cursor.next.kind != "end":
            cursor.fail("';' is expected")

    if not draft.formula(Owner.SYSTEM, Class.OTHER, read_all):
        cursor.skip_to(";")
    cursor.took(";")


class _Reader(Reader):
    """``next(e)`` is e with the values of the next step."""

    def word(self, token: Token) -> Part:
        if token.text != "next" or not self.cursor.took("("):
            return super().word(token)
        inner = self.part(0)
        self.cursor.expect(")")
        return Part(f.primed(inner.formula), inner.kind, token.at)


def plain(contract: Contract, form: str) -> Contract:
    """The contract as NuSMV's LTL has words for it. Raises NotExpressibleError."""
    words = frozenset({*SYNTAX.prefix, *SYNTAX.infix, *TRUTHS, *_RULES, *_KEYWORDS})
    plain_words = each_formula(renamed(contract, words), without_weak_until)
    return lowered(plain_words, form, _apart)


def _apart(contract: Contract) -> Contract:
    domains_of = known(contract)

    def leaf(formula: Formula) -> Formula:
        steps = {variable.primed for variable in f.variables(formula)}
        return written_out(formula, domains_of) if len(steps) > 1 else formula

    return each_conjunct(contract, leaf)


def write(contract: Contract, form: str) -> str:
    """The contract as a module whose LTLSPEC holds where the guarantees follow."""
    from sysmlc.logic.formats.chase import word

    made = plain(contract, form)
    spec = implication(made, _Next(_SPELLING.words, _SPELLING.next), form)
    declared = [_declared(one) for one in made.variables]
    name = word(contract.component)
    return "\n".join(["MODULE main", "VAR", *declared, f"LTLSPEC NAME {name} := {spec};", ""])


class _Next(Spelling, frozen=True):
    """A comparison of next values is ``X`` before the comparison."""

    def text(self, formula: Formula) -> str:
        if any(variable.primed for variable in f.variables(formula)) and _is_leaf(formula):
            return f"X {self._bare(_unprimed(formula))}"
        return super().text(formula)

    def _bare(self, formula: Formula) -> str:
        text = super().text(formula)
        return text if isinstance(formula, Var) else f"({text})"


def _is_leaf(formula: Formula) -> bool:
    comparisons = (Op.EQ, Op.NE, Op.LT, Op.LE, Op.GT, Op.GE)
    return isinstance(formula, Var) or (isinstance(formula, Apply) and formula.op in comparisons)


def _unprimed(formula: Formula) -> Formula:
    match formula:
        case Var(name):
            return Var(name)
        case Apply(op, args):
            return Apply(op, tuple(_unprimed(arg) for arg in args))
        case _:
            return formula


def _declared(variable: Variable) -> str:
    side = "input" if variable.owner is Owner.ENVIRONMENT else "output"
    match variable.domain:
        case BooleanDomain():
            type_ = "boolean"
        case IntegerDomain(low, high):
            type_ = f"{low}..{high}"
        case EnumerationDomain(literals):
            type_ = f"{{{', '.join(literals)}}}"
    return f"  {variable.name} : {type_}; -- {side}"


_KEYWORDS = frozenset(
    re.findall(
        r"\w+",
        "MODULE DEFINE MDEFINE CONSTANTS VAR IVAR FROZENVAR INIT TRANS INVAR SPEC CTLSPEC LTLSPEC "
        "PSLSPEC COMPUTE NAME INVARSPEC FAIRNESS JUSTICE COMPASSION ISA ASSIGN CONSTRAINT SIMPWFF "
        "CTLWFF LTLWFF PSLWFF COMPWFF IN MIN MAX MIRROR PRED PREDICATES process array of boolean "
        "integer real word word1 bool signed unsigned extend resize sizeof uwconst swconst EX AX "
        "EF AF EG AG E F O G H X Y Z A U S V T BU EBF ABF EBG ABG case esac mod next init union "
        "in xor xnor self TRUE FALSE count abs max min",
    )
)
