"""Saves graphs as UML and reads them back, for the tests of the back end ``uml``."""

from graph_differences import diff
from sysmlc.backends.uml.backend import write_document
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph, parse_text
from sysmlc.ir.verify import verify
from sysmlc.passes import pipeline
from sysmlc.sources import Source

PASSES = ("resolve", "kept", "inherit", "classify")


def read(data, name="model.uml"):
    """The graph of an XMI document, classified."""
    graph, sink = Graph(), Sink()
    FRONTEND.read([Source(name, data)], graph, sink, Coverage())
    pipeline.build_pipeline(PASSES).run(graph, sink)
    return graph


def refined(text):
    """The graph that a text form means, classified."""
    graph = parse_text(text)
    pipeline.build_pipeline(PASSES).run(graph, Sink())
    return graph


def saved(graph):
    """The document, and what it could not say: codes and messages."""
    sink = Sink()
    text = write_document(graph, sink)
    return text, [f"{found.rule.code} {found.message}" for found in sink]


def round_trip(graph):
    """The document, the graph that is read back from it, and what differs."""
    text, _ = saved(graph)
    back = read(text.encode())
    assert verify(back) == []
    return text, back, diff(graph, back, {"id", "source", "trace"})
