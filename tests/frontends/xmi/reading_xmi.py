"""Small models in the dialects of the tools, read into a graph."""

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.xmi import FRONTEND
from sysmlc.ir import Graph
from sysmlc.ir.text import print_text
from sysmlc.ir.verify import verify
from sysmlc.sources import Source

PAPYRUS = """<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
 xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
 xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore"
 xmlns:Blocks="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Blocks"
 xmlns:PortsAndFlows="http://www.eclipse.org/papyrus/sysml/1.6/SysML/PortsAndFlows"
 xmlns:Plant="http://plant/profile"
 xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML">%s</xmi:XMI>"""

MAGICDRAW = """<?xml version='1.0' encoding='UTF-8'?>
<xmi:XMI xmlns:uml='http://www.omg.org/spec/UML/20131001'
 xmlns:xmi='http://www.omg.org/spec/XMI/20131001'
 xmlns:sysml='http://www.omg.org/spec/SysML/20150709/SysML'
 xmlns:MagicDraw_Profile='http://www.omg.org/spec/UML/20131001/MagicDrawProfile'>
<xmi:Documentation><xmi:exporter>MagicDraw UML</xmi:exporter></xmi:Documentation>%s</xmi:XMI>"""


class Read:
    """The graph, the diagnostics and the coverage of some files."""

    def __init__(self, sources, graph=None):
        self.graph = graph or Graph()
        self.sink = Sink()
        self.coverage = Coverage()
        FRONTEND.read(sources, self.graph, self.sink, self.coverage)
        assert verify(self.graph) == []

    @property
    def text(self):
        return print_text(self.graph)

    @property
    def findings(self):
        return [f"{diagnostic.rule.name}: {diagnostic.message}" for diagnostic in self.sink]

    @property
    def totals(self):
        return {k: n for k, n in self.coverage.as_json()["total"].items() if n}


def source(text, name="m.uml"):
    return Source(name, text if isinstance(text, bytes) else text.encode())


def papyrus(model, applications="", name="m.uml"):
    body = f'<uml:Model xmi:id="m" name="M">{model}</uml:Model>{applications}'
    return source(PAPYRUS % body, name)


def magicdraw(model, applications="", name="m.mdxml"):
    body = f"<uml:Model xmi:type='uml:Model' xmi:id='m' name='M'>{model}</uml:Model>{applications}"
    return source(MAGICDRAW % body, name)


def read(*sources):
    return Read(sources)


def below_model(reading):
    """The lines below the model, without indentation of the model and without places."""
    lines = reading.text.splitlines()[1:]
    return "\n".join(line[2:].partition(" @")[0] for line in lines) + "\n"
