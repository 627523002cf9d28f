"""The back end ``ecore``: pyecore reads its output, as EMF does."""

from ecore_reader import read_ecore_xmi
from hypothesis import given
from random_graphs import graphs

from sysmlc.backends.ecore import print_xmi
from sysmlc.ir import Graph, print_text


@given(graph=graphs(max_size=6))
def test_pyecore_loads_a_saved_graph_unchanged(graph, tmp_path_factory):
    saved = tmp_path_factory.mktemp("ecore") / "graph.xmi"
    saved.write_text(print_xmi(graph), encoding="utf-8")
    assert print_text(read_ecore_xmi(str(saved))) == print_text(graph)


def test_an_empty_graph_is_saved_too(tmp_path):
    saved = tmp_path / "graph.xmi"
    saved.write_text(print_xmi(Graph()), encoding="utf-8")
    assert len(read_ecore_xmi(str(saved))) == 0
