"""Each rule of the structural passes reports its wrong example and accepts its right example."""

import pytest
from pass_runs import STRUCTURAL, list_codes, run_until

from rule_examples import has_graphs, read_graphs
from sysmlc.diagnostics import catalogue
from sysmlc.passes import pipeline

for name in STRUCTURAL:
    pipeline.load(name)

MODULES = {
    "resolve": (*range(150, 154), 166, 167),
    "inherit": range(200, 205),
    "classify": (156, *range(210, 221)),
    "ports": (*range(121, 123), *range(300, 310)),
    "flows": range(310, 320),
    "behaviours": range(400, 410),
    "interactions": range(440, 450),
}
RULES = [
    (pass_name, rule)
    for rule in catalogue().values()
    for pass_name, numbers in MODULES.items()
    if int(rule.code[-3:]) in numbers and has_graphs(rule)
]


@pytest.mark.parametrize(("pass_name", "rule"), RULES, ids=lambda x: getattr(x, "name", x))
def test_rule_reports_its_wrong_example_and_not_its_right_one(pass_name, rule):
    assert rule.code in list_codes(run_until(read_graphs(rule).wrong, pass_name)[1])
    assert rule.code not in list_codes(run_until(read_graphs(rule).right, pass_name)[1])


@pytest.mark.parametrize(("pass_name", "rule"), RULES, ids=lambda x: getattr(x, "name", x))
def test_the_right_example_has_no_warnings_at_all(pass_name, rule):
    _, sink = run_until(read_graphs(rule).right, pass_name)
    assert {diagnostic.severity for diagnostic in sink} <= {"info"}


def test_every_structural_pass_has_rules():
    assert {pass_name for pass_name, _ in RULES} == set(STRUCTURAL)
