"""Every rule can be explained: it has a page with a reason, a wrong model and a right one."""

import re

import pytest

from sysmlc.diagnostics.rule import PAGES
from sysmlc.driver import load_full_catalogue

RULES = [rule for rule in load_full_catalogue().values() if not rule.name.startswith("test-")]
FAULTS_OF_SYSMLC = {"SM900", "SM901"}
"""No model shows them."""


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: f"{rule.code}-{rule.name}")
def test_a_rule_is_explained(rule):
    assert re.fullmatch(r"SM[1-79]\d\d", rule.code)
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", rule.name)
    assert not rule.phrase.endswith(".")
    assert not rule.help[:1].isupper()
    assert not rule.help.endswith(".")
    page = rule.read_page()
    assert page.title == f"{rule.code} {rule.name}"
    assert page.why.endswith((".", ".)"))
    if rule.code not in FAULTS_OF_SYSMLC:
        assert page.wrong
        assert page.right
        assert page.wrong != page.right


def test_every_page_belongs_to_a_rule():
    assert {path.name for path in PAGES.iterdir()} == {f"{rule.code}.md" for rule in RULES}


@pytest.mark.parametrize("path", sorted(PAGES.glob("*.md")), ids=lambda path: path.stem)
def test_a_page_has_known_sections_in_order(path):
    text = path.read_text(encoding="utf-8")
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    titles = re.findall(r"^#+ .*", prose, re.MULTILINE)
    known = ["## Why", "## Wrong", "## Right", "## In Papyrus"]
    assert titles[1:] == [title for title in known if title in titles]
    assert len(set(re.findall(r"^```(\w+)$", text, re.MULTILINE))) <= 1
