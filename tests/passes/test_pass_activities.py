"""The pass ``activities``: each activity becomes a token graph, or a rule reports the reason."""

import pytest
from pass_runs import list_codes
from token_graphs import derive_token_graph, derive_token_graphs, list_edges, name_inputs

from activity_sketch import sketch
from rule_examples import has_graphs, read_graphs
from sysmlc.analyses.activities import Activities
from sysmlc.diagnostics import Sink, catalogue
from sysmlc.ir.text import parse_text, print_text
from sysmlc.logic.activities.token_graph import TokenGraph

LIMITS = {"SM455": {"max_markings": 3}, "SM479": {"max_depth": 1}}
"""Options with limits that the models of the rules about limits exceed."""
RULES = {code: rule for code, rule in catalogue().items() if "SM450" <= code <= "SM479"}
UNORDERED = "activity 'a' has nodes but no flows, so that nothing orders them; it gets no contract"
WITH_GRAPHS = sorted(code for code, rule in RULES.items() if has_graphs(rule))
"""Rules whose examples are graphs; those in XMI or SysML v2 are compiled as files."""


@pytest.mark.parametrize("code", WITH_GRAPHS)
def test_rule_reports_its_wrong_example_and_not_its_right_one(code):
    options = LIMITS.get(code, {})
    _, sink = derive_token_graphs(read_graphs(RULES[code]).wrong, **options)
    assert code in list_codes(sink)
    diagnostic = next(d for d in sink if d.rule.code == code)
    assert diagnostic.subject.id in parse_text(read_graphs(RULES[code]).wrong)
    assert "{" not in diagnostic.message + diagnostic.help
    _, sink = derive_token_graphs(read_graphs(RULES[code]).right, **options)
    assert code not in list_codes(sink)


@pytest.mark.parametrize("code", WITH_GRAPHS)
def test_an_activity_without_token_graph_is_always_reported(code):
    for text in (read_graphs(RULES[code]).wrong, read_graphs(RULES[code]).right):
        token_graphs, sink = derive_token_graphs(text)
        assert token_graphs or len(sink)


def test_the_pass_leaves_the_elements_unchanged_and_is_idempotent():
    graph = parse_text(read_graphs(RULES["SM453"]).right)
    before = print_text(graph)
    Activities().run(graph, Sink())
    once = graph.derived(TokenGraph)
    Activities().run(graph, Sink())
    assert graph.derived(TokenGraph) == once
    assert print_text(graph) == before


# -- edges and workers --------------------------------------------------------------------------


def test_actions_without_names_are_named_after_what_they_call_or_assign():
    lines = sketch("action x\naction y\naction c\naction o\nx -> y\ny -> c\nc -> o").splitlines()
    named = {'x "x"': "level := 1", 'y "y"': "level := level + 1", 'c "c"': "", 'o "o"': "wait()"}
    for name, body in named.items():
        unnamed = f'{name[0]} body="{body}"' if body else name[0]
        lines = [line.replace(f"Action {name}", f"Action {unnamed}") for line in lines]
    index = next(number for number, line in enumerate(lines) if "Action c" in line)
    lines.insert(index + 1, "    -> calls close")
    graph = derive_token_graph("\n".join([*lines, 'Activity close "Close"', ""]))
    assert [(node.label, node.run) for node in graph.nodes if node.run] == [
        ("action 'assign level'", "run_assign_level"),
        ("action 'assign level 2'", "run_assign_level_2"),
        ("action 'Close'", "run_Close"),
        ("action 4", "run_action_4"),
    ]


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


# -- data stores --------------------------------------------------------------------------------

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


# -- ends ---------------------------------------------------------------------------------------


def test_an_activity_ends_when_no_token_in_it_can_move():
    """A join that waits in vain does not delay the end (fUML 1.5, 8.10.1)."""
    graphs, sink = derive_token_graphs(read_graphs(RULES["SM453"]).wrong)
    assert graphs[0].finishes
    assert "SM453" in list_codes(sink)


def test_the_condition_that_an_activity_is_over_gets_a_name_when_it_is_long():
    chain = "initial i\n" + "".join(f"action a{n}\n" for n in range(9)) + "i -> a0\n"
    graph = derive_token_graph(sketch(chain + "\n".join(f"a{n} -> a{n + 1}" for n in range(8))))
    assert graph.named_conditions == (("", "over"),)
    assert derive_token_graph(sketch("initial i\naction x\ni -> x")).named_conditions == ()


# -- size ---------------------------------------------------------------------------------------


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


def test_two_flows_that_reach_a_merge_at_once_are_two_tokens():
    start = "initial i\naction x\naction y\nmerge m\nfinal e\ni -> x"
    end = "x -> m\nm -> y\ny -> e"
    _, sink = derive_token_graphs(sketch(f"{start}\n{end}"))
    assert list_codes(sink) == []
    _, sink = derive_token_graphs(sketch(f"{start}\nx -> m\n{end}"))
    assert list_codes(sink) == ["SM454"]


def test_the_second_token_at_a_merge_does_not_count_where_the_first_ends_the_activity():
    text = sketch("initial i\naction x\nmerge m\nfinal e\ni -> x\nx -> m\nx -> m\nm -> e")
    graph, sink = derive_token_graphs(text)
    assert list_codes(sink) == []
    assert graph


@pytest.mark.parametrize(
    ("nodes", "code", "beginning"),
    [
        (
            "accept go\n  on-pallet t\naction x\ngo -> x",
            "SM454",
            "accept action 'go' accepts",
        ),
        (
            "initial i\nfork k\naction x\naction y\nmerge m\naction z\n"
            "i -> k\nk -> x\nk -> y\nx -> m\ny -> m\nm -> z",
            "SM454",
            "bring parallel branches together",
        ),
        ("initial i\nmerge m\naction x\naction y\ni -> m\nm -> x\nm -> y", "SM457", "add a fork"),
        (
            "initial i\ndecision d\naction x\naction y\ni -> d\nd -> x\nd -> y",
            "SM457",
            "make the guards exclude",
        ),
    ],
)
def test_the_advice_on_tokens_fits_their_cause(nodes, code, beginning):
    _, sink = derive_token_graphs(sketch(nodes))
    (advice,) = [diagnostic.help for diagnostic in sink if diagnostic.rule.code == code]
    assert advice.startswith(beginning)


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        ("", "'a' has no nodes"),
        ('  DataStore s "s"\n', "'a' has no actions"),
        ("  TemplateBinding b\n", "'a' binds a template, whose nodes it does not copy"),
    ],
)
def test_an_activity_without_actions_gets_no_contract(content, fault):
    (diagnostic,) = derive_token_graphs(f'Activity a "a"\n{content}')[1]
    assert diagnostic.rule.code == "SM469"
    assert diagnostic.message == f"activity {fault}; it gets no contract"


# -- unfinished activities ----------------------------------------------------------------------


@pytest.mark.parametrize(
    "nodes",
    [
        "action x\naction y",
        "action x\n  pin p\naction y\naccept z\n  on-tool t",
        "initial i\naction x\nfinal f",
        "initial i",
    ],
)
def test_an_unfinished_activity_without_flows_has_one_finding_and_no_contract(nodes):
    token_graphs, sink = derive_token_graphs(sketch(nodes))
    assert token_graphs == []
    assert [(found.rule.code, found.message) for found in sink] == [("SM486", UNORDERED)]


@pytest.mark.parametrize(
    "nodes",
    [
        "action x",
        "structured s\n  action x",
        "action x\naction y\nx -> y",
        "initial i\naction x\naction y\ni -> x",
    ],
)
def test_one_action_or_one_flow_are_enough_for_a_contract(nodes):
    token_graphs, sink = derive_token_graphs(sketch(nodes))
    assert len(token_graphs) == 1
    assert "SM486" not in list_codes(sink)


def test_an_exception_handler_orders_the_two_actions_of_an_activity():
    token_graphs, sink = derive_token_graphs(sketch("protected work\naction repair"))
    assert len(token_graphs) == 1
    assert "SM486" not in list_codes(sink)
