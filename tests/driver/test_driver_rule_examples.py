"""Every rule has a model that has it and one that nearly has it, and a test that says so.

Examples that are graphs, SysML v2 or parts of XMI and AutomationML files are compiled. The others
are fragments, files of other kinds or prose; their rules are named in a test of their own, by code
or by name.
"""

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import pytest

from example_documents import complete_example
from sysmlc.driver import (
    Request,
    compile_model,
    list_backend_names,
    load_backends,
    load_full_catalogue,
)

TESTS = Path(__file__).parents[1]
RULES = [rule for rule in load_full_catalogue().values() if not rule.name.startswith("test-")]
OF_CIRCUMSTANCES = {
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
OURS = {"SM900", "SM901", "SM902", "SM903"}
"""Faults of the compiler and of its settings, not of a model."""


# fmt: off
_NUMBERS = (
    100, 110, 112, 115, 116, 117, 118, 119, 120, 123, 125, 128, 129, 133, 134,
    135, 138, 141, 142, 144, 147, 149, 154, 155, 160, 161, 162, 163, 164, 165,
    171, 174, 177, 181, 182, 183, 184, 185, 186, 638, 639, 750, 751, 756, 757,
)
# fmt: on
FRAGMENTS = {f"SM{number}" for number in _NUMBERS}
"""The rest of the file matters, or the example is no XML; to be completed when it is touched."""
COMPILED = [
    rule
    for rule in RULES
    if rule.read_page().language in ("ir", "sysml", "xml")
    if rule.code not in {*OF_CIRCUMSTANCES, *FRAGMENTS}
]


def find_codes(language: str, text: str, folder: Path, backends: Sequence[str]) -> set[str]:
    """Return the rules that the compilation of an example reports."""
    name, content = complete_example(language, text)
    path = folder / name
    path.write_text(content, encoding="utf-8")
    compilation = compile_model(Request((path,), backends=tuple(load_backends(backends))))
    return {diagnostic.rule.code for diagnostic in compilation.diagnostics}


QUICK_BACKENDS = [name for name in list_backend_names() if name != "sysmlx"]
"""The back end sysmlx takes most of the time: it resolves each model a second time."""
OF_SYSMLX = "SM759"
"""The rule that only this back end reports."""


@pytest.mark.parametrize("rule", COMPILED, ids=lambda rule: rule.code)
def test_a_rule_reports_its_wrong_example_and_not_its_right_one(rule, tmp_path):
    page = rule.read_page()
    backends = list_backend_names() if rule.code == OF_SYSMLX else QUICK_BACKENDS
    assert rule.code in find_codes(page.language, page.wrong, tmp_path, backends)
    assert rule.code not in find_codes(page.language, page.right, tmp_path, backends)


@pytest.mark.long
@pytest.mark.parametrize("rule", COMPILED, ids=lambda rule: rule.code)
def test_a_right_example_can_be_written_as_interchange(rule, tmp_path):
    page = rule.read_page()
    assert rule.code not in find_codes(page.language, page.right, tmp_path, ["sysmlx"])


TESTED_AS = {
    "SM188": "test_the_first_200_violations_are_reported_and_the_rest_is_counted",
    "SM700": "import BAD_TEMPLATE",
    "SM717": "reqtable.backend import BAD_TEMPLATE",
    **dict.fromkeys([r.code for r in RULES if "SM320" <= r.code <= "SM340"], "range(320, 341)"),
}
"""What stands in the test of a rule that does not name it so, or that tests several alike."""


@cache
def every_test() -> str:
    here = Path(__file__).name
    return "\n".join(path.read_text("utf-8") for path in TESTS.rglob("*.py") if path.name != here)


@pytest.mark.parametrize(
    "rule", [r for r in RULES if r not in COMPILED and r.code not in OURS], ids=lambda r: r.code
)
def test_a_rule_whose_examples_are_not_compiled_is_named_in_a_test(rule):
    names = (rule.code, rule.name, TESTED_AS.get(rule.code, rule.code))
    assert any(name in every_test() for name in names)


def test_most_examples_are_compiled():
    assert len(COMPILED) > 250


def test_a_fragment_is_xml():
    assert {r.code for r in RULES if r.read_page().language == "xml"} >= FRAGMENTS
