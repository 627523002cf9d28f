"""Elements of UML that the graph folds into others: events of triggers, template signatures."""

from sysmlc.backends.uml.context import Context, make_part_id
from sysmlc.backends.uml.hrefs import is_external, make_reference
from sysmlc.backends.uml.metaclasses import EVENTS
from sysmlc.backends.uml.node import Node
from sysmlc.backends.uml.values import (
    add_expression,
    add_time,
    format_value,
    read_bodies,
    write_bodies,
)
from sysmlc.ir import Edge, Element, Graph, Kind

_PACKAGES = (Kind.PACKAGE, Kind.PROFILE)


def write_events(context: Context) -> None:
    """Add an event for each trigger.

    Triggers share an event if one application gives their events a stereotype.
    """
    keys = _find_shared_events(context.graph)
    events: dict[str, Node] = {}
    for trigger in context.graph.of_kind(Kind.TRIGGER):
        if trigger.id in context.nodes:
            _write_event(context, trigger, keys.get(trigger.id, trigger.id), events)


def _find_shared_events(graph: Graph) -> dict[str, str]:
    """Map the id of each trigger to the id of the first trigger with the same event."""
    keys: dict[str, str] = {}
    for application in graph.of_kind(Kind.APPLICATION):
        if str(application.attrs.get("on", "")).endswith("-event"):
            triggers = graph.targets(application, Edge.REFERENCES)
            shared = next((keys[trigger.id] for trigger in triggers if trigger.id in keys), None)
            for trigger in triggers:
                keys.setdefault(trigger.id, shared or triggers[0].id)
    return keys


def _write_event(context: Context, trigger: Element, key: str, events: dict[str, Node]) -> None:
    """Refer to the event of a trigger; add the event if no trigger with the key has one."""
    graph, node = context.graph, context.find_node(trigger)
    references = graph.targets(trigger, Edge.REFERENCES)
    external = next((target for target in references if is_external(target)), None)
    metaclass = EVENTS.get(trigger.subkind)
    if external is not None and not graph.targets(trigger, Edge.TYPED_BY):
        reference = node.add(make_reference(graph, "event", external))
        if metaclass is not None:
            reference.attributes["xmi:type"] = f"uml:{metaclass}"
        return
    if metaclass is None:
        return
    if key not in events:
        events[key] = _make_event(context, trigger, metaclass)
    node.attributes["event"] = events[key].id


def _make_event(context: Context, trigger: Element, metaclass: str) -> Node:
    """Add an event to the nearest package of the trigger, or to the top of the document."""
    graph = context.graph
    packages = [owner for owner in graph.ancestors(trigger) if owner.kind in _PACKAGES]
    id = make_part_id(trigger.id, "event")
    if packages:
        event = context.find_node(packages[0]).add(Node("packagedElement"))
        event.attributes = {"xmi:type": f"uml:{metaclass}", "xmi:id": id}
    else:
        event = Node(f"uml:{metaclass}", {"xmi:id": id})
        context.roots.append(event)
    if trigger.name:
        event.attributes["name"] = trigger.name
    feature = "operation" if trigger.subkind == "call" else "signal"
    targets = graph.targets(trigger, Edge.TYPED_BY)
    if targets and metaclass in ("SignalEvent", "CallEvent"):
        context.write_references(trigger, event, feature, targets, "typed-by")
    _write_time_and_condition(context, trigger, event)
    return event


def _write_time_and_condition(context: Context, trigger: Element, event: Node) -> None:
    attrs = trigger.attrs
    for key, tag in (("when", "when"), ("condition", "changeExpression")):
        if key not in attrs:
            continue
        text, bodies = format_value(attrs[key]), read_bodies(attrs, f"{key}_")
        if bodies is not None:
            write_bodies(context.add_part(trigger, event, tag, "OpaqueExpression"), *bodies)
        elif key == "when":
            add_time(context, trigger, event, tag, "TimeExpression", text)
        else:
            add_expression(context, trigger, event, tag, text)
    if attrs.get("relative"):
        event.attributes["isRelative"] = "true"


def find_or_add_signature(context: Context, template: Element) -> Node:
    """Return the signature that holds the parameters of a template."""
    node = context.find_node(template)
    for child in node.children:
        if child.tag == "ownedTemplateSignature":
            return child
    is_classifier = template.kind not in (Kind.PACKAGE, Kind.OPERATION)
    metaclass = "RedefinableTemplateSignature" if is_classifier else "TemplateSignature"
    signature = node.add(Node("ownedTemplateSignature"))
    signature.attributes = {
        "xmi:type": f"uml:{metaclass}",
        "xmi:id": make_part_id(template.id, "signature"),
    }
    return signature
