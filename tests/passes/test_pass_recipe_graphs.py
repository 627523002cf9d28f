"""The pass ``recipe``: the service graphs of tasks, with their loops, guards and assignments."""

import pytest
from pass_runs import list_codes
from recipe_runs import (
    derive_model,
    derive_service_graph,
    print_application,
    run_recipe,
    shorten_id,
)

import recipe_samples as samples
from sysmlc.ir.expressions import Binary, Literal, Unary
from sysmlc.recipe.expression import make_variable
from sysmlc.recipe.model import Model


def test_results_are_assigned_to_variables_and_guards_are_expressions():
    nodes, graph = derive_service_graph()
    assert nodes["look"].assign == (("ok", "ok"),)
    guards = {edge.text: edge.guard for edge in graph.edges if edge.text}
    assert guards == {"ok": make_variable("ok"), "else": None}
    assert {edge.text for edge in graph.edges if edge.is_else} == {"else"}


def test_a_decision_that_goes_back_is_a_loop_with_body_and_exit():
    nodes, graph = derive_service_graph(
        "s m", "m l", "l d", "d m ok", "d g else", "g a", "a b", "b e"
    )
    loop = nodes["good?"]
    assert (loop.kind, loop.expression, loop.max_iterations) == ("loop", make_variable("ok"), None)
    roles = {shorten_id(e.target): e.role for e in graph.edges if e.source == loop.id}
    assert roles == {"after": "body", "grip": "exit"}


def test_the_condition_of_a_loop_is_the_negated_guard_of_its_exit():
    nodes, _ = derive_service_graph("s m", "m l", "l d", "d m else", "d g ok", "g a", "a b", "b e")
    assert nodes["good?"].expression == Unary("not", make_variable("ok"))


def test_a_tag_of_the_decision_bounds_the_iterations_of_a_loop():
    bounded = '"good?" subkind="decision"\n      ' + print_application(
        "d", "Loop", 'tag.maxIterations="4"'
    )
    nodes, _ = derive_service_graph(
        "s m",
        "m l",
        "l d",
        "d m ok",
        "d g else",
        "g a",
        "a b",
        "b e",
        nodes=samples.NODES.replace('"good?" subkind="decision"', bounded),
    )
    assert nodes["good?"].max_iterations == 4


def test_several_assignments_of_an_action_become_a_chain_of_nodes():
    nodes, graph = derive_service_graph(
        "s g",
        "g x",
        "x l",
        "l a",
        "a e",
        nodes=samples.NODES
        + '    Action x "count" subkind="opaque" body="n := n + 1; ok := true"\n',
    )
    assert nodes["count"].variable == "n"
    assert nodes["count"].expression == Binary("+", make_variable("n"), Literal(1))
    assert nodes["count#2"].variable == "ok"
    ends = {(shorten_id(edge.source), shorten_id(edge.target)) for edge in graph.edges}
    assert {("grip", "count"), ("count", "count#2"), ("count#2", "look")} <= ends


def test_an_object_flow_orders_nodes_without_a_control_flow():
    flow = "    ObjectFlow o1\n      -> flow-source l.ok\n      -> flow-target a.in\n"
    nodes = samples.NODES.replace(
        '"place" subkind="call-behavior"\n      -> calls place\n',
        '"place" subkind="call-behavior"\n      -> calls place\n'
        '      Pin a.in "ok" direction="in"\n        -> typed-by Boolean\n',
        1,
    )
    nodes_by_id, graph = derive_service_graph("s g", "g l", "a e", nodes=nodes + flow)
    assert nodes_by_id["place"].bind == (("ok", make_variable("ok")),)
    items = {(shorten_id(e.source), shorten_id(e.target), e.item) for e in graph.edges}
    assert ("look", "place", "Plant::Boolean") in items


def test_an_activity_without_initial_and_final_node_gets_both():
    """By UML, an action without incoming flows starts, and the last action ends the activity."""
    nodes = samples.NODES.replace('    Control s "start" subkind="initial"\n', "")
    nodes = nodes.replace('    Control e "end" subkind="final"\n', "")
    steps = ("g l", "l d", "d a ok", "d b else", "a m", "b m")
    _, graph = derive_service_graph(*steps, nodes=nodes)
    ends = {(shorten_id(edge.source), shorten_id(edge.target)) for edge in graph.edges}
    assert {("initial", "grip"), ("after", "final")} <= ends


def test_an_unnamed_attribute_or_pin_is_named_by_its_kind():
    text = samples.task().replace('Property mount.n "n"', "Property mount.n")
    text = text.replace('Pin l.ok "ok"', "Pin l.ok")
    graph = derive_model(text).service_graphs[0]
    assert [variable.name for variable in graph.variables] == ["ok", "pin", "property"]
    look = next(node for node in graph.nodes if node.id == "Plant::Mount::look")
    assert look.assign == (("pin", "pin"),)


# -- the reading of contracts --------------------------------------------------------------------


def list_shown_pairs(graph):
    return {(shorten_id(edge.source), shorten_id(edge.target)) for edge in graph.edges}


def test_a_structured_node_that_only_groups_steps_is_no_step():
    """No flow leads to the node itself, so that its nodes belong to the activity around it."""
    place = '    Action a "place" subkind="call-behavior"\n      -> calls place\n'
    for subkind in ("interruptible", "structured"):
        group = f'    Structured x "group" subkind="{subkind}"\n' + place.replace("    ", "      ")
        nodes, graph = derive_service_graph(nodes=samples.NODES.replace(place, group))
        assert "group" not in nodes
        assert nodes["place"].kind == "service"
        assert {("good?", "place"), ("place", "after")} <= list_shown_pairs(graph)


def test_else_is_written_in_any_letter_case():
    _, graph = derive_service_graph("s g", "g l", "l d", "d a ok", "d b Else", "a m", "b m", "m e")
    assert [(edge.text, edge.guard) for edge in graph.edges if edge.is_else] == [("Else", None)]


COMBINED_STEPS = ("s g", "g d", "d l", "d a", "l m", "a m", "m b", "m x", "b y", "x y", "y e")
"""Two branches that meet at node m, from which two branches lead to node y."""


@pytest.mark.parametrize(
    ("first", "drawn", "last", "kinds"),
    [
        ("fork", "fork", "join", ("join", "fork")),
        ("fork", "join", "join", ("join", "fork")),
        ("decision", "merge", "merge", ("merge", "decision")),
    ],
)
def test_a_control_node_that_stands_for_two_becomes_two(first, drawn, last, kinds):
    nodes = samples.NODES.replace('subkind="merge"', f'subkind="{drawn}"')
    nodes = nodes.replace('subkind="decision"', f'subkind="{first}"')
    nodes += f"""\
    Action x "look again" subkind="call-behavior"
      -> calls look
    Control y "last" subkind="{last}"
"""
    text = samples.task(nodes=nodes, steps=COMBINED_STEPS)
    graph, sink = run_recipe(text)
    (model,) = graph.derived(Model)
    (service_graph,) = model.service_graphs
    kinds_by_id = {shorten_id(node.id): node.kind for node in service_graph.nodes}
    assert (kinds_by_id["after"], kinds_by_id[kinds[1]]) == kinds
    incoming = {("look", "after"), ("place", "after"), ("after", kinds[1])}
    outgoing = {(kinds[1], "drop"), (kinds[1], "look again")}
    assert incoming | outgoing <= list_shown_pairs(service_graph)
    assert "SM604" not in list_codes(sink)


def test_a_merge_with_several_outgoing_flows_can_leave_a_loop():
    """Contracts read it as a merge and a decision."""
    nodes, _ = derive_service_graph("s m", "m l ok", "l m", "m e else")
    assert (nodes["after"].kind, nodes["decision"].kind) == ("merge", "loop")


TWO_SERVICES = """\
    Action g "grip" subkind="call-behavior"
      -> calls grip
    Action l "look" subkind="call-behavior"
      -> calls look
    Control e "end" subkind="final"
"""
INITIAL = '    Control s "start" subkind="initial"\n'


def test_a_block_waits_for_all_flows_that_reach_it():
    """It is a step, and steps join their flows (UML 2.5.1, 15.2.3.4); it was a merge."""
    nodes = f"""\
{INITIAL}{TWO_SERVICES}    Control d "both" subkind="fork"
    Structured x "group" subkind="structured"
      Action a "place" subkind="call-behavior"
        -> calls place
"""
    steps = ("s d", "d l", "d g", "l x", "g x", "x e")
    graph, sink = run_recipe(samples.task(nodes=nodes, steps=steps))
    (service_graph,) = graph.derived(Model)[0].service_graphs
    kinds = {shorten_id(node.id): node.kind for node in service_graph.nodes}
    assert kinds["group"] == "join"
    assert {("look", "group"), ("grip", "group")} <= list_shown_pairs(service_graph)
    assert "SM604" not in list_codes(sink)


LOOKS = "".join(
    f"""\
    Action {id} "{id}" subkind="call-behavior"
      -> calls look
      Pin {id}.ok "ok" direction="out"
        -> typed-by Boolean
    ObjectFlow {id}.flow
      -> flow-source {id}.ok
      -> flow-target a.in
"""
    for id in ("near", "far")
)


@pytest.mark.parametrize(("bound", "kind"), [("", "merge"), ("2", "")])
def test_a_pin_takes_the_value_of_any_of_its_flows(bound, kind):
    """Unless its lower bound asks for the values of all flows (UML 2.5.1, 16.2.3)."""
    nodes = f"""\
{INITIAL}    Control d "which" subkind="decision"
    Action a "place" subkind="call-behavior"
      -> calls place
      Pin a.in "seen" direction="in" multiplicity="{bound or 1}"
        -> typed-by Boolean
    Control e "end" subkind="final"
{LOOKS}"""
    steps = ("s d", "d near ok", "d far else", "a e")
    graph, sink = run_recipe(samples.task(nodes=nodes, steps=steps))
    (service_graph,) = graph.derived(Model)[0].service_graphs
    kinds = {shorten_id(node.id): node.kind for node in service_graph.nodes}
    assert kinds.get("merge", "") == kind
    before_place = {pair[0] for pair in list_shown_pairs(service_graph) if pair[1] == "place"}
    assert before_place == ({"merge"} if kind else {"near", "far"})
    assert ("SM604" in list_codes(sink)) == (not kind)


def test_an_initial_node_gives_its_token_to_one_flow():
    """Its flows compete for one token, as in contracts: only a fork starts both branches."""
    steps = ("s g ok", "s l else", "g m", "l m", "m e")
    drawn = INITIAL + TWO_SERVICES + '    Control m "after" subkind="merge"\n'
    nodes, graph = derive_service_graph(*steps, nodes=drawn)
    assert (nodes["start"].kind, nodes["decision"].kind) == ("initial", "decision")
    assert {("start", "decision"), ("decision", "grip"), ("decision", "look")} <= list_shown_pairs(
        graph
    )
    assert [(edge.text, edge.is_else) for edge in graph.edges if edge.text] == [
        ("ok", False),
        ("else", True),
    ]


def test_actions_without_incoming_flows_start_together():
    """No initial node is drawn: each of them has a token of its own (UML 2.5.1, 15.2.3.4)."""
    nodes = TWO_SERVICES + '    Control m "both" subkind="join"\n'
    graph, sink = run_recipe(samples.task(nodes=nodes, steps=("l m", "g m", "m e")))
    (service_graph,) = graph.derived(Model)[0].service_graphs
    assert {("initial", "fork"), ("fork", "grip"), ("fork", "look")} <= list_shown_pairs(
        service_graph
    )
    assert "SM604" not in list_codes(sink)


@pytest.mark.parametrize("source", ["merge", "decision", "initial"])
def test_a_literal_false_closes_a_flow(source):
    """Tools write the literal 'true' for every flow, but 'false' is a guard of the modeller."""
    nodes = f'    Control m "m" subkind="{source}"\n{TWO_SERVICES}'
    steps = ["m g false", "m l else", "g e", "l e"]
    if source != "initial":
        nodes, steps = INITIAL + nodes, ["s m", *steps]
    text = samples.task(nodes=nodes, steps=tuple(steps))
    text = text.replace('guard="false"', 'guard="false" guard_literal=true')
    graph = derive_model(text).service_graphs[0]
    guards = [edge.guard for edge in graph.edges if shorten_id(edge.target) == "grip"]
    assert guards == [Literal(False)]


def test_an_activity_without_a_token_game_has_a_graph():
    """By its weight, a flow waits for two tokens: contracts reject it, and recipes show it."""
    text = samples.task().replace("    ControlFlow m-e-7\n", "    ControlFlow m-e-7 weight=2\n")
    assert "weight=2" in text
    graph = derive_model(text).service_graphs[0]
    assert ("after", "end") in list_shown_pairs(graph)
