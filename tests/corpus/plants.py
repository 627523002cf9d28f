"""The AutomationML of the corpus as compile units, refined as far as structure goes."""

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.caex import FRONTEND
from sysmlc.ir import Graph
from sysmlc.passes import pipeline
from sysmlc.sources import load

PASSES = ("resolve", "kept", "inherit", "classify", "ports")


def refined(sources, frontend=FRONTEND):
    """The graph of sources that a front end reads."""
    graph, sink = Graph(), Sink()
    frontend.read(sources, graph, sink, Coverage())
    pipeline.build_pipeline(PASSES).run(graph, sink)
    return graph


def units(corpus):
    """Files by the name of the unit: every entry of ``dev``, and BayGate in four forms."""
    return baygate(corpus) | {path.name: [path] for path in sorted((corpus / "aml/dev").iterdir())}


def baygate(corpus):
    """The four forms of BayGate; that with libraries has three files."""
    folder = corpus / "aml" / "baygate"
    names = ("BayGate.aml", "BayGate.amlx", "BayGate_caex215.aml", "BayGate_extlibs.aml")
    found = {name: [folder / name] for name in names}
    found["BayGate_extlibs.aml"] += sorted((folder / "libs").iterdir())
    return found


def sources(corpus, paths):
    """The files with names relative to BayGate's folder, or alone."""
    top = corpus / "aml" / "baygate"
    names = [str(p.relative_to(top)) if p.is_relative_to(top) else p.name for p in paths]
    return [one for p, name in zip(paths, names, strict=True) for one in load(p, name)]
