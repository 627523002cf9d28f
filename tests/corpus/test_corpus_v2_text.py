"""Text of SysML v2 of real models: read, written and read again it is the same model.

The text is what ``--emit +sysml`` makes of the XMI and AutomationML of the corpus. What the way
there loses is told (SM730 to SM737, docs/write-sysml-v2.md); on the way from text to text nothing
may be lost or come in.
"""

import gc

import pytest
from plants import baygate

from sysmlc.backends.sysml.document import print_document
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
"""Bytes; the larger ones of the corpus take seconds each and are alike."""


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


def differences(files):
    """What is another in the text of the text of a model."""
    gc.unfreeze()
    made = compile_model(Request(tuple(files), backends=tuple(select_backends(("ir",)))))
    once = read(text_of(made.graph))
    again = read(text_of(once))
    return [str(one) for one in compare(once, again, ("id",))]


@pytest.mark.long
def test_text_that_is_read_and_written_again_is_the_same_model(corpus):
    found = {name: differences(files) for name, files in units(corpus).items()}
    assert len(found) == 64
    assert {name: told for name, told in found.items() if told} == {}
