"""Real models do not differ from their re-exported copies; the forms of BayGate are one model."""

from random import Random

import pytest

from dialects.graph_mutations import copy_with_new_ids
from sysmlc.driver import Request, compile_model
from sysmlc.ir.compare import compare
from sysmlc.passes import pipeline

pytestmark = pytest.mark.corpus

FOLDERS = ("aml/dev", "xmi/papyrus", "xmi/magicdraw", "xmi/ea", "xmi/md-eclipse-export")
LARGE = 1_500_000
"""Size in bytes from which a file is skipped, because it takes too long."""


def read_graph(path):
    passes = (pipeline.load("resolve"),)
    return compile_model(Request(inputs=(path,), passes=passes)).graph


@pytest.mark.parametrize("folder", FOLDERS)
def test_new_ids_and_another_order_are_no_difference(folder, corpus):
    paths = [p for p in (corpus / folder).iterdir() if p.is_file() and p.stat().st_size < LARGE]
    compared = 0
    for path in sorted(paths):
        graph = read_graph(path)
        compared += len(graph) > 1
        assert compare(graph, copy_with_new_ids(graph, Random(1))) == [], path.name
    assert compared > 0


@pytest.mark.parametrize("name", ["BayGate_extlibs.aml", "BayGate.amlx"])
def test_baygate_is_one_model_in_one_file_in_three_and_in_a_package(name, corpus):
    folder = corpus / "aml" / "baygate"
    assert compare(read_graph(folder / "BayGate.aml"), read_graph(folder / name)) == []


def test_baygate_in_caex_2_15_differs_in_value_types_only(corpus):
    folder = corpus / "aml" / "baygate"
    changes = compare(
        read_graph(folder / "BayGate.aml"), read_graph(folder / "BayGate_caex215.aml")
    )
    assert [(c.owner, str(c.what), c.name, c.before, c.after) for c in changes] == [
        ("", "removed", "Quantities", "", ""),
        ("BayGate Breakdown::Conveyor", "retyped", "length", "Length", "length[m]"),
        ("BayGate Breakdown::Conveyor", "retyped", "velocity", "Velocity", "speed[m/s]"),
    ]
