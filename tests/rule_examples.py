"""The examples of rules as models in IR text."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from sysmlc.diagnostics import Rule
from sysmlc.driver.registry import load_full_catalogue
from sysmlc.ir import Graph
from sysmlc.ir.text import IrSyntaxError

_STORED = Path(__file__).with_name("ir_examples.md")
_ENTRY = re.compile(r"^## (SM\d+)\n\n```ir\n(.*?)```\n\n```ir\n(.*?)```$", re.MULTILINE | re.DOTALL)


class Example(NamedTuple):
    """A graph that violates a rule, and one that does not, in IR text."""

    wrong: str
    right: str


STORED = {
    code: Example(wrong, right) for code, wrong, right in _ENTRY.findall(_STORED.read_text("utf-8"))
}
"""Graphs for the rules whose pages show XMI or SysML v2."""


def has_graphs(rule: Rule) -> bool:
    """Whether there are examples of a rule in IR text."""
    return rule.code in STORED or rule.read_page().language == "ir"


def read_graphs(rule: Rule) -> Example:
    """Return the examples of a rule in IR text."""
    page = rule.read_page()
    return STORED.get(rule.code) or Example(page.wrong, page.right)


def parse_rule_examples(parse: Callable[[str], Graph]) -> list[Graph]:
    """Return the graphs of the wrong and right examples; other languages are skipped."""
    examples = [read_graphs(rule) for rule in load_full_catalogue().values()]
    graphs = []
    for text in sorted({text for example in examples for text in example}):
        try:
            graphs.append(parse(text))
        except (IrSyntaxError, ValueError, KeyError):
            continue
    assert len(graphs) > 150
    return graphs
