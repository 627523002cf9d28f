"""Construction of the token graph of a drawing: drawn nodes and flows, and what UML implies.

Implied are: the start of actions without incoming flows (an accept action listens again after each
event), the fork after an action, the join before it, the merge at a pin that several flows reach,
the choice at an object node that several flows leave, and the order of a sequence node.
"""

from collections.abc import Iterator

from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, query
from sysmlc.ir.element import derived_id
from sysmlc.logic.activities.token_graph import Interruptible, TokenGraph
from sysmlc.passes.activities import rules
from sysmlc.passes.activities.draft import Draft
from sysmlc.passes.activities.drawing import Drawing
from sysmlc.passes.activities.exception_analysis import Raising
from sysmlc.passes.activities.exceptions import add_exceptions, chain_handler_bodies
from sysmlc.passes.activities.flows import add_default_branch, add_flow
from sysmlc.passes.activities.implied_control import ACCEPTS, add_implied_start, chain_sequence_node
from sysmlc.passes.activities.inputs import Inputs
from sysmlc.passes.activities.nodes import add_node
from sysmlc.passes.activities.regions import (
    FLOWS,
    Regions,
    find_interruptible_regions,
    is_entered_later,
)


def build(
    graph: Graph, drawing: Drawing, inputs: Inputs, raising: Raising, sink: Sink
) -> TokenGraph:
    """Return the token graph of a drawing. Reports shapes that UML asks to be drawn otherwise."""
    draft = Draft(graph, drawing, inputs, raising, sink)
    # Before the nodes: pins of chained nodes are not reported as open.
    chain_handler_bodies(draft)
    for node in drawing.nodes:
        add_node(draft, node)
    # Before the flows: flows after a protected node leave its outcome.
    add_exceptions(draft)
    for node in drawing.nodes:
        chain_sequence_node(draft, node)
    for flow in drawing.flows:
        add_flow(draft, flow)
    regions = find_interruptible_regions(graph, drawing.inside, drawing.nodes)
    _find_listening_actions(draft, regions)
    for node in drawing.nodes:
        add_default_branch(draft, node)
        add_implied_start(draft, node)
    _check_events(draft)
    return _finish(draft, regions)


def _check_events(draft: Draft) -> None:
    for event, takers in draft.takers.items():
        if len(takers) > 1:
            names = " and ".join(draft.drawing.labels[node.id] for node in takers)
            subject = draft.graph.subject(takers[0])
            draft.sink.report(rules.SHARED_EVENT, subject, nodes=names, event=event)


def _find_listening_actions(draft: Draft, regions: Regions) -> None:
    """Let accept actions without flows listen when a token enters their interruptible region."""
    for region, members in regions:
        idle_actions = [e for e in members if e.subkind in ACCEPTS and not draft.incoming[e.id]]
        for node in idle_actions if is_entered_later(draft.graph, members) else ():
            draft.listening[node.id] = region.id


def _finish(draft: Draft, regions: Regions) -> TokenGraph:
    activity = draft.drawing.activity
    rounds = list(_list_rounds(draft))
    round_of_edge = {edge: round.id for edges, round in rounds for edge in edges}
    edges = (
        replace(edge, interrupts=round_of_edge[edge.id]) if edge.id in round_of_edge else edge
        for edge in draft.edges
    )
    return TokenGraph(
        activity=activity.id,
        component=query.component_name(draft.graph, activity),
        label=f"activity '{activity.name}'" if activity.name else "the activity",
        nodes=tuple(draft.nodes.values()),
        edges=tuple(edges),
        inputs=tuple(draft.inputs.variables.values()),
        pulses=tuple(draft.inputs.pulses),
        interruptibles=(
            *_describe_regions(draft, regions),
            *_list_exception_regions(draft),
            *(round for _, round in rounds),
        ),
    )


def _describe_regions(draft: Draft, regions: Regions) -> Iterator[Interruptible]:
    for region, members in regions:
        yield Interruptible(region.id, region.name, _list_members(draft, members))


def _list_members(draft: Draft, elements: list[Element]) -> tuple[str, ...]:
    """Return the nodes of the region and the nodes added for them and their pins."""
    owners = {element.id for element in elements}
    return tuple(
        node.id
        for node in draft.nodes.values()
        if node.origin in owners or draft.graph[node.origin].owner in owners
    )


def _list_exception_regions(draft: Draft) -> Iterator[Interruptible]:
    """Yield for each exception the nodes that lose their tokens when it ends a structured node."""
    for id, catcher in draft.ended.items():
        members = (
            node.id
            for node in draft.nodes.values()
            if node.id == catcher.id or catcher.id in draft.drawing.enclosing_regions(node.region)
        )
        yield Interruptible(id, catcher.name, tuple(members))


def _list_rounds(draft: Draft) -> Iterator[tuple[list[str], Interruptible]]:
    """Yield for each loop the nodes that lose their remaining tokens when a new round begins."""
    for id, back_edges in draft.rounds.items():
        edges = [e for e in draft.edges if e.region == id and draft.graph[e.origin].kind in FLOWS]
        members = dict.fromkeys(end for edge in edges for end in (edge.source, edge.target))
        if members:
            name = draft.drawing.labels[id]
            yield back_edges, Interruptible(derived_id(id, "rounds"), name, tuple(members))
