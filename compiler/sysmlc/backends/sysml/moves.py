"""What stands elsewhere than in the model, because only there its ends can be named."""

from sysmlc.backends.sysml.entry import Plan
from sysmlc.backends.sysml.rules import APPROXIMATED
from sysmlc.ir import Edge, Kind


def move_flows(plan: Plan) -> None:
    """Item flows stand beside the connectors that realise them, where the ends can be named."""
    for flow in plan.graph.of_kind(Kind.ITEM_FLOW):
        entry = plan.entry(flow)
        realizing = [plan.entry(one) for one in plan.graph.targets(flow, Edge.REALIZING)]
        homes = [one.parent for one in realizing if one is not None]
        if entry is None or not homes or homes[0] is None or homes[0] is entry.parent:
            continue
        if all(one is homes[0] for one in homes):
            (plan.tops if entry.parent is None else entry.parent.members).remove(entry)
            entry.parent = homes[0]
            homes[0].members.append(entry)
            facts = {"said": "the owner of an item flow", "written": "that of its connector"}
            plan.losses.note(APPROXIMATED, flow, **facts)


def move_messages(plan: Plan) -> None:
    """Messages stand in the operand in which they are sent."""
    for message in plan.graph.of_kind(Kind.MESSAGE):
        entry = plan.entry(message)
        event = plan.graph.target(message, Edge.SEND_EVENT)
        if event is None or event.kind is not Kind.OCCURRENCE:
            event = plan.graph.target(message, Edge.RECEIVE_EVENT)
        home = None if event is None else plan.entry(plan.graph.owner(event))
        if entry is None or entry.parent is None or home is None or home is entry.parent:
            continue
        entry.parent.members.remove(entry)
        entry.parent = home
        home.members.append(entry)
