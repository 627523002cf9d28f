"""``sysmlc explain``: what a rule means and how to satisfy it."""

import re
from collections.abc import Iterator
from difflib import SequenceMatcher
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from sysmlc.diagnostics import Rule


@click.command(
    "explain",
    short_help="Explain a rule: why it exists, a wrong and a right model.",
    epilog="""\b
Examples:
  sysmlc explain SM170
  sysmlc explain missing-file
  sysmlc explain                 # all rules, one line each""",
)
@click.argument("code", required=False, metavar="[CODE|NAME]")
def command(code: str | None) -> None:
    """Explain the rule with this code or name; without one, list all rules."""
    from sysmlc.cli.session import fail, load_rules
    from sysmlc.support.suggestions import did_you_mean

    rules = load_rules()
    if code is None:
        for rule in rules.values():
            click.echo(f"{rule.code}  {rule.severity.value:<7}  {rule.name}")
        return
    rules_by_key = {**rules, **{rule.name: rule for rule in rules.values()}}
    key = code.upper() if code.upper() in rules_by_key else code.lower()
    if key not in rules_by_key:
        hint = did_you_mean(key, rules_by_key)
        near = hint if hint.startswith("did") else "'sysmlc explain' lists all rules"
        fail(f"unknown rule '{code}'; {near}")
    click.echo("\n".join(_explanation(rules_by_key[key])))


def _format_message(template: str) -> str:
    """Return the message with ``port '<port>'`` for ``port '{port}'``."""
    return re.sub(r"\{(\w+)[^{}]*\}", r"<\1>", template)


def _explanation(rule: "Rule") -> Iterator[str]:
    yield f"{rule.code} {rule.name} ({rule.severity.value})"
    yield ""
    yield f"  {_format_message(rule.phrase)}"
    page = rule.read_page()
    wrong, right = page.wrong.strip("\n").splitlines(), page.right.strip("\n").splitlines()
    # A sentence differs as a whole, and an advice may consist of what the finding fills in.
    marks = page.language != ""
    advice = "" if re.fullmatch(r"\{\w+\}", rule.help) else rule.help
    for title, lines in (
        ("Why", _indent(page.why.splitlines())),
        ("What to do", _indent(_format_message(advice).splitlines())),
        ("Wrong", _mark_differences(wrong, right) if marks else _indent(wrong)),
        ("Right", _mark_differences(right, wrong) if marks else _indent(right)),
        ("In Papyrus", _indent(page.papyrus.splitlines())),
    ):
        if lines:
            yield ""
            yield f"{title}:"
            yield from lines


def _indent(lines: list[str]) -> list[str]:
    return [f"  {line}" for line in lines]


def _mark_differences(lines: list[str], counterpart: list[str]) -> list[str]:
    """Return the lines with a mark before those that the counterpart lacks, unless it lacks all."""
    blocks = SequenceMatcher(None, lines, counterpart, autojunk=False).get_matching_blocks()
    common = {index for block in blocks for index in range(block.a, block.a + block.size)}
    return [
        f"  {line}" if index in common or not common else f"> {line}"
        for index, line in enumerate(lines)
    ]
