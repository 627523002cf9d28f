"""Writes graphs as CAEX 3.0 and reads them back, for the tests of the back end ``aml``."""

from lxml import etree

from graph_differences import diff
from sysmlc.backends.aml.backend import write_files
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.caex import FRONTEND
from sysmlc.ir import Graph, parse_text
from sysmlc.ir.verify import verify
from sysmlc.passes import pipeline
from sysmlc.sources import Source

PASSES = ("resolve", "inherit", "classify", "ports")
IGNORED = {"id", "source", "trace"}


def read(*sources):
    """The graph of AutomationML files, refined as far as structure goes."""
    graph, sink = Graph(), Sink()
    FRONTEND.read(list(sources), graph, sink, Coverage())
    pipeline.build_pipeline(PASSES).run(graph, sink)
    assert verify(graph) == []
    return graph


def refined(text):
    """The graph that a text form means, refined."""
    graph = parse_text(text)
    pipeline.build_pipeline(PASSES).run(graph, Sink())
    return graph


def saved(graph, unit="plant"):
    """The files by path, and what they do not say: codes and messages."""
    sink = Sink()
    texts = write_files(graph, unit, sink)
    return texts, [f"{found.rule.code} {found.message}" for found in sink]


def round_trip(graph):
    """The files, the graph that is read back from them, and what differs."""
    texts, _ = saved(graph)
    paths = {path.removeprefix("aml/"): text for path, text in texts.items()}
    back = read(*(Source(path, text.encode()) for path, text in paths.items()))
    return texts, back, diff(graph, back, IGNORED)


def root(texts):
    """The only file as an XML tree without namespaces."""
    (text,) = texts.values()
    tree = etree.fromstring(text.encode())
    for one in tree.iter("*"):
        one.tag = etree.QName(one).localname
    return tree


def at(texts, path):
    """Attributes of the only element on an XPath."""
    (found,) = root(texts).xpath(path)
    return dict(found.attrib)
