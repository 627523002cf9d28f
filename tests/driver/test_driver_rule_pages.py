"""Every rule has a page with a reason, a wrong model that violates it, and a right model.

The examples are compiled if they are graphs, SysML v2 or parts of XMI and AutomationML files. The
others are fragments, files of other kinds or prose; a test of their rule exists elsewhere and
contains its code or name.
"""

import re
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import pytest

from example_documents import complete_example
from sysmlc.diagnostics.rule import PAGES
from sysmlc.driver import (
    Request,
    compile_model,
    list_backend_names,
    load_backends,
    load_full_catalogue,
)

TESTS = Path(__file__).parents[1]
RULES = [rule for rule in load_full_catalogue().values() if not rule.name.startswith("test-")]
NEEDS_SPECIAL_CONDITIONS = {
    "SM455": "the limit is an option",
    "SM479": "the limit is an option",
    "SM702": "the diagram is very large",
    "SM703": "diagrams of authors are asked for",
    **dict.fromkeys(("SM508", "SM524", "SM525", "SM526"), "'sysmlc contracts check' composes"),
    **dict.fromkeys(("SM560", "SM561", "SM562"), "'sysmlc contracts check' compares"),
    "SM207": "there is no standard library",
    "SM208": "there are 8,000 aliases",
    "SM240": "there are thousands of definitions",
    **dict.fromkeys(
        ("SM506", "SM548", "SM595", "SM596", "SM597", "SM598", "SM599"),
        "'sysmlc contracts check' composes",
    ),
    "SM758": "the same file stands for text and interchange",
}
INTERNAL_ERRORS = {"SM900", "SM901"}
"""No model reproduces them."""
NOT_ABOUT_MODELS = {"SM900", "SM901", "SM902", "SM903"}
"""Internal errors of the compiler, and diagnostics about its configuration."""


# fmt: off
_NUMBERS = (
    100, 110, 112, 115, 116, 117, 118, 119, 120, 123, 125, 128, 129, 133, 134,
    135, 138, 141, 142, 144, 147, 149, 154, 155, 160, 161, 162, 163, 164, 165,
    171, 174, 177, 181, 182, 183, 184, 185, 186, 638, 639, 750, 751, 756, 757,
)
# fmt: on
FRAGMENTS = {f"SM{number}" for number in _NUMBERS}
"""Rules whose examples need the rest of the file, or are not well-formed XML by themselves."""
COMPILED = [
    rule
    for rule in RULES
    if rule.read_page().language in ("ir", "sysml", "xml")
    if rule.code not in {*NEEDS_SPECIAL_CONDITIONS, *FRAGMENTS}
]


def find_codes(language: str, text: str, folder: Path, backends: Sequence[str]) -> set[str]:
    """Compile an example and return the codes of its diagnostics."""
    name, content = complete_example(language, text)
    path = folder / name
    path.write_text(content, encoding="utf-8")
    compilation = compile_model(Request((path,), backends=tuple(load_backends(backends))))
    return {diagnostic.rule.code for diagnostic in compilation.diagnostics}


QUICK_BACKENDS = [name for name in list_backend_names() if name != "sysmlx"]
"""All back ends except sysmlx, which is slow because it resolves each model a second time."""
REPORTED_BY_SYSMLX = "SM759"
"""A rule that only the back end sysmlx reports."""


@pytest.mark.parametrize("rule", COMPILED, ids=lambda rule: rule.code)
def test_a_rule_reports_its_wrong_example_and_not_its_right_one(rule, tmp_path):
    page = rule.read_page()
    backends = list_backend_names() if rule.code == REPORTED_BY_SYSMLX else QUICK_BACKENDS
    assert rule.code in find_codes(page.language, page.wrong, tmp_path, backends)
    assert rule.code not in find_codes(page.language, page.right, tmp_path, backends)


@pytest.mark.long
@pytest.mark.parametrize("rule", COMPILED, ids=lambda rule: rule.code)
def test_a_right_example_can_be_written_as_interchange(rule, tmp_path):
    page = rule.read_page()
    assert rule.code not in find_codes(page.language, page.right, tmp_path, ["sysmlx"])


SEARCH_TEXTS = {
    "SM188": "test_the_first_200_violations_are_reported_and_the_rest_is_counted",
    "SM700": "import BAD_TEMPLATE",
    "SM717": "reqtable.backend import BAD_TEMPLATE",
    **dict.fromkeys(
        [rule.code for rule in RULES if "SM320" <= rule.code <= "SM340"], "range(320, 341)"
    ),
}
"""Text to search for where the test of a rule contains neither its code nor its name."""


@cache
def read_test_modules() -> str:
    """Return the text of all test modules except this one."""
    this_module = Path(__file__).name
    return "\n".join(
        path.read_text("utf-8") for path in TESTS.rglob("*.py") if path.name != this_module
    )


@pytest.mark.parametrize(
    "rule",
    [rule for rule in RULES if rule not in COMPILED and rule.code not in NOT_ABOUT_MODELS],
    ids=lambda rule: rule.code,
)
def test_a_rule_whose_examples_are_not_compiled_is_named_in_a_test(rule):
    names = (rule.code, rule.name, SEARCH_TEXTS.get(rule.code, rule.code))
    assert any(name in read_test_modules() for name in names)


def test_most_examples_are_compiled():
    assert len(COMPILED) > 250


def test_fragments_are_examples_in_xml():
    assert {rule.code for rule in RULES if rule.read_page().language == "xml"} >= FRAGMENTS


# -- form of the pages ----------------------------------------------------------------------------


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: f"{rule.code}-{rule.name}")
def test_a_rule_has_a_page_and_a_message_in_the_usual_form(rule):
    assert re.fullmatch(r"SM[1-79]\d\d", rule.code)
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", rule.name)
    assert not rule.phrase.endswith(".")
    assert not rule.help[:1].isupper()
    assert not rule.help.endswith(".")
    page = rule.read_page()
    assert page.title == f"{rule.code} {rule.name}"
    assert page.why.endswith((".", ".)"))
    if rule.code not in INTERNAL_ERRORS:
        assert page.wrong
        assert page.right
        assert page.wrong != page.right


def test_every_page_belongs_to_a_rule():
    assert {path.name for path in PAGES.iterdir()} == {f"{rule.code}.md" for rule in RULES}


@pytest.mark.parametrize("path", sorted(PAGES.glob("*.md")), ids=lambda path: path.stem)
def test_a_page_has_the_usual_sections_in_order(path):
    text = path.read_text(encoding="utf-8")
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    titles = re.findall(r"^#+ .*", prose, re.MULTILINE)
    sections = ["## Why", "## Wrong", "## Right", "## In Papyrus"]
    assert titles[1:] == [section for section in sections if section in titles]
    assert len(set(re.findall(r"^```(\w+)$", text, re.MULTILINE))) <= 1
