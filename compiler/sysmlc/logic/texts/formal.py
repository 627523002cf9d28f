"""Formal texts in models: temporal logic, with the past, and property patterns as sentences.

Most models have none: what reads them is imported when there is one.
"""

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING

from sysmlc.logic.contract import Domain
from sysmlc.logic.formula import Formula

if TYPE_CHECKING:
    from sysmlc.logic.spelling import FormulaError

_LANGUAGES = ("ltl", "spin", "promela", "pattern")
_SENTENCE = r"\s*globally\s*,|.*\bit\s+is\s+(always|never|eventually)\s+the\s+case\s+that\b"
"""What nobody writes by chance: tools call the language of any prose English."""


def is_formal(language: str, text: str) -> bool:
    """Whether a text in a language is meant to be a formula or a sentence of a pattern."""
    name = language.lower()
    return any(one in name for one in _LANGUAGES) or (
        "english" in name and re.match(_SENTENCE, text, re.IGNORECASE | re.DOTALL) is not None
    )


def read_formal(text: str, language: str, variables: Mapping[str, Domain]) -> Formula:
    """The formula that a text says, with operators of the past where it has them.

    Raises FormulaError; ``told`` says where.
    """
    name = language.lower()
    if "pattern" in name or "english" in name:
        from sysmlc.logic.texts.sentences import read_sentence

        return read_sentence(text, variables)
    from sysmlc.logic.texts.past import read_past

    return read_past(text, variables)


def told(error: "FormulaError", text: str) -> str:
    """What is wrong with a text, and where: the line when there are several."""
    from sysmlc.logic.spelling import line_and_column

    line, column = line_and_column(text, error.at)
    place = f"line {line}, column {column}" if "\n" in text.strip() else f"column {column}"
    return f"{error} ({place})"
