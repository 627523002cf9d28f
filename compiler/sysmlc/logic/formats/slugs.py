"""Structured slugs: infix or prefix lines below ``[INPUT]``, ``[SYS_TRANS]`` ..., ranges, sums.

Source: slugs' examples and its tools/StructuredSlugsParser (what is no line of slugsin is infix).
"""

import re
from collections.abc import Callable, Iterator
from pathlib import PurePath

from sysmlc.logic import formula as f
from sysmlc.logic.contract import BooleanDomain, Class, Contract, IntegerDomain, Owner, Variable
from sysmlc.logic.formats import rules
from sysmlc.logic.formats.base import conjuncts_of, game, lowered, said
from sysmlc.logic.formats.counting import counted
from sysmlc.logic.formats.draft import Draft
from sysmlc.logic.formats.file import File
from sysmlc.logic.formats.lower import each_conjunct, flat, known, renamed
from sysmlc.logic.formats.slugs_prefix import PrefixError, from_prefix
from sysmlc.logic.formats.spelt import LTL, Spelling, primed
from sysmlc.logic.formula import Apply, Const, Formula, Op, Var
from sysmlc.logic.infix import TRUTH, Part, Reader
from sysmlc.logic.spelling import (
    COMPARING,
    CONNECTIVES,
    STRENGTH,
    TRUTHS,
    Cursor,
    FormulaError,
    Syntax,
    tokens,
)

SYNTAX = Syntax(
    {"!": Op.NOT},
    {**CONNECTIVES, **COMPARING, "+": Op.ADD},
    TRUTHS,
    {"(": ")"},
    STRENGTH,
    ("^", "-"),
)
DECLARING = {"INPUT": Owner.ENVIRONMENT, "OUTPUT": Owner.SYSTEM}
SECTIONS = {
    "ENV_INIT": (Owner.ENVIRONMENT, Class.INIT),
    "SYS_INIT": (Owner.SYSTEM, Class.INIT),
    "ENV_TRANS": (Owner.ENVIRONMENT, Class.SAFETY),
    "SYS_TRANS": (Owner.SYSTEM, Class.SAFETY),
    "ENV_LIVENESS": (Owner.ENVIRONMENT, Class.LIVENESS),
    "SYS_LIVENESS": (Owner.SYSTEM, Class.LIVENESS),
}
_TITLE = re.compile(r"\[(\w+)\]$")
_DECLARED = re.compile(r"([^\W\d]\w*)(?:\s*:\s*(-?\d+)\s*\.\.\.\s*(-?\d+))?$")
_IN_NAMES = re.compile(r"(?<=\w)[.@](?=\w)")
"""Bits of slugs' own (``x@0.0.7``) become names that formulas of all forms can have."""
_SPELLING = Spelling(
    LTL, primed, lambda v: {True: "TRUE", False: "FALSE"}[v] if v.__class__ is bool else str(v)
)


def read(file: File) -> tuple[Contract, ...]:
    """The contract of the file, whose name it has; slugsin is read by ``[SECTION]`` too."""
    draft = Draft(file, "slugs")
    title = ""
    for at, line in lines(_IN_NAMES.sub("_", file.text)):
        found = _TITLE.match(line)
        if found:
            title = _title(draft, found.group(1), at)
        elif title in DECLARING:
            _declare(draft, line, at, DECLARING[title])
        elif title in SECTIONS:
            _conjunct(draft, line, at, *SECTIONS[title])
        elif not draft.is_broken:
            draft.fault(rules.NOT_UNDERSTOOD, at, form="slugs", reason="it is below no [SECTION]")
    return draft.contracts(PurePath(file.path).stem)


def lines(text: str) -> Iterator[tuple[int, str]]:
    """Lines with something but a comment, without blanks around, with their places."""
    at = 0
    for line in text.split("\n"):
        kept = line.partition("#")[0]
        if kept.strip():
            yield at + len(kept) - len(kept.lstrip()), kept.strip()
        at += len(line) + 1


def _title(draft: Draft, title: str, at: int) -> str:
    if title in DECLARING or title in SECTIONS:
        return title
    known_ones = ", ".join([*DECLARING, *SECTIONS])
    reason = f"[{title}] is no section; there are {known_ones}"
    draft.fault(rules.NOT_UNDERSTOOD, at, form="slugs", reason=reason)
    return ""


def _declare(draft: Draft, line: str, at: int, owner: Owner) -> None:
    found = _DECLARED.match(line)
    if found is None:
        reason = f"'{line}' is neither a name nor a name with a range (x:0...7)"
        draft.fault(rules.NOT_UNDERSTOOD, at, form="slugs", reason=reason)
        return
    name, low, high = found.groups()
    if low is None:
        draft.declare(name, at, owner, BooleanDomain())
    elif len(low) > 18 or len(high) > 18 or int(low) > int(high):
        reason = f"the range of '{name}' is empty or too large"
        draft.fault(rules.NOT_UNDERSTOOD, at, form="slugs", reason=reason)
    else:
        draft.declare(name, at, owner, IntegerDomain(int(low), int(high)))


def _conjunct(draft: Draft, line: str, at: int, owner: Owner, class_: Class) -> None:
    def read_line() -> None:
        draft.add(owner, class_, _formula(draft, line, at), at)

    draft.formula(owner, class_, read_line)


def _formula(draft: Draft, line: str, at: int) -> Formula:
    """A line: in prefix notation if it can be that. Raises FormulaError."""
    try:
        return from_prefix(line, draft.domains)
    except PrefixError:
        pass
    try:
        cursor = Cursor(tokens(line, SYNTAX))
        made = _Reader(cursor, SYNTAX, draft.domains).formula()
        if cursor.next.kind != "end":
            cursor.fail()
    except FormulaError as error:
        raise FormulaError(str(error), at + error.at) from None
    return made


class _Reader(Reader):
    """``a ^ b`` is either of two; 0 and 1 are truths where a truth is asked for."""

    def truth(self, part: Part) -> Formula:
        if isinstance(part.formula, Const) and part.formula.value in (0, 1):
            return Const(bool(part.formula.value))
        return super().truth(part)

    def part(self, weakest: int) -> Part:
        left = super().part(weakest)
        while weakest <= STRENGTH[Op.OR] and self.cursor.took("^"):
            right = super().part(STRENGTH[Op.OR] + 1)
            other = f.negate(f.iff(self.truth(left), self.truth(right)))
            left = Part(other, TRUTH, left.at)
        return left


def plain(contract: Contract, form: str) -> Contract:
    """The contract as structured slugs have words for it. Raises NotExpressibleError."""
    made = game(contract, form, primed_liveness=True)
    return lowered(renamed(made, SYNTAX.truths), form, _without_minus)


def write(contract: Contract, form: str) -> str:
    """The contract; enumerations are counted, what is not a sum is written out over the values."""
    return sections(
        plain(contract, form), lambda one: said(form, _SPELLING.text, one), _declaration
    )


def _without_minus(contract: Contract) -> Contract:
    sums = counted(contract, is_flat=False)
    domains_of = known(sums)
    return each_conjunct(sums, lambda leaf: leaf if _is_sum(leaf) else flat(leaf, domains_of))


def _is_sum(formula: Formula) -> bool:
    """Whether slugs can say it: sums of variables and numbers that are not negative."""
    match formula:
        case Const(value):
            return isinstance(value, int) and value >= 0
        case Apply(op, args):
            return op not in (Op.SUB, Op.MUL, Op.DIV, Op.MOD) and all(map(_is_sum, args))
        case Var():
            return True


def sections(
    contract: Contract,
    text: Callable[..., str],
    declarations: Callable[[Variable], str],
) -> str:
    """The sections of a file of slugs, one line a conjunct."""
    made = []
    for title, owner in DECLARING.items():
        owned = [declarations(one) for one in contract.variables if one.owner is owner]
        made.append("\n".join([f"[{title}]", *owned, ""]))
    for title, key in SECTIONS.items():
        texts = [text(one) for one in conjuncts_of(contract, *key)]
        made.append("\n".join([f"[{title}]", *texts, ""]))
    return "\n".join(made)


def _declaration(variable: Variable) -> str:
    if isinstance(variable.domain, IntegerDomain):
        return f"{variable.name}:{variable.domain.low}...{variable.domain.high}"
    return variable.name
