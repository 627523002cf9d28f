"""Reads small texts of SysML v2 for the tests of the front end."""

from refinement import run_steps
from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.ir.verify import verify
from sysmlc.sources import Source

PASSES = ("resolve", "inherit", "classify", "ports")


class Reading:
    """The graph of some texts, with the diagnostics and the coverage."""

    def __init__(self, *texts, passes=("resolve",), names=("model.sysml",)):
        self.graph, self.sink, self.coverage = Graph(), Sink(), Coverage()
        named = zip([*names, *(f"m{n}.sysml" for n in range(9))], texts, strict=False)
        sources = [Source(name, text.encode()) for name, text in named]
        FRONTEND.read(sources, self.graph, self.sink, self.coverage)
        assert verify(self.graph) == []
        run_steps(passes, self.graph, self.sink, verify_each=True)

    def find_element(self, name, kind=None):
        """Return the only element with a qualified name, and the kind if it is given."""
        elements = [element for element in self.graph if self.graph.qualified_name(element) == name]
        elements = [element for element in elements if kind is None or element.kind is Kind(kind)]
        assert len(elements) == 1, (name, elements)
        return elements[0]

    def list_owned(self, name, kind=None):
        """Return kind and name of each element that an element owns."""
        return [
            f"{member.kind} {member.name}".rstrip()
            for member in self.graph.owned(self.find_element(name, kind))
        ]

    def list_targets(self, name, edge, kind=None):
        """Return the qualified names of the targets of an element's edges."""
        targets = self.graph.targets(self.find_element(name, kind), Edge(edge))
        return [self.graph.qualified_name(target) for target in targets]

    def list_flows(self, name):
        """Return the flows and transitions that an element owns, as ``a -> b [guard]``."""
        graph = self.graph
        lines = []
        for flow in graph.owned(self.find_element(name)):
            if flow.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW, Kind.TRANSITION):
                ends = [graph.target(flow, end) for end in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
                text = " -> ".join("?" if end is None else end.name or end.subkind for end in ends)
                guard = flow.attrs.get("guard")
                lines.append(text + (f" [{guard}]" if guard is not None else ""))
        return lines

    def list_codes(self):
        """Return the codes of the diagnostics."""
        return [diagnostic.rule.code for diagnostic in self.sink]

    def count_verdicts(self):
        """Return the number of nodes for each verdict that occurs."""
        total = self.coverage.as_json()["total"]
        return {key: number for key, number in total.items() if number}


def read(*texts, **options):
    """Read texts that are files of one unit."""
    return Reading(*texts, **options)


def read_classified(*texts):
    """Read texts and classify their elements."""
    return Reading(*texts, passes=PASSES)
