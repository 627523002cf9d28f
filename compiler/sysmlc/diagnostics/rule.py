"""Rules: the faults that sysmlc reports, and the pages that explain them.

A page is a Markdown file. Its title is the code and the name of the rule, and these sections
follow::

    # SM301 untyped-port
    ## Why
    ## Wrong
    ## Right
    ## In Papyrus

An example is one fenced block with its language, or a sentence. The last section is optional.
"""

import re
from enum import StrEnum
from pathlib import Path

from msgspec import Struct

PAGES = Path(__file__).with_name("rules")
"""The folder of the pages of sysmlc's own rules, ``<code>.md`` each."""
_CODE = re.compile(r"[A-Z]+\d+")
_NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
_SECTION = re.compile(r"^## (Why|Wrong|Right|In Papyrus)\n", re.MULTILINE)
_FENCED = re.compile(r"```(\w+)\n(.*)```", re.DOTALL)


class Severity(StrEnum):
    """How much a diagnostic matters."""

    ERROR = "error"
    """The model has no correct output."""
    WARNING = "warning"
    """The model has an output, which is probably not what its author meant."""
    INFO = "info"
    """The author should know, but nothing is wrong."""


class RulePage(Struct, frozen=True):
    """The texts of a page.

    ``language`` is the language of the examples, empty if they are sentences.
    """

    title: str = ""
    why: str = ""
    wrong: str = ""
    right: str = ""
    language: str = ""
    papyrus: str = ""


class Rule(Struct, frozen=True):
    """One kind of fault.

    ``phrase`` and ``help`` are format strings for the facts of ``Sink.report``. ``page`` is the
    Markdown of the rule's page; it is empty for sysmlc's own rules, whose pages are files.
    """

    code: str
    name: str
    severity: Severity
    phrase: str
    help: str = ""
    page: str = ""

    def read_page(self) -> RulePage:
        """Return the page of the rule, with empty texts if the rule has no page."""
        if self.page:
            return _parse_page(self.page)
        try:
            return _parse_page((PAGES / f"{self.code}.md").read_text(encoding="utf-8"))
        except OSError:
            return RulePage()


# -- catalogue ---------------------------------------------------------------------------------

_rules: dict[str, Rule] = {}
_names: set[str] = set()


def rule(
    code: str, name: str, severity: Severity, phrase: str, help: str = "", page: str = ""
) -> Rule:
    """Create a rule and add it to the catalogue.

    The code consists of a prefix, ``SM`` for the rules of sysmlc, and a number. Raises ValueError
    if the code or the name has another form or belongs to another rule.
    """
    if not (_CODE.fullmatch(code) and _NAME.fullmatch(name)):
        expected = "a code such as ACME001 and a name such as open-end"
        raise ValueError(f"rule {code} {name}: expected {expected}")
    created = Rule(code, name, severity, phrase, help, page)
    # A module of a plug-in that could not be imported is executed again by the next attempt.
    if _rules.get(code) == created:
        return created
    if code in _rules or name in _names:
        raise ValueError(f"rule {code} {name}: the code or the name is taken")
    _rules[code] = created
    _names.add(name)
    return created


def catalogue() -> dict[str, Rule]:
    """Return the rules of the modules imported so far, sorted by code."""
    return dict(sorted(_rules.items()))


# -- pages -------------------------------------------------------------------------------------


def _parse_page(text: str) -> RulePage:
    """Return the texts of a page. Lines of a paragraph are joined, lines of code are not."""
    head, *parts = _SECTION.split(text)
    sections = dict(zip(parts[::2], parts[1::2], strict=True))
    language, wrong = _read_example(sections.get("Wrong", ""))
    return RulePage(
        title=head.strip().removeprefix("# "),
        why=_join_lines(sections.get("Why", "")),
        wrong=wrong,
        right=_read_example(sections.get("Right", ""))[1],
        language=language,
        papyrus=sections.get("In Papyrus", "").strip(),
    )


def _read_example(section: str) -> tuple[str, str]:
    """Return language and text of an example; a sentence has no language."""
    code = _FENCED.fullmatch(section.strip())
    return (code[1], code[2]) if code else ("", _join_lines(section))


def _join_lines(section: str) -> str:
    paragraphs = re.split(r"\n\s*\n", section.strip())
    return "\n\n".join(" ".join(paragraph.split()) for paragraph in paragraphs)
