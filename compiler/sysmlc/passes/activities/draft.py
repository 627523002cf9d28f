"""A token graph under construction: nodes, edges, and names for their variables."""

from itertools import pairwise

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.ir.element import derived_id
from sysmlc.logic.activities.token_graph import Guard, NodeKind, TokenEdge, TokenNode
from sysmlc.logic.names import identifier
from sysmlc.passes.activities.drawing import Drawing, Flow, flow_label
from sysmlc.passes.activities.exception_analysis import Raising
from sysmlc.passes.activities.inputs import Answer, Inputs


class Draft:
    """Nodes and edges so far, and the tables that the builders of nodes, flows and exceptions
    share.

    ``short`` maps a node to its name inside variables. ``chained`` holds nodes that do not start by
    themselves, ``takers`` the accept actions by event, ``answers`` the inputs of decisions.
    ``exits`` maps a protected node to the node that its drawn flows leave, because they wait for
    exception handlers. ``rounds`` maps a loop to the edges that begin another round. ``ended``
    holds the structured nodes that exceptions end, ``failing`` the calls that may end with an
    exception. ``listening`` maps an accept action to the interruptible region whose tokens make it
    listen.
    """

    def __init__(
        self, graph: Graph, drawing: Drawing, inputs: Inputs, raising: Raising, sink: Sink
    ) -> None:
        self.graph = graph
        self.raising = raising
        self.drawing = drawing
        self.inputs = inputs
        self.sink = sink
        self.nodes: dict[str, TokenNode] = {}
        self.edges: list[TokenEdge] = []
        self.short: dict[str, str] = {}
        self.answers: dict[str, Answer] = {}
        self.chained: set[str] = set()
        self.exits: dict[str, str] = {}
        self.rounds: dict[str, list[str]] = {}
        self.ended: dict[str, Element] = {}
        self.failing: set[str] = set()
        self.listening: dict[str, str] = {}
        self._used: set[str] = set()
        self._reaching: dict[str, list[TokenEdge]] = {}
        self.takers: dict[str, list[Element]] = {}
        self.incoming: dict[str, list[Flow]] = {node.id: [] for node in drawing.nodes}
        self.outgoing: dict[str, list[Flow]] = {node.id: [] for node in drawing.nodes}
        for flow in drawing.flows:
            if not flow.enters:
                self.outgoing[flow.source.id].append(flow)
            if not flow.leaves:
                self.incoming[flow.target.id].append(flow)

    def put_node(self, node: TokenNode, short: str) -> TokenNode:
        """Add or replace a node."""
        self.nodes[node.id] = node
        self.short[node.id] = short
        return node

    def ensure_node(
        self, origin: Element, role: str, kind: NodeKind, label: str, region: str
    ) -> TokenNode:
        """Return the node that plays a role for a drawn element, added at the first request."""
        id = derived_id(origin.id, role)
        if id in self.nodes:
            return self.nodes[id]
        short = f"{role}_{self.short.get(origin.id, identifier(origin.name, 'node'))}"
        return self.put_node(TokenNode(id, kind, label, origin.id, region), identifier(short))

    def add_edge(
        self,
        source: str,
        target: str,
        origin: Element,
        region: str,
        *,
        marked: bool = False,
        guard: Guard | None = None,
        interrupts: str = "",
        keeps: bool = False,
        listens: str = "",
    ) -> TokenEdge:
        """Add an edge. The first edge of a flow has the id of the flow."""
        label = flow_label(origin, self.nodes[source].label, self.nodes[target].label)
        variable = self.inputs.names.new(f"at_{self.short[source]}_to_{self.short[target]}")
        id = origin.id if self._has_free_id(origin) else derived_id(origin.id, variable)
        self._used.add(id)
        edge = TokenEdge(
            id,
            variable,
            label,
            source,
            target,
            (origin.id,),
            region,
            marked,
            guard,
            interrupts,
            keeps,
            listens,
        )
        self.edges.append(edge)
        self._reaching.setdefault(target, []).append(edge)
        return edge

    def add_path(
        self, node: Element, *nodes: str, marked: bool = False, guard: Guard | None = None
    ) -> list[TokenEdge]:
        """Add edges along the nodes; mark and guard belong to the first edge."""
        edges = []
        for source, target in pairwise(nodes):
            edges.append(self.add_edge(source, target, node, node.id, marked=marked, guard=guard))
            marked, guard = False, None
        return edges

    def exit_of(self, node: Element) -> str:
        """Return the node that the drawn flows of *node* leave."""
        return self.exits.get(node.id, node.id)

    def edges_into(self, id: str) -> list[TokenEdge]:
        """Return the edges so far that reach a node."""
        return self._reaching.get(id, [])

    def primary_flows(self, node: Element) -> list[Flow]:
        """Return the incoming flows without the flow that only brings the input of a decision."""
        input_flow = node.attrs.get("decision_input_flow")
        return [flow for flow in self.incoming[node.id] if flow.element.id != input_flow]

    def qualify_role(self, word: str, node: Element, region: str) -> str:
        """Return the role, followed by the part of the node if the region is one."""
        parts = self.drawing.parts.get(node.id, ())
        return " ".join([word, *(part.word for part in parts if part.id == region)])

    def _has_free_id(self, origin: Element) -> bool:
        is_flow = origin.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
        return is_flow and origin.id not in self._used


def lower_bound(pin: Element) -> int:
    """Return the lower bound of the multiplicity of a pin; 1 if it is no number."""
    bounds = query.bounds(pin.attrs.get("multiplicity"))
    return 1 if bounds is None else bounds[0]
