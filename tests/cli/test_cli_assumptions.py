"""Assumptions of requirements: for which demands ``contracts check`` relies on them."""

import json

import pytest

MODEL = """package Plant {
  private import ScalarValues::*;
  attribute def Load;
  part def Press {
    attribute on : Boolean := false;
    in attribute ok : Boolean;
    exhibit state life {
      entry; then Off;
      state Off;
      state On { entry assign on := true; }
      transition first Off accept Load if not ok then On;
    }
  }
  %s
}
"""
ASSUMES = "assume constraint { p.ok }"
DEMANDS = "require constraint { not p.on }"


@pytest.mark.parametrize(
    ("requirements", "verdicts"),
    [
        (
            f"requirement one {{ subject p : Press; {ASSUMES} {DEMANDS} }}"
            f"requirement two {{ subject p : Press; {DEMANDS} }}",
            {"one": "holds", "two": "broken"},
        ),
        (
            f"requirement outer {{ subject p : Press; {ASSUMES}"
            f"  requirement inner {{ subject p : Press; {DEMANDS} }} }}"
            f"requirement two {{ subject p : Press; {DEMANDS} }}",
            {"inner": "holds", "two": "broken"},
        ),
        (
            f"requirement environment {{ subject p : Press; {ASSUMES} }}"
            f"requirement two {{ subject p : Press; {DEMANDS} }}",
            {"two": "holds"},
        ),
        (
            f"package A {{ requirement one {{ subject p : Press; {ASSUMES} {DEMANDS} }} }}"
            f"package B {{ requirement one {{ subject p : Press; {DEMANDS} }} }}",
            {"A::one": "holds", "B::one": "broken"},
        ),
        (
            f"requirement def Safe {{ subject p : Press; {DEMANDS} }}"
            f"requirement special : Safe {{ subject p : Press; {ASSUMES} }}",
            {"Safe": "broken"},
        ),
    ],
    ids=["two", "nested", "common", "one-name", "inherited-demand"],
)
def test_an_assumption_counts_for_the_demands_of_its_requirement(
    workspace, all_passes, requirements, verdicts
):
    workspace.write("press.sysml", MODEL % requirements)
    result = workspace.sysmlc("contracts", "check", "press.sysml", "--format", "json")
    listed = json.loads(result.stdout)["requirements"]
    for suffix, verdict in verdicts.items():
        answers = [item for item in listed if f"::{item['requirement']}".endswith(f"::{suffix}")]
        assert [item["verdict"] for item in answers] == [verdict]
