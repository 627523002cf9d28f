"""Parts that the graph folds into elements: events of triggers, signatures of templates."""

from sysmlc.backends.uml import values
from sysmlc.backends.uml.book import Book
from sysmlc.backends.uml.hrefs import is_outside, reference
from sysmlc.backends.uml.identity import part_id
from sysmlc.backends.uml.metaclasses import EVENTS
from sysmlc.backends.uml.node import Node
from sysmlc.ir import Edge, Element, Graph, Kind

_PACKAGES = (Kind.PACKAGE, Kind.PROFILE)


def write_events(book: Book) -> None:
    """An event for each trigger; triggers on whose event one stereotype is applied share it."""
    shared = _shared(book.graph)
    made: dict[str, Node] = {}
    for trigger in book.graph.of_kind(Kind.TRIGGER):
        if trigger.id in book.nodes:
            _event(book, trigger, shared.get(trigger.id, trigger.id), made)


def _shared(graph: Graph) -> dict[str, str]:
    found: dict[str, str] = {}
    for application in graph.of_kind(Kind.APPLICATION):
        if str(application.attrs.get("on", "")).endswith("-event"):
            holders = graph.targets(application, Edge.REFERENCES)
            first = next((found[one.id] for one in holders if one.id in found), None)
            for one in holders:
                found.setdefault(one.id, first or holders[0].id)
    return found


def _event(book: Book, trigger: Element, key: str, made: dict[str, Node]) -> None:
    graph, node = book.graph, book.node(trigger)
    outside = [one for one in graph.targets(trigger, Edge.REFERENCES) if is_outside(one)]
    if outside and not graph.targets(trigger, Edge.TYPED_BY):
        node.add(_outside(graph, trigger, outside[0]))
        return
    metaclass = EVENTS.get(trigger.subkind)
    if metaclass is None:
        return
    if key not in made:
        made[key] = _new_event(book, trigger, metaclass)
    node.attributes["event"] = made[key].id


def _outside(graph: Graph, trigger: Element, event: Element) -> Node:
    made = reference(graph, "event", event)
    if trigger.subkind in EVENTS:
        made.attributes["xmi:type"] = f"uml:{EVENTS[trigger.subkind]}"
    return made


def _new_event(book: Book, trigger: Element, metaclass: str) -> Node:
    graph = book.graph
    above = [one for one in graph.ancestors(trigger) if one.kind in _PACKAGES]
    id = part_id(trigger.id, "event")
    if above:
        made = book.node(above[0]).add(Node("packagedElement"))
        made.attributes = {"xmi:type": f"uml:{metaclass}", "xmi:id": id}
    else:
        made = Node(f"uml:{metaclass}", {"xmi:id": id})
        book.tops.append(made)
    if trigger.name:
        made.attributes["name"] = trigger.name
    feature = "operation" if trigger.subkind == "call" else "signal"
    targets = graph.targets(trigger, Edge.TYPED_BY)
    if targets and metaclass in ("SignalEvent", "CallEvent"):
        book.refer(trigger, made, feature, targets, "typed-by")
    _details(book, trigger, made)
    return made


def _details(book: Book, trigger: Element, event: Node) -> None:
    attrs = trigger.attrs
    for key, tag in (("when", "when"), ("condition", "changeExpression")):
        if key not in attrs:
            continue
        said, several = values.shown(attrs[key]), values.texts(attrs, f"{key}_")
        if several:
            made = book.part(trigger, event, tag, "OpaqueExpression")
            values.say(made, several[0], several[1])
        elif key == "when":
            values.timed(book, trigger, event, tag, "TimeExpression", said)
        else:
            values.opaque(book, trigger, event, tag, said)
    if attrs.get("relative"):
        event.attributes["isRelative"] = "true"


def signature_id(book: Book, template: str) -> str:
    """Id of the signature of the template with this id in the graph."""
    return part_id(template, "signature")


def signature(book: Book, template: Element) -> Node:
    """The signature that holds the parameters of a template."""
    node = book.node(template)
    for child in node.children:
        if child.tag == "ownedTemplateSignature":
            return child
    is_classifier = template.kind not in (Kind.PACKAGE, Kind.OPERATION)
    metaclass = "RedefinableTemplateSignature" if is_classifier else "TemplateSignature"
    made = node.add(Node("ownedTemplateSignature"))
    made.attributes = {
        "xmi:type": f"uml:{metaclass}",
        "xmi:id": signature_id(book, template.id),
    }
    return made
