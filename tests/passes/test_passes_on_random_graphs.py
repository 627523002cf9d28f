"""What holds for every model: valid graphs stay valid, twice equals once, order does not matter."""

from hypothesis import given, settings
from hypothesis import strategies as st
from pass_runs import STRUCTURAL, list_codes, print_after_second_run, run_structural_passes
from random_structures import hierarchies, structures

from long_runs import examples
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.ir.text import parse_text, print_text
from sysmlc.ir.verify import verify
from sysmlc.passes import pipeline


@settings(max_examples=examples(150), deadline=None)
@given(structures())
def test_each_pass_leaves_a_valid_graph_and_twice_equals_once(graph):
    assert verify(graph) == []
    for name in STRUCTURAL:
        pipeline.load(name).run(graph, Sink())
        assert verify(graph) == []
        once = print_text(graph)
        assert print_after_second_run(graph, name) == once


@settings(max_examples=examples(200), deadline=None)
@given(hierarchies())
def test_features_are_what_the_definition_says(graph):
    expected = {one.id: set(defined_features(graph, one.id)) for one in graph.of_kind(Kind.CLASS)}
    run_structural_passes(graph, Sink(), "inherit")
    for id, names in expected.items():
        found = [one.id for one in graph.targets(graph[id], Edge.FEATURE)]
        assert len(found) == len(set(found))
        assert set(found) == names


def defined_features(graph: Graph, id: str) -> list[str]:
    """UML 2.5.1 clause 9.9.4 in so many words: own ones, and those of the generals, without what
    one of them redefines. There are no circles."""
    members = [one.id for one in graph.owned(graph[id])]
    for general in graph.targets(graph[id], Edge.SPECIALIZES):
        members += defined_features(graph, general.id)
    hidden = {old.id for one in members for old in graph.targets(graph[one], Edge.REDEFINES)}
    return [one for one in members if one not in hidden]


@settings(max_examples=examples(100), deadline=None)
@given(structures(), st.randoms(use_true_random=False))
def test_resolving_does_not_depend_on_the_order_of_references(graph, random):
    text = print_text(graph)
    shuffled = parse_text(text)
    pending = list(shuffled.pending)
    random.shuffle(pending)
    shuffled.pending.clear()
    for reference in pending:
        shuffled.pending.append(reference)
    results = []
    for one in (parse_text(text), shuffled):
        sink = Sink()
        run_structural_passes(one, sink, "resolve")
        results.append((_shape(one), sorted(list_codes(sink))))
    assert results[0] == results[1]


def _shape(graph: Graph) -> tuple[list[str], list[tuple[str, str, str]]]:
    elements = [f"{one!r} {one.id} {sorted(one.attrs.items())}" for one in graph]
    return sorted(elements), sorted((str(edge), a, b) for edge, a, b in graph.edges())
