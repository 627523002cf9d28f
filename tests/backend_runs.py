"""Runs of one back end on a graph, in memory."""

from pathlib import Path

from refinement import run_all
from sysmlc.backends.base import Backend, EmitOptions
from sysmlc.diagnostics import Diagnostic, Sink
from sysmlc.ir import Graph
from sysmlc.ir.text import parse_text
from sysmlc.support.output import Artefact, Output


def emit(
    backend: Backend, graph: Graph, options: EmitOptions | None = None
) -> tuple[dict[str, Artefact], list[Diagnostic]]:
    """Return the outputs of a back end by path, and its diagnostics."""
    output, sink = Output(), Sink()
    backend.emit(graph, output, sink, options or EmitOptions())
    return {artefact.path: artefact for artefact in output.artefacts()}, list(sink)


def refine_and_emit(
    backend: Backend, text: str, templates: Path | None = None
) -> tuple[Graph, dict[str, Artefact], list[Diagnostic]]:
    """Run all passes on a model in IR text, then a back end.

    Return the graph, the outputs by path, and the diagnostics of passes and back end.
    """
    graph, sink = parse_text(text), Sink()
    run_all(graph, sink, verify_each=True)
    artefacts, diagnostics = emit(backend, graph, EmitOptions(templates))
    return graph, artefacts, [*sink, *diagnostics]
