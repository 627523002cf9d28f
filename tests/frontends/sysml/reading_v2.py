"""Reads small texts of SysML v2 for the tests of the front end."""

from sysmlc.diagnostics import Coverage, Sink
from sysmlc.frontends.sysml import FRONTEND
from sysmlc.ir import Edge, Graph, Kind
from sysmlc.ir.verify import verify
from sysmlc.passes import pipeline
from sysmlc.sources import Source

PASSES = ("resolve", "inherit", "classify", "ports")


class Reading:
    """The graph of some texts, with what was found and counted."""

    def __init__(self, *texts, passes=("resolve",), names=("model.sysml",)):
        self.graph, self.sink, self.coverage = Graph(), Sink(), Coverage()
        named = zip([*names, *(f"m{n}.sysml" for n in range(9))], texts, strict=False)
        sources = [Source(name, text.encode()) for name, text in named]
        FRONTEND.read(sources, self.graph, self.sink, self.coverage)
        assert verify(self.graph) == []
        pipeline.build_pipeline(passes).run(self.graph, self.sink, verify_each=True)

    def named(self, name, kind=None):
        """The only element with a qualified name."""
        found = [one for one in self.graph if self.graph.qualified_name(one) == name]
        found = [one for one in found if kind is None or one.kind is Kind(kind)]
        assert len(found) == 1, (name, found)
        return found[0]

    def owned(self, name, kind=None):
        """Kind and name of what an element owns, one a line."""
        return [
            f"{one.kind} {one.name}".rstrip() for one in self.graph.owned(self.named(name, kind))
        ]

    def to(self, name, edge, kind=None):
        """Qualified names of what the edges of an element lead to."""
        found = self.graph.targets(self.named(name, kind), Edge(edge))
        return [self.graph.qualified_name(one) for one in found]

    def flows(self, name):
        """The control flows of an activity: ``a -> b [guard]``."""
        graph = self.graph
        lines = []
        for one in graph.owned(self.named(name)):
            if one.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW, Kind.TRANSITION):
                ends = [graph.target(one, e) for e in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
                shown = " -> ".join("?" if e is None else e.name or e.subkind for e in ends)
                guard = one.attrs.get("guard")
                lines.append(shown + (f" [{guard}]" if guard is not None else ""))
        return lines

    def codes(self):
        """Codes of what was found."""
        return [found.rule.code for found in self.sink]

    def totals(self):
        """Number of nodes for each verdict that occurs."""
        total = self.coverage.as_json()["total"]
        return {key: number for key, number in total.items() if number}


def read(*texts, **given):
    """Read texts that are files of one unit."""
    return Reading(*texts, **given)


def classified(*texts):
    """Read texts and find the roles of their elements."""
    return Reading(*texts, passes=PASSES)
