"""The check that no flow gets a second token: reductions preserve its result, and runs agree."""

import random

from hypothesis import given, note, settings
from hypothesis import strategies as st
from random_block_activities import Canvas, blocks, build_tokens, draw_activity, play, play_trace

from long_runs import examples
from sysmlc.analyses.activities import Activities, construction
from sysmlc.analyses.activities.drawing import read_drawing
from sysmlc.analyses.activities.exception_analysis import find_raising
from sysmlc.analyses.activities.inputs import Inputs, Scope
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Kind
from sysmlc.ir.text import parse_text, print_text
from sysmlc.logic import evaluate
from sysmlc.logic.activities import petri_net
from sysmlc.logic.activities.derivation import derive_contract
from sysmlc.logic.activities.petri_net import reduce_net
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import ACTIVITY_REGION

KINDS = ("opaque", "fork", "join", "merge", "decision", "flow-final", "final", "value")


def build_unchecked(canvas: Canvas) -> TokenGraph:
    """Return the token graph, safe or not."""
    graph, sink = canvas.graph, Sink()
    drawing = read_drawing(graph, graph["a"], sink)
    inputs = Inputs(graph, Scope(graph, graph["a"], Activities().assumed_range, sink), sink)
    return construction.build(graph, drawing, inputs, find_raising(graph), sink)


@st.composite
def random_graphs(draw) -> TokenGraph:
    """Draw a token graph of any nodes with any flows between them."""
    canvas = Canvas()
    nodes = [canvas.control("initial")]
    for kind in draw(st.lists(st.sampled_from(KINDS), min_size=2, max_size=6)):
        is_action = kind in ("opaque", "value")
        nodes.append(
            canvas.node(Kind.ACTION, kind, f"w{len(nodes)}") if is_action else canvas.control(kind)
        )
    sources = [n for n in nodes if n.subkind not in ("final", "flow-final")]
    ends = st.tuples(st.sampled_from(sources), st.sampled_from(nodes[1:]))
    canvas.flow(nodes[0], nodes[1])
    for source, target in draw(st.lists(ends, min_size=2, max_size=9)):
        canvas.flow(source, target)
    return build_unchecked(canvas)


@st.composite
def single_token_graphs(draw) -> TokenGraph:
    """Draw actions, decisions and merges behind one start, without forks and joins."""
    canvas = Canvas()
    start, first = canvas.control("initial"), canvas.control("merge")
    canvas.flow(start, first)
    open_ends = [first]
    merges = [first]
    for number in range(draw(st.integers(0, 8))):
        source = open_ends.pop(draw(st.integers(0, len(open_ends) - 1))) if open_ends else None
        if source is None:
            break
        kind = draw(st.sampled_from(("opaque", "decision", "merge", "value", "final", "back")))
        if kind == "back":
            canvas.flow(source, draw(st.sampled_from(merges)))
            continue
        is_action = kind in ("opaque", "value")
        node = canvas.node(Kind.ACTION, kind, f"w{number}") if is_action else canvas.control(kind)
        canvas.flow(source, node)
        merges += [node] if kind == "merge" else []
        open_ends += [node] * {"final": 0, "decision": 2}.get(kind, 1)
    return build_unchecked(canvas)


def search_markings(tokens):
    """Return the result of the search through all markings of the whole net."""
    return petri_net.search_markings(petri_net.build_net(tokens, ACTIVITY_REGION), 100_000)


@settings(max_examples=examples(300), deadline=None)
@given(random_graphs())
def test_reductions_preserve_the_result_of_the_search(tokens):
    """Only an end that prevents the next firing may make the reduced net more careful."""
    whole = search_markings(tokens)
    net = petri_net.build_net(tokens, ACTIVITY_REGION)
    reduce_net(net)
    reduced = petri_net.search_markings(net, 100_000)
    ends = {edge.source for edge in tokens.ends(ACTIVITY_REGION)}
    if whole.unsafe or not ends:
        assert bool(whole.unsafe) == bool(reduced.unsafe)
    if not whole.unsafe and not reduced.unsafe:
        assert whole.finishes == reduced.finishes
        assert reduced.dead == whole.dead if not ends else reduced.dead <= whole.dead


@settings(max_examples=examples(300), deadline=None)
@given(random_graphs(), st.integers(0, 2**16))
def test_no_run_of_a_safe_activity_has_a_second_token_on_a_flow(tokens, seed):
    """The interpreter raises an exception at a second token."""
    if not petri_net.check_safety(tokens, ACTIVITY_REGION, 100_000).unsafe:
        assert len(list(play(tokens, random.Random(seed), 61))) == 61


@settings(max_examples=examples(300), deadline=None)
@given(random_graphs())
def test_following_a_single_token_gives_the_result_of_the_search_or_none(tokens):
    result = petri_net.check_single_token(tokens, ACTIVITY_REGION)
    assert result in (None, search_markings(tokens))


@settings(max_examples=examples(100), deadline=None)
@given(single_token_graphs())
def test_without_forks_and_joins_no_marking_is_built(tokens):
    assert petri_net.check_single_token(tokens, ACTIVITY_REGION) == search_markings(tokens)


def test_two_tokens_that_meet_at_a_merge_before_a_sink_are_found():
    canvas = Canvas()
    start, merge, sink = (canvas.control(kind) for kind in ("initial", "merge", "flow-final"))
    work = canvas.node(Kind.ACTION, "opaque", "work")
    for source, target in ((start, work), (work, merge), (work, merge), (merge, sink)):
        canvas.flow(source, target)
    assert petri_net.check_safety(build_unchecked(canvas), ACTIVITY_REGION, 1000).unsafe


@settings(max_examples=examples(100), deadline=None)
@given(blocks(12))
def test_series_and_parallel_reductions_reduce_blocks_to_three_places(block):
    canvas = Canvas()
    canvas.graph = draw_activity(block)
    tokens = build_unchecked(canvas)
    net = petri_net.build_net(tokens, ACTIVITY_REGION)
    reduce_net(net)
    assert len(net.places) <= 3
    assert not petri_net.search_markings(net, 10).unsafe


def test_many_parallel_branches_are_checked_without_building_their_markings():
    canvas = Canvas()
    start, fork, join = (canvas.control(kind) for kind in ("initial", "fork", "join"))
    canvas.flow(start, fork)
    for _ in range(200):
        first, last = canvas.draw(("seq", ("act",), ("seq", ("loop", ("act",)), ("act",))))
        canvas.flow(fork, first)
        canvas.flow(last, join)
    canvas.flow(join, canvas.control("final"))
    safety = petri_net.check_safety(build_unchecked(canvas), ACTIVITY_REGION, 10)
    assert safety.is_complete
    assert not safety.unsafe


GUARDS = ("ok", "else", "true", "not ok", "level >", "")


@st.composite
def random_drawings(draw) -> Canvas:
    """Draw what modelling tools allow: nested regions, any guards, handlers without owners."""
    canvas = Canvas()
    nodes = [canvas.control("initial")]
    for kind in draw(st.lists(st.sampled_from([*KINDS, *BOXES, *WORKS]), max_size=7)):
        outer_owner = canvas.owner
        boxes = [outer_owner, *(n for n in nodes if n.kind is Kind.STRUCTURED)]
        canvas.owner = draw(st.sampled_from(boxes))
        nodes.append(canvas.node(*BOXES.get(kind, (kind_of(kind), kind)), name=f"w{len(nodes)}"))
        canvas.owner = outer_owner
    ends = st.tuples(st.sampled_from(nodes), st.sampled_from(nodes), st.sampled_from(GUARDS))
    for source, target, guard in draw(st.lists(ends, max_size=10)):
        flow = canvas.flow(source, target, guard)
        if draw(st.integers(0, 5)) == 0:
            regions = [n.id for n in nodes if n.subkind == "interruptible"]
            flow.attrs["interrupts"] = draw(st.sampled_from(["", "nobody", *regions]))
    for node in nodes:
        ids_inside = tuple(
            child.id for child in canvas.graph.owned(node) if child.id.startswith("n")
        )
        if node.subkind == "loop":
            node.attrs.update(test=ids_inside[:1], body_part=ids_inside[1:])
        if node.subkind == "conditional":
            node.attrs["clauses"] = ((ids_inside[:1], ids_inside[1:]),)
        if node.kind in (Kind.STRUCTURED, Kind.ACTION) and draw(st.integers(0, 5)) == 0:
            body = draw(st.sampled_from([n.id for n in nodes] + ["nobody"]))
            node.attrs["handlers"] = (((body,), (), ()),)
        if node.subkind == "expansion" and draw(st.booleans()):
            node.attrs["mode"] = "iterative"
        for region in nodes:
            if region.subkind == "interruptible" and draw(st.booleans()):
                canvas.graph.connect(Edge.IN_PARTITION, node, region)
    return canvas


BOXES = {
    name: (Kind.STRUCTURED, name)
    for name in ("structured", "sequence", "loop", "conditional", "expansion", "interruptible")
} | {"store": (Kind.DATA_STORE, ""), "buffer": (Kind.OBJECT_NODE, "")}
WORKS = ("opaque", "value", "accept", "raise")


def kind_of(kind: str) -> Kind:
    return Kind.ACTION if kind in WORKS else Kind.CONTROL


@settings(max_examples=examples(250), deadline=None)
@given(random_drawings(), st.integers(0, 2**16))
def test_any_drawing_runs_as_its_contract_states_or_has_a_diagnostic(canvas, seed):
    sink = Sink()
    Activities(max_markings=3000).run(canvas.graph, sink)
    graphs = canvas.graph.derived(TokenGraph)
    assert graphs or len(sink)
    note(print_text(canvas.graph))
    for tokens in graphs:
        check_run(tokens, seed)


def check_run(tokens, seed):
    """Assert that a random run satisfies all guarantees."""
    trace = play_trace(tokens, seed, 40)
    for conjunct in derive_contract(tokens).guarantees:
        assert evaluate.find_violation(conjunct, trace) is None, conjunct.text


def test_the_body_of_a_handler_may_have_another_owner_than_the_protected_node():
    """UML requires one owner for both, but modelling tools do not enforce it."""
    graph = parse_text("""\
Activity a "a"
  Control start subkind="initial"
  Structured loop "Loop" body_part=[] subkind="loop" test=["work"]
    Action work "Work" handlers=[[["body"], [], []]] subkind="opaque"
  Control body "Body" subkind="merge"
  ControlFlow f1
    -> flow-source start
    -> flow-target body
  ControlFlow f2 guard="ok"
    -> flow-source work
    -> flow-target work
""")
    tokens = build_tokens(graph)
    outcome = next(edge for edge in tokens.edges if edge.source == "body")
    assert outcome.region == ACTIVITY_REGION
    for seed in range(20):
        check_run(tokens, seed)
