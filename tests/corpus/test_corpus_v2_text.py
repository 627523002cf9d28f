"""The SysML v2 text of real models: read, written and read again it is the same model.

The text is what ``--emit +sysml`` writes for the XMI and AutomationML of the corpus. The first
writing reports its losses (SM730 to SM737, docs/write-sysml-v2.md); from text to text nothing may
be lost or added.
"""

import gc

import pytest
from plants import baygate

from sysmlc.backends.sysml.backend import print_document
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.driver import Request, compile_model, select_backends
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Graph
from sysmlc.ir.compare import compare
from sysmlc.passes import pipeline
from sysmlc.sources import Source

pytestmark = pytest.mark.corpus

PASSES = ("resolve", "inherit", "classify", "ports", "flows")
LARGEST = 300 * 1024
"""Bytes of a model; larger models of the corpus take seconds each and add nothing new."""


def units(corpus):
    folder = corpus / "xmi"
    models = [path for path in sorted(folder.glob("*/*")) if path.suffix not in (".md", ".ecore")]
    named = {path.relative_to(folder).as_posix(): [path] for path in models}
    named |= {f"aml/{name}": files for name, files in baygate(corpus).items()}
    named |= {f"aml/{path.name}": [path] for path in sorted((corpus / "aml/dev").iterdir())}
    return {
        name: files
        for name, files in named.items()
        if sum(file.stat().st_size for file in files) <= LARGEST
    }


def text_of(graph):
    return print_document(graph, Sink())[0]


def read(text):
    graph = Graph()
    FRONTEND.read([Source("model.sysml", text.encode())], graph, Sink(), Coverage())
    pipeline.build_pipeline(PASSES).run(graph, Sink())
    return graph


def find_differences(files):
    """Return the differences between the text of a model and the text of that text."""
    gc.unfreeze()
    compilation = compile_model(Request(tuple(files), backends=tuple(select_backends(("ir",)))))
    first = read(text_of(compilation.graph))
    second = read(text_of(first))
    return [str(change) for change in compare(first, second, ("id",))]


@pytest.mark.long
def test_text_that_is_read_and_written_again_is_the_same_model(corpus):
    differences = {name: find_differences(files) for name, files in units(corpus).items()}
    assert len(differences) == 64
    assert {name: changes for name, changes in differences.items() if changes} == {}
