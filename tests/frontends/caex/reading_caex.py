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


def told(found):
    return f"{found.rule.code}: {found.message}"


class Read:
    """What came out of reading some files; elements are asked for by qualified name."""

    def __init__(self, *sources):
        self.graph, self.sink, self.coverage = Graph(), Sink(), Coverage()
        given = [one if isinstance(one, Source) else aml(one) for one in sources]
        FRONTEND.read(given, self.graph, self.sink, self.coverage)
        assert verify(self.graph) == []

    @property
    def text(self):
        return print_text(self.graph)

    @property
    def findings(self):
        """All but infos, and but for SM140: the models here have first what is referred to."""
        told_of = [found for found in self.sink if found.rule.code != "SM140"]
        return [told(found) for found in told_of if found.severity is not Severity.INFO]

    @property
    def order(self):
        return [told(found) for found in self.sink if found.rule.code == "SM140"]

    @property
    def infos(self):
        return [told(found) for found in self.sink if found.severity is Severity.INFO]

    @property
    def totals(self):
        total = self.coverage.as_json()["total"]
        return {k: n for k, n in total.items() if n and k != "elements"}

    def all(self, name, kind=None):
        names = ((e, self.graph.qualified_name(e)) for e in self.graph)
        return [e for e, its in names if its == name and kind in (None, e.kind.value)]

    def one(self, name, kind=None):
        (found,) = self.all(name, kind)
        return found

    def to(self, name, edge, kind=None):
        """Qualified names of what the edges of an element lead to."""
        targets = self.graph.targets(self.one(name, kind), Edge(edge))
        return [self.graph.qualified_name(target) for target in targets]

    def owned(self, name, kind=None):
        inside = self.graph.owned(self.one(name, kind))
        return [f"{e.kind.value} {e.name}".strip() for e in inside]

    def links(self):
        """Each connector as its two ends: names of parts, then the port."""
        return {
            c.name: tuple(self._end(end) for end in self.graph.targets(c, Edge.END))
            for c in self.graph
            if c.kind.value == "Connector"
        }

    def _end(self, end):
        steps = [*self.graph.targets(end, Edge.PATH), *self.graph.targets(end, Edge.ROLE)]
        return ".".join(step.name for step in steps)
