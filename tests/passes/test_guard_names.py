"""Names of flows that leave a decision, read as guards by the pass ``activities``."""

import pytest
from pass_runs import list_codes, run_all

MODEL = """\
Package p "P"
  Activity a "Check"
    Action inspect "inspect" subkind="opaque"
      Pin result "result" direction="out"
        -> typed-by {type}
    Control d "" subkind="decision"
    Action ship "ship" subkind="opaque"
    Action scrap "scrap" subkind="opaque"
    ObjectFlow f1
      -> flow-source result
      -> flow-target d
    ObjectFlow f2 {first}
      -> flow-source d
      -> flow-target ship
    ObjectFlow f3 {second}
      -> flow-source d
      -> flow-target scrap
  Enumeration verdict "Verdict"
    EnumerationLiteral ok "Accepted"
    EnumerationLiteral nok "Rejected"
  DataType bool "Boolean"
"""


def read_guards(first, second, type_="verdict"):
    """Return the guards of the two flows, whether they are literals, and the codes reported."""
    text = MODEL.format(first=first, second=second, type=type_)
    graph, sink = run_all(text)
    guards = [graph[id].attrs.get("guard") for id in ("f2", "f3")]
    are_literals = [graph[id].attrs.get("guard_literal") for id in ("f2", "f3")]
    return guards, are_literals, [code for code in list_codes(sink) if code == "SM461"]


@pytest.mark.parametrize(
    ("names", "type_"),
    [(("Accepted", "Rejected"), "verdict"), (("true", "false"), "bool")],
)
def test_names_that_are_values_of_what_is_tested_are_guards(names, type_):
    first, second = (f'"{name}"' for name in names)
    assert read_guards(first, second, type_) == (list(names), [True, True], ["SM461"])


def test_a_name_beside_else_is_a_guard_in_words():
    guards, are_literals, codes = read_guards('"the part is good"', '"Else"')
    assert (guards, codes) == (["the part is good", "else"], ["SM461"])
    assert are_literals == [None, None]


def test_the_guard_true_that_tools_add_is_replaced():
    default = 'guard="true" guard_literal=true'
    guards, _, codes = read_guards(f'"Accepted" {default}', f'"Rejected" {default}')
    assert (guards, codes) == (["Accepted", "Rejected"], ["SM461"])


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ('"good parts"', '"bad parts"'),
        ('"ObjectFlow1"', '"else"'),
        ('"Accepted" guard="level > 3"', '"Rejected" guard="level <= 3"'),
        ("", ""),
    ],
    ids=["no values", "generated name", "guards", "no names"],
)
def test_other_names_are_no_guards(first, second):
    guards, _, _ = read_guards(first, second)
    assert guards[0] in (None, "level > 3")
