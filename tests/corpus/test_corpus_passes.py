"""Every real model goes through the structural passes: valid graphs, twice equals once."""

import os
from pathlib import Path

import pytest

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph
from sysmlc.ir.text import print_text
from sysmlc.passes import pipeline
from sysmlc.sources.files import load

pytestmark = pytest.mark.corpus

STRUCTURAL = ("resolve", "inherit", "classify", "ports", "flows", "behaviours")
SUFFIXES = {".uml", ".xmi", ".xml", ".mdxml", ".mdzip"}
LARGE = {"Alf.library.uml"}


def models() -> list[Path]:
    folder = Path(os.environ.get("SYSMLC_CORPUS", "nowhere")) / "xmi"
    found = sorted(path for path in folder.rglob("*") if path.suffix in SUFFIXES)
    return [path for path in found if path.name not in LARGE]


@pytest.mark.parametrize("path", models(), ids=lambda path: path.name)
def test_model_passes_and_passing_again_changes_nothing(path):
    graph, sink = Graph(), Sink()
    FRONTEND.read(load(path, path.name), graph, sink, Coverage())
    pipeline.build_pipeline(STRUCTURAL).run(graph, sink, verify_each=True)
    once = print_text(graph)
    pipeline.build_pipeline(STRUCTURAL).run(graph, Sink(), verify_each=True)
    assert print_text(graph) == once
    assert not graph.pending
    assert [found.message for found in sink if found.rule.code in ("SM150", "SM151")] == []


def test_the_corpus_is_there(corpus):
    assert len(models()) > 35
