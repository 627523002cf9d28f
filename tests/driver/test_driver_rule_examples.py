"""Every rule has a model that has it and one that nearly has it, and a test that says so.

Examples that are graphs are compiled as they stand. Those that are XML, files or prose cannot be;
their rules are named in a test of their own, by code or by name.
"""

from functools import cache
from pathlib import Path

import pytest

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
    "SM476": "what is in the example leads to another behaviour",
    "SM479": "the limit is an option",
    "SM702": "the diagram is very large",
    "SM703": "diagrams of authors are asked for",
    **dict.fromkeys(("SM508", "SM524", "SM525", "SM526"), "'sysmlc contracts check' composes"),
    **dict.fromkeys(("SM560", "SM561", "SM562"), "'sysmlc contracts check' compares"),
}
OURS = {"SM900", "SM901", "SM902", "SM903"}
"""Faults of the compiler and of its settings, not of a model."""


GRAPHS = [
    rule
    for rule in RULES
    if rule.read_page().language == "ir" and rule.code not in OF_CIRCUMSTANCES
]


def found(text: str, folder: Path) -> set[str]:
    path = folder / "model.ir"
    path.write_text(text, encoding="utf-8")
    made = compile_model(Request((path,), backends=tuple(load_backends(list_backend_names()))))
    return {one.rule.code for one in made.diagnostics}


@pytest.mark.parametrize("rule", GRAPHS, ids=lambda rule: rule.code)
def test_the_wrong_model_has_it_and_the_right_one_has_not(rule, tmp_path):
    assert rule.code in found(rule.read_page().wrong, tmp_path)
    assert rule.code not in found(rule.read_page().right, tmp_path)


TESTED_AS = {
    "SM188": "test_of_many_violations_the_first_are_told_and_the_others_counted",
    "SM700": "import BAD_TEMPLATE",
    "SM717": "rules.BAD_TEMPLATE",
    **dict.fromkeys([r.code for r in RULES if "SM320" <= r.code <= "SM340"], "range(320, 341)"),
}
"""What stands in the test of a rule that does not name it so, or that tests several alike."""


@cache
def every_test() -> str:
    here = Path(__file__).name
    return "\n".join(path.read_text("utf-8") for path in TESTS.rglob("*.py") if path.name != here)


@pytest.mark.parametrize(
    "rule", [r for r in RULES if r not in GRAPHS and r.code not in OURS], ids=lambda r: r.code
)
def test_a_rule_whose_examples_are_no_graphs_is_named_in_a_test(rule):
    names = (rule.code, rule.name, TESTED_AS.get(rule.code, rule.code))
    assert any(name in every_test() for name in names)


def test_most_examples_are_graphs():
    assert len(GRAPHS) > 150
