"""A reference for runs: fair runs over enumerated states, by strongly connected components."""

import networkx as nx
from explicit import list_evaluations

from sysmlc.logic import domains
from sysmlc.logic.contract import Class
from sysmlc.logic.evaluate import compile_evaluation


class ListedRuns:
    """The runs in which all *conjuncts* hold, over enumerated states."""

    def __init__(self, variables, conjuncts) -> None:
        self.values = list(
            domains.valuations({variable.name: variable.domain for variable in variables})
        )
        steps = list_evaluations(conjuncts, Class.SAFETY)
        self.graph = nx.DiGraph()
        for source, current in enumerate(self.values):
            for target, following in enumerate(self.values):
                if all(rule(current, following) for rule in steps):
                    self.graph.add_edge(source, target)
        starts = list_evaluations(conjuncts, Class.INIT)
        self.starts = [
            i for i, current in enumerate(self.values) if all(r(current, None) for r in starts)
        ]
        self.recurring = list_evaluations(conjuncts, Class.LIVENESS)

    def remove_states(self, states) -> None:
        """Remove the runs through some states."""
        removed = set(states)
        self.graph.remove_nodes_from(removed)
        self.starts = [state for state in self.starts if state not in removed]

    def find_fair_states(self, graph) -> set[int]:
        """Return the states of *graph* from which a fair run continues in it."""
        cores = [
            part for part in nx.strongly_connected_components(graph) if self.is_fair(graph, part)
        ]
        core = set().union(*cores)
        return core.union(*(nx.ancestors(graph, state) for state in core))

    def is_fair(self, graph, part) -> bool:
        has_step = any(successor in part for state in part for successor in graph.successors(state))
        return has_step and all(
            any(rule(self.values[state], None) for state in part) for rule in self.recurring
        )

    def find_reachable_states(self) -> set[int]:
        initial = set(self.starts)
        return initial.union(
            *(nx.descendants(self.graph, i) for i in self.starts if i in self.graph)
        )

    def is_violated(self, conjunct) -> bool:
        """Whether *conjunct* fails in some run."""
        rule, graph = compile_evaluation(conjunct.formula), self.graph
        fair = self.find_fair_states(graph)
        if conjunct.class_ is Class.INIT:
            return any(not rule(self.values[state], None) for state in self.starts if state in fair)
        if conjunct.class_ is Class.SAFETY:
            return any(
                not rule(self.values[state], self.values[successor])
                for state in self.find_reachable_states() & fair
                for successor in graph.successors(state)
                if successor in fair
            )
        violating = [state for state in graph if not rule(self.values[state], None)]
        return bool(self.find_fair_states(graph.subgraph(violating)) & self.find_reachable_states())

    def is_possible(self) -> bool:
        return any(one in self.find_fair_states(self.graph) for one in self.starts)
