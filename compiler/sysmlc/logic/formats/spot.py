"""Spot: one LTL formula over Booleans, with lines ``.inputs`` and ``.outputs`` for the owners.

The lines below the formula are those of ltlsynt's ``--part-file``. SPIN and SMV also have one
formula ``assumptions -> guarantees``, which this module reads and writes for them.
"""

import re
from collections.abc import Iterable
from pathlib import PurePath

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Conjunct, Contract, Owner, drop_trivial
from sysmlc.logic.formats.draft import ContractDraft, SpecificationFile
from sysmlc.logic.formats.encodings import encode_as_bits
from sysmlc.logic.formats.lowering import rename_reserved
from sysmlc.logic.formats.writing import (
    LTL_WORDS,
    Notation,
    add_next_operator,
    apply_lowering,
)
from sysmlc.logic.formula import Formula, Op, Var
from sysmlc.logic.infix import BOOLEAN, FormulaReader, Term
from sysmlc.logic.syntax import (
    CONNECTIVE_SIGNS,
    PRECEDENCE,
    TEMPORAL_SIGNS,
    TEMPORAL_WORDS,
    UNTIL_WORDS,
    Cursor,
    FormulaError,
    Syntax,
    Token,
    tokenize,
)

SYNTAX = Syntax(
    {"!": Op.NOT, "~": Op.NOT, **TEMPORAL_WORDS, **TEMPORAL_SIGNS},
    {
        **CONNECTIVE_SIGNS,
        **UNTIL_WORDS,
        "/\\": Op.AND,
        "\\/": Op.OR,
        "=>": Op.IMPLIES,
        "<=>": Op.IFF,
    },
    {"true": True, "false": False, "1": True, "0": False},
    {"(": ")"},
    PRECEDENCE,
    signs=("-",),
)
_PARTITION_LINE = re.compile(r"^[ \t]*\.(inputs|outputs)\b[ \t:]*([^\n]*)$", re.MULTILINE)
_NAME = re.compile(r"[^\s,]+")
_OWNERS = {"inputs": Owner.ENVIRONMENT, "outputs": Owner.SYSTEM}
_NOTATION = Notation(LTL_WORDS, add_next_operator, format_name="Spot")
_RESERVED = frozenset({*SYNTAX.prefix, *SYNTAX.infix, *SYNTAX.booleans, "M", "xor"})


# -- reading ---------------------------------------------------------------------------------------


def read(file: SpecificationFile) -> tuple[Contract, ...]:
    """Return the contract, named after the file, or nothing if a fault was reported."""
    draft = ContractDraft(file, "Spot")
    for line in _PARTITION_LINE.finditer(file.text):
        for name in _NAME.finditer(line.group(2)):
            offset = line.start(2) + name.start()
            if name.group().isidentifier():
                draft.declare(name.group(), offset, _OWNERS[line.group(1)], BooleanDomain())
            else:
                reason = f"'{name.group()}' is not a valid name in formulas"
                draft.report_not_understood(offset, reason)
    read_implication(draft, blank_partition(file.text), SYNTAX, _SpotReader)
    return draft.build(PurePath(file.path).stem.removesuffix(".spot"))


def read_partition(text: str) -> dict[str, Owner]:
    """Return the owners of the variables that the lines ``.inputs`` and ``.outputs`` name."""
    return {
        name: _OWNERS[line.group(1)]
        for line in _PARTITION_LINE.finditer(text)
        for name in _NAME.findall(line.group(2))
    }


def blank_partition(text: str) -> str:
    """Replace the lines ``.inputs`` and ``.outputs`` by blanks, which preserves offsets."""
    return _PARTITION_LINE.sub(lambda line: " " * len(line.group()), text)


def read_implication(
    draft: ContractDraft, text: str, syntax: Syntax, reader_class: type[FormulaReader]
) -> None:
    """Add the text ``assumptions -> guarantees``, or guarantees alone, to the draft."""
    cursor = Cursor(tokenize(text, syntax))

    def read() -> None:
        read_sides(draft, reader_class(cursor, syntax, draft.domains))
        cursor.expect_end()

    draft.read_formula(Owner.SYSTEM, Class.OTHER, read)


def read_sides(
    draft: ContractDraft, reader: FormulaReader, assumed: Formula | None = None
) -> Formula:
    """Read ``assumptions -> guarantees``, or guarantees alone, and add them to the draft.

    Return the assumptions. *assumed* are those of an earlier formula of the same contract; they are
    not added again. Raises FormulaError, also for other assumptions than these.
    """
    # The formula is not read whole, because folding would drop a side if the other is constant.
    offset = right_offset = reader.cursor.next.offset
    left: Formula = f.TRUE
    right = reader.read_formula(PRECEDENCE[Op.IMPLIES] + 1)
    if reader.cursor.accept("->"):
        right_offset = reader.cursor.next.offset
        left, right = right, reader.read_formula()
    if assumed is None:
        draft.add_ltl(Owner.ENVIRONMENT, left, offset)
    elif left != assumed:
        raise FormulaError("it has other assumptions than the formula before", offset)
    draft.add_ltl(Owner.SYSTEM, right, right_offset)
    return left


class _SpotReader(FormulaReader):
    """Reads Spot's atomic propositions, which may be quoted; 0 and 1 are Booleans."""

    def read_operand(self) -> Term:
        token = self.cursor.next
        if token.kind == "number" and token.text in SYNTAX.booleans:
            self.cursor.take()
            return Term(f.const(SYNTAX.booleans[token.text]), BOOLEAN, token.offset)
        if token.kind == "string":
            self.cursor.take()
            return self.resolve_name(Token("name", token.text[1:-1], token.offset))
        return super().read_operand()

    def resolve_name(self, token: Token) -> Term:
        if token.text in self.variables:
            return Term(Var(token.text), BOOLEAN, token.offset)
        where = "lines below it, or in the .part file beside it"
        reason = f"'{token.text}' is among neither the .inputs nor the .outputs ({where})"
        raise FormulaError(reason, token.offset)


# -- writing ---------------------------------------------------------------------------------------


def lower(contract: Contract, format_name: str) -> Contract:
    """Return the contract over Booleans. Raises NotExpressibleError."""
    return apply_lowering(rename_reserved(contract, _RESERVED), format_name, encode_as_bits)


def write(contract: Contract, format_name: str) -> str:
    """Return the contract as one formula over bits with the owners of the bits below it."""
    lowered = lower(contract, format_name)
    formula = print_implication(lowered, _NOTATION)
    return "\n".join([formula, *list_partition(lowered), ""])


def list_partition(contract: Contract) -> list[str]:
    """Return the lines ``.inputs`` and ``.outputs``."""
    lines = []
    for title, owner in _OWNERS.items():
        names = [variable.name for variable in contract.variables if variable.owner is owner]
        lines.append(" ".join([f".{title}", *names]))
    return lines


def print_implication(contract: Contract, notation: Notation) -> str:
    """Return ``(assumptions) -> (guarantees)``, or the guarantees alone if nothing is assumed."""
    guarantees = _print_conjunction(contract.guarantees, notation)
    assumptions = _print_conjunction(contract.assumptions, notation)
    if assumptions == notation.print(f.TRUE):
        return guarantees
    return f"({assumptions}) {notation.words[Op.IMPLIES]} ({guarantees})"


def _print_conjunction(conjuncts: Iterable[Conjunct], notation: Notation) -> str:
    texts = [f"({notation.print_ltl_conjunct(item)})" for item in drop_trivial(conjuncts)]
    return f" {notation.words[Op.AND]} ".join(texts) or notation.print(f.TRUE)
