"""Every rule has a page with a reason, a wrong model that violates it, and a right model.

The examples are compiled if they are graphs, SysML v2 or parts of XMI and AutomationML files. The
others are fragments, files of other kinds or prose; a test of their rule exists elsewhere and
contains its code or name.
"""

import re
from collections.abc import Sequence
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
    "SM243": "there are two files",
    "SM341": "there are two files",
    "SM455": "the limit is an option",
    "SM479": "the limit is an option",
    **dict.fromkeys(
        ("SM506", "SM508", "SM524", "SM525", "SM526", "SM548"), "'sysmlc contracts check' composes"
    ),
    **dict.fromkeys(
        ("SM516", "SM517", "SM518", "SM519", "SM557", "SM558", "SM559"),
        "'sysmlc contracts check' finds them",
    ),
    **dict.fromkeys(("SM560", "SM561", "SM562"), "'sysmlc contracts check' compares"),
    **dict.fromkeys(
        ("SM595", "SM596", "SM597", "SM598", "SM599"), "'sysmlc contracts check' composes"
    ),
    "SM628": "there are two files",
    "SM702": "diagrams of authors are requested",
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


def find_messages(rule: Rule, text: str, folder: Path, backends: Sequence[str]) -> list[str]:
    """Compile an example of *rule*; return subject and message of each diagnostic of the rule."""
    name, content = complete_example(rule.read_page().language, text)
    path = folder / name
    path.write_text(content, encoding="utf-8")
    options = REQUEST_OPTIONS.get(rule.code, {})
    request = Request((path,), backends=tuple(load_backends(backends)), **options)
    compilation = compile_model(request)
    return [
        f"{diagnostic.subject.name}: {diagnostic.message}".replace(folder.as_posix(), "")
        for diagnostic in compilation.diagnostics
        if diagnostic.rule == rule
    ]


QUICK_BACKENDS = [name for name in list_backend_names() if name != "sysmlx"]
"""All back ends except sysmlx, which is slow because it resolves each model a second time."""
REPORTED_BY_SYSMLX = "SM759"
"""A rule that only the back end sysmlx reports."""


@pytest.mark.parametrize("rule", COMPILED, ids=lambda rule: rule.code)
def test_a_rule_reports_its_wrong_example_and_not_its_right_one(rule, tmp_path, golden):
    """The golden file of the rule has the messages with all facts."""
    page = rule.read_page()
    backends = list_backend_names() if rule.code == REPORTED_BY_SYSMLX else QUICK_BACKENDS
    # Most rules are reported by front ends and passes, so that back ends need not run.
    if messages := find_messages(rule, page.wrong, tmp_path, ()):
        backends = ()
    else:
        messages = find_messages(rule, page.wrong, tmp_path, backends)
    assert messages
    golden.check(f"rules/{rule.code}", {"messages.txt": "\n".join([*messages, ""])})
    assert find_messages(rule, page.right, tmp_path, backends) == []


@pytest.mark.long
@pytest.mark.parametrize("rule", COMPILED[::4], ids=lambda rule: rule.code)
def test_right_examples_can_be_written_as_interchange(rule, tmp_path):
    page = rule.read_page()
    assert find_messages(rule, page.right, tmp_path, ["sysmlx"]) == []


SEARCH_TEXTS = {
    "SM188": "test_the_first_200_violations_are_reported_and_the_rest_is_counted",
    "SM700": "import BAD_TEMPLATE",
    "SM717": "BAD_TEMPLATE,\n    UNSATISFIED",
    **dict.fromkeys(
        [rule.code for rule in RULES if "SM320" <= rule.code <= "SM340"], "range(320, 341)"
    ),
}
"""Text to search for where the test of a rule contains neither its code nor its name."""


def read_test_modules() -> str:
    """Return the text of all test modules except this one."""
    this_module = Path(__file__).name
    return "\n".join(
        path.read_text("utf-8") for path in TESTS.rglob("*.py") if path.name != this_module
    )


def test_rules_whose_examples_are_not_compiled_are_named_in_tests():
    tests = read_test_modules()
    rules = [r for r in RULES if r not in COMPILED and r.code not in NOT_ABOUT_MODELS]
    names = {rule.code: (rule.code, rule.name, SEARCH_TEXTS.get(rule.code)) for rule in rules}
    unnamed = [
        code for code, texts in names.items() if not any(text and text in tests for text in texts)
    ]
    assert unnamed == []


def test_most_examples_are_compiled():
    assert len(COMPILED) > 280


def test_examples_that_are_not_compiled_are_in_languages_that_could_be():
    compilable = {rule.code for rule in RULES if rule.read_page().language in LANGUAGES}
    assert NOT_COMPILED.keys() <= compilable


# -- form of the pages ----------------------------------------------------------------------------


def find_faults_of_form(rule: Rule) -> list[str]:
    """Return the statements about the form of rules and their pages that do not hold."""
    page = rule.read_page()
    statements = {
        "the code is SM and three digits": re.fullmatch(r"SM[1-79]\d\d", rule.code),
        "the name is words with hyphens": re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", rule.name),
        "the message has no final stop": not rule.phrase.endswith("."),
        "the help starts in lower case": not rule.help[:1].isupper(),
        "the help has no final stop": not rule.help.endswith("."),
        "the page is named after the rule": page.title == f"{rule.code} {rule.name}",
        "the reason is a sentence": page.why.endswith((".", ".)")),
        "the examples exist and differ": rule.code in INTERNAL_ERRORS
        or (page.wrong and page.right and page.wrong != page.right),
    }
    return [statement for statement, holds in statements.items() if not holds]


def test_rules_have_pages_and_messages_in_the_usual_form():
    faults = {rule.code: broken for rule in RULES if (broken := find_faults_of_form(rule))}
    assert faults == {}


def test_every_page_belongs_to_a_rule():
    assert {path.name for path in PAGES.iterdir()} == {f"{rule.code}.md" for rule in RULES}


def has_usual_sections(text: str) -> bool:
    """Whether a page has the usual sections in order, and examples in one language only."""
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    titles = re.findall(r"^#+ .*", prose, re.MULTILINE)
    sections = ["## Why", "## Wrong", "## Right", "## In Papyrus"]
    is_in_order = titles[1:] == [section for section in sections if section in titles]
    return is_in_order and len(set(re.findall(r"^```(\w+)$", text, re.MULTILINE))) <= 1


def test_pages_have_the_usual_sections_in_order():
    pages = sorted(PAGES.glob("*.md"))
    assert [page.name for page in pages if not has_usual_sections(page.read_text("utf-8"))] == []
