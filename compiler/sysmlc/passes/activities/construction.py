"""From a drawing to a token graph: one node a node, one edge a flow, and what UML implies.

Implied are: the start of actions without incoming flows (an accept action listens again after
each event), the fork after an action, the join before it, the merge at a pin that several flows
reach, the choice at an object node that several flows leave, and the order of a sequence node.
"""

from collections.abc import Iterator

from msgspec.structs import replace

from sysmlc.diagnostics import Sink
from sysmlc.ir import Element, Graph, query
from sysmlc.ir.identity import derived_id
from sysmlc.logic.activities.token_graph import Interruptible, TokenGraph
from sysmlc.passes.activities import rules
from sysmlc.passes.activities.draft import Draft
from sysmlc.passes.activities.drawing import Drawing
from sysmlc.passes.activities.exception_analysis import Raising
from sysmlc.passes.activities.exceptions import add_exceptions, keep_handlers
from sysmlc.passes.activities.flows import add_flow, add_rest
from sysmlc.passes.activities.implied_control import ACCEPTS, add_order, add_start
from sysmlc.passes.activities.inputs import Inputs
from sysmlc.passes.activities.nodes import add_node
from sysmlc.passes.activities.regions import (
    FLOWS,
    Regions,
    interruptible_regions,
    is_entered_later,
)


def build(
    graph: Graph, drawing: Drawing, inputs: Inputs, raising: Raising, sink: Sink
) -> TokenGraph:
    """The token graph of a drawing; reports shapes that UML asks to be drawn otherwise."""
    draft = Draft(graph, drawing, inputs, raising, sink)
    keep_handlers(draft)
    for node in drawing.nodes:
        add_node(draft, node)
    add_exceptions(draft)
    for node in drawing.nodes:
        add_order(draft, node)
    for flow in drawing.flows:
        add_flow(draft, flow)
    regions = interruptible_regions(graph, drawing.inside, drawing.nodes)
    _find_listening(draft, regions)
    for node in drawing.nodes:
        add_rest(draft, node)
        add_start(draft, node)
    _check_events(draft)
    return _result(draft, regions)


def _check_events(draft: Draft) -> None:
    for event, takers in draft.takers.items():
        if len(takers) > 1:
            names = " and ".join(draft.drawing.labels[node.id] for node in takers)
            subject = draft.graph.subject(takers[0])
            draft.sink.report(rules.SHARED_EVENT, subject, nodes=names, event=event)


def _find_listening(draft: Draft, regions: Regions) -> None:
    """Accept actions without flows listen when a token enters their interruptible region."""
    for region, members in regions:
        open_ = [e for e in members if e.subkind in ACCEPTS and not draft.incoming[e.id]]
        for node in open_ if is_entered_later(draft.graph, members) else ():
            draft.listening[node.id] = region.id


def _result(draft: Draft, regions: Regions) -> TokenGraph:
    activity = draft.drawing.activity
    rounds = list(_rounds(draft))
    again = {edge: round.id for edges, round in rounds for edge in edges}
    edges = (
        replace(edge, interrupts=again[edge.id]) if edge.id in again else edge
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
            *_regions(draft, regions),
            *_exceptions(draft),
            *(round for _, round in rounds),
        ),
    )


def _regions(draft: Draft, regions: Regions) -> Iterator[Interruptible]:
    for region, members in regions:
        yield Interruptible(region.id, region.name, _members(draft, members))


def _members(draft: Draft, elements: list[Element]) -> tuple[str, ...]:
    """The region's nodes with what was added for them and their pins."""
    owners = {element.id for element in elements}
    return tuple(
        node.id
        for node in draft.nodes.values()
        if node.origin in owners or draft.graph[node.origin].owner in owners
    )


def _exceptions(draft: Draft) -> Iterator[Interruptible]:
    """What loses its tokens when an exception ends a structured node."""
    for id, catcher in draft.ended.items():
        members = (
            node.id
            for node in draft.nodes.values()
            if node.id == catcher.id or catcher.id in draft.drawing.around(node.region)
        )
        yield Interruptible(id, catcher.name, tuple(members))


def _rounds(draft: Draft) -> Iterator[tuple[list[str], Interruptible]]:
    """What is left over between the parts of a loop when it begins another round."""
    for id, back in draft.rounds.items():
        drawn = [e for e in draft.edges if e.region == id and draft.graph[e.origin].kind in FLOWS]
        members = dict.fromkeys(end for edge in drawn for end in (edge.source, edge.target))
        if members:
            name = draft.drawing.labels[id]
            yield back, Interruptible(derived_id(id, "rounds"), name, tuple(members))
