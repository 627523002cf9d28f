"""Small AutomationML files, read into a graph."""

from sysmlc.diagnostics import Coverage, Severity, Sink
from sysmlc.frontends.caex import FRONTEND
from sysmlc.ir import Edge, Graph
from sysmlc.ir.text import print_text
from sysmlc.ir.verify import verify
from sysmlc.sources import Source

CAEX_3 = (
    '<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="plant.aml">'
    "%s</CAEXFile>"
)
CAEX_2 = '<CAEXFile SchemaVersion="2.15" FileName="plant.aml">%s</CAEXFile>'


def aml(body, name="plant.aml", form=CAEX_3):
    return Source(name, body if isinstance(body, bytes) else (form % body).encode())


def aml_2(body, name="plant.aml"):
    return aml(body, name, CAEX_2)


def classes(body, name="Lib"):
    return f'<SystemUnitClassLib Name="{name}">{body}</SystemUnitClassLib>'


def roles(body, name="Roles"):
    return f'<RoleClassLib Name="{name}">{body}</RoleClassLib>'


def interfaces(body, name="Interfaces"):
    return f'<InterfaceClassLib Name="{name}">{body}</InterfaceClassLib>'


def types(body, name="Types"):
    return f'<AttributeTypeLib Name="{name}">{body}</AttributeTypeLib>'


def plant(body, name="Plant"):
    return f'<InstanceHierarchy Name="{name}">{body}</InstanceHierarchy>'


def describe(diagnostic):
    return f"{diagnostic.rule.code}: {diagnostic.message}"


class Read:
    """The graph, diagnostics and coverage of some files; elements are found by qualified name."""

    def __init__(self, *sources):
        self.graph, self.sink, self.coverage = Graph(), Sink(), Coverage()
        files = [source if isinstance(source, Source) else aml(source) for source in sources]
        FRONTEND.read(files, self.graph, self.sink, self.coverage)
        assert verify(self.graph) == []

    @property
    def text(self):
        return print_text(self.graph)

    @property
    def findings(self):
        """Errors and warnings, except SM140: models of these tests have libraries first."""
        return [
            describe(diagnostic)
            for diagnostic in self.sink
            if diagnostic.rule.code != "SM140" and diagnostic.severity is not Severity.INFO
        ]

    @property
    def order(self):
        return [describe(finding) for finding in self.sink if finding.rule.code == "SM140"]

    @property
    def infos(self):
        return [describe(finding) for finding in self.sink if finding.severity is Severity.INFO]

    @property
    def totals(self):
        total = self.coverage.as_json()["total"]
        return {k: n for k, n in total.items() if n and k != "elements"}

    def find_all(self, name, kind=None):
        return [
            element
            for element in self.graph
            if self.graph.qualified_name(element) == name and kind in (None, element.kind.value)
        ]

    def find(self, name, kind=None):
        (element,) = self.find_all(name, kind)
        return element

    def targets(self, name, edge, kind=None):
        """Return the qualified names of the targets of an element's edges."""
        targets = self.graph.targets(self.find(name, kind), Edge(edge))
        return [self.graph.qualified_name(target) for target in targets]

    def list_owned(self, name, kind=None):
        owned = self.graph.owned(self.find(name, kind))
        return [f"{element.kind.value} {element.name}".strip() for element in owned]

    def links(self):
        """Return each connector as its two ends: names of parts, then the port."""
        return {
            c.name: tuple(self._end(end) for end in self.graph.targets(c, Edge.END))
            for c in self.graph
            if c.kind.value == "Connector"
        }

    def _end(self, end):
        steps = [*self.graph.targets(end, Edge.PATH), *self.graph.targets(end, Edge.ROLE)]
        return ".".join(step.name for step in steps)
