"""Graphs that are saved as UML and read back."""

from graph_differences import diff
from sysmlc.backends.uml import write_document
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph, parse_text
from sysmlc.ir.verify import verify
from sysmlc.passes import pipeline
from sysmlc.sources import Source

PASSES = ("resolve", "kept", "inherit", "classify")


def read(data, name="model.uml"):
    """Return the graph of an XMI document after classification."""
    graph, sink = Graph(), Sink()
    FRONTEND.read([Source(name, data)], graph, sink, Coverage())
    pipeline.build_pipeline(PASSES).run(graph, sink)
    return graph


def refine(text):
    """Return the graph of a text form after classification."""
    graph = parse_text(text)
    pipeline.build_pipeline(PASSES).run(graph, Sink())
    return graph


def save(graph):
    """Return the document, and the diagnostics: codes and messages."""
    sink = Sink()
    text = write_document(graph, sink)
    return text, [f"{diagnostic.rule.code} {diagnostic.message}" for diagnostic in sink]


def round_trip(graph):
    """Return the document, the graph that is read back from it, and the differences."""
    text, _ = save(graph)
    back = read(text.encode())
    assert verify(back) == []
    return text, back, diff(graph, back, {"id", "source", "trace", "caex_id"})
