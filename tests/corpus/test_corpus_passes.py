"""The structural passes leave every real model valid, and change nothing in a second run."""

import pytest
from reading_corpus import list_models, load_files, lower

from sysmlc.diagnostics import Sink
from sysmlc.ir.text import print_text
from sysmlc.passes import pipeline

pytestmark = pytest.mark.corpus

STRUCTURAL = ("resolve", "inherit", "classify", "ports", "flows", "behaviours")

SLOW = {"Alf.library.uml"}


def list_quick_models():
    return [path for path in list_models("xmi") if path.name not in SLOW]


@pytest.mark.parametrize("path", list_quick_models(), ids=lambda path: path.name)
def test_a_second_run_of_the_structural_passes_changes_nothing(path):
    graph, sink = lower(load_files(path), STRUCTURAL, verify_each=True)
    once = print_text(graph)
    pipeline.build_pipeline(STRUCTURAL).run(graph, Sink(), verify_each=True)
    assert print_text(graph) == once
    assert not graph.pending
    assert [
        diagnostic.message for diagnostic in sink if diagnostic.rule.code in ("SM150", "SM151")
    ] == []


def test_the_corpus_has_models(corpus):
    assert len(list_quick_models()) > 35
