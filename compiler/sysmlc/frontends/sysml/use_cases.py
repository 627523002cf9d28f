"""Use cases: subject, actors, inclusions, extension points."""

from sysmlc.frontends.sysml import nodes
from sysmlc.frontends.sysml.definitions import lower_definition
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.requirements import lower_objective, lower_subject
from sysmlc.ir import Edge, Element, Kind
from sysmlc.language.tree import Node


def lower_use_case(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a use case definition or usage."""
    special = [member for member in nodes.body_of(node) if member.membership in _MEMBER_HANDLERS]
    lowering.verdicts.skipped.update(id(member) for member in special)
    use_case = lower_definition(lowering, node, owner, Kind.USE_CASE, "")
    for member in special:
        _MEMBER_HANDLERS[member.membership](lowering, member, use_case)


def lower_inclusion(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower the inclusion of another use case to an edge."""
    if owner is None:
        lowering.verdicts.mark_unsupported(node)
        return
    included = nodes.find_reference(node, "ReferenceSubsetting", "FeatureTyping", "Subsetting")
    lowering.connect_reference(Edge.INCLUDES, owner, included)


def lower_extension_point(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower an event of a use case to an extension point."""
    lowering.add_element(node, Kind.EXTENSION_POINT, nodes.name_of(node), owner)


# -- actors ------------------------------------------------------------------------------------


def _lower_actor(lowering: Lowering, node: Node, use_case: Element) -> None:
    """Lower an actor to an association with the use case (UML 2.5.1 clause 18.1.3)."""
    # Associations that the model states get their ends in the first round.
    lowering.queue.defer_to_second_round(lambda: _associate(lowering, node, use_case))


def _associate(lowering: Lowering, node: Node, use_case: Element) -> None:
    association = _find_association(lowering, node, use_case)
    if association is not None:
        lowering.elements.own[id(node)] = association
        return
    graph = lowering.graph
    association = lowering.add_element(node, Kind.ASSOCIATION, "", graph.owner(use_case))
    case_end = lowering.add_derived(node, Kind.PROPERTY, "", association)
    graph.connect(Edge.END, association, case_end)
    graph.connect(Edge.TYPED_BY, case_end, use_case)
    actor_end = lowering.add_derived(node, Kind.PROPERTY, nodes.name_of(node), association)
    graph.connect(Edge.END, association, actor_end)
    lowering.defer_edges(Edge.TYPED_BY, actor_end, lowering.trees.types_of(node))


def _find_association(lowering: Lowering, actor: Node, use_case: Element) -> Element | None:
    """Return an association of the model between a use case and the type of an actor."""
    graph = lowering.graph
    types = [lowering.elements.find(type_) for type_ in lowering.trees.types_of(actor)]
    for end in graph.sources(use_case, Edge.TYPED_BY):
        for association in graph.sources(end, Edge.END):
            ends = graph.targets(association, Edge.END)
            if any(graph.target(end, Edge.TYPED_BY) in types for end in ends):
                return association
    return None


_MEMBER_HANDLERS = {
    "SubjectMembership": lower_subject,
    "ActorMembership": _lower_actor,
    "StakeholderMembership": _lower_actor,
    "ObjectiveMembership": lower_objective,
}
