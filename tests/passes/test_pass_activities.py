"""The pass ``activities``: what is drawn becomes a token graph, or a rule says why not."""

import pytest

from sysmlc.diagnostics import Sink, catalogue
from sysmlc.ir.text import parse_text, print_text
from sysmlc.ir.verify import verify
from sysmlc.logic.tokens import TokenGraph
from sysmlc.passes.activities import Activities
from sysmlc.passes.activity_rules import sketch

RULES = {code: rule for code, rule in catalogue().items() if "SM450" <= code <= "SM499"}


def tokens(text: str, **options):
    graph, sink = parse_text(text), Sink()
    assert verify(graph) == []
    Activities(**options).run(graph, sink)
    return list(graph.derived(TokenGraph)), sink


def only(text: str, **options) -> TokenGraph:
    (found,), _ = tokens(text, **options)
    return found


def edges(graph: TokenGraph) -> list[str]:
    return [f"{'*' * edge.marked}{edge.variable}" for edge in graph.edges]


def codes(sink: Sink) -> list[str]:
    return [found.rule.code for found in sink]


@pytest.mark.parametrize("code", sorted(RULES))
def test_each_rule_is_found_in_its_wrong_model_and_not_in_its_right_one(code):
    options = {"max_markings": 3} if code == "SM455" else {}
    _, sink = tokens(RULES[code].wrong, **options)
    assert code in codes(sink)
    found = next(d for d in sink if d.rule.code == code)
    assert found.subject.id in parse_text(RULES[code].wrong)
    assert "{" not in found.message + found.help
    _, sink = tokens(RULES[code].right, **options)
    assert code not in codes(sink)


@pytest.mark.parametrize("code", sorted(RULES))
def test_an_activity_without_token_graph_is_always_reported(code):
    for text in (RULES[code].wrong, RULES[code].right):
        found, sink = tokens(text)
        assert found or len(sink)


def test_the_graph_stays_as_it_is_and_twice_equals_once():
    graph = parse_text(RULES["SM453"].right)
    before = print_text(graph)
    Activities().run(graph, Sink())
    once = graph.derived(TokenGraph)
    Activities().run(graph, Sink())
    assert graph.derived(TokenGraph) == once
    assert print_text(graph) == before


# -- what is drawn -----------------------------------------------------------------------------


def test_one_boolean_an_edge_and_a_run_variable_an_action():
    graph = only(
        sketch(
            "initial i\naction read\nfork k\naction x\naction y\njoin j\nfinal f\n"
            "i -> read\nread -> k\nk -> x\nk -> y\nx -> j\ny -> j\nj -> f"
        )
    )
    assert edges(graph) == [
        "*at_start_to_read",
        "at_read_to_fork_1",
        "at_fork_1_to_x",
        "at_fork_1_to_y",
        "at_x_to_join_1",
        "at_y_to_join_1",
        "at_join_1_to_end",
    ]
    assert [node.run for node in graph.workers()] == ["run_read", "run_x", "run_y"]
    assert [variable.name for variable in graph.inputs] == ["done_read", "done_x", "done_y"]
    assert graph.edges[2].label == "the flow from fork 1 to action 'x'"
    assert graph.edges[2].origins == ("f2",)


PINS = """
Activity a "a"
  Parameter p "piece" direction="in"
  ActivityParameter pn "piece" direction="in"
    -> references p
  Action x "x" subkind="opaque"
    Pin x.in "in" direction="in"
    Pin x.out "out" direction="out"
  Action v "seven" subkind="value"
    Pin v.out "out" direction="out"
  Action w "weigh" subkind="opaque"
    Pin w.a "a" direction="in"
    Pin w.b "b" direction="in"
  ActivityParameter r "result" direction="out"
  ObjectFlow o1
    -> flow-source pn
    -> flow-target x.in
  ObjectFlow o2
    -> flow-source x.out
    -> flow-target w.a
  ObjectFlow o3
    -> flow-source v.out
    -> flow-target w.b
"""


def test_an_action_waits_for_all_its_pins_and_a_value_takes_no_time():
    graph = only(PINS)
    weigh = graph.node("w")
    assert [edge.variable for edge in graph.incoming(weigh)] == [
        "at_x_to_weigh",
        "at_seven_to_weigh",
    ]
    assert [node.run for node in graph.workers()] == ["run_x", "run_weigh"]
    assert edges(graph)[0] == "*at_piece_to_x"
    assert edges(graph)[-1] == "*at_start_seven_to_seven"


def test_flows_that_reach_one_pin_bring_their_tokens_one_after_the_other():
    found, sink = tokens(PINS.replace("flow-target w.b", "flow-target w.a"))
    assert found == []
    assert "SM454" in codes(sink)


def test_an_accept_action_without_incoming_flows_listens_again_after_each_event():
    graph = only(sketch("accept go\n  on-pallet t\nend e\ngo -> e"))
    assert edges(graph) == ["at_go_to_flow_final_1", "*at_go_to_go"]
    assert [variable.name for variable in graph.inputs] == ["receive_pallet"]
    assert not graph.finishes


def test_a_sent_signal_is_an_output_of_one_step():
    action = '  Action x "x" subkind="send"\n'
    text = sketch("initial i\naction x\ni -> x").replace("opaque", "send")
    graph = only(text.replace(action, f"{action}    -> calls s\n") + 'Signal s "Ready"\n')
    assert [node.run for node in graph.workers()] == ["send_Ready"]
    assert graph.inputs == ()


# -- guards ------------------------------------------------------------------------------------

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


def decision(first: str, second: str, flow: str = "ControlFlow", attrs: str = ""):
    found, sink = tokens(DECISION.format(first=first, second=second, flow=flow, attrs=attrs))
    return found[0], codes(sink)


def test_guards_over_properties_that_exclude_each_other_and_cover_all_are_fine():
    graph, found = decision('guard="level > 4"', 'guard="level <= 4"')
    assert found == []
    assert graph.node("d").exclusive
    assert [variable.name for variable in graph.inputs] == ["done_x", "done_y", "level"]


def test_a_gap_between_guards_and_an_overlap_are_found_by_their_meaning():
    assert decision('guard="level > 4"', 'guard="level < 4"')[1] == ["SM456"]
    assert decision('guard="level > 4"', 'guard="level < 6"')[1] == ["SM457"]


def test_literal_guards_are_compared_with_the_object_that_the_decision_passes_on():
    graph, found = decision(
        'guard="true" guard_literal=true', 'guard="false" guard_literal=true', "ObjectFlow"
    )
    assert found == []
    assert [variable.name for variable in graph.inputs] == ["done_x", "done_y", "input_decision_1"]


def test_other_literals_than_those_on_the_branches_keep_the_token():
    graph, found = decision(
        'guard="1" guard_literal=true', 'guard="2" guard_literal=true', attrs='decision_input="b"'
    )
    assert found == ["SM456"]
    assert graph.inputs[-1].domain.literals == ("1", "2", "other")


def test_the_literal_true_that_tools_write_on_control_flows_opens_every_branch():
    graph, found = decision('guard="true" guard_literal=true', 'guard="true" guard_literal=true')
    assert found == ["SM457"]
    assert [edge.guard for edge in graph.edges] == [None, None, None]


def test_a_name_that_is_not_known_becomes_one_input_wherever_it_is_used():
    graph, found = decision('guard="tested and level > 2"', 'guard="not tested"')
    assert found == ["SM458", "SM456"]
    assert [variable.name for variable in graph.inputs] == ["done_x", "done_y", "tested", "level"]


# -- structure ---------------------------------------------------------------------------------

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
    graph = only(LOOP.format(first=first))
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
    graph = only(CONDITIONAL)
    inner = [e for e in graph.edges if e.region == "c"]
    guarded = [
        (graph.node(e.source).label, e.guard.text, graph.node(e.target).label)
        for e in inner
        if e.guard
    ]
    of = "of structured node 'case'"
    assert guarded == [
        (f"the test 1 {of}", "test 1 is true", f"the body 1 {of}"),
        (f"the test 1 {of}", "else", f"the test 2 {of}"),
        (f"the test 2 {of}", "test 2 is true", f"the body 2 {of}"),
        (f"the test 2 {of}", "else", f"the end {of}"),
    ]


def test_the_nodes_of_a_sequence_node_follow_each_other():
    text = sketch("initial i\nstructured s\n  action x\n  action y\ni -> s")
    graph = only(text.replace('subkind="structured"', 'subkind="sequence"'))
    assert edges(graph) == ["at_x_to_y", "*at_start_to_s", "*at_start_x_to_x"]


def test_handlers_of_exceptions_do_not_start_by_themselves():
    graph = only(RULES["SM463"].wrong)
    assert [node.run for node in graph.workers()] == ["run_work"]


# -- size --------------------------------------------------------------------------------------


def test_large_activities_lose_the_nodes_that_only_pass_tokens_on():
    text = sketch(
        "initial i\naction read\nfork k\naction x\naction y\njoin j\nmerge m\nfinal f\n"
        "i -> read\nread -> k\nk -> x\nk -> y\nx -> j\ny -> j\nj -> m\nm -> f"
    )
    graph = only(text, collapse_over=7)
    assert (
        edges(graph)
        == [
            "*at_start_to_read",
            "at_fork_1_to_x",
            "at_fork_1_to_y",
            "at_x_to_join_1",
            "at_y_to_join_1",
            "at_join_1_to_merge_1",
        ]
        or len(graph.edges) < 8
    )
    origins = {origin for edge in graph.edges for origin in edge.origins}
    assert origins >= {f"f{number}" for number in range(8)}
    assert [edge.label for edge in graph.edges][1] == "the flow from action 'read' to action 'x'"
