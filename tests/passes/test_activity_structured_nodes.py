"""The pass ``activities``: loops, conditionals, sequences, regions and the flows across borders."""

import pytest
from pass_runs import list_codes
from token_graphs import derive_token_graph, derive_token_graphs, list_edges, name_inputs

from activity_sketch import sketch
from rule_examples import read_graphs
from sysmlc.diagnostics import catalogue
from sysmlc.logic import evaluate
from sysmlc.logic.activities.token_step import State, TokenStep

RULES = catalogue()


# -- structured nodes ---------------------------------------------------------------------------

LOOP = """
Activity a "a"
  Control i "" subkind="initial"
  Structured l "retry" subkind="loop" tested_first={first} test=["t"] body_part=["b"]
    Action t "test" subkind="opaque"
    Action b "try" subkind="opaque"
  ControlFlow f1
    -> flow-source i
    -> flow-target l
"""


@pytest.mark.parametrize(("first", "path"), [("true", "test"), ("false", "body")])
def test_a_loop_node_tests_before_or_after_its_body(first, path):
    graph = derive_token_graph(LOOP.format(first=first))
    merge = next(node for node in graph.nodes if node.label.startswith("the repetition"))
    (after,) = graph.outgoing(merge)
    assert graph.node(after.target).label == f"the {path} of structured node 'retry'"


CONDITIONAL = """
Activity a "a"
  Structured c "case" subkind="conditional" clauses=[[["t1"], ["b1"]], [["t2"], ["b2"]]]
    Action t1 "t1" subkind="opaque"
    Action b1 "b1" subkind="opaque"
    Action t2 "t2" subkind="opaque"
    Action b2 "b2" subkind="opaque"
"""


def test_the_clauses_of_a_conditional_node_are_tried_in_order():
    graph = derive_token_graph(CONDITIONAL)
    edges = [e for e in graph.edges if e.region == "c"]
    guarded = [
        (graph.node(e.source).label, e.guard.text, graph.node(e.target).label)
        for e in edges
        if e.guard
    ]
    suffix = "of structured node 'case'"
    assert guarded == [
        (f"the decision after test 1 {suffix}", "test 1 is true", f"the body 1 {suffix}"),
        (f"the decision after test 1 {suffix}", "else", f"the test 2 {suffix}"),
        (f"the decision after test 2 {suffix}", "test 2 is true", f"the body 2 {suffix}"),
        (f"the decision after test 2 {suffix}", "else", f"the end {suffix}"),
    ]


def test_a_clause_whose_test_is_the_literal_true_is_the_else_of_a_conditional_node():
    graph = derive_token_graph(
        CONDITIONAL.replace('t2 "t2" subkind="opaque"', 't2 "t2" subkind="value" value=true')
    )
    texts = [edge.guard.text for edge in graph.edges if edge.region == "c" and edge.guard]
    assert texts == ["test 1 is true", "else", "test 2 is true"]
    assert [name for name in name_inputs(graph) if "input" in name] == ["input_test_1_case"]


def test_the_decider_pin_names_the_action_whose_value_is_the_result_of_the_test():
    decider = """    Action t3 "t3" subkind="value" value=true
      Pin p "p" direction="out"
"""
    clauses = 'clauses=[[["t1", "t3"], ["b1"]], [["t2"], ["b2"]]] clause_outputs=[{}, [[], []]]'
    text = CONDITIONAL.replace('clauses=[[["t1"], ["b1"]], [["t2"], ["b2"]]]', clauses) + decider
    with_decider = derive_token_graph(text.replace("{}", '[["p"], []]'))
    assert not any("input" in name for name in name_inputs(with_decider))
    without_decider = derive_token_graph(text.replace("{}", "[[], []]"))
    assert [name for name in name_inputs(without_decider) if "input" in name] == [
        "input_test_1_case",
        "input_test_2_case",
    ]


def test_the_nodes_of_a_sequence_node_run_in_order():
    text = sketch("initial i\nstructured s\n  action x\n  action y\ni -> s")
    graph = derive_token_graph(text.replace('subkind="structured"', 'subkind="sequence"'))
    assert list_edges(graph) == ["at_x_to_y", "*at_start_to_s", "*at_start_x_to_x"]


def test_a_structured_node_without_flows_is_only_a_group_and_not_reported():
    graphs, sink = derive_token_graphs(read_graphs(RULES["SM471"]).right)
    assert [node.kind for node in graphs[0].nodes].count("structured") == 0
    assert "SM471" not in list_codes(sink)


def nest_structured_nodes(levels: int) -> str:
    lines = [f'{"  " * n}Structured s{n} "" subkind="structured"' for n in range(1, levels + 1)]
    return "\n".join(
        ['Activity a "a"', *lines, f'{"  " * levels}  Action x "x" subkind="opaque"\n']
    )


def test_structured_nodes_may_be_nested_a_hundred_levels_deep():
    assert derive_token_graph(nest_structured_nodes(100)).finishes


@pytest.mark.parametrize("levels", [101, 1500])
def test_models_with_deeper_nesting_are_reported(levels):
    graphs, sink = derive_token_graphs(nest_structured_nodes(levels))
    assert graphs == []
    assert list_codes(sink) == ["SM479"]


# -- borders of structured nodes ----------------------------------------------------------------

BORDER = """
Activity a "a"
  Control i "" subkind="initial"
  Control k "" subkind="fork"
  Structured s "s" subkind="structured"
    Action x "x" subkind="opaque"
    Action y "y" subkind="opaque"
  Action z "z" subkind="opaque"
  ControlFlow f1
    -> flow-source i
    -> flow-target k
  ControlFlow f2
    -> flow-source k
    -> flow-target s
  ObjectFlow f3
    -> flow-source k
    -> flow-target x
  ObjectFlow f4
    -> flow-source y
    -> flow-target z
"""


def test_a_flow_across_a_border_belongs_to_the_region_around_it():
    graph = derive_token_graph(BORDER)
    (into,) = [edge for edge in graph.edges if edge.origin == "f3"]
    (out,) = [edge for edge in graph.edges if edge.origin == "f4"]
    assert (into.region, graph.enters(into)) == ("", True)
    assert (out.region, graph.enters(out)) == ("", False)


def test_an_action_that_waits_for_a_token_from_outside_keeps_its_region_from_ending():
    """The region starts the action (fUML 1.5, 8.10.2), so it waits for the token of the action."""
    graph = derive_token_graph(BORDER)
    list_sources = [graph.node(edge.source).label for edge in graph.incoming(graph.node("x"))]
    assert list_sources == ["fork 1", "the start"]
    state = State(frozenset(e.id for e in graph.inside("s")[0] if e.target == "x"), frozenset("s"))
    empty = State(frozenset(), frozenset("s"))
    assert not TokenStep(graph, state, {}, evaluate.is_true).is_complete("s")
    assert TokenStep(graph, empty, {}, evaluate.is_true).is_complete("s")


def test_the_value_at_an_input_pin_may_pass_through_to_an_output_pin():
    graph = derive_token_graph("""
Activity a "a"
  Structured s "s" subkind="structured"
    Pin p "p" direction="in" multiplicity="0..1"
    Pin q "q" direction="out"
    ObjectFlow f1
      -> flow-source p
      -> flow-target q
  Control e "" subkind="flow-final"
  ObjectFlow f2
    -> flow-source q
    -> flow-target e
""")
    edges = [e for e in graph.edges if e.region == "s"]
    assert [(graph.node(e.source).kind, graph.node(e.target).kind, e.marked) for e in edges] == [
        ("initial", "sink", True)
    ]


# -- loops, expansion regions -------------------------------------------------------------------

VARIABLES = """
Activity a "a"
  Structured l "count" subkind="loop" tested_first=true test=["t"] body_part=["b"]
    Pin n "n" direction="out" subkind="result"
    Control k "k" subkind="fork"
    Action t "test" subkind="opaque"
    Action b "body" subkind="opaque"
    ObjectFlow f1
      -> flow-source n
      -> flow-target k
    ObjectFlow f2
      -> flow-source k
      -> flow-target t
    ObjectFlow f3
      -> flow-source k
      -> flow-target b
"""


def test_a_loop_variable_has_a_new_token_in_each_round():
    graph = derive_token_graph(VARIABLES)
    (variable,) = [edge for edge in graph.edges if edge.origin == "f1"]
    assert graph.node(variable.source).label == "the round of structured node 'count'"
    (rounds,) = graph.interruptibles
    assert set(rounds.nodes) == {"k", "t", "b", variable.source}
    (back,) = [edge for edge in graph.edges if edge.interrupts]
    assert graph.node(back.target).label == "the repetition of structured node 'count'"


def test_a_fork_between_the_actions_of_a_test_belongs_to_the_test():
    text = VARIABLES.replace('test=["t"]', 'test=["t", "b"]').replace('body_part=["b"]', "")
    graph = derive_token_graph(text)
    assert graph.node("k").region == graph.node("t").region


def test_the_environment_decides_how_often_an_iterative_expansion_region_repeats():
    graph = derive_token_graph(read_graphs(RULES["SM477"]).right)
    assert name_inputs(graph) == ["input_more_e", "done_x"]
    guards = [edge.guard.text for edge in graph.edges if edge.guard]
    assert guards == ["there is another element", "else"]


EXPANSION = """
Activity a "a"
  Action x "x" subkind="opaque"
    Pin x.out "out" direction="out"
  ObjectNode in "in" subkind="expansion" region_as_input="e"
  Structured e "each" subkind="expansion" mode="parallel"
    Action y "y" subkind="opaque"
      Pin y.in "in" direction="in"
  ObjectFlow f1
    -> flow-source x.out
    -> flow-target in
  ObjectFlow f2
    -> flow-source in
    -> flow-target y.in
"""


def test_an_expansion_node_is_a_pin_of_its_region():
    graph = derive_token_graph(EXPANSION)
    (into,) = [edge for edge in graph.edges if edge.origin == "f1"]
    (inside,) = [edge for edge in graph.edges if edge.origin == "f2"]
    assert (into.target, into.region) == ("e", "")
    assert inside.marked
    assert graph.node(inside.region).label == "the element of structured node 'each'"
