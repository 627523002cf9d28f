"""Passes on random graphs: they leave valid graphs, are idempotent and ignore the order."""

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
def test_each_pass_is_idempotent_and_leaves_a_valid_graph(graph):
    assert verify(graph) == []
    for name in STRUCTURAL:
        pipeline.load(name).run(graph, Sink())
        assert verify(graph) == []
        once = print_text(graph)
        assert print_after_second_run(graph, name) == once


@settings(max_examples=examples(200), deadline=None)
@given(hierarchies())
def test_features_are_those_of_the_definition_in_uml(graph):
    classes = graph.of_kind(Kind.CLASS)
    expected = {class_.id: set(list_defined_features(graph, class_.id)) for class_ in classes}
    run_structural_passes(graph, Sink(), "inherit")
    for id, ids in expected.items():
        features = [feature.id for feature in graph.targets(graph[id], Edge.FEATURE)]
        assert len(features) == len(set(features))
        assert set(features) == ids


def list_defined_features(graph: Graph, id: str) -> list[str]:
    """Return the features by UML 2.5.1, 9.9.4, in a hierarchy without cycles.

    The features of a class are the features that it owns and those of its generals, without the
    features that any of these redefines.
    """
    members = [feature.id for feature in graph.owned(graph[id])]
    for general in graph.targets(graph[id], Edge.SPECIALIZES):
        members += list_defined_features(graph, general.id)
    redefined = {
        feature.id for id in members for feature in graph.targets(graph[id], Edge.REDEFINES)
    }
    return [id for id in members if id not in redefined]


@settings(max_examples=examples(100), deadline=None)
@given(structures(), st.randoms(use_true_random=False))
def test_resolution_does_not_depend_on_the_order_of_references(graph, random):
    text = print_text(graph)
    shuffled = parse_text(text)
    pending = list(shuffled.pending)
    random.shuffle(pending)
    shuffled.pending.clear()
    for reference in pending:
        shuffled.pending.append(reference)
    results = []
    for resolved in (parse_text(text), shuffled):
        sink = Sink()
        run_structural_passes(resolved, sink, "resolve")
        results.append((sort_content(resolved), sorted(list_codes(sink))))
    assert results[0] == results[1]


def sort_content(graph: Graph) -> tuple[list[str], list[tuple[str, str, str]]]:
    """Return the elements and the edges of a graph, sorted by their text."""
    elements = [f"{element!r} {element.id} {sorted(element.attrs.items())}" for element in graph]
    return sorted(elements), sorted((str(edge), a, b) for edge, a, b in graph.edges())
