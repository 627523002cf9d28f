"""The pass ``activities``: guards of decisions, and literals on branches."""

import pytest
from pass_runs import list_codes
from token_graphs import derive_token_graphs, name_inputs

from sysmlc.logic import formula as f

DECISION = """
Class c "C"
  Property level "level"
    -> typed-by int
  Constraint k body="0 <= level and level <= 9"
  Activity a "a"
    Control i "" subkind="initial"
    Control d "" subkind="decision" {attrs}
    Action x "x" subkind="opaque"
    Action y "y" subkind="opaque"
    {flow} f1
      -> flow-source i
      -> flow-target d
    {flow} f2 {first}
      -> flow-source d
      -> flow-target x
    {flow} f3 {second}
      -> flow-source d
      -> flow-target y
DataType int "Integer"
"""


def derive_decision(first: str, second: str, flow: str = "ControlFlow", attrs: str = ""):
    """Return the token graph of a decision with two guards, and the codes of the diagnostics."""
    text = DECISION.format(first=first, second=second, flow=flow, attrs=attrs)
    graphs, sink = derive_token_graphs(text)
    return graphs[0], list_codes(sink)


def test_guards_over_properties_that_exclude_each_other_and_cover_all_values_are_valid():
    graph, codes = derive_decision('guard="level > 4"', 'guard="level <= 4"')
    assert codes == []
    assert graph.node("d").exclusive
    assert name_inputs(graph) == ["done_x", "done_y", "level"]


def test_gaps_and_overlaps_of_guards_are_reported():
    assert derive_decision('guard="level > 4"', 'guard="level < 4"')[1] == ["SM456"]
    assert derive_decision('guard="level > 4"', 'guard="level < 6"')[1] == ["SM457"]


def test_literal_guards_are_compared_with_the_object_that_the_decision_passes_on():
    graph, codes = derive_decision(
        'guard="true" guard_literal=true', 'guard="false" guard_literal=true', "ObjectFlow"
    )
    assert codes == []
    assert name_inputs(graph) == ["done_x", "done_y", "input_decision_1"]


def test_a_token_whose_value_no_branch_names_ends_at_the_decision():
    graph, codes = derive_decision(
        'guard="1" guard_literal=true', 'guard="2" guard_literal=true', attrs='decision_input="b"'
    )
    assert codes == ["SM476"]
    assert graph.inputs[-1].domain.literals == ("_1", "_2", "other")
    *_, rest = graph.outgoing(graph.node("d"))
    assert (rest.guard.text, graph.node(rest.target).kind) == ("else", "sink")
    assert graph.node("d").exhaustive


def test_a_text_or_a_literal_of_an_enumeration_is_compared_like_a_number():
    graph, codes = derive_decision(
        'guard="red" guard_literal=true', 'guard="else"', attrs='decision_input="b"'
    )
    assert codes == []
    assert graph.inputs[-1].domain.literals == ("red", "other")


def test_values_on_branches_become_distinct_identifiers():
    graph, _ = derive_decision(
        'guard="other" guard_literal=true',
        'guard="no gap" guard_literal=true',
        attrs='decision_input="b"',
    )
    assert graph.inputs[-1].domain.literals == ("other_2", "no_gap", "other")


def test_the_literal_true_that_tools_write_on_control_flows_is_no_guard():
    literal = 'guard="true" guard_literal=true'
    graph, codes = derive_decision(literal, literal)
    assert codes == ["SM457"]
    assert [edge.guard for edge in graph.edges] == [None, None, None]


def test_an_undefined_name_becomes_the_same_input_wherever_it_is_used():
    graph, codes = derive_decision('guard="tested and level > 2"', 'guard="not tested"')
    assert codes == ["SM458", "SM456"]
    assert name_inputs(graph) == ["done_x", "done_y", "tested", "level"]


@pytest.mark.parametrize(
    ("left", "right"),
    [
        ("heat(x) > 3", "heat(x)<=3"),
        ("heat(x) > 3", "!(3 < heat(x))"),
        ("!(heat(x) > 3)", "(heat(x) > 3)"),
        ("heat(x) == level", "level <> heat(x)"),
    ],
)
def test_guards_without_formula_that_are_opposites_are_one_input(left, right):
    graph, codes = derive_decision(f'guard="{left}"', f'guard="{right}"')
    assert codes == ["SM458", "SM458"]
    (variable,) = [variable for variable in graph.inputs if variable.condition]
    assert variable.reason.startswith("calls such as 'heat(x)' are not ")
    conditions = {edge.guard.condition for edge in graph.edges if edge.guard is not None}
    assert conditions == {f.var(variable.name), f.negate(f.var(variable.name))}
