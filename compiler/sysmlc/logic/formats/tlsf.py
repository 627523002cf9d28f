"""TLSF: sections of assumptions and guarantees over Boolean signals, parameters, definitions.

Source: TLSF v1.1; enumerations, sets and patterns of its full form are named as outside.
"""

import re
from collections.abc import Callable, Iterator
from pathlib import PurePath

from msgspec.structs import replace

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Contract, Owner
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.base import conjuncts_of, lowered, said_ltl
from sysmlc.logic.formats.counting import in_bits
from sysmlc.logic.formats.draft import Draft
from sysmlc.logic.formats.file import File
from sysmlc.logic.formats.lower import renamed
from sysmlc.logic.formats.spelt import LTL, Spelling, next_of
from sysmlc.logic.formats.tlsf_tree import INFIX, PREFIX, QUANTIFIERS, Tree, expression
from sysmlc.logic.formats.tlsf_values import DEEPEST_CALL, Bus, Definition, Value, Values
from sysmlc.logic.formula import Formula, Op, Var
from sysmlc.logic.infix import DEEPEST
from sysmlc.logic.spelling import Cursor, Syntax, tokens
from sysmlc.support.escapes import escape_invisible
from sysmlc.support.recursion import allow_recursion

_SIGNS = ("!", "&&", "||", "->", "<->", "==", "!=", "<", "<=", ">", ">=", "+", "-", "*", "/", "%")
SYNTAX = Syntax(
    {},
    {},
    {},
    {"(": ")", "[": "]", "{": "}"},
    {},
    (*_SIGNS, ";", ":", ",", "=", "~", "."),
    r"//[^\n]*|/\*[\s\S]*?\*/",
    r"[^\W\d][\w'@]*",
    r'"[^"]*"',
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
_OUTSIDE = {"Moore": "the semantics of Moore machines", "Finite": "the semantics of finite runs"}
_Handler = Callable[[Cursor, str], None]


def read(file: File) -> tuple[Contract, ...]:
    """The contract of the file, whose name it has."""
    with allow_recursion(DEEPEST + 2 * DEEPEST_CALL):
        return _File(file).read()


class _File:
    """Reads a file: first what is declared anywhere in it, then what is said."""

    def __init__(self, file: File) -> None:
        self._draft = Draft(file, "TLSF")
        self._cursor = Cursor(tokens(file.text, SYNTAX))
        self._definitions: dict[str, Definition] = {}
        self._known: dict[str, Value] = {}
        self._values = Values(self._definitions, self._known)

    def read(self) -> tuple[Contract, ...]:
        """The contract, unless something is wrong with it."""
        self._each_section(self._declaring)
        self._cursor.back_to(0)
        self._each_section(self._saying)
        return self._draft.contracts(PurePath(self._draft.file.path).stem)

    def _each_section(self, handle: _Handler) -> None:
        cursor = self._cursor
        while cursor.next.kind != "end" and not self._draft.is_broken:
            self._draft.statement(cursor, lambda: self._section(handle), "}")

    def _section(self, handle: _Handler) -> None:
        title = self._cursor.expect_kind("name", "a section").text
        self._cursor.expect("{")
        self._inside(title, handle)

    def _inside(self, title: str, handle: _Handler) -> None:
        """What stands in a section up to its brace; MAIN and GLOBAL hold further ones."""
        cursor = self._cursor
        while not cursor.took("}"):
            if cursor.next.kind == "end":
                cursor.fail("'}' is expected")
            if title in ("MAIN", "GLOBAL"):
                self._section(handle)
            else:
                handle(cursor, title)

    def _declaring(self, cursor: Cursor, title: str) -> None:
        if title == "INFO":
            self._info(cursor)
        elif title in ("PARAMETERS", "DEFINITIONS"):
            self._definition(cursor)
        elif title in _OWNERS:
            self._signal(cursor, _OWNERS[title])
        elif title in _SECTIONS:
            self._skip(cursor)
        else:
            cursor.fail(f"'{title}' is no section that is known; what it holds")

    def _skip(self, cursor: Cursor) -> None:
        """Go on to the brace that closes the section."""
        depth = 0
        while cursor.next.kind != "end" and (depth or not cursor.has("}")):
            depth += cursor.has("{") - cursor.has("}")
            cursor.take()

    def _info(self, cursor: Cursor) -> None:
        title = cursor.expect_kind("name", "a title")
        at = cursor.expect(":").at + 1
        words = []
        while not cursor.has("}") and cursor.next.kind != "end" and cursor.after_next.text != ":":
            words.append(cursor.take().text)
        if title.text == "SEMANTICS":
            self._semantics([word for word in words if word != ","], at)

    def _semantics(self, words: list[str], at: int) -> None:
        for word in words:
            if word in _OUTSIDE:
                self._draft.fault(rules.OUTSIDE, at, what=_OUTSIDE[word], form="TLSF")
        if _OUTSIDE.keys().isdisjoint(words) and "Strict" not in words:
            self._draft.file.report(rules.NOT_STRICT, at, semantics=",".join(words))

    def _definition(self, cursor: Cursor) -> None:
        name = cursor.expect_kind("name", "a name")
        if name.text == "enum":
            self._draft.fault(rules.OUTSIDE, name.at, what="an enumeration", form="TLSF")
            self._cursor.skip_behind(";")
            return
        parameters = []
        if cursor.took("("):
            parameters.append(cursor.expect_kind("name", "a name").text)
            while cursor.took(","):
                parameters.append(cursor.expect_kind("name", "a name").text)
            cursor.expect(")")
        cursor.expect("=")
        clauses = [_clause(cursor)]
        while not cursor.took(";"):
            clauses.append(_clause(cursor))
        if name.text in self._definitions:
            self._draft.fault(rules.DECLARED_TWICE, name.at, name=name.text)
        self._definitions[name.text] = Definition(tuple(parameters), tuple(clauses))

    def _signal(self, cursor: Cursor, owner: Owner) -> None:
        name = cursor.expect_kind("name", "a name")
        if not cursor.took("["):
            cursor.expect(";")
            self._declare(_plain_name(name.text), name.at, owner)
            self._known[name.text] = Var(_plain_name(name.text))
            return
        size = self._values.number(expression(cursor), {})
        cursor.expect("]")
        cursor.expect(";")
        if not 0 <= size <= _WIDEST:
            cursor.fail(f"a bus has 0 to {_WIDEST} bits")
        bits = tuple(f"{_plain_name(name.text)}_{bit}" for bit in range(size))
        for bit in bits:
            self._declare(bit, name.at, owner)
        self._known[name.text] = Bus(bits)

    def _declare(self, name: str, at: int, owner: Owner) -> None:
        self._draft.declare(name, at, owner, BooleanDomain())

    def _saying(self, cursor: Cursor, title: str) -> None:
        if title not in _SECTIONS:
            self._skip(cursor)
            return
        owner, class_ = _SECTIONS[title]

        def read_one() -> None:
            tree = expression(cursor)
            if not cursor.has(";", "}"):
                cursor.fail("';' is expected")
            self._add(owner, class_, self._values.truth(tree, {}), _start(tree))

        if not self._draft.formula(owner, class_, read_one):
            cursor.skip_to(";", "}")
        while cursor.took(";"):
            pass

    def _add(self, owner: Owner, class_: Class, formula: Formula, at: int) -> None:
        if class_ is Class.INIT:
            self._draft.add_classified(owner, class_, formula, at)
        else:
            whole = f.always(formula) if class_ is Class.SAFETY else formula
            self._draft.add_ltl(owner, whole, at)


def _plain_name(name: str) -> str:
    """A name without the signs that only TLSF has in names."""
    return re.sub(r"\W", "_", name)


def _start(tree: Tree) -> int:
    return min([tree.at, *(_start(arg) for arg in tree.args[:1])])


def _clause(cursor: Cursor) -> tuple[Tree | None, Tree]:
    if cursor.took("otherwise"):
        cursor.expect(":")
        return None, expression(cursor)
    first = expression(cursor)
    return (first, expression(cursor)) if cursor.took(":") else (None, first)


_WIDEST = 1 << 12
_SPELLING = Spelling(
    LTL | {Op.AND: "&&", Op.OR: "||"},
    next_of,
)
_WRITTEN = {
    "INITIALLY": (Owner.ENVIRONMENT, (Class.INIT,)),
    "PRESET": (Owner.SYSTEM, (Class.INIT,)),
    "REQUIRE": (Owner.ENVIRONMENT, (Class.SAFETY,)),
    "ASSERT": (Owner.SYSTEM, (Class.SAFETY,)),
    "ASSUME": (Owner.ENVIRONMENT, (Class.LIVENESS, Class.OTHER)),
    "GUARANTEE": (Owner.SYSTEM, (Class.LIVENESS, Class.OTHER)),
}


def plain(contract: Contract, form: str) -> Contract:
    """The contract over Booleans. Raises NotExpressibleError."""
    return lowered(renamed(contract, _RESERVED), form, in_bits)


def write(contract: Contract, form: str) -> str:
    """The contract over bits, with the semantics of games (strict implication)."""
    made = plain(contract, form)
    title = escape_invisible(contract.component).replace("\\", "").replace('"', "")
    parts = [
        "INFO {",
        f'  TITLE:       "{title}"',
        '  DESCRIPTION: "Contract of the component, written by sysmlc."',
        "  SEMANTICS:   Mealy,Strict",
        "  TARGET:      Mealy",
        "}\n",
        "MAIN {",
        *(_block(name, _signals(made, owner)) for name, owner in _OWNERS.items()),
        *(_block(name, _lines(made, *key)) for name, key in _WRITTEN.items()),
        "}",
    ]
    return "\n".join([*parts, ""])


def _block(title: str, lines: Iterator[str]) -> str:
    return "\n".join([f"  {title} {{", *(f"    {line};" for line in lines), "  }"])


def _signals(contract: Contract, owner: Owner) -> Iterator[str]:
    return (one.name for one in contract.variables if one.owner is owner)


def _lines(contract: Contract, owner: Owner, classes: tuple[Class, ...]) -> Iterator[str]:
    for class_ in classes:
        for one in conjuncts_of(contract, owner, class_):
            shown = one if class_ is Class.LIVENESS else replace(one, class_=Class.OTHER)
            yield said_ltl("TLSF", _SPELLING, shown)


_RESERVED = frozenset(
    {*INFIX, *PREFIX, *QUANTIFIERS, *_SECTIONS, *_OWNERS, "otherwise", "true", "false", "IN"}
    | {"INFO", "MAIN", "GLOBAL", "PARAMETERS", "DEFINITIONS", "SUM", "PROD", "MIN", "MAX", "CAP"}
    | {"CUP", "SETMINUS", "SIZE", "enum"}
)
