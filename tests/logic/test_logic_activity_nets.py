"""The check for a second token: reductions keep its answer, and playing never contradicts it."""

import random

from activity_models import Canvas, activity, blocks
from hypothesis import given, note, settings
from hypothesis import strategies as st

from long_runs import examples
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Kind
from sysmlc.ir.text import parse_text, print_text
from sysmlc.logic import evaluate
from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities import net_safety as token_net
from sysmlc.logic.activities.derivation import derive_contract
from sysmlc.logic.activities.petri_net import reduce_net
from sysmlc.logic.activities.token_graph import ACTIVITY_REGION, TokenGraph
from sysmlc.passes.activities import Activities
from sysmlc.passes.activities import construction as activity_tokens
from sysmlc.passes.activities import drawing as activity_drawing
from sysmlc.passes.activities.exception_analysis import find_raising
from sysmlc.passes.activities.inputs import Inputs, Scope

KINDS = ("opaque", "fork", "join", "merge", "decision", "flow-final", "final", "value")


def drawn(canvas: Canvas) -> TokenGraph:
    """The token graph as drawn, safe or not."""
    graph, sink = canvas.graph, Sink()
    drawing = activity_drawing.read_drawing(graph, graph["a"], sink)
    inputs = Inputs(graph, Scope(graph, graph["a"], sink), sink)
    return activity_tokens.build(graph, drawing, inputs, find_raising(graph), sink)


@st.composite
def scribbles(draw) -> TokenGraph:
    """Any nodes with any flows between them."""
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
    return drawn(canvas)


@st.composite
def lines(draw) -> TokenGraph:
    """Steps, decisions and merges behind one start, each entered and left as often as it may be."""
    canvas = Canvas()
    start, first = canvas.control("initial"), canvas.control("merge")
    canvas.flow(start, first)
    ways = [first]
    merges = [first]
    for number in range(draw(st.integers(0, 8))):
        source = ways.pop(draw(st.integers(0, len(ways) - 1))) if ways else None
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
        ways += [node] * {"final": 0, "decision": 2}.get(kind, 1)
    return drawn(canvas)


@settings(max_examples=examples(300), deadline=None)
@given(scribbles())
def test_reductions_keep_the_answer(tokens):
    """Only an end that forestalls the next firing may make the reduced net more careful."""
    whole = token_net.search_markings(token_net.build_net(tokens, ACTIVITY_REGION), 100_000)
    net = token_net.build_net(tokens, ACTIVITY_REGION)
    reduce_net(net)
    quick = token_net.search_markings(net, 100_000)
    ends = {edge.source for edge in tokens.ends(ACTIVITY_REGION)}
    if whole.unsafe or not ends:
        assert bool(whole.unsafe) == bool(quick.unsafe)
    if not whole.unsafe and not quick.unsafe:
        assert whole.finishes == quick.finishes
        assert quick.dead == whole.dead if not ends else quick.dead <= whole.dead


@settings(max_examples=examples(300), deadline=None)
@given(scribbles(), st.integers(0, 2**16))
def test_no_run_of_a_safe_activity_brings_a_second_token(tokens, seed):
    if token_net.check_safety(tokens, ACTIVITY_REGION, 100_000).unsafe:
        return
    dice = random.Random(seed)
    state = token_game.initial_state(tokens)
    for _ in range(60):
        inputs = {v.name: dice.random() < 0.5 for v in tokens.inputs}
        state = token_game.next_state(
            tokens, state, inputs, evaluate.is_true, lambda _, open_: dice.choice(open_)
        )


@settings(max_examples=examples(300), deadline=None)
@given(scribbles())
def test_a_single_token_is_followed_as_all_markings_are_searched(tokens):
    found = token_net.check_single_token(tokens, ACTIVITY_REGION)
    whole = token_net.search_markings(token_net.build_net(tokens, ACTIVITY_REGION), 100_000)
    assert found in (None, whole)


@settings(max_examples=examples(100), deadline=None)
@given(lines())
def test_where_nothing_forks_or_joins_no_marking_is_built(tokens):
    whole = token_net.search_markings(token_net.build_net(tokens, ACTIVITY_REGION), 100_000)
    assert token_net.check_single_token(tokens, ACTIVITY_REGION) == whole


def test_two_tokens_that_meet_at_a_merge_before_a_sink_are_found():
    canvas = Canvas()
    start, merge, sink = (canvas.control(kind) for kind in ("initial", "merge", "flow-final"))
    work = canvas.node(Kind.ACTION, "opaque", "work")
    for source, target in ((start, work), (work, merge), (work, merge), (merge, sink)):
        canvas.flow(source, target)
    assert token_net.check_safety(drawn(canvas), ACTIVITY_REGION, 1000).unsafe


@settings(max_examples=examples(100), deadline=None)
@given(blocks(12))
def test_series_and_parallel_parts_leave_next_to_nothing_to_search(block):
    canvas = Canvas()
    canvas.graph = activity(block)
    tokens = drawn(canvas)
    net = token_net.build_net(tokens, ACTIVITY_REGION)
    reduce_net(net)
    assert len(net.places) <= 3
    assert not token_net.search_markings(net, 10).unsafe


def test_many_parallel_branches_are_checked_without_building_their_markings():
    canvas = Canvas()
    start, fork, join = (canvas.control(kind) for kind in ("initial", "fork", "join"))
    canvas.flow(start, fork)
    for _ in range(200):
        first, last = canvas.draw(("seq", ("act",), ("seq", ("loop", ("act",)), ("act",))))
        canvas.flow(fork, first)
        canvas.flow(last, join)
    canvas.flow(join, canvas.control("final"))
    safety = token_net.check_safety(drawn(canvas), ACTIVITY_REGION, 10)
    assert safety.is_complete
    assert not safety.unsafe


STATEMENTS = ("ok", "else", "true", "not ok", "level >", "")


@st.composite
def doodles(draw) -> Canvas:
    """Anything that a tool lets one draw: regions in regions, guards, pins, loose handlers."""
    canvas = Canvas()
    nodes = [canvas.control("initial")]
    for kind in draw(st.lists(st.sampled_from([*KINDS, *BOXES, *WORKS]), max_size=7)):
        outer = canvas.owner
        boxes = [outer, *(n for n in nodes if n.kind is Kind.STRUCTURED)]
        canvas.owner = draw(st.sampled_from(boxes))
        nodes.append(canvas.node(*BOXES.get(kind, (_kind(kind), kind)), name=f"w{len(nodes)}"))
        canvas.owner = outer
    ends = st.tuples(st.sampled_from(nodes), st.sampled_from(nodes), st.sampled_from(STATEMENTS))
    for source, target, guard in draw(st.lists(ends, max_size=10)):
        flow = canvas.flow(source, target, guard)
        if draw(st.integers(0, 5)) == 0:
            regions = [n.id for n in nodes if n.subkind == "interruptible"]
            flow.attrs["interrupts"] = draw(st.sampled_from(["", "nobody", *regions]))
    for node in nodes:
        inside = tuple(n.id for n in canvas.graph.owned(node) if n.id.startswith("n"))
        if node.subkind == "loop":
            node.attrs.update(test=inside[:1], body_part=inside[1:])
        if node.subkind == "conditional":
            node.attrs["clauses"] = ((inside[:1], inside[1:]),)
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


def _kind(kind: str) -> Kind:
    return Kind.ACTION if kind in WORKS else Kind.CONTROL


@settings(max_examples=examples(250), deadline=None)
@given(doodles(), st.integers(0, 2**16))
def test_whatever_is_drawn_is_played_as_its_contract_says_or_has_a_rule(canvas, seed):
    sink = Sink()
    Activities(max_markings=3000).run(canvas.graph, sink)
    made = canvas.graph.derived(TokenGraph)
    assert made or len(sink)
    note(print_text(canvas.graph))
    for tokens in made:
        play_as_its_contract_says(tokens, seed)


def play_as_its_contract_says(tokens, seed):
    dice = random.Random(seed)
    state, trace = token_game.initial_state(tokens), []
    for _ in range(40):
        inputs = {v.name: dice.random() < 0.5 for v in tokens.inputs}
        trace.append({**inputs, **token_game.values_of(tokens, state)})
        state = token_game.next_state(
            tokens, state, inputs, evaluate.is_true, lambda _, o, dice=dice: dice.choice(o)
        )
    for conjunct in derive_contract(tokens).guarantees:
        assert evaluate.find_violation(conjunct, trace) is None, conjunct.text


def test_body_of_a_handler_may_stand_outside_what_its_node_is_in():
    """UML wants both to have one owner; tools do not see to it."""
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
    Activities().run(graph, Sink())
    (tokens,) = graph.derived(TokenGraph)
    outcome = next(edge for edge in tokens.edges if edge.source == "body")
    assert outcome.region == ACTIVITY_REGION
    for seed in range(20):
        play_as_its_contract_says(tokens, seed)
