"""Fair runs over states that are all listed, with strongly connected components: the judge."""

import networkx as nx
from explicit import rules

from sysmlc.logic import domains
from sysmlc.logic.contract import Class
from sysmlc.logic.evaluate import compile_evaluation


class Listed:
    """The runs in which conjuncts hold."""

    def __init__(self, variables, conjuncts) -> None:
        self.values = list(domains.valuations({one.name: one.domain for one in variables}))
        steps = rules(conjuncts, Class.SAFETY)
        self.graph = nx.DiGraph()
        for one, now in enumerate(self.values):
            for other, then in enumerate(self.values):
                if all(rule(now, then) for rule in steps):
                    self.graph.add_edge(one, other)
        starts = rules(conjuncts, Class.INIT)
        self.starts = [i for i, now in enumerate(self.values) if all(r(now, None) for r in starts)]
        self.recurring = rules(conjuncts, Class.LIVENESS)

    def fair(self, graph) -> set[int]:
        """States of a graph from which a fair run goes on in it."""
        cores = [
            part for part in nx.strongly_connected_components(graph) if self.is_fair(graph, part)
        ]
        core = set().union(*cores)
        return core.union(*(nx.ancestors(graph, one) for one in core))

    def is_fair(self, graph, part) -> bool:
        has_step = any(other in part for one in part for other in graph.successors(one))
        return has_step and all(
            any(rule(self.values[one], None) for one in part) for rule in self.recurring
        )

    def reachable(self) -> set[int]:
        found = set(self.starts)
        return found.union(*(nx.descendants(self.graph, i) for i in self.starts if i in self.graph))

    def is_violated(self, conjunct) -> bool:
        """Whether the conjunct fails in some run."""
        rule, graph = compile_evaluation(conjunct.formula), self.graph
        fair = self.fair(graph)
        if conjunct.class_ is Class.INIT:
            return any(not rule(self.values[one], None) for one in self.starts if one in fair)
        if conjunct.class_ is Class.SAFETY:
            return any(
                not rule(self.values[one], self.values[other])
                for one in self.reachable() & fair
                for other in graph.successors(one)
                if other in fair
            )
        left = [one for one in graph if not rule(self.values[one], None)]
        return bool(self.fair(graph.subgraph(left)) & self.reachable())

    def is_possible(self) -> bool:
        return any(one in self.fair(self.graph) for one in self.starts)
