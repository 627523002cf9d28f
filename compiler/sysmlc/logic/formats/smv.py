"""SMV (NuSMV, nuXmv): the behaviour as a model, and the requirements as LTLSPEC.

INIT, INVAR and TRANS are the steps that the compiler derives from the model, JUSTICE the recurring
assumptions. A comment behind a variable, ``-- input`` or ``-- output``, names its owner. NuSMV's
LTL does not allow a next value inside a comparison, so that in LTLSPEC a comparison of a current
with a next value becomes cases.
"""

import re
from pathlib import PurePath

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import (
    BooleanDomain,
    Class,
    Conjunct,
    Contract,
    Domain,
    EnumerationDomain,
    IntegerDomain,
    Owner,
    Source,
    Variable,
    drop_trivial,
)
from sysmlc.logic.formats.draft import ContractDraft, SpecificationFile
from sysmlc.logic.formats.lowering import (
    eliminate_weak_until,
    expand_comparison,
    has_partial_division,
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
    is_recurring,
    is_step,
    remove_primes,
)
from sysmlc.logic.formula import Apply, Formula, Literal, Op, Var
from sysmlc.logic.identifiers import Names
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
_CONDITIONS = {
    "INIT": (Owner.SYSTEM, Class.INIT),
    "INVAR": (Owner.SYSTEM, Class.SAFETY),
    "TRANS": (Owner.SYSTEM, Class.SAFETY),
    "JUSTICE": (Owner.ENVIRONMENT, Class.LIVENESS),
}
"""Sections with a condition, each with the owner and class of the conjunct that it states."""
_SECTIONS = ("MODULE", "VAR", "IVAR", "LTLSPEC", *_CONDITIONS)
_KEYWORDS = frozenset(
    re.findall(
        r"\w+",
        "MODULE DEFINE MDEFINE CONSTANTS VAR IVAR FROZENVAR INIT TRANS INVAR SPEC CTLSPEC LTLSPEC "
        "PSLSPEC COMPUTE NAME INVARSPEC FAIRNESS JUSTICE COMPASSION ISA ASSIGN CONSTRAINT SIMPWFF "
        "CTLWFF LTLWFF PSLWFF COMPWFF IN MIN MAX MIRROR PRED PREDICATES process array of boolean "
        "integer real word word1 bool signed unsigned extend resize sizeof uwconst swconst EX AX "
        "EF AF EG AG E F O G H X Y Z A U S V T BU EBF ABF EBG ABG case esac mod next init union "
        "in xor xnor self TRUE FALSE count abs max min COMPID NEXTWFF READ WRITE CONSTARRAY "
        "Integer Real Word toint floor typeof FUN PARSYNTH pi sin cos exp tan ln clock time "
        "noncontinuous",
    )
)
_RESERVED = _KEYWORDS | {*SYNTAX.prefix, *SYNTAX.infix, *BOOLEANS}


# -- reading ---------------------------------------------------------------------------------------


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract of the file's main module, or nothing if a fault was reported.

    The name of the only LTLSPEC, else of the file, is the name of the contract.
    """
    draft = ContractDraft(file, "SMV")
    cursor = Cursor(tokenize(file.text, SYNTAX))
    specifications: dict[str, Formula] = {}
    while not cursor.is_at_end:
        draft.read_statement(cursor, lambda: _read_section(draft, cursor, specifications), ";")
    only_name = "".join(specifications) if len(specifications) == 1 else ""
    return draft.build(only_name or PurePath(file.path).stem)


def _read_section(draft: ContractDraft, cursor: Cursor, specifications: dict[str, Formula]) -> None:
    title = cursor.expect_kind("name", "a section")
    if title.text == "MODULE":
        cursor.expect_kind("name", "a name")
    elif title.text in ("VAR", "IVAR"):
        while cursor.next.kind == "name" and cursor.after_next.text == ":":
            _read_declaration(draft, cursor)
    elif title.text == "LTLSPEC":
        _read_specification(draft, cursor, specifications)
    elif title.text in _CONDITIONS:
        _read_condition(draft, cursor, *_CONDITIONS[title.text])
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


def _read_condition(draft: ContractDraft, cursor: Cursor, owner: Owner, class_: Class) -> None:
    def read() -> None:
        offset = cursor.next.offset
        formula = _SmvReader(cursor, SYNTAX, draft.domains).read_formula()
        _expect_end(cursor)
        draft.add(owner, class_, formula, offset, source=Source.DERIVED)

    if not draft.read_formula(owner, class_, read):
        cursor.skip_to(";")
    cursor.accept(";")


def _read_specification(
    draft: ContractDraft, cursor: Cursor, specifications: dict[str, Formula]
) -> None:
    """Read a requirement, and record its assumptions under its name."""
    name = f"{len(specifications) + 1}" if specifications else ""
    if cursor.accept("NAME"):
        name = cursor.expect_kind("name", "a name").text
        cursor.expect(":=")

    def read() -> None:
        assumed = next(iter(specifications.values()), None)
        reader = _SmvReader(cursor, SYNTAX, draft.domains)
        specifications[name] = read_sides(draft, reader, assumed)
        _expect_end(cursor)

    if not draft.read_formula(Owner.SYSTEM, Class.OTHER, read):
        cursor.skip_to(";")
    cursor.accept(";")


def _expect_end(cursor: Cursor) -> None:
    if not cursor.is_next(";") and not cursor.is_at_end:
        cursor.fail("';' is expected")


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
    """Return the contract without weak until and, outside TRANS, comparisons across a step.

    Raises NotExpressibleError.
    """
    renamed = rename_reserved(contract, _RESERVED)
    lowered = rewrite_conjuncts(renamed, eliminate_weak_until)
    return apply_lowering(lowered, format_name, _lower_atoms)


def _lower_atoms(contract: Contract) -> Contract:
    domains = index_domains(contract)
    divided = rewrite_contract_atoms(
        contract,
        lambda atom: expand_comparison(atom, domains) if has_partial_division(atom) else atom,
    )
    separate = rewrite_contract_atoms(divided, lambda atom: separate_steps(atom, domains))
    pairs = zip(divided.guarantees, separate.guarantees, strict=True)
    guarantees = tuple(whole if is_step(whole) else cases for whole, cases in pairs)
    return replace(separate, guarantees=guarantees)


def write(contract: Contract, format_name: str) -> str:
    """Return a module with the behaviour and, for each requirement on it, an LTLSPEC.

    A contract without behaviour is one LTLSPEC: the assumptions imply the guarantees.
    """
    lowered = lower(contract, format_name)
    steps = [item for item in drop_trivial(lowered.guarantees) if is_step(item)]
    claims = tuple(item for item in lowered.guarantees if not is_step(item))
    justice = [item for item in lowered.assumptions if is_recurring(item) and item.is_derived]
    assumed = tuple(item for item in lowered.assumptions if item not in justice)
    lines = [
        "MODULE main",
        "VAR",
        *map(_print_declaration, lowered.variables),
        *(f"{_name_section(item)} {_MODEL.print(item.formula)};" for item in steps),
        *(f"JUSTICE {_MODEL.print(item.formula)};" for item in justice),
    ]
    name = convert_to_word(contract.component)
    names = Names(*index_domains(lowered), *_RESERVED, name)
    groups: list[tuple[str, tuple[Conjunct, ...]]] = [
        (names.new(item.viewpoint or name), (item,)) for item in claims
    ]
    if not steps or len(claims) == 1:
        groups = [(name, claims)]
    if not groups:
        lines += (f"-- assumed: {_NOTATION.print_ltl_conjunct(a)}" for a in assumed)
    for title, group in groups:
        viewpoints = {"", *(item.viewpoint for item in group)}
        needed = tuple(item for item in assumed if item.viewpoint in viewpoints)
        formula = replace(lowered, assumptions=needed, guarantees=group)
        specification = print_implication(formula, _NOTATION)
        lines.append(f"LTLSPEC NAME {title} := {specification};")
    return "\n".join([*lines, ""])


def _name_section(conjunct: Conjunct) -> str:
    if conjunct.class_ is Class.INIT:
        return "INIT"
    return "TRANS" if f.has_primes(conjunct.formula) else "INVAR"


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
        text = super().print(remove_primes(formula))
        return f"X {text}" if isinstance(formula, Var) else f"X ({text})"


def _is_atom(formula: Formula) -> bool:
    is_comparison = isinstance(formula, Apply) and formula.op in COMPARISONS
    return is_comparison or isinstance(formula, Var)


def _print_literal(value: Literal) -> str:
    """Return a value; NuSMV takes ``true`` for the name of a variable."""
    return str(value).upper() if isinstance(value, bool) else str(value)


_NOTATION = _SmvNotation({**LTL_WORDS, Op.RELEASE: "V"}, add_next_operator, _print_literal, "smv")
_MODEL = Notation(LTL_WORDS, lambda name: f"next({name})", _print_literal)
