"""Members that the text cannot write in the namespace of their owner.

A reference to a feature is valid only where a type around it has this feature.
"""

from collections.abc import Iterable, Iterator

from sysmlc.backends.sysml.plan import Member, Plan
from sysmlc.backends.sysml.rules import APPROXIMATED
from sysmlc.ir import Edge, Element, Kind


def move_members(plan: Plan) -> None:
    """Move members to the namespaces in which the text can write them."""
    _move_item_flows(plan)
    _move_messages(plan)
    _move_object_flows(plan)


def _move_item_flows(plan: Plan) -> None:
    """Move item flows to the namespace of their connectors, where their ends have names."""
    for flow in plan.graph.of_kind(Kind.ITEM_FLOW):
        member = plan.find(flow)
        connectors = [plan.find(target) for target in plan.graph.targets(flow, Edge.REALIZING)]
        namespaces = [connector.parent for connector in connectors if connector is not None]
        if member is None or not namespaces:
            continue
        namespace = namespaces[0]
        if namespace is None or namespace is member.parent:
            continue
        if all(other is namespace for other in namespaces):
            _move(plan, member, namespace)
            facts = {
                "construct": "the owner of an item flow",
                "replacement": "that of its connector",
            }
            plan.losses.record(APPROXIMATED, flow, **facts)


def _move_messages(plan: Plan) -> None:
    """Move messages to the operand that owns their events."""
    for message in plan.graph.of_kind(Kind.MESSAGE):
        member = plan.find(message)
        event = plan.graph.target(message, Edge.SEND_EVENT)
        if event is None or event.kind is not Kind.OCCURRENCE:
            event = plan.graph.target(message, Edge.RECEIVE_EVENT)
        operand = None if event is None else plan.find(plan.graph.owner(event))
        if member is None or member.parent is None or operand is None:
            continue
        if operand is not member.parent:
            _move(plan, member, operand)


def _move_object_flows(plan: Plan) -> None:
    """Move object flows between two nodes to a namespace that contains both nodes.

    An edge at an expansion node belongs to the region, but the node to the activity around it.
    """
    for flow in plan.graph.of_kind(Kind.OBJECT_FLOW):
        member = plan.find(flow)
        ends = [plan.graph.target(flow, edge) for edge in (Edge.FLOW_SOURCE, Edge.FLOW_TARGET)]
        if member is None or any(end is None or end.kind is Kind.CONTROL for end in ends):
            continue
        namespace = find_common_namespace(plan, member, ends)
        if namespace is not None and namespace is not member.parent:
            _move(plan, member, namespace)
            facts = {
                "construct": "the owner of an object flow",
                "replacement": "that of both its ends",
            }
            plan.losses.record(APPROXIMATED, flow, **facts)


def find_common_namespace(
    plan: Plan, flow: Member, nodes: Iterable[Element | None]
) -> Member | None:
    """Return the innermost namespace around a flow that contains all nodes, or None.

    Feature chains lead from there to the nodes, so that no definition may stand between.
    """
    shared = list(flow.namespaces)
    for node in nodes:
        member = find_object_node(plan, node)
        reachable = [] if member is None else list(iter_reaching_namespaces(member))
        shared = [space for space in shared if any(space is other for other in reachable)]
    return shared[0] if shared else None


def find_behaviour(plan: Plan, node: Element) -> Member | None:
    """Return the member of the nearest owner of a node that the text has a member for."""
    owners = (plan.find(ancestor) for ancestor in plan.graph.ancestors(node))
    return next((owner for owner in owners if owner is not None), None)


def find_object_node(plan: Plan, node: Element | None) -> Member | None:
    """Return the member that stands for an object node: for that of a parameter, the parameter."""
    member = plan.find(node)
    if node is not None and member is None and node.kind is Kind.ACTIVITY_PARAMETER:
        return plan.find(plan.graph.target(node, Edge.REFERENCES))
    return member


def iter_reaching_namespaces(member: Member) -> Iterator[Member]:
    """Yield the namespaces from which a feature chain through usages leads to a member."""
    for namespace in member.namespaces:
        yield namespace
        if not namespace.shape.is_usage:
            return


def _move(plan: Plan, member: Member, namespace: Member) -> None:
    (plan.roots if member.parent is None else member.parent.members).remove(member)
    member.parent = namespace
    namespace.members.append(member)
