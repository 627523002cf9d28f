"""Formal texts in models: temporal logic, with the past, and property patterns as sentences."""

import re
from collections.abc import Mapping

from sysmlc.logic.contract import Domain
from sysmlc.logic.evaluate import has_primes
from sysmlc.logic.formula import Formula, Op
from sysmlc.logic.infix import Part, Reader
from sysmlc.logic.reduce import is_ahead
from sysmlc.logic.sentences import read_sentence
from sysmlc.logic.spelling import (
    NEUTRAL,
    PAST,
    PAST_WORDS,
    Cursor,
    FormulaError,
    line_and_column,
    tokens,
)
from sysmlc.values import replace

_LANGUAGES = ("ltl", "spin", "promela", "pattern")
_SENTENCE = re.compile(
    r"\s*globally\s*,|.*\bit\s+is\s+(always|never|eventually)\s+the\s+case\s+that\b", re.I | re.S
)
"""What nobody writes by chance: tools call the language of any prose English."""
_SYNTAX = replace(
    NEUTRAL,
    prefix={**NEUTRAL.prefix, **PAST_WORDS},
    infix={**NEUTRAL.infix, "S": Op.SINCE},
)


def is_formal(language: str, text: str) -> bool:
    """Whether a text in a language is meant to be a formula or a sentence of a pattern."""
    name = language.lower()
    return any(one in name for one in _LANGUAGES) or (
        "english" in name and _SENTENCE.match(text) is not None
    )


def read_formal(text: str, language: str, variables: Mapping[str, Domain]) -> Formula:
    """The formula that a text says, with operators of the past where it has them.

    Raises FormulaError; ``told`` says where.
    """
    name = language.lower()
    if "pattern" in name or "english" in name:
        return read_sentence(text, variables)
    reader = _PastReader(Cursor(tokens(text, _SYNTAX)), _SYNTAX, variables)
    formula = reader.formula()
    if reader.cursor.next.kind != "end":
        reader.cursor.fail()
    return formula


def told(error: FormulaError, text: str) -> str:
    """What is wrong with a text, and where: the line when there are several."""
    line, column = line_and_column(text, error.at)
    place = f"line {line}, column {column}" if "\n" in text.strip() else f"column {column}"
    return f"{error} ({place})"


class _PastReader(Reader):
    """Y, O, H and S of what is known by then."""

    def _prefixed(self, op: Op, weakest: int) -> Part:
        made = super()._prefixed(op, weakest)
        return self._known(op, made)

    def _applied(self, op: Op, left: Part) -> Part:
        return self._known(op, super()._applied(op, left))

    def _known(self, op: Op, made: Part) -> Part:
        args = getattr(made.formula, "args", ())
        if op in PAST and any(is_ahead(arg) or has_primes(arg) for arg in args):
            raise FormulaError(f"'{op}' cannot look back at what is yet to come", made.at)
        return made
