"""Pages of rules: why a rule exists, with a wrong and a right model.

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
from pathlib import Path

from msgspec import Struct

FOLDER = Path(__file__).with_name("rules")
"""The pages of sysmlc's own rules, ``<code>.md`` each."""
_SECTION = re.compile(r"^## (Why|Wrong|Right|In Papyrus)\n", re.MULTILINE)
_FENCED = re.compile(r"```(\w+)\n(.*)```", re.DOTALL)


class RulePage(Struct, frozen=True):
    """The texts of a page; ``language`` is that of the examples, empty for sentences."""

    title: str = ""
    why: str = ""
    wrong: str = ""
    right: str = ""
    language: str = ""
    papyrus: str = ""


def read_shipped_page(code: str) -> RulePage:
    """Return the page of one of sysmlc's own rules; raise OSError if there is none."""
    return parse_page((FOLDER / f"{code}.md").read_text(encoding="utf-8"))


def parse_page(text: str) -> RulePage:
    """Return the texts of a page; lines of a paragraph are joined, code stays as it is."""
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
