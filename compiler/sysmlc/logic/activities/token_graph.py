"""Token graphs: activities as 1-safe token games.

The analysis ``activities`` derives a token graph from an activity diagram (UML 2.5.1, clauses 15
and 16; fUML 1.5, clause 8). Contracts, the reference interpreter and back ends read it.

In one step of the game, actions end, and their tokens pass all forks, joins, merges, object nodes,
silent actions and final nodes on their way: what follows runs in the next step
(docs/decisions/0046). A token rests on an edge when its target cannot take it yet, and for one step
on the edges that ``delays`` names. ``FIRING`` states what each kind of node does with tokens.

A region is the content of a structured node, or of the activity. An edge belongs to the innermost
region that contains both of its ends. A node moves tokens only while its region runs. A region is
complete when a token reaches one of its final nodes, or when nothing in it is left after the step.
"""

from collections.abc import Container, Iterator
from functools import cached_property

from msgspec import Struct

from sysmlc.logic.activities.token_nodes import (
    ACTIVITY_REGION,
    NO_START,
    Duration,
    Firing,
    Handshake,
    Interruptible,
    NodeKind,
    RegionStart,
    Store,
    TokenEdge,
    TokenNode,
)
from sysmlc.logic.contract import Variable
from sysmlc.logic.formula import Formula, variables


class TokenGraph(Struct, frozen=True, dict=True):
    """One activity as a token game; nodes and edges are in the order of the model.

    ``inputs`` are the variables that the environment decides. ``pulses`` names those that stand for
    an event or the end of an action; the others keep their value until they change. ``finishes`` is
    false if no run can end. ``rests`` are the regions that can be complete without a token at a
    final node (None: any of them). ``named_conditions`` are pairs of a region and the variable
    that is true when it is complete, or of an edge (id) and the variable that is true when it gets
    a token: formulas that would repeat a long condition refer to the variable.
    ``stores`` are the variables that nodes write. ``shared`` are variables that nodes write but
    that the activity alone does not decide: other behaviours write them, too, or they are features
    of parts; ``shared_inputs`` are further variables that these writes read. An activity without
    ``handshake`` starts in the first step, and again after each end.
    """

    activity: str
    component: str
    label: str
    nodes: tuple[TokenNode, ...]
    edges: tuple[TokenEdge, ...]
    inputs: tuple[Variable, ...] = ()
    pulses: tuple[str, ...] = ()
    interruptibles: tuple[Interruptible, ...] = ()
    finishes: bool = True
    rests: frozenset[str] | None = None
    named_conditions: tuple[tuple[str, str], ...] = ()
    stores: tuple[Store, ...] = ()
    shared: tuple[Store, ...] = ()
    shared_inputs: tuple[Variable, ...] = ()
    handshake: Handshake | None = None

    @cached_property
    def written_variables(self) -> frozenset[str]:
        """Names of the variables that nodes of the activity write."""
        return frozenset(store.variable.name for store in self.stores)

    def is_decided_outside(self, formula: Formula) -> bool:
        """Whether the condition reads an input."""
        return any(variable.name not in self.written_variables for variable in variables(formula))

    def is_decided_inside(self, formula: Formula) -> bool:
        """Whether the condition reads variables, all of which the activity writes."""
        return bool(variables(formula)) and not self.is_decided_outside(formula)

    @cached_property
    def _nodes(self) -> dict[str, TokenNode]:
        return {node.id: node for node in self.nodes}

    @cached_property
    def _incoming(self) -> dict[str, list[TokenEdge]]:
        edges: dict[str, list[TokenEdge]] = {node.id: [] for node in self.nodes}
        for edge in self.edges:
            edges[edge.target].append(edge)
        return edges

    @cached_property
    def _outgoing(self) -> dict[str, list[TokenEdge]]:
        edges: dict[str, list[TokenEdge]] = {node.id: [] for node in self.nodes}
        for edge in self.edges:
            edges[edge.source].append(edge)
        return edges

    def node(self, id: str) -> TokenNode:
        """Return the node with this id. Raises KeyError."""
        return self._nodes[id]

    @cached_property
    def _edges(self) -> dict[str, TokenEdge]:
        return {edge.id: edge for edge in self.edges}

    def find_edge(self, id: str) -> TokenEdge | None:
        """Return the edge with this id, if there is one."""
        return self._edges.get(id)

    def incoming(self, node: TokenNode) -> list[TokenEdge]:
        """Return the edges that reach the node, in order."""
        return self._incoming[node.id]

    def outgoing(self, node: TokenNode) -> list[TokenEdge]:
        """Return the edges that leave the node, in order."""
        return self._outgoing[node.id]

    def workers(self) -> Iterator[TokenNode]:
        """Iterate over the nodes that run for some steps and have a variable for that."""
        return (node for node in self.nodes if node.firing is Firing.WORK)

    @cached_property
    def _inside(self) -> dict[str, tuple[list[TokenEdge], list[TokenNode]]]:
        content: dict[str, tuple[list[TokenEdge], list[TokenNode]]] = {}
        for edge in self.edges:
            content.setdefault(edge.region, ([], []))[0].append(edge)
        for node in self.workers():
            content.setdefault(node.region, ([], []))[1].append(node)
        return content

    def inside(self, region: str) -> tuple[list[TokenEdge], list[TokenNode]]:
        """Return the edges and running nodes directly in a region."""
        return self._inside.get(region, ([], []))

    def regions(self) -> Iterator[str]:
        """Yield the region of the activity and that of every structured node."""
        yield ACTIVITY_REGION
        yield from (node.id for node in self.nodes if node.kind is NodeKind.STRUCTURED)

    def entering(self, interruptible: str) -> list[TokenEdge]:
        """Return the edges by which tokens enter an interruptible region, also from its start."""
        region = next(region for region in self.interruptibles if region.id == interruptible)
        members = frozenset(region.nodes)
        return [
            edge
            for edge in self.edges
            if edge.target in members
            and not edge.keeps
            and (edge.source not in members or self._nodes[edge.source].kind is NodeKind.INITIAL)
        ]

    def enters(self, edge: TokenEdge) -> bool:
        """Return whether the edge leads into a region from outside."""
        return self._nodes[edge.target].region != edge.region

    def is_entered_from_outside(self, node: TokenNode) -> bool:
        """Whether an edge from outside its region leads to the node."""
        return any(map(self.enters, self._incoming[node.id]))

    @property
    def takes_time(self) -> bool:
        """Whether the environment, or a called behaviour, decides when an action of it ends.

        The actions of other activities only assign, send and compute.
        """
        return any(
            node.kind is NodeKind.ACTION and node.duration is Duration.TIMED
            for node in self.workers()
        )

    def triggers(self, node: TokenNode) -> list[TokenEdge]:
        """Return the edges that prevent the completion of the region while all hold a token.

        These are the edges from inside the region, if the node has any: it then waits for the
        tokens from outside (docs/decisions/0013).
        """
        incoming = self._incoming[node.id]
        return [edge for edge in incoming if edge.region == node.region] or incoming

    @cached_property
    def _members(self) -> dict[str, list[TokenNode]]:
        members: dict[str, list[TokenNode]] = {}
        for node in self.nodes:
            members.setdefault(node.region, []).append(node)
        return members

    def members(self, region: str) -> list[TokenNode]:
        """Return the nodes directly in a region."""
        return self._members.get(region, [])

    def regions_around(self, region: str) -> Iterator[TokenNode]:
        """Yield the structured node of the region and those around it, innermost first."""
        while region != ACTIVITY_REGION:
            node = self._nodes[region]
            yield node
            region = node.region

    def nodes_between(self, inner: str, outer: str) -> Iterator[TokenNode]:
        """Yield the structured nodes from region *inner* up to, not including, region *outer*."""
        for node in self.regions_around(inner):
            if node.id == outer:
                return
            yield node

    def can_rest(self, region: str) -> bool:
        """Whether the region can be complete without a token at a final node."""
        return self.rests is None or region in self.rests

    def ends(self, region: str) -> list[TokenEdge]:
        """Return the edges whose token ends the region."""
        return [
            edge
            for node in self.members(region)
            if node.firing is Firing.END
            for edge in self._incoming[node.id]
        ]

    # -- steps ---------------------------------------------------------------------------------

    def can_choose(self, node: TokenNode) -> bool:
        """Whether several branches of the node can be open at the same time."""
        # Several else branches are open together, although UML allows only one.
        if node.firing is not Firing.CHOICE:
            return False
        branches = self._outgoing[node.id]
        else_count = sum(branch.is_else for branch in branches)
        guarded_count = len(branches) - else_count
        return else_count > 1 or (guarded_count > 1 and not node.exclusive)

    def delays(self, edge: TokenEdge) -> bool:
        """Whether a token that the edge gets moves on in the next step at the earliest.

        It waits for a decision, whose guards read the values after this step, on a branch that was
        chosen, where it interrupts a region, before the content of a structured node, and where a
        cycle has no action.
        """
        return edge.id in self._passing[0]

    @property
    def passing_edges(self) -> list[TokenEdge]:
        """The edges that leave nodes which pass tokens on in the step in which they get them.

        An edge comes after the edges that bring its tokens, and after those in nested regions, so
        that a computation that follows the flows back, in this order, needs no deep recursion.
        """
        return self._passing[1]

    @cached_property
    def _passing(self) -> tuple[frozenset[str], list[TokenEdge]]:
        """The ids of the edges that delay tokens, and the edges on which tokens pass, in order."""
        edges = {
            edge.id
            for edge in self.edges
            if self._nodes[edge.target].firing is Firing.CHOICE
            or self.can_choose(self._nodes[edge.source])
            or edge.interrupts
            or self.enters(edge)
        }
        # Depth first through nodes without steps: an edge back to an open node closes a cycle.
        opened: set[str] = set()
        closed: dict[str, None] = {}
        for node in self.nodes:
            path = [(node.id, self._iter_passing(node, edges))] if node.id not in closed else []
            opened |= {id for id, _ in path}
            while path:
                id, following = path[-1]
                edge = next(following, None)
                if edge is None:
                    closed[id] = None
                    opened.discard(id)
                    path.pop()
                elif edge.target in opened:
                    edges.add(edge.id)
                elif edge.target not in closed:
                    opened.add(edge.target)
                    path.append((edge.target, self._iter_passing(self._nodes[edge.target], edges)))
        ordered = sorted(
            map(self.node, reversed(closed)),
            key=lambda node: len(list(self.regions_around(node.region))),
            reverse=True,
        )
        return frozenset(edges), [
            edge for node in ordered for edge in self._iter_passing(node, frozenset())
        ]

    def _iter_passing(self, node: TokenNode, delaying: Container[str]) -> Iterator[TokenEdge]:
        """Iterate over the edges on which a token leaves the node in the step in which it comes."""
        passes = node.firing in (Firing.ANY, Firing.ALL)
        edges = self._outgoing[node.id] if passes else []
        return (edge for edge in edges if edge.id not in delaying)

    def list_delays(self, region: str) -> list[TokenEdge]:
        """List the edges that prevent the end of a region in the step in which they get a token.

        On those inside the region the token moves on after this step; those that leave the region
        interrupt it. The branches of a decision that can choose are omitted, because the decision
        itself prevents the end.
        """
        return self._delays.get(region, [])

    @cached_property
    def _delays(self) -> dict[str, list[TokenEdge]]:
        edges: dict[str, list[TokenEdge]] = {}
        for edge in self.edges:
            source = self._nodes[edge.source]
            if edge.interrupts and edge.region != source.region:
                edges.setdefault(source.region, []).append(edge)
            if self.delays(edge) and not self.enters(edge) and not self.can_choose(source):
                edges.setdefault(edge.region, []).append(edge)
        return edges

    def can_hold(self, edge: TokenEdge) -> bool:
        """Whether a token may be on the edge after a step."""
        return edge.id in self._holding

    @cached_property
    def _holding(self) -> frozenset[str]:
        resting = {id for region in self.regions() for id in self.start(region).tokens}
        return frozenset(
            edge.id for edge in self.edges if edge.id in resting or self._can_wait(edge)
        )

    def _can_wait(self, edge: TokenEdge) -> bool:
        """Whether the target may leave a token on the edge, or takes it in a later step."""
        target = self._nodes[edge.target]
        waits = target.queues or len(self._incoming[target.id]) > 1
        is_synchronous = target.firing in (Firing.ALL, Firing.WORK)
        is_stuck = edge.keeps or target.firing is Firing.NEVER
        return self.delays(edge) or is_stuck or (is_synchronous and waits)

    def start(self, region: str) -> RegionStart:
        """Return what a region has in its first step, without the content of nested regions.

        Its tokens have passed the nodes without steps. A token at a final node rests for the first
        step, so that each performance lasts one step at least.
        """
        return self._starts.get(region, NO_START)

    @cached_property
    def _starts(self) -> dict[str, RegionStart]:
        return {region: self._compute_start(region) for region in self.regions()}

    def _compute_start(self, region: str) -> RegionStart:
        tokens = {edge.id for edge in self.inside(region)[0] if edge.marked}
        moved: dict[str, TokenNode] = {}
        while True:
            ready = (node for node in self.members(region) if node.id not in moved)
            node = next((node for node in ready if self._starts_moving(node, tokens)), None)
            if node is None:
                break
            moved[node.id] = node
            taken = [edge for edge in self._incoming[node.id] if edge.id in tokens]
            tokens -= {edge.id for edge in taken if not edge.keeps}
            if node.firing is not Firing.WORK:
                tokens |= {edge.id for edge in self._outgoing[node.id]}
            for edge in self.inside(region)[0]:
                heard = bool(edge.listens) and any(e in taken for e in self.entering(edge.listens))
                if heard and edge.target not in moved:
                    tokens.add(edge.id)
        running = frozenset(id for id, node in moved.items() if node.firing is Firing.WORK)
        return RegionStart(frozenset(tokens), running, frozenset(moved))

    def _starts_moving(self, node: TokenNode, tokens: set[str]) -> bool:
        """Whether the node takes tokens before the first step of its region."""
        ready = [edge.id in tokens and not self.delays(edge) for edge in self._incoming[node.id]]
        if node.firing is Firing.WORK:
            return bool(ready) and all(ready)
        stays_inside = all(
            edge.region == node.region and not edge.interrupts for edge in self._outgoing[node.id]
        )
        is_all = node.firing is Firing.ALL and bool(ready) and all(ready)
        return stays_inside and (is_all or (node.firing is Firing.ANY and any(ready)))

    def start_all(self, region: str) -> RegionStart:
        """Return what a region has in its first step, with the content of nested regions."""
        start = self.start(region)
        tokens, running, moved = set(start.tokens), set(start.running), set(start.moved)
        for id in start.running:
            if self._nodes[id].kind is NodeKind.STRUCTURED:
                inner = self.start_all(id)
                tokens |= inner.tokens
                running |= inner.running
                moved |= inner.moved
        return RegionStart(frozenset(tokens), frozenset(running), frozenset(moved))
