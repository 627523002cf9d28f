"""What holds for every model: valid graphs stay valid, twice equals once, order does not matter."""

from hypothesis import given, settings
from hypothesis import strategies as st
from passing import STRUCTURAL, again, codes, refine
from structures import structures

from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text, print_text
from sysmlc.ir.verify import verify
from sysmlc.passes import pipeline


@settings(max_examples=150, deadline=None)
@given(structures())
def test_each_pass_leaves_a_valid_graph_and_twice_equals_once(graph):
    assert verify(graph) == []
    for name in STRUCTURAL:
        pipeline.load(name).run(graph, Sink())
        assert verify(graph) == []
        once = print_text(graph)
        assert again(graph, name) == once


@settings(max_examples=100, deadline=None)
@given(structures(), st.randoms(use_true_random=False))
def test_resolving_does_not_depend_on_the_order_of_references(graph, random):
    text = print_text(graph)
    shuffled = parse_text(text)
    random.shuffle(shuffled.pending)
    results = []
    for one in (parse_text(text), shuffled):
        sink = Sink()
        refine(one, sink, "resolve")
        results.append((_shape(one), sorted(codes(sink))))
    assert results[0] == results[1]


def _shape(graph: Graph) -> tuple[list[str], list[tuple[str, str, str]]]:
    elements = [f"{one!r} {one.id} {sorted(one.attrs.items())}" for one in graph]
    return sorted(elements), sorted((str(edge), a, b) for edge, a, b in graph.edges())
