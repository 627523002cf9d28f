"""Interactions: occurrences with lifelines and messages between them."""

from contextlib import suppress
from graphlib import CycleError
from itertools import pairwise

from sysmlc.frontends.sysml import annotations, nodes
from sysmlc.frontends.sysml.connections import list_payloads
from sysmlc.frontends.sysml.elements import NodeElements
from sysmlc.frontends.sysml.features import lower_property
from sysmlc.frontends.sysml.lowering import Lowering, QualifiedNames
from sysmlc.ir import Edge, Element, Graph, Kind, list_items
from sysmlc.ir.algorithms import sort_topologically
from sysmlc.ir.query.interactions import covered_lifelines, interaction_fragments
from sysmlc.language.tree import Node

_MESSAGE_EDGES = (
    (Edge.FLOW_SOURCE, Edge.SEND_EVENT),
    (Edge.FLOW_TARGET, Edge.RECEIVE_EVENT),
)
"""Edges of a message to a lifeline and to the occurrence on it, for each end."""


def lower_interaction_member(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower a feature of an interaction: a fragment, a lifeline, or a property.

    In a text of the back end ``sysml``, referential parts, ports and features that metadata marks
    are lifelines. In other models every feature is a lifeline.
    """
    if node.kind == "OccurrenceUsage":
        _lower_fragment(lowering, node, owner)
    elif _is_lifeline(node) or not _is_from_backend(node.owner):
        _lower_lifeline(lowering, node, owner)
    else:
        lower_property(lowering, node, owner)


def _is_lifeline(node: Node) -> bool:
    name = annotations.metadata_value(node, "Kind", "name")
    is_referential = node.attributes.get("isReference") or node.kind == "PortUsage"
    return name == "lifeline" or (bool(is_referential) and name != "property")


def _is_from_backend(interaction: Node | None) -> bool:
    if interaction is None:
        return False
    return annotations.metadata_value(interaction, "Kind", "name") == "interaction"


def _lower_fragment(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower a combined fragment or an operand; metadata of our library states which it is."""
    name = str(annotations.metadata_value(node, "Kind", "name") or "seq")
    kind, subkind = (Kind.OPERAND, "") if name == "operand" else (Kind.FRAGMENT, name)
    fragment = lowering.add_element(node, kind, nodes.name_of(node), owner, subkind=subkind)
    lowering.lower_all(nodes.body_of(node), fragment)


# -- lifelines ---------------------------------------------------------------------------------


def _lower_lifeline(lowering: Lowering, node: Node, owner: Element) -> None:
    lifeline = lowering.add_element(node, Kind.LIFELINE, nodes.name_of(node), owner)
    lowering.queue.defer_until_elements(lambda: _connect_represented(lowering, node, lifeline))
    for member in nodes.body_of(node):
        if member.kind == "EventOccurrenceUsage":
            lower_event(lowering, member, lifeline)
        elif nodes.is_annotation(member):
            lowering.lower(member, lifeline)
        else:
            lowering.verdicts.mark_approximated(member, "a feature of a lifeline", "nothing")


def _connect_represented(lowering: Lowering, node: Node, lifeline: Element) -> None:
    """Connect a lifeline to the feature it names, or to the only part of its type.

    If several parts have the type, the one with the name of the lifeline counts. The back end
    ``sysml`` names a feature that the lifeline cannot subset in metadata, which is read later.
    """
    preserved = list_items(annotations.metadata_value(node, "Kept", "attributes"))
    if any(str(fact).startswith(Edge.REPRESENTS.value) for fact in preserved):
        return
    reference = nodes.find_reference(node, "Redefinition", "ReferenceSubsetting", "Subsetting")
    if reference is not None:
        lowering.connect_node(Edge.REPRESENTS, lifeline, reference.target)
        return
    for type_ in lowering.trees.types_of(node):
        classifier = lowering.elements.find(type_)
        if classifier is None:
            continue
        typed = lowering.graph.sources(classifier, Edge.TYPED_BY)
        parts = [element for element in typed if element.kind is Kind.PROPERTY]
        candidates = [part for part in parts if part.name == lifeline.name] or parts
        if len(candidates) == 1:
            lowering.graph.connect(Edge.REPRESENTS, lifeline, candidates[0])


# -- messages ----------------------------------------------------------------------------------


def lower_message(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower a message from one lifeline to another."""
    sort = annotations.metadata_value(node, "Kind", "name") or "asynch-signal"
    message = lowering.add_element(
        node, Kind.MESSAGE, nodes.name_of(node), owner, subkind=str(sort)
    )
    operation = annotations.metadata_value(node, "Kind", "calls")
    payloads = list_payloads(node)
    if operation:
        lowering.queue.defer_until_edges(
            lambda: _connect_operation(lowering.graph, lowering.names, message, str(operation))
        )
    else:
        for payload in payloads:
            for reference in nodes.list_references(payload, "FeatureTyping"):
                lowering.connect_reference(Edge.CALLS, message, reference)
    lowering.queue.defer_until_edges(lambda: _connect_message(lowering, node, message))
    messages = [member for member in lowering.graph.owned(owner) if member.kind is Kind.MESSAGE]
    if messages == [message]:
        # After the connection of all messages and orderings.
        lowering.queue.defer_to_second_round(lambda: _order_occurrences(lowering.graph, owner))
    annotations.lower_only_annotations(lowering, node, message, "a message", payloads)


def _connect_operation(
    graph: Graph, names: QualifiedNames, message: Element, qualified_name: str
) -> None:
    """Connect a message to the operation whose qualified name metadata states."""
    operation = graph.get(names.id_of(qualified_name))
    if operation is not None:
        graph.connect(Edge.CALLS, message, operation)


def _connect_message(lowering: Lowering, node: Node, message: Element) -> None:
    """Connect a message to the lifelines at its ends and to the occurrences on them."""
    owner = lowering.graph.owner(message)
    ends = nodes.ends_of(node) or nodes.events_of(node)
    for (flow_edge, event_edge), end in zip(_MESSAGE_EDGES, ends, strict=False):
        elements = map(lowering.elements.find, nodes.path_of_end(end))
        path = [element for element in elements if element is not None]
        lifeline = next((element for element in path if element.kind is Kind.LIFELINE), None)
        if lifeline is None or owner is None:
            continue
        event = None if path[-1] is lifeline else path[-1]
        occurrence = _ensure_occurrence(lowering, owner, event)
        lowering.graph.connect(Edge.COVERS, occurrence, lifeline)
        lowering.graph.connect(flow_edge, message, lifeline)
        lowering.graph.connect(event_edge, message, occurrence)


def _ensure_occurrence(lowering: Lowering, owner: Element, event: Element | None) -> Element:
    """Return the event that the model names as end of a message, else add an occurrence."""
    if event is not None and event.kind is Kind.OCCURRENCE:
        return event
    occurrence = lowering.add_implied_child(owner, Kind.OCCURRENCE, "")
    lowering.set_attributes(occurrence, subkind="message")
    return occurrence


def _order_occurrences(graph: Graph, container: Element) -> None:
    """Put the fragments of an interaction in an order that its messages and successions allow.

    The text states the events of each lifeline together, so that document order is an order for
    each lifeline only. If the messages contradict it, they take precedence, because events without
    a succession are not ordered (SysML 2.0, 7.9.5). Contradictory messages change nothing.
    """
    fragments = interaction_fragments(graph, container)
    keys = {fragment.id: f"{index:06}" for index, fragment in enumerate(fragments)}
    stated = [
        (keys[source.id], keys[target.id])
        for member in graph.owned(container)
        for source, target in _list_ordered_pairs(graph, member)
        if source.id in keys and target.id in keys
    ]
    if all(source < target for source, target in stated):
        return
    on_lifelines: dict[str, list[str]] = {}
    for fragment in fragments:
        for lifeline in covered_lifelines(graph, fragment):
            on_lifelines.setdefault(lifeline.id, []).append(keys[fragment.id])
    implied = [pair for events in on_lifelines.values() for pair in pairwise(events)]
    for pairs in (stated + implied, stated):
        with suppress(CycleError):
            for key in list(sort_topologically(keys.values(), pairs)):
                fragment = fragments[int(key)]
                graph.move(fragment, None)
                graph.move(fragment, container)
            return


def _list_ordered_pairs(graph: Graph, member: Element) -> list[tuple[Element, Element]]:
    """Return the occurrence that a message or an ordering puts first, and the other one."""
    edges = {
        Kind.MESSAGE: (Edge.SEND_EVENT, Edge.RECEIVE_EVENT),
        Kind.GENERAL_ORDERING: (Edge.FLOW_SOURCE, Edge.FLOW_TARGET),
    }.get(member.kind)
    ends = [] if edges is None else [graph.target(member, edge) for edge in edges]
    present = [end for end in ends if end is not None]
    return [(present[0], present[1])] if len(present) == 2 else []


# -- events ------------------------------------------------------------------------------------


def lower_event(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower an event of a lifeline or of the interaction; it may be another event's name."""
    is_on_lifeline = owner.kind is Kind.LIFELINE
    interaction = lowering.graph.owner(owner) if is_on_lifeline else owner
    reference = nodes.find_reference(node, "ReferenceSubsetting")
    if reference is not None and not node.name:
        lowering.queue.defer_until_elements(
            lambda: _share_element(lowering.elements, node, reference.target)
        )
        return
    occurrence = lowering.add_element(
        node, Kind.OCCURRENCE, nodes.name_of(node), interaction, subkind="message"
    )
    if is_on_lifeline:
        lowering.graph.connect(Edge.COVERS, occurrence, owner)


def _share_element(elements: NodeElements, node: Node, target: Node | None) -> None:
    """Register the element of a referenced event as the element of the node, too."""
    element = elements.find(target)
    if element is not None:
        elements.own[id(node)] = element


def lower_event_order(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower a succession between events to a general ordering."""
    ends = nodes.ends_of(node)
    if len(ends) < 2:
        lowering.verdicts.mark_approximated(node, "an order of messages without ends", "nothing")
        return
    ordering = lowering.add_element(node, Kind.GENERAL_ORDERING, node.name or "", owner)
    lowering.queue.defer_until_edges(
        lambda: _connect_ordering(lowering.graph, lowering.elements, ordering, ends)
    )


def _connect_ordering(
    graph: Graph, elements: NodeElements, ordering: Element, ends: list[Node]
) -> None:
    for edge, end in zip((Edge.FLOW_SOURCE, Edge.FLOW_TARGET), ends, strict=False):
        path = nodes.path_of_end(end)
        event = elements.find(path[-1]) if path else None
        if event is not None:
            graph.connect(edge, ordering, event)
