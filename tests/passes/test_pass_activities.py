"""The pass ``activities``: each activity becomes a token graph, or a rule reports the reason."""

import pytest
from pass_runs import list_codes

from activity_sketch import sketch
from sysmlc.diagnostics import Sink, catalogue
from sysmlc.ir.text import parse_text, print_text
from sysmlc.ir.verify import verify
from sysmlc.logic.activities.interpreter import State, is_complete
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.passes.activities import Activities

LIMITS = {"SM455": {"max_markings": 3}, "SM479": {"max_depth": 1}}
"""Options with limits that the models of the rules about limits exceed."""
RULES = {code: rule for code, rule in catalogue().items() if "SM450" <= code <= "SM479"}
WITH_GRAPHS = sorted(code for code, rule in RULES.items() if rule.read_page().language == "ir")
"""Rules whose examples are graphs; those in XMI or SysML v2 are compiled as files."""


def derive_token_graphs(text: str, **options):
    graph, sink = parse_text(text), Sink()
    assert verify(graph) == []
    Activities(**options).run(graph, sink)
    return list(graph.derived(TokenGraph)), sink


def derive_token_graph(text: str, **options) -> TokenGraph:
    """Return the token graph of the only activity."""
    (token_graph,), _ = derive_token_graphs(text, **options)
    return token_graph


def list_edges(graph: TokenGraph) -> list[str]:
    """Return the variable of each edge, with an asterisk if it has a token at the start."""
    return [f"{'*' * edge.marked}{edge.variable}" for edge in graph.edges]


def name_inputs(graph: TokenGraph) -> list[str]:
    return [variable.name for variable in graph.inputs]


@pytest.mark.parametrize("code", WITH_GRAPHS)
def test_rule_reports_its_wrong_model_and_not_its_right_one(code):
    options = LIMITS.get(code, {})
    _, sink = derive_token_graphs(RULES[code].read_page().wrong, **options)
    assert code in list_codes(sink)
    diagnostic = next(d for d in sink if d.rule.code == code)
    assert diagnostic.subject.id in parse_text(RULES[code].read_page().wrong)
    assert "{" not in diagnostic.message + diagnostic.help
    _, sink = derive_token_graphs(RULES[code].read_page().right, **options)
    assert code not in list_codes(sink)


@pytest.mark.parametrize("code", WITH_GRAPHS)
def test_an_activity_without_token_graph_is_always_reported(code):
    for text in (RULES[code].read_page().wrong, RULES[code].read_page().right):
        token_graphs, sink = derive_token_graphs(text)
        assert token_graphs or len(sink)


def test_the_pass_leaves_the_elements_unchanged_and_is_idempotent():
    graph = parse_text(RULES["SM453"].read_page().right)
    before = print_text(graph)
    Activities().run(graph, Sink())
    once = graph.derived(TokenGraph)
    Activities().run(graph, Sink())
    assert graph.derived(TokenGraph) == once
    assert print_text(graph) == before


# -- edges and workers -------------------------------------------------------------------------


def test_each_edge_has_a_boolean_and_each_action_a_run_variable():
    graph = derive_token_graph(
        sketch(
            "initial i\naction read\nfork k\naction x\naction y\njoin j\nfinal f\n"
            "i -> read\nread -> k\nk -> x\nk -> y\nx -> j\ny -> j\nj -> f"
        )
    )
    assert list_edges(graph) == [
        "*at_start_to_read",
        "at_read_to_fork_1",
        "at_fork_1_to_x",
        "at_fork_1_to_y",
        "at_x_to_join_1",
        "at_y_to_join_1",
        "at_join_1_to_end",
    ]
    assert [node.run for node in graph.workers()] == ["run_read", "run_x", "run_y"]
    assert name_inputs(graph) == ["done_read", "done_x", "done_y"]
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
    graph = derive_token_graph(PINS)
    weigh = graph.node("w")
    assert [edge.variable for edge in graph.incoming(weigh)] == [
        "at_x_to_weigh",
        "at_seven_to_weigh",
    ]
    assert [node.run for node in graph.workers()] == ["run_x", "run_weigh"]
    assert list_edges(graph)[0] == "*at_piece_to_x"
    assert list_edges(graph)[-1] == "*at_start_seven_to_seven"


def test_flows_that_reach_one_pin_bring_their_tokens_in_turn():
    """The action runs twice; a token that arrives while it runs waits on the flow."""
    graph = derive_token_graph(PINS.replace("flow-target w.b", "flow-target w.a"))
    weigh = graph.node("w")
    assert [graph.node(edge.source).label for edge in graph.incoming(weigh)] == [
        "the merge before action 'weigh'"
    ]
    assert weigh.queues


def test_a_pin_with_as_many_values_as_flows_waits_for_all_flows():
    text = PINS.replace("flow-target w.b", "flow-target w.a")
    graph = derive_token_graph(
        text.replace('w.a "a" direction="in"', 'w.a "a" direction="in" multiplicity="2"')
    )
    assert len(graph.incoming(graph.node("w"))) == 2


def test_an_input_that_may_be_missing_needs_no_flow():
    text = PINS.replace('w.b "b" direction="in"', 'w.b "b" direction="in" multiplicity="0..1"')
    _, sink = derive_token_graphs(text.replace("flow-target w.b", "flow-target w.a"))
    assert "SM464" not in list_codes(sink)


def test_an_accept_action_without_incoming_flows_waits_again_after_each_event():
    graph = derive_token_graph(sketch("accept go\n  on-pallet t\nend e\ngo -> e"))
    assert list_edges(graph) == ["at_go_to_flow_final_1", "*at_go_to_go"]
    assert name_inputs(graph) == ["receive_pallet"]
    assert not graph.finishes


def test_a_sent_signal_is_an_output_of_one_step():
    action = '  Action x "x" subkind="send"\n'
    text = sketch("initial i\naction x\ni -> x").replace("opaque", "send")
    graph = derive_token_graph(
        text.replace(action, f"{action}    -> calls s\n") + 'Signal s "Ready"\n'
    )
    assert [node.run for node in graph.workers()] == ["send_Ready"]
    assert graph.inputs == ()


@pytest.mark.parametrize(("attribute", "inputs"), [("", 1), (" synchronous=false", 0)])
def test_the_end_of_an_asynchronous_call_is_not_awaited(attribute, inputs):
    text = sketch("initial i\naction x\ni -> x")
    call = f'subkind="call-behavior"{attribute}'
    graph = derive_token_graph(text.replace('subkind="opaque"', call))
    assert [node.run for node in graph.workers()] == ["run_x"]
    assert len(graph.inputs) == inputs


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


# -- structured nodes --------------------------------------------------------------------------

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


# -- borders of structured nodes ---------------------------------------------------------------

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
    assert not is_complete(graph, state, "s")
    assert is_complete(graph, State(frozenset(), frozenset("s")), "s")


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


def test_a_structured_node_without_flows_is_only_a_group_and_not_reported():
    graphs, sink = derive_token_graphs(RULES["SM471"].read_page().right)
    assert [node.kind for node in graphs[0].nodes].count("structured") == 0
    assert "SM471" not in list_codes(sink)


# -- loops, expansion regions ------------------------------------------------------------------

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
    graph = derive_token_graph(RULES["SM477"].read_page().right)
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


# -- data stores -------------------------------------------------------------------------------

STORE = """
Activity a "a"
  Control i "" subkind="initial"
  Action w "write" subkind="opaque"
  Action r "read" subkind="opaque"
  DataStore d "value"
  ControlFlow f1
    -> flow-source i
    -> flow-target w
  ControlFlow f2
    -> flow-source w
    -> flow-target r
  ObjectFlow f3
    -> flow-source w
    -> flow-target d
  ObjectFlow f4
    -> flow-source d
    -> flow-target r
"""


def test_a_data_store_retains_its_value_when_it_is_read():
    graph = derive_token_graph(STORE)
    assert [edge.origin for edge in graph.edges if edge.keeps] == ["f4"]
    assert graph.node("d").kind == "data-store"


# -- exceptions --------------------------------------------------------------------------------

PROTECTED = """
Activity a "a"
  Structured s "try" subkind="structured" handlers=[[["h"], [], []]]
    Action x "x" subkind="opaque"
    Action r "r" subkind="raise"
    ControlFlow f1
      -> flow-source x
      -> flow-target r
  Structured h "repair" subkind="structured"
    Action y "y" subkind="opaque"
  Action z "z" subkind="opaque"
  ControlFlow f2
    -> flow-source s
    -> flow-target z
"""


def list_sources(graph: TokenGraph, id: str) -> list[str]:
    return [graph.node(edge.source).label for edge in graph.incoming(graph.node(id))]


def test_the_body_of_a_handler_starts_with_an_exception_only():
    graph = derive_token_graph(PROTECTED)
    assert list_sources(graph, "h") == ["the exception of structured node 'try'"]
    assert "h" in {node.id for node in graph.nodes}


def test_an_exception_ends_the_protected_node():
    graph = derive_token_graph(PROTECTED)
    interrupts = [edge for edge in graph.edges if edge.interrupts]
    assert [graph.node(edge.source).label for edge in interrupts] == [
        "the end of action 'x'",
        "action 'r'",
    ]
    (region,) = graph.interruptibles
    assert {"s", "x", "r"} <= set(region.nodes)
    assert not {"h", "y", "z"} & set(region.nodes)


def test_the_flows_after_the_protected_node_continue_when_the_handler_ends():
    graph = derive_token_graph(PROTECTED)
    (after,) = graph.incoming(graph.node("z"))
    assert list_sources(graph, after.source) == [
        "structured node 'repair'",
        "structured node 'try'",
    ]


def test_a_call_in_a_protected_node_ends_normally_or_with_an_exception():
    graph = derive_token_graph(PROTECTED)
    assert "raised_x" in name_inputs(graph)


def test_the_first_of_two_handlers_for_one_type_catches_it():
    text = PROTECTED.replace('[[["h"], [], []]]', '[[["h"], [], ["t"]], [["z"], [], ["t"]]]')
    graph = derive_token_graph(text + 'Class t "Fault"\n')
    assert list_sources(graph, "h") == ["the exception of structured node 'try'"]
    assert list_sources(graph, "z")[0] != "the exception of structured node 'try'"


def test_an_input_selects_among_handlers_for_several_types():
    text = PROTECTED.replace('[[["h"], [], []]]', '[[["h"], [], ["t"]], [["z"], [], ["u"]]]')
    graph = derive_token_graph(text + 'Class t "Fault"\nClass u "Stop"\n')
    (types,) = [v for v in graph.inputs if v.name == "exception_try"]
    assert types.domain.literals == ("Fault", "Stop", "other")


def test_an_uncaught_exception_ends_the_activity():
    graph = derive_token_graph(sketch("initial i\nraise stop\ni -> stop"))
    (end,) = graph.outgoing(graph.node("stop"))
    assert graph.node(end.target).kind == "final"


CALLER = """
Activity a "a"
  Action c "c" subkind="call-behavior"
    -> calls b
Activity b "b"
  Structured s "s" subkind="structured" {handlers}
    Action r "r" subkind="raise"
  Structured h "h" subkind="structured"
"""


def test_a_call_of_an_activity_that_raises_an_exception_may_end_the_caller():
    graphs, sink = derive_token_graphs(CALLER.format(handlers=""))
    assert "raised_c" in name_inputs(graphs[0])
    subjects = {diagnostic.subject.id for diagnostic in sink if diagnostic.rule.code == "SM475"}
    assert subjects == {"c", "r"}


def test_a_call_of_an_activity_that_catches_its_exceptions_ends_normally():
    graphs, sink = derive_token_graphs(CALLER.format(handlers='handlers=[[["h"], [], []]]'))
    assert name_inputs(graphs[0]) == ["done_c"]
    assert "SM475" not in list_codes(sink)


# -- ends --------------------------------------------------------------------------------------


def test_an_activity_ends_when_no_token_in_it_can_move():
    """A join that waits in vain does not delay the end (fUML 1.5, 8.10.1)."""
    graphs, sink = derive_token_graphs(RULES["SM453"].read_page().wrong)
    assert graphs[0].finishes
    assert "SM453" in list_codes(sink)


def test_the_condition_that_an_activity_is_over_gets_a_name_when_it_is_long():
    chain = "initial i\n" + "".join(f"action a{n}\n" for n in range(9)) + "i -> a0\n"
    graph = derive_token_graph(sketch(chain + "\n".join(f"a{n} -> a{n + 1}" for n in range(8))))
    assert graph.quiets == (("", "over"),)
    assert derive_token_graph(sketch("initial i\naction x\ni -> x")).quiets == ()


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


# -- size --------------------------------------------------------------------------------------


def test_nodes_that_only_pass_tokens_on_are_removed_from_large_activities():
    text = sketch(
        "initial i\naction read\nfork k\naction x\naction y\njoin j\nmerge m\nfinal f\n"
        "i -> read\nread -> k\nk -> x\nk -> y\nx -> j\ny -> j\nj -> m\nm -> f"
    )
    graph = derive_token_graph(text, collapse_over=7)
    assert len(graph.edges) < 8
    origins = {origin for edge in graph.edges for origin in edge.origins}
    assert origins >= {f"f{number}" for number in range(8)}
    assert [edge.label for edge in graph.edges][1] == "the flow from action 'read' to action 'x'"


def test_two_flows_that_reach_the_merge_before_the_end_at_once_are_two_tokens():
    start, end = "initial i\naction x\nmerge m\nfinal e\ni -> x", "x -> m\nm -> e"
    _, sink = derive_token_graphs(sketch(f"{start}\n{end}"))
    assert list_codes(sink) == []
    _, sink = derive_token_graphs(sketch(f"{start}\nx -> m\n{end}"))
    assert list_codes(sink) == ["SM454"]
