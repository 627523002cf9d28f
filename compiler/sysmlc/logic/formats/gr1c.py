"""gr1c's .spc: Booleans and ranges from 0, comparisons with constants, sections that end in ``;``.

Source: the examples and the manual of gr1c 0.13.
"""

from collections.abc import Iterator
from pathlib import PurePath

from sysmlc.logic.contract import BooleanDomain, Class, Contract, IntegerDomain, Owner, Variable
from sysmlc.logic.formats.draft import ContractDraft, SpecificationFile, read_conjuncts
from sysmlc.logic.formats.encodings import encode_as_integers
from sysmlc.logic.formats.lowering import rename_reserved
from sysmlc.logic.formats.writing import (
    LTL_WORDS,
    Notation,
    add_prime,
    apply_lowering,
    conjuncts_of,
    reduce_to_gr1,
)
from sysmlc.logic.formula import Op
from sysmlc.logic.infix import FormulaReader
from sysmlc.logic.syntax import (
    BOOLEANS,
    COMPARISON_SIGNS,
    CONNECTIVE_SIGNS,
    PRECEDENCE,
    TEMPORAL_SIGNS,
    Cursor,
    Syntax,
    tokenize,
)

SYNTAX = Syntax(
    {"!": Op.NOT, **TEMPORAL_SIGNS},
    {**CONNECTIVE_SIGNS, **COMPARISON_SIGNS},
    BOOLEANS | {"True": True, "False": False},
    {"(": ")"},
    PRECEDENCE,
    signs=(":", ";", "[", "]", ",", "-"),
    comment=r"\#[^\n]*",
)
_DECLARATIONS = {"ENV": Owner.ENVIRONMENT, "SYS": Owner.SYSTEM}
_SECTIONS = {
    "ENVINIT": (Owner.ENVIRONMENT, Class.INIT),
    "ENVTRANS": (Owner.ENVIRONMENT, Class.SAFETY),
    "ENVGOAL": (Owner.ENVIRONMENT, Class.LIVENESS),
    "SYSINIT": (Owner.SYSTEM, Class.INIT),
    "SYSTRANS": (Owner.SYSTEM, Class.SAFETY),
    "SYSGOAL": (Owner.SYSTEM, Class.LIVENESS),
}
_OPERATORS = {Class.INIT: "", Class.SAFETY: "[]", Class.LIVENESS: "[]<>"}
_NOTATION = Notation(LTL_WORDS, add_prime, str, "gr1c")
_RESERVED = frozenset({*_DECLARATIONS, *_SECTIONS, *SYNTAX.booleans})


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract, named after the file, or nothing if a fault was reported."""
    draft = ContractDraft(file, "gr1c")
    cursor = Cursor(tokenize(file.text, SYNTAX))
    while not cursor.is_at_end:
        draft.read_statement(cursor, lambda: _read_section(draft, cursor), ";")
    return draft.build(PurePath(file.path).stem)


def _read_section(draft: ContractDraft, cursor: Cursor) -> None:
    title = cursor.expect(*_DECLARATIONS, *_SECTIONS).text
    cursor.expect(":")
    if title in _DECLARATIONS:
        while cursor.next.kind == "name":
            _read_declaration(draft, cursor, _DECLARATIONS[title])
    elif not cursor.is_next(";"):
        _read_conjuncts(draft, cursor, *_SECTIONS[title])
    cursor.expect(";")


def _read_declaration(draft: ContractDraft, cursor: Cursor, owner: Owner) -> None:
    name = cursor.take()
    if not cursor.accept("["):
        draft.declare(name.text, name.offset, owner, BooleanDomain())
        return
    low = cursor.read_integer()
    cursor.expect(",")
    high = cursor.read_integer()
    cursor.expect("]")
    draft.declare(name.text, name.offset, owner, IntegerDomain(min(low, high), high))


def _read_conjuncts(draft: ContractDraft, cursor: Cursor, owner: Owner, class_: Class) -> None:
    reader = FormulaReader(cursor, SYNTAX, draft.domains)

    def read() -> None:
        for formula, offset in read_conjuncts(reader, SYNTAX, ";"):
            draft.add_classified(owner, class_, formula, offset)

    if not draft.read_formula(owner, class_, read):
        cursor.skip_to(";")


def lower(contract: Contract, format_name: str) -> Contract:
    """Return the contract in GR(1) over integers from 0. Raises NotExpressibleError."""
    game = reduce_to_gr1(contract, format_name, separate_init=True)
    return apply_lowering(
        rename_reserved(game, _RESERVED),
        format_name,
        lambda contract: encode_as_integers(contract, is_flat=True),
    )


def write(contract: Contract, format_name: str) -> str:
    """Return the contract as text. Raises NotExpressibleError."""
    lowered = lower(contract, format_name)
    lines = []
    for title, owner in _DECLARATIONS.items():
        variables = (variable for variable in lowered.variables if variable.owner is owner)
        declarations = "".join(f" {_print_declaration(variable)}" for variable in variables)
        lines.append(f"{title}:{declarations};")
    lines.append("")
    for title, (owner, class_) in _SECTIONS.items():
        lines.append(f"{title}:{''.join(_iter_lines(lowered, owner, class_))};")
    return "\n".join([*lines, ""])


def _print_declaration(variable: Variable) -> str:
    if isinstance(variable.domain, IntegerDomain):
        return f"{variable.name} [0,{variable.domain.high}]"
    return variable.name


def _iter_lines(contract: Contract, owner: Owner, class_: Class) -> Iterator[str]:
    for index, conjunct in enumerate(conjuncts_of(contract, owner, class_)):
        text = _NOTATION.print_conjunct(conjunct)
        yield f"\n{'& ' if index else '  '}{_OPERATORS[class_]}({text})"
