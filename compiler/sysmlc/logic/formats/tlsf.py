"""TLSF: sections of assumptions and guarantees over Boolean signals, parameters, definitions.

Source: TLSF v1.1. Enumerations, sets and patterns of its full form are reported as not supported.
"""

import re
from collections.abc import Callable, Iterator
from pathlib import PurePath

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Contract, Owner
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.draft import ContractDraft, SpecificationFile
from sysmlc.logic.formats.encodings import encode_as_bits
from sysmlc.logic.formats.lowering import rename_reserved
from sysmlc.logic.formats.tlsf_expressions import (
    INFIX,
    MAX_CALL_DEPTH,
    PREFIX,
    QUANTIFIERS,
    Bus,
    Definition,
    Evaluator,
    Tree,
    Value,
    parse_expression,
)
from sysmlc.logic.formats.writing import (
    LTL_WORDS,
    Notation,
    add_next_operator,
    apply_lowering,
    conjuncts_of,
)
from sysmlc.logic.formula import Formula, Op, Var
from sysmlc.logic.infix import MAX_DEPTH
from sysmlc.logic.syntax import Cursor, Syntax, Token, tokenize
from sysmlc.support.interpreter import allow_recursion
from sysmlc.support.program_text import format_comment

_SIGNS = ("!", "&&", "||", "->", "<->", "==", "!=", "<", "<=", ">", ">=", "+", "-", "*", "/", "%")
# The tables of operators are empty: `tlsf_expressions` parses expressions, with other precedences.
SYNTAX = Syntax(
    {},
    {},
    {},
    {"(": ")", "[": "]", "{": "}"},
    {},
    signs=(*_SIGNS, ";", ":", ",", "=", "~", "."),
    comment=r"//[^\n]*|/\*[\s\S]*?\*/",
    name=r"[^\W\d][\w'@]*",
    string=r'"[^"]*"',
)
_OWNERS = {"INPUTS": Owner.ENVIRONMENT, "OUTPUTS": Owner.SYSTEM}
_SECTIONS = {
    "INITIALLY": (Owner.ENVIRONMENT, Class.INIT),
    "PRESET": (Owner.SYSTEM, Class.INIT),
    "REQUIRE": (Owner.ENVIRONMENT, Class.SAFETY),
    "REQUIREMENTS": (Owner.ENVIRONMENT, Class.SAFETY),
    "ASSERT": (Owner.SYSTEM, Class.SAFETY),
    "INVARIANTS": (Owner.SYSTEM, Class.SAFETY),
    "ASSUME": (Owner.ENVIRONMENT, Class.OTHER),
    "ASSUMPTIONS": (Owner.ENVIRONMENT, Class.OTHER),
    "GUARANTEE": (Owner.SYSTEM, Class.OTHER),
    "GUARANTEES": (Owner.SYSTEM, Class.OTHER),
}
_UNSUPPORTED_SEMANTICS = {
    "Moore": "the semantics of Moore machines",
    "Finite": "the semantics of finite runs",
}
_MAX_BUS_WIDTH = 1 << 12
_RESERVED = frozenset(
    {*INFIX, *PREFIX, *QUANTIFIERS, *_SECTIONS, *_OWNERS, "otherwise", "true", "false", "IN"}
    | {"INFO", "MAIN", "GLOBAL", "PARAMETERS", "DEFINITIONS", "SUM", "PROD", "MIN", "MAX", "CAP"}
    | {"CUP", "SETMINUS", "SIZE", "enum"}
)


# -- reading ---------------------------------------------------------------------------------------

_SectionReader = Callable[[str], None]
"""Reads one item of the section with the title."""


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract, named after the file, or nothing if a fault was reported."""
    # The evaluator recurses over trees and over calls.
    with allow_recursion(MAX_DEPTH + 2 * MAX_CALL_DEPTH):
        return _TlsfReader(file).read()


class _TlsfReader:
    """Reads a file in two rounds: declarations, which may stand below their use, and formulas."""

    def __init__(self, file: SpecificationFile) -> None:
        self._draft = ContractDraft(file, "TLSF")
        self._cursor = Cursor(tokenize(file.text, SYNTAX))
        self._definitions: dict[str, Definition] = {}
        self._signals: dict[str, Value] = {}
        self._evaluator = Evaluator(self._definitions, self._signals)

    def read(self) -> tuple[Contract, ...]:
        """Return the contract, or nothing if a fault was reported."""
        self._read_sections(self._read_declaration)
        self._cursor.reset(0)
        self._read_sections(self._read_formula)
        return self._draft.build(PurePath(self._draft.file.path).stem)

    def _read_sections(self, read_item: _SectionReader) -> None:
        cursor = self._cursor
        while not cursor.is_at_end and not self._draft.is_broken:
            self._draft.read_statement(cursor, lambda: self._read_section(read_item), "}")

    def _read_section(self, read_item: _SectionReader) -> None:
        """Read a section; MAIN and GLOBAL contain sections."""
        cursor = self._cursor
        title = cursor.expect_kind("name", "a section").text
        cursor.expect("{")
        while not cursor.accept("}"):
            if cursor.is_at_end:
                cursor.fail("'}' is expected")
            if title in ("MAIN", "GLOBAL"):
                self._read_section(read_item)
            else:
                read_item(title)

    def _read_declaration(self, title: str) -> None:
        if title == "INFO":
            self._read_info()
        elif title in ("PARAMETERS", "DEFINITIONS"):
            self._read_definition()
        elif title in _OWNERS:
            self._read_signal(_OWNERS[title])
        elif title in _SECTIONS:
            self._skip_section()
        else:
            self._cursor.fail(f"'{title}' is no section that is known; what it holds")

    def _skip_section(self) -> None:
        """Move to the brace that closes the section."""
        cursor, depth = self._cursor, 0
        while not cursor.is_at_end and (depth or not cursor.is_next("}")):
            depth += cursor.is_next("{") - cursor.is_next("}")
            cursor.take()

    def _read_info(self) -> None:
        cursor = self._cursor
        title = cursor.expect_kind("name", "a title")
        offset = cursor.expect(":").offset + 1
        words = []
        while not cursor.is_next("}") and not cursor.is_at_end and cursor.after_next.text != ":":
            words.append(cursor.take().text)
        if title.text == "SEMANTICS":
            self._check_semantics([word for word in words if word != ","], offset)

    def _check_semantics(self, words: list[str], offset: int) -> None:
        for word in words:
            if word in _UNSUPPORTED_SEMANTICS:
                self._draft.report_outside(offset, _UNSUPPORTED_SEMANTICS[word])
        if _UNSUPPORTED_SEMANTICS.keys().isdisjoint(words) and "Strict" not in words:
            self._draft.file.report(rules.NOT_STRICT, offset, semantics=",".join(words))

    def _read_definition(self) -> None:
        cursor = self._cursor
        name = cursor.expect_kind("name", "a name")
        if name.text == "enum":
            self._draft.report_outside(name.offset, "an enumeration")
            cursor.skip_past(";")
            return
        parameters = []
        if cursor.accept("("):
            parameters.append(cursor.expect_kind("name", "a name").text)
            while cursor.accept(","):
                parameters.append(cursor.expect_kind("name", "a name").text)
            cursor.expect(")")
        cursor.expect("=")
        clauses = [self._read_clause()]
        while not cursor.accept(";"):
            clauses.append(self._read_clause())
        if name.text in self._definitions:
            self._draft.report_fault(rules.DECLARED_TWICE, name.offset, name=name.text)
        self._definitions[name.text] = Definition(tuple(parameters), tuple(clauses))

    def _read_clause(self) -> tuple[Tree | None, Tree]:
        """Read ``guard: body``, ``otherwise: body`` or a body alone."""
        cursor = self._cursor
        if cursor.accept("otherwise"):
            cursor.expect(":")
            return None, parse_expression(cursor)
        first = parse_expression(cursor)
        return (first, parse_expression(cursor)) if cursor.accept(":") else (None, first)

    def _read_signal(self, owner: Owner) -> None:
        cursor = self._cursor
        token = cursor.expect_kind("name", "a name")
        # Only TLSF allows the signs ' and @ in names.
        name = re.sub(r"\W", "_", token.text)
        if not cursor.accept("["):
            cursor.expect(";")
            self._declare(name, token, owner)
            self._signals[token.text] = Var(name)
            return
        width = self._evaluator.evaluate_number(parse_expression(cursor), {})
        cursor.expect("]")
        cursor.expect(";")
        if not 0 <= width <= _MAX_BUS_WIDTH:
            cursor.fail(f"a bus has 0 to {_MAX_BUS_WIDTH} bits")
        bits = tuple(f"{name}_{bit}" for bit in range(width))
        for bit in bits:
            self._declare(bit, token, owner)
        self._signals[token.text] = Bus(bits)

    def _declare(self, name: str, token: Token, owner: Owner) -> None:
        self._draft.declare(name, token.offset, owner, BooleanDomain())

    def _read_formula(self, title: str) -> None:
        if title not in _SECTIONS:
            self._skip_section()
            return
        cursor = self._cursor
        owner, class_ = _SECTIONS[title]

        def read() -> None:
            tree = parse_expression(cursor)
            if not cursor.is_next(";", "}"):
                cursor.fail("';' is expected")
            formula = self._evaluator.evaluate_formula(tree, {})
            self._add_formula(owner, class_, formula, _find_start(tree))

        if not self._draft.read_formula(owner, class_, read):
            cursor.skip_to(";", "}")
        while cursor.accept(";"):
            pass

    def _add_formula(self, owner: Owner, class_: Class, formula: Formula, offset: int) -> None:
        if class_ is Class.INIT:
            self._draft.add_classified(owner, class_, formula, offset)
        else:
            whole = f.always(formula) if class_ is Class.SAFETY else formula
            self._draft.add_ltl(owner, whole, offset)


def _find_start(tree: Tree) -> int:
    """Return the offset of the first character of an expression.

    ``tree.offset`` is the offset of the operator, which follows its first operand."""
    return min([tree.offset, *(_find_start(arg) for arg in tree.args[:1])])


# -- writing ---------------------------------------------------------------------------------------

_NOTATION = Notation(LTL_WORDS | {Op.AND: "&&", Op.OR: "||"}, add_next_operator, format_name="TLSF")
_WRITTEN_SECTIONS = {
    "INITIALLY": (Owner.ENVIRONMENT, (Class.INIT,)),
    "PRESET": (Owner.SYSTEM, (Class.INIT,)),
    "REQUIRE": (Owner.ENVIRONMENT, (Class.SAFETY,)),
    "ASSERT": (Owner.SYSTEM, (Class.SAFETY,)),
    "ASSUME": (Owner.ENVIRONMENT, (Class.LIVENESS, Class.OTHER)),
    "GUARANTEE": (Owner.SYSTEM, (Class.LIVENESS, Class.OTHER)),
}


def lower(contract: Contract, format_name: str) -> Contract:
    """Return the contract over Booleans. Raises NotExpressibleError."""
    return apply_lowering(rename_reserved(contract, _RESERVED), format_name, encode_as_bits)


def write(contract: Contract, format_name: str) -> str:
    """Return the contract over bits, with the semantics of GR(1) games (strict implication)."""
    lowered = lower(contract, format_name)
    # A string of TLSF ends at the next quotation mark, and has no escapes.
    title = format_comment(contract.component)
    lines = [
        "INFO {",
        f'  TITLE:       "{title}"',
        '  DESCRIPTION: "Contract of the component, written by sysmlc."',
        "  SEMANTICS:   Mealy,Strict",
        "  TARGET:      Mealy",
        "}\n",
        "MAIN {",
    ]
    for section, owner in _OWNERS.items():
        names = (variable.name for variable in lowered.variables if variable.owner is owner)
        lines.append(_print_section(section, names))
    for section, (owner, classes) in _WRITTEN_SECTIONS.items():
        lines.append(_print_section(section, _iter_formulas(lowered, owner, classes)))
    return "\n".join([*lines, "}", ""])


def _print_section(title: str, items: Iterator[str]) -> str:
    return "\n".join([f"  {title} {{", *(f"    {item};" for item in items), "  }"])


def _iter_formulas(contract: Contract, owner: Owner, classes: tuple[Class, ...]) -> Iterator[str]:
    for class_ in classes:
        for conjunct in conjuncts_of(contract, owner, class_):
            # The section implies "always" for safety; only liveness needs its operators.
            if class_ is not Class.LIVENESS:
                conjunct = replace(conjunct, class_=Class.OTHER)
            yield _NOTATION.print_ltl_conjunct(conjunct)
