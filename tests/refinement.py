"""Runs of passes and analyses on a graph in memory."""

from collections.abc import Sequence

from sysmlc.analyses import analysis
from sysmlc.diagnostics import Sink
from sysmlc.ir import Graph
from sysmlc.passes import pipeline


def run_all(graph: Graph, sink: Sink, *, verify_each: bool = False) -> None:
    """Run all passes and the analyses of ``sysmlc check``."""
    run_steps((*pipeline.NAMES, *analysis.CHECKED), graph, sink, verify_each=verify_each)


def run_steps(names: Sequence[str], graph: Graph, sink: Sink, *, verify_each: bool = False) -> None:
    """Run the passes of these names, then the analyses of these names and those they need."""
    passes = [name for name in names if name in pipeline.NAMES]
    pipeline.build_pipeline(passes).run(graph, sink, verify_each=verify_each)
    for name in analysis.expand(name for name in names if name in analysis.NAMES):
        if analysis.has_result(name, graph):
            analysis.load(name).run(graph, sink)
