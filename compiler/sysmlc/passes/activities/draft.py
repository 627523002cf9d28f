"""A token graph while it grows: nodes, edges, and names for their variables."""

from itertools import pairwise

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.ir.identity import derived_id
from sysmlc.logic.activities.token_graph import Guard, NodeKind, TokenEdge, TokenNode
from sysmlc.logic.names import identifier
from sysmlc.passes.activities.drawing import Drawing, Flow, flow_label
from sysmlc.passes.activities.exception_analysis import Raising
from sysmlc.passes.activities.inputs import Answer, Inputs


class Draft:
    """Nodes and edges so far; ``short`` has the name of each node inside variables.

    ``chained`` holds nodes that do not start by themselves, ``takers`` the accept actions by
    event, ``answers`` the inputs of decisions. ``exits`` leads from a node to the one that its
    drawn flows leave when they wait for handlers of exceptions, ``rounds`` from a loop to the
    edges that begin another round. ``ended`` holds the structured nodes that exceptions end,
    ``failing`` the calls that may end with an exception. ``listening`` leads from an accept action
    to the interruptible region whose tokens make it listen.
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

    def put(self, node: TokenNode, short: str) -> TokenNode:
        """Add or replace a node."""
        self.nodes[node.id] = node
        self.short[node.id] = short
        return node

    def extra(self, base: Element, role: str, kind: NodeKind, label: str, region: str) -> TokenNode:
        """The node that plays a role for what is drawn, added when it is asked for first."""
        id = derived_id(base.id, role)
        if id in self.nodes:
            return self.nodes[id]
        short = f"{role}_{self.short.get(base.id, identifier(base.name, 'node'))}"
        return self.put(TokenNode(id, kind, label, base.id, region), identifier(short))

    def link(
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
        """Add an edge; the first one of a flow has the flow's id."""
        label = flow_label(origin, self.nodes[source].label, self.nodes[target].label)
        variable = self.inputs.names.new(f"at_{self.short[source]}_to_{self.short[target]}")
        id = origin.id if self._is_free(origin) else derived_id(origin.id, variable)
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

    def path(
        self, node: Element, *path: str, marked: bool = False, guard: Guard | None = None
    ) -> list[TokenEdge]:
        """Edges along the nodes; mark and guard belong to the first one."""
        made = []
        for source, target in pairwise(path):
            made.append(self.link(source, target, node, node.id, marked=marked, guard=guard))
            marked, guard = False, None
        return made

    def exit(self, node: Element) -> str:
        """The node that the drawn flows of ``node`` leave."""
        return self.exits.get(node.id, node.id)

    def reaching(self, id: str) -> list[TokenEdge]:
        """Edges so far that reach a node."""
        return self._reaching.get(id, [])

    def primary(self, node: Element) -> list[Flow]:
        """Incoming flows without the flow that only brings a decision's input."""
        side = node.attrs.get("decision_input_flow")
        return [flow for flow in self.incoming[node.id] if flow.element.id != side]

    def role(self, word: str, node: Element, region: str) -> str:
        """The word, and the part of the node that the region is."""
        parts = self.drawing.parts.get(node.id, ())
        return " ".join([word, *(part.word for part in parts if part.id == region)])

    def _is_free(self, origin: Element) -> bool:
        is_flow = origin.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
        return is_flow and origin.id not in self._used


def least(pin: Element) -> int:
    """The lower bound of the pin's multiplicity; 1 when it is no number."""
    bounds = query.bounds(pin.attrs.get("multiplicity"))
    return 1 if bounds is None else bounds[0]
