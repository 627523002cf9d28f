"""SMV (NuSMV, nuXmv): variables with types, and the contract as one LTLSPEC.

A comment behind a variable, ``-- input`` or ``-- output``, names its owner. NuSMV's LTL does not
allow a next value inside a comparison, so a comparison of a current with a next value is expanded.
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
from sysmlc.logic.formats.draft import ContractDraft, SpecificationFile
from sysmlc.logic.formats.lowering import (
    eliminate_weak_until,
    index_domains,
    rename_reserved,
    rewrite_conjuncts,
    rewrite_contract_atoms,
    separate_steps,
)
from sysmlc.logic.formats.spot import print_implication, read_sides
from sysmlc.logic.formats.writing import (
    LTL_WORDS,
    Notation,
    add_next_operator,
    apply_lowering,
    convert_to_word,
)
from sysmlc.logic.formula import Apply, Formula, Op, Var
from sysmlc.logic.infix import FormulaReader, Term
from sysmlc.logic.syntax import (
    ARITHMETIC_SIGNS,
    BOOLEANS,
    COMPARISON_SIGNS,
    COMPARISONS,
    CONNECTIVE_SIGNS,
    PRECEDENCE,
    TEMPORAL_WORDS,
    Cursor,
    FormulaError,
    Syntax,
    Token,
    tokenize,
)

SYNTAX = Syntax(
    {"!": Op.NOT, **TEMPORAL_WORDS},
    {
        **CONNECTIVE_SIGNS,
        "U": Op.UNTIL,
        "V": Op.RELEASE,
        **COMPARISON_SIGNS,
        **ARITHMETIC_SIGNS,
    },
    BOOLEANS,
    {"(": ")"},
    PRECEDENCE,
    signs=(":", ";", "{", "}", ",", "..", ":="),
    comment=r"--[^\n]*",
)
_OWNERS = {"input": Owner.ENVIRONMENT, "output": Owner.SYSTEM}
_OWNER_COMMENT = re.compile(r"[^\n]*?--\s*(input|output)\b")
_SECTIONS = ("MODULE", "VAR", "IVAR", "LTLSPEC")
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
_RESERVED = _KEYWORDS | {*SYNTAX.prefix, *SYNTAX.infix, *BOOLEANS}


# -- reading ---------------------------------------------------------------------------------------


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract of the file's main module, or nothing if a fault was reported.

    The name of the last LTLSPEC, else of the file, is the name of the contract.
    """
    draft = ContractDraft(file, "SMV")
    cursor = Cursor(tokenize(file.text, SYNTAX))
    names = [PurePath(file.path).stem]
    while not cursor.is_at_end:
        draft.read_statement(cursor, lambda: _read_section(draft, cursor, names), ";")
    return draft.build(names[-1])


def _read_section(draft: ContractDraft, cursor: Cursor, names: list[str]) -> None:
    title = cursor.expect_kind("name", "a section")
    if title.text == "MODULE":
        cursor.expect_kind("name", "a name")
    elif title.text in ("VAR", "IVAR"):
        while cursor.next.kind == "name" and cursor.after_next.text == ":":
            _read_declaration(draft, cursor)
    elif title.text == "LTLSPEC":
        _read_specification(draft, cursor, names)
    else:
        draft.report_outside(title.offset, f"'{title.text}'")
        cursor.skip_to(*_SECTIONS)


def _read_declaration(draft: ContractDraft, cursor: Cursor) -> None:
    name = cursor.take()
    cursor.expect(":")
    domain = _read_type(cursor)
    end = cursor.expect(";").offset
    # Comments are not among the tokens.
    comment = _OWNER_COMMENT.match(draft.file.text, end)
    if comment is None:
        reason = f"a comment '-- input' or '-- output' must say who decides '{name.text}'"
        raise FormulaError(reason, name.offset)
    draft.declare(name.text, name.offset, _OWNERS[comment.group(1)], domain)


def _read_type(cursor: Cursor) -> Domain:
    if cursor.accept("boolean"):
        return BooleanDomain()
    offset = cursor.next.offset
    if cursor.accept("{"):
        literals = [cursor.expect_kind("name", "a value").text]
        while cursor.accept(","):
            literals.append(cursor.expect_kind("name", "a value").text)
        cursor.expect("}")
        if len(set(literals)) < len(literals):
            raise FormulaError("a value is there twice", offset)
        return EnumerationDomain(tuple(literals))
    low = cursor.read_integer()
    cursor.expect("..")
    high = cursor.read_integer()
    if low > high:
        raise FormulaError(f"the range {low}..{high} is empty", offset)
    return IntegerDomain(low, high)


def _read_specification(draft: ContractDraft, cursor: Cursor, names: list[str]) -> None:
    if cursor.accept("NAME"):
        names.append(cursor.expect_kind("name", "a name").text)
        cursor.expect(":=")

    def read() -> None:
        read_sides(draft, _SmvReader(cursor, SYNTAX, draft.domains))
        if not cursor.is_next(";") and not cursor.is_at_end:
            cursor.fail("';' is expected")

    if not draft.read_formula(Owner.SYSTEM, Class.OTHER, read):
        cursor.skip_to(";")
    cursor.accept(";")


class _SmvReader(FormulaReader):
    """Reads ``next(e)`` as e with the values of the next step."""

    def resolve_name(self, token: Token) -> Term:
        if token.text != "next" or not self.cursor.accept("("):
            return super().resolve_name(token)
        term = self.read_term(0)
        self.cursor.expect(")")
        return Term(f.prime(term.formula), term.kind, token.offset)


# -- writing ---------------------------------------------------------------------------------------


def lower(contract: Contract, format_name: str) -> Contract:
    """Return the contract without weak until and without comparisons across a step.

    Raises NotExpressibleError.
    """
    lowered = rewrite_conjuncts(rename_reserved(contract, _RESERVED), eliminate_weak_until)
    return apply_lowering(lowered, format_name, _separate_steps)


def _separate_steps(contract: Contract) -> Contract:
    domains = index_domains(contract)
    return rewrite_contract_atoms(contract, lambda atom: separate_steps(atom, domains))


def write(contract: Contract, format_name: str) -> str:
    """Return a module whose LTLSPEC is that the assumptions imply the guarantees."""
    lowered = lower(contract, format_name)
    specification = print_implication(lowered, _NOTATION, format_name)
    name = convert_to_word(contract.component)
    lines = [
        "MODULE main",
        "VAR",
        *map(_print_declaration, lowered.variables),
        f"LTLSPEC NAME {name} := {specification};",
    ]
    return "\n".join([*lines, ""])


def _print_declaration(variable: Variable) -> str:
    direction = "input" if variable.owner is Owner.ENVIRONMENT else "output"
    match variable.domain:
        case BooleanDomain():
            type_ = "boolean"
        case IntegerDomain(low, high):
            type_ = f"{low}..{high}"
        case EnumerationDomain(literals):
            type_ = f"{{{', '.join(literals)}}}"
    return f"  {variable.name} : {type_}; -- {direction}"


class _SmvNotation(Notation, frozen=True):
    """Writes ``X`` before a comparison of next values, since NuSMV's LTL has no ``next(x)``."""

    def print(self, formula: Formula) -> str:
        is_primed = any(variable.primed for variable in f.variables(formula))
        if not is_primed or not _is_atom(formula):
            return super().print(formula)
        text = super().print(_remove_primes(formula))
        return f"X {text}" if isinstance(formula, Var) else f"X ({text})"


def _is_atom(formula: Formula) -> bool:
    is_comparison = isinstance(formula, Apply) and formula.op in COMPARISONS
    return is_comparison or isinstance(formula, Var)


def _remove_primes(formula: Formula) -> Formula:
    match formula:
        case Var(name):
            return Var(name)
        case Apply(op, args):
            return Apply(op, tuple(map(_remove_primes, args)))
        case _:
            return formula


_NOTATION = _SmvNotation({**LTL_WORDS, Op.RELEASE: "V"}, add_next_operator)
