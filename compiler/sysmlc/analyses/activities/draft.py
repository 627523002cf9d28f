"""A token graph under construction: nodes, edges, and names for their variables."""

from itertools import pairwise

from sysmlc.analyses.activities.drawing import Drawing, Flow, flow_label
from sysmlc.analyses.activities.inputs import DecisionInput, Inputs
from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, Kind, query
from sysmlc.ir.element import derived_id
from sysmlc.logic.activities.token_nodes import Guard, NodeKind, TokenEdge, TokenNode
from sysmlc.logic.identifiers import identifier


class Draft:
    """The nodes and edges added so far, and tables that the modules of this package share.

    The tables have ids as keys:

    - ``short_names``: the name of a node inside names of variables.
    - ``chained``: nodes that another node starts, so that they have no implied start.
    - ``decision_inputs``: the input that a decision compares with its literal guards.
    - ``exits``: for a node with exception handlers or a call that may fail, the node that its drawn
      flows leave instead, because they also wait for the handlers.
    - ``back_edges``: for a loop, the edge that begins another round.
    """

    def __init__(self, graph: Graph, drawing: Drawing, inputs: Inputs, sink: Sink) -> None:
        self.graph = graph
        self.drawing = drawing
        self.inputs = inputs
        self.sink = sink
        self.nodes: dict[str, TokenNode] = {}
        self.edges: dict[str, TokenEdge] = {}
        self.short_names: dict[str, str] = {}
        self.decision_inputs: dict[str, DecisionInput] = {}
        self.chained: set[str] = set()
        self.exits: dict[str, str] = {}
        self.back_edges: dict[str, str] = {}
        self._edges_by_target: dict[str, list[TokenEdge]] = {}

    @property
    def follows_v2(self) -> bool:
        """Whether tokens follow the rules of SysML v2 instead of those of UML."""
        return query.follows_v2(self.graph, self.drawing.activity)

    def put_node(self, node: TokenNode, short: str) -> TokenNode:
        """Add or replace a node."""
        self.nodes[node.id] = node
        self.short_names[node.id] = short
        return node

    def ensure_node(
        self, origin: Element, role: str, kind: NodeKind, label: str, region: str
    ) -> TokenNode:
        """Return the node with this role for the element *origin*; add it if it is missing."""
        id = derived_id(origin.id, role)
        if id in self.nodes:
            return self.nodes[id]
        short = f"{role}_{self.short_names.get(origin.id, identifier(origin.name, 'node'))}"
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
        """Add an edge. The first edge of a flow has the id of the flow, others a derived id."""
        label = flow_label(origin, self.nodes[source].label, self.nodes[target].label)
        variable = self.inputs.names.new(
            f"at_{self.short_names[source]}_to_{self.short_names[target]}"
        )
        id = origin.id if self._has_free_id(origin) else derived_id(origin.id, variable)
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
        self.edges[id] = edge
        self._edges_by_target.setdefault(target, []).append(edge)
        return edge

    def add_path(
        self, node: Element, *nodes: str, marked: bool = False, guard: Guard | None = None
    ) -> list[TokenEdge]:
        """Add edges that lead from node to node; only the first edge gets *marked* and *guard*."""
        edges = []
        for source, target in pairwise(nodes):
            edges.append(self.add_edge(source, target, node, node.id, marked=marked, guard=guard))
            marked, guard = False, None
        return edges

    def exit_of(self, node: Element) -> str:
        """Return the id of the token node that the drawn flows of *node* leave."""
        return self.exits.get(node.id, node.id)

    def edges_into(self, id: str) -> list[TokenEdge]:
        """Return the edges added so far that lead to a node."""
        return self._edges_by_target.get(id, [])

    def primary_flows(self, node: Element) -> list[Flow]:
        """Return the incoming flows of a node, without the decision input flow of a decision."""
        input_flow = node.attrs.get("decision_input_flow")
        return [flow for flow in self.drawing.incoming(node) if flow.element.id != input_flow]

    def qualify_role(self, word: str, node: Element, region: str) -> str:
        """Return *word*, followed by the name of the part if the region is a part of the node."""
        parts = self.drawing.parts.get(node.id, ())
        return " ".join([word, *(part.word for part in parts if part.id == region)])

    def _has_free_id(self, origin: Element) -> bool:
        is_flow = origin.kind in (Kind.CONTROL_FLOW, Kind.OBJECT_FLOW)
        return is_flow and origin.id not in self.edges


def lower_bound(pin: Element) -> int:
    """Return the lower bound of the multiplicity of a pin; 1 if it is not a number."""
    bounds = query.bounds(pin.attrs.get("multiplicity"))
    return 1 if bounds is None else bounds[0]
