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
from sysmlc.diagnostics import Rule
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
NOT_COMPILED = {
    "SM115": "a snapshot is an entry of a project archive",
    "SM119": "the right example refers to a second file",
    "SM128": "the list has a million references",
    "SM129": "the element has thousands of attributes",
    "SM155": "the element is in a snapshot of a project archive",
    "SM160": "only 'sysmlc coverage' reports it",
    "SM161": "diagrams of authors are requested and are in a file of their own",
    "SM162": "diagrams of authors are requested",
    "SM186": "schemas are given",
    "SM207": "there is no standard library",
    "SM208": "there are 8,000 aliases",
    "SM240": "there are thousands of definitions",
    "SM455": "the limit is an option",
    "SM479": "the limit is an option",
    **dict.fromkeys(
        ("SM506", "SM508", "SM524", "SM525", "SM526", "SM548"), "'sysmlc contracts check' composes"
    ),
    **dict.fromkeys(
        ("SM517", "SM518", "SM519", "SM557", "SM558", "SM559"),
        "'sysmlc contracts check' finds them",
    ),
    **dict.fromkeys(("SM560", "SM561", "SM562"), "'sysmlc contracts check' compares"),
    **dict.fromkeys(
        ("SM595", "SM596", "SM597", "SM598", "SM599"), "'sysmlc contracts check' composes"
    ),
    "SM702": "the diagram is very large",
    "SM703": "diagrams of authors are requested",
    "SM758": "the same file stands for text and interchange",
}
"""Rules whose examples are not compiled, and the condition under which they are reported."""
INTERNAL_ERRORS = {"SM900", "SM901"}
"""No model reproduces them."""
NOT_ABOUT_MODELS = {"SM900", "SM901", "SM902", "SM903"}
"""Internal errors of the compiler, and diagnostics about its configuration."""


LANGUAGES = ("ir", "sysml", "xml")
"""Languages of examples that can be compiled."""
REQUEST_OPTIONS = {"SM174": {"strict_input": True}}
"""Options without which a rule is not checked."""
COMPILED = [
    rule
    for rule in RULES
    if rule.read_page().language in LANGUAGES
    if rule.code not in NOT_COMPILED
]


def find_codes(rule: Rule, text: str, folder: Path, backends: Sequence[str]) -> set[str]:
    """Compile an example of *rule* and return the codes of its diagnostics."""
    name, content = complete_example(rule.read_page().language, text)
    path = folder / name
    path.write_text(content, encoding="utf-8")
    options = REQUEST_OPTIONS.get(rule.code, {})
    request = Request((path,), backends=tuple(load_backends(backends)), **options)
    compilation = compile_model(request)
    return {diagnostic.rule.code for diagnostic in compilation.diagnostics}


QUICK_BACKENDS = [name for name in list_backend_names() if name != "sysmlx"]
"""All back ends except sysmlx, which is slow because it resolves each model a second time."""
REPORTED_BY_SYSMLX = "SM759"
"""A rule that only the back end sysmlx reports."""


@pytest.mark.parametrize("rule", COMPILED, ids=lambda rule: rule.code)
def test_a_rule_reports_its_wrong_example_and_not_its_right_one(rule, tmp_path):
    page = rule.read_page()
    backends = list_backend_names() if rule.code == REPORTED_BY_SYSMLX else QUICK_BACKENDS
    assert rule.code in find_codes(rule, page.wrong, tmp_path, backends)
    assert rule.code not in find_codes(rule, page.right, tmp_path, backends)


@pytest.mark.long
@pytest.mark.parametrize("rule", COMPILED, ids=lambda rule: rule.code)
def test_a_right_example_can_be_written_as_interchange(rule, tmp_path):
    page = rule.read_page()
    assert rule.code not in find_codes(rule, page.right, tmp_path, ["sysmlx"])


SEARCH_TEXTS = {
    "SM188": "test_the_first_200_violations_are_reported_and_the_rest_is_counted",
    "SM700": "import BAD_TEMPLATE",
    "SM717": "BAD_TEMPLATE,\n    UNSATISFIED",
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
    assert len(COMPILED) > 280


def test_examples_that_are_not_compiled_are_in_languages_that_could_be():
    compilable = {rule.code for rule in RULES if rule.read_page().language in LANGUAGES}
    assert NOT_COMPILED.keys() <= compilable


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
