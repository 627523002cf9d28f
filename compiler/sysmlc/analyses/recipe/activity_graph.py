"""The nodes and flows of an activity that a recipe shows, read from its token graph.

Each node of a token graph names the drawn node that it stands for, and each edge the drawn flow.
The projection keeps these, and drops what UML only implies (docs/decisions/0049).
"""

from collections.abc import Iterator

from msgspec import Struct

from sysmlc.analyses.activities import draw_tokens
from sysmlc.analyses.activities.regions import FLOWS
from sysmlc.ir import Element, Graph, Kind
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import TokenEdge, TokenNode

_STEPS = frozenset([Kind.ACTION, Kind.CONTROL, Kind.STRUCTURED])
_ENDS = ("final", "flow-final")


class Flow(Struct, frozen=True):
    """A drawn flow and the nodes at its ends; ``edge`` is the edge that brings its tokens."""

    element: Element
    source: Element
    target: Element
    edge: TokenEdge


class ActivityGraph:
    """The nodes and flows of one activity.

    The content of for-each regions and blocks is ``inlined``: it belongs to the graph of the
    activity around them. ``inlined`` has the ids of the activity, of these structured nodes, and of
    those that only group nodes of the region around them.
    """

    def __init__(self, graph: Graph, activity: Element) -> None:
        tokens = draw_tokens(graph, activity)
        self.nodes: list[Element] = []
        self.inlined = {activity.id}
        self._members: dict[str, list[Element]] = {}
        self._flows: dict[str, list[Flow]] = {}
        for flow in _list_flows(graph, tokens):
            self._flows.setdefault(_find_owner(tokens, flow.edge.region), []).append(flow)
        drawn = [node for node in tokens.nodes if node.id == node.origin != activity.id]
        owners = {node.id: _find_owner(tokens, node.region) for node in drawn}
        for id, owner in owners.items():
            self._members.setdefault(owner, []).append(graph[id])
        for id, owner in owners.items():  # a region comes before its content
            if owner in self.inlined:
                self.nodes.append(graph[id])
                self.inlined.update(_list_groups(graph, graph[id], owner))
                if is_for_each(graph[id]) or self._is_block(graph[id]):
                    self.inlined.add(id)
        self.flows = [flow for id in self._flows if id in self.inlined for flow in self._flows[id]]

    def list_nodes(self, region: Element) -> list[Element]:
        """Return the nodes directly in a structured node or in the activity."""
        return self._members.get(region.id, [])

    def list_steps(self, region: Element) -> list[Element]:
        """Return the nodes directly in a structured node, without object nodes."""
        return [node for node in self.list_nodes(region) if node.kind in _STEPS]

    def find_entries(self, region: Element) -> list[Element]:
        """Return the first nodes in a region: initial nodes, or else nodes without predecessor."""
        steps = self.list_steps(region)
        targets = {flow.target.id for flow in self._flows.get(region.id, ())}
        starts = [step for step in steps if step.subkind == "initial"]
        return starts or [step for step in steps if step.id not in targets]

    def find_exits(self, region: Element) -> list[Element]:
        """Return the last nodes in a region: final nodes, and nodes without successor."""
        sources = {flow.source.id for flow in self._flows.get(region.id, ())}
        steps = self.list_steps(region)
        return [step for step in steps if step.subkind in _ENDS or step.id not in sources]

    def _is_block(self, node: Element) -> bool:
        """Whether a node only groups steps: a structured node with one entry and without forks."""
        if node.kind is not Kind.STRUCTURED or node.subkind not in ("", "structured"):
            return False
        has_fork = any(step.subkind == "fork" for step in self.list_steps(node))
        return not has_fork and len(self.find_entries(node)) == 1


def is_for_each(node: Element) -> bool:
    """Whether a region takes the elements of a list one after the other (SysML v2 ``for``)."""
    is_region = node.kind is Kind.STRUCTURED and node.subkind == "expansion"
    return is_region and node.attrs.get("mode") == "iterative" and "collection" in node.attrs


def _find_owner(tokens: TokenGraph, region: str) -> str:
    """Return the id of the structured node or activity to whose content a region belongs."""
    return tokens.node(region).origin if region else tokens.activity


def _list_groups(graph: Graph, node: Element, owner: str) -> Iterator[str]:
    """Yield the ids of the elements between a node and its owner in the token graph."""
    for group in graph.ancestors(node):
        if group.id == owner:
            return
        yield group.id


def _list_flows(graph: Graph, tokens: TokenGraph) -> list[Flow]:
    """Return the drawn flows; of several edges for one flow, the first leaves its source."""
    flows: dict[str, Flow] = {}
    drawn = {node.id: _find_drawn(graph, node) for node in tokens.nodes}
    for edge in tokens.edges:
        element = graph[edge.origin]
        if element.kind in FLOWS:
            source = flows[element.id].source if element.id in flows else drawn[edge.source]
            flows[element.id] = Flow(element, source, drawn[edge.target], edge)
    return list(flows.values())


def _find_drawn(graph: Graph, node: TokenNode) -> Element:
    """Return the drawn node for which a token node stands, or to whose pin it belongs."""
    element = graph[node.origin]
    owner = graph.owner(element)
    return owner if element.kind is Kind.PIN and owner is not None else element
