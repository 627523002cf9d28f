"""One step of the performances of a component, which others start and stop."""

from sysmlc.logic.activities import interpreter as token_game
from sysmlc.logic.activities.token_graph import Firing, NodeKind, TokenEdge, TokenNode


class PerformanceStep(token_game.TokenStep):
    """One step of the performances of a component, whose outermost nodes others start and stop.

    A region is complete, too, if a token reaches one of its final nodes just now: the way to a
    final node takes no step. A performance that is complete does not start again.
    """

    def is_complete(self, region: str) -> bool:
        if token_game.is_complete(self.graph, self.old, region):
            return True
        return any(self._arrives(edge) for edge in self.graph.ends(region))

    def list_finished(self) -> set[str]:
        """Return the ids of the running nodes that are done; what they write counts."""
        return {
            node.id
            for node in self.graph.workers()
            if node.id in self.old.running and self._finishes(node)
        }

    def start_and_stop(self, starts: set[str], stops: set[str]) -> token_game.State:
        """Return the next state after performances were stopped and others were started."""
        self.move_tokens()
        for id in stops:
            self.running.discard(id)
            self.clear_region(id)
        for id in starts:
            self.running.add(id)
            self.start_region(self.graph.node(id))
        return token_game.State(frozenset(self.tokens), frozenset(self.running))

    def _finishes(self, node: TokenNode) -> bool:
        if node.kind is NodeKind.STRUCTURED:
            return self.is_complete(node.id)
        return self.is_done(node)

    def _arrives(self, edge: TokenEdge) -> bool:
        """Whether the source of an edge gives it a token in this step, without another choice."""
        source = self.graph.node(edge.source)
        around = self.graph.regions_around(source.region)
        inner = self.graph.nodes_between(source.region, edge.region)
        if any(region.id not in self.old.running for region in around) or any(
            self.is_complete(region.id) for region in inner
        ):
            return False
        waiting = [token.id in self.old.tokens for token in self.graph.incoming(source)]
        match source.firing:
            case Firing.ANY:
                return any(waiting)
            case Firing.ALL:
                return bool(waiting) and all(waiting)
            case Firing.CHOICE:
                branches = self.graph.outgoing(source)
                is_open = edge in self.list_open_branches(branches)
                return is_open and all(waiting) and not _can_choose(source, branches)
            case Firing.WORK:
                return source.id in self.old.running and self._finishes(source)
            case _:
                return False


def _can_choose(node: TokenNode, branches: list[TokenEdge]) -> bool:
    """Whether several branches of a decision can be open at once, so that its token waits."""
    else_count = sum(branch.is_else for branch in branches)
    guarded_count = len(branches) - else_count
    return else_count > 1 or (guarded_count > 1 and not node.exclusive)
