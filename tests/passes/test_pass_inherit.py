"""The pass ``inherit``: features of classifiers, redefinition, and cycles of generalizations."""

import sys

import pytest
from pass_runs import list_codes, list_diagnostics, run_until

from sysmlc.diagnostics import Sink
from sysmlc.diagnostics.renderers import make_report, merge_facts
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.passes import pipeline


def list_features(graph, id):
    return [feature.name for feature in graph.targets(graph[id], Edge.FEATURE)]


def test_a_cycle_of_classes_inherits_from_a_general_outside_the_cycle():
    graph, sink = run_until(
        """\
Class base "Base"
  Property base.id "id"
Class a "A"
  -> specializes b base
Class b "B"
  -> specializes a
  Property b.x "x"
""",
        "inherit",
    )
    assert (list_features(graph, "a"), list_features(graph, "b")) == (["id"], ["x"])
    assert list_diagnostics(sink) == ["SM200 error: 'A' specialises itself: 'A', 'B', 'A'"]


def test_a_classifier_that_specialises_itself_is_a_cycle():
    _, sink = run_until('Class a "A"\n  -> specializes a\n', "inherit")
    assert list_codes(sink) == ["SM200"]


def test_a_redefinition_hides_inherited_features_only():
    graph, sink = run_until(
        """\
Class a "A"
  Property a.x "x"
Class b "B"
  -> specializes c
  Property b.y "y"
    -> redefines a.x
Class c "C"
  -> specializes a
    Property c.z "z"
Class d "D"
  -> specializes a
  Property d.y "y"
    -> redefines b.y
""",
        "inherit",
    )
    assert list_features(graph, "b") == ["y", "z"]
    assert list_features(graph, "d") == ["y", "x"]
    (diagnostic,) = sink
    assert (diagnostic.rule.code, diagnostic.help) == (
        "SM202",
        "let 'D' specialise 'B', or remove the relation",
    )
    assert diagnostic.message == "'D::y' redefines 'B::y', but 'D' does not inherit from 'B'"


def test_two_classifiers_of_one_name_are_told_apart():
    text = 'Class {0} "Gate"\n  Property {0}.x "x"\n'
    _, sink = run_until(text.format("a") + text.format("b") + "    -> subsets a.x\n", "inherit")
    assert list_diagnostics(sink) == [
        "SM202 warning: 'Gate::x' subsets 'Gate::x', but 'Gate' does not inherit from the other "
        "'Gate'"
    ]


def test_a_redefining_feature_may_have_a_type_from_outside_the_unit():
    _, sink = run_until(
        """\
Class out "Out" external=true href="lib.uml#out"
Class in "In"
Class a "A"
  Property a.x "x"
    -> typed-by in
Class b "B"
  -> specializes a
  Property b.x "x"
    -> typed-by out
    -> redefines a.x
""",
        "inherit",
    )
    assert list_codes(sink) == []


TWO_REDEFINITIONS = """\
Class wide "Wide"
Class narrow "Narrow"
Class a "A"
  Property a.x "x"
    -> typed-by wide
  Property a.y "y"
    -> typed-by wide
Class b "B"
  -> specializes a
  Property b.x "x"
    -> typed-by narrow
    -> redefines a.x
  Property b.y "y"
    -> typed-by narrow
    -> redefines a.y
"""


@pytest.mark.parametrize(
    ("generalization", "code"), [("  -> specializes a\n", "SM203"), ("", "SM202")]
)
def test_a_missing_generalization_is_one_fact_of_the_features_that_need_it(generalization, code):
    text = TWO_REDEFINITIONS.replace("  -> specializes a\n", generalization)
    _, sink = run_until(text, "inherit")
    assert list_codes(sink) == [code, code]
    (finding,) = merge_facts(make_report(sink, ()).findings)
    assert finding.diagnostic.notes == ("also B::y",)


def test_two_missing_generalizations_are_two_facts():
    _, sink = run_until(TWO_REDEFINITIONS.replace("typed-by wide", "typed-by a", 1), "inherit")
    assert len(merge_facts(make_report(sink, ()).findings)) == 2


def test_ends_of_an_association_are_not_its_features():
    graph, _ = run_until(
        """\
Association a "A"
  -> end e
  Property e "e"
  Property p "p"
""",
        "inherit",
    )
    assert list_features(graph, "a") == ["p"]


def build_chain(number):
    """Return classes that each specialise the previous class; the first has a feature."""
    graph = Graph()
    for index in range(number):
        graph.add(Element(f"c{index}", Kind.CLASS, f"C{index}"))
        if index:
            graph.connect(Edge.SPECIALIZES, f"c{index}", f"c{index - 1}")
    graph.add(Element("x", Kind.PROPERTY, "x", "c0"))
    return graph


def count_calls(run):
    """Return the number of function calls during the run."""
    calls = 0

    def count(frame, event, arg):
        nonlocal calls
        calls += event in ("call", "c_call")

    sys.setprofile(count)
    try:
        run()
    finally:
        sys.setprofile(None)
    return calls


def test_the_effort_of_inheritance_is_linear_in_the_length_of_a_chain():
    inherit = pipeline.load("inherit")
    short, long = build_chain(250), build_chain(1000)
    calls = [count_calls(lambda g=graph: inherit.run(g, Sink())) for graph in (short, long)]
    assert list_features(long, "c999") == ["x"]
    assert calls[1] < 5 * calls[0]
