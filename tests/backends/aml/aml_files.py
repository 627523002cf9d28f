"""Graphs that are written as CAEX 3.0 and read back."""

from lxml import etree

from graph_differences import diff
from sysmlc.backends.aml import write_files
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.caex import FRONTEND
from sysmlc.ir import Graph, parse_text
from sysmlc.ir.verify import verify
from sysmlc.passes import pipeline
from sysmlc.sources import Source

PASSES = ("resolve", "inherit", "classify", "ports")
IGNORED = {"id", "source", "trace"}


def read(*sources):
    """Return the graph of AutomationML files after the passes for structure."""
    graph, sink = Graph(), Sink()
    FRONTEND.read(list(sources), graph, sink, Coverage())
    pipeline.build_pipeline(PASSES).run(graph, sink)
    assert verify(graph) == []
    return graph


def refine(text):
    """Return the graph of a text form after the passes for structure."""
    graph = parse_text(text)
    pipeline.build_pipeline(PASSES).run(graph, Sink())
    return graph


def save(graph, unit="plant"):
    """Return the files by path, and the diagnostics: codes and messages."""
    sink = Sink()
    texts = write_files(graph, unit, sink)
    return texts, [f"{diagnostic.rule.code} {diagnostic.message}" for diagnostic in sink]


def round_trip(graph):
    """Return the files, the graph that is read back from them, and the differences."""
    texts, _ = save(graph)
    paths = {path.removeprefix("aml/"): text for path, text in texts.items()}
    back = read(*(Source(path, text.encode()) for path, text in paths.items()))
    return texts, back, diff(graph, back, IGNORED)


def parse_file(texts):
    """Return the only file as an XML tree without namespaces."""
    (text,) = texts.values()
    tree = etree.fromstring(text.encode())
    for element in tree.iter("*"):
        element.tag = etree.QName(element).localname
    return tree


def attrs_of(texts, path):
    """Return the XML attributes of the only element on an XPath."""
    (element,) = parse_file(texts).xpath(path)
    return dict(element.attrib)
