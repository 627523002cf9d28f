"""Graphs that are written as SysML v2 text."""

from sysmlc.backends.sysml import LIBRARY, print_document
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph, parse_text
from sysmlc.passes import pipeline
from sysmlc.sources import Source
from sysmlc.support import resources

PASSES = ("resolve", "inherit", "classify", "ports", "expressions")


def read_xmi(data, name="model.uml"):
    """Return the graph of an XMI document, classified."""
    graph, sink = Graph(), Sink()
    FRONTEND.read([Source(name, data)], graph, sink, Coverage())
    pipeline.build_pipeline(PASSES).run(graph, sink)
    return graph


def refine(text):
    """Return the graph of a model in text form, classified."""
    graph = parse_text(text)
    pipeline.build_pipeline(PASSES).run(graph, Sink())
    return graph


def write(graph):
    """Return the texts of a graph by file name, and its losses as codes and messages."""
    sink = Sink()
    text, uses_library = print_document(graph, sink)
    files = {"model.sysml": text}
    if uses_library:
        files[LIBRARY] = resources.read_text("metamodels", LIBRARY)
    return files, [f"{loss.rule.code} {loss.message}" for loss in sink]


def text_of(model):
    """Return the SysML v2 text of a small model in text form."""
    return write(refine(model))[0]["model.sysml"]


def lines_of(model):
    """Return the lines of that text, without indentation and empty lines."""
    return [line.strip() for line in text_of(model).splitlines() if line.strip()]
