"""The SysML v2 text of random small models of SysML v1 has no errors."""

from random import Random

import pytest
from sysml_texts import PASSES, read_xmi, write

from dialects.random_small_models import draw_small_model
from long_runs import quick_first
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Graph
from sysmlc.passes import pipeline
from sysmlc.sources import Source


def find_errors(graph):
    """Return the errors that the passes of ``sysmlc check`` find in the text of a graph."""
    files, _ = write(graph)
    text_graph, sink = Graph(), Sink()
    sources = [Source(name, text.encode()) for name, text in files.items()]
    FRONTEND.read(sources, text_graph, sink, Coverage())
    pipeline.build_pipeline((*PASSES, "flows")).run(text_graph, sink)
    return [f"{error.rule.code} {error.message}" for error in sink if error.is_error]


@pytest.mark.parametrize("first", quick_first(range(0, 240, 10), 4))
def test_the_texts_of_random_small_models_have_no_errors(first):
    errors = {}
    for seed in range(first, first + 10):
        errors[seed] = find_errors(read_xmi(draw_small_model(Random(seed))))
    assert {seed: texts for seed, texts in errors.items() if texts} == {}
