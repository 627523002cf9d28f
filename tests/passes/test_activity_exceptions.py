"""The pass ``activities``: exceptions, handlers and calls of activities that raise exceptions."""

from pass_runs import list_codes
from token_graphs import derive_token_graph, derive_token_graphs, name_inputs

from activity_sketch import sketch
from sysmlc.logic.activities.token_graph import TokenGraph

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
    text = CALLER.format(handlers="").replace('  Structured h "h" subkind="structured"\n', "")
    graphs, sink = derive_token_graphs(text)
    assert "raised_c" in name_inputs(graphs[0])
    subjects = {diagnostic.subject.id for diagnostic in sink if diagnostic.rule.code == "SM475"}
    assert subjects == {"c", "r"}


def test_a_call_of_an_activity_that_catches_its_exceptions_ends_normally():
    graphs, sink = derive_token_graphs(CALLER.format(handlers='handlers=[[["h"], [], []]]'))
    assert name_inputs(graphs[0]) == ["done_c"]
    assert "SM475" not in list_codes(sink)


def test_the_advice_on_a_node_after_a_raise_action_names_that_action():
    text = "initial i\nraise r\naction w\ni -> r\nr -> w"
    advice = [d.help for d in derive_token_graphs(sketch(text))[1] if d.rule.code == "SM452"]
    assert advice == ["action 'r' always raises an exception: lead the flow from another node"]
    _, sink = derive_token_graphs(sketch(text.replace("raise", "action")))
    assert "SM452" not in list_codes(sink)
