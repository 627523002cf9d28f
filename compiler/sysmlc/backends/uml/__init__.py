"""Back end ``uml``: the graph as SysML v1 in XMI, as Papyrus saves it."""

from msgspec import Struct

from sysmlc.backends.base import EmitOptions, name_compile_unit
from sysmlc.backends.uml.attributes import write_attributes
from sysmlc.backends.uml.containment import find_containing_feature
from sysmlc.backends.uml.context import Context, make_part_id
from sysmlc.backends.uml.events import find_or_add_signature, write_events
from sysmlc.backends.uml.hrefs import is_external, list_shipped_libraries
from sysmlc.backends.uml.metaclasses import (
    RECLASSIFIED_KINDS,
    UNSUPPORTED_KINDS,
    find_metaclass,
)
from sysmlc.backends.uml.node import Node
from sysmlc.backends.uml.relations import write_edges
from sysmlc.backends.uml.rules import (
    ILLEGAL_CHARACTERS,
    MOVED,
    RESPELT_ID,
    UNSUPPORTED_KIND,
    Losses,
    RoundTripFacts,
    is_plant,
)
from sysmlc.backends.uml.stereotypes import StereotypeWriter, write_profiles
from sysmlc.diagnostics import Sink, Subject
from sysmlc.ir import Edge, Element, Graph, Kind
from sysmlc.ir.compare.titles import spell_kind
from sysmlc.support import resources
from sysmlc.support.counts import count
from sysmlc.support.output import Output, assign_file_names
from sysmlc.support.xml_text import print_tree

_NAMESPACES = {
    "xmi": "http://www.omg.org/spec/XMI/20131001",
    "xsi": "http://www.w3.org/2001/XMLSchema-instance",
    "ecore": "http://www.eclipse.org/emf/2002/Ecore",
    "uml": "http://www.eclipse.org/uml2/5.0.0/UML",
}
_UNNAMED = frozenset(
    {
        Kind.COMMENT,
        Kind.SLOT,
        Kind.IMPORT,
        Kind.CONNECTOR_END,
        Kind.TEMPLATE_BINDING,
        Kind.TEMPLATE_SUBSTITUTION,
    }
)
"""Kinds without a name in UML; a template parameter has the name of the exposed element."""
_DERIVED_KINDS = frozenset({Kind.UNIT, Kind.QUANTITY_KIND, Kind.VIEW})
"""Kinds of elements that passes derive, besides external stubs."""
_VALUES = ("value", "default")
"""Attributes of the graph that hold values of model attributes."""
_CONDITIONS = {"precondition": "precondition", "postcondition": "postcondition"}
"""The feature that refers to an owned rule, by the rule's subkind."""
_TRANSITION_CONDITIONS = {"precondition": "preCondition", "postcondition": "postCondition"}


class UmlBackend(Struct, frozen=True):
    """Saves the graph of any front end as UML 2.5 with SysML 1.6, as Papyrus does."""

    name: str = "uml"
    summary: str = "the model as SysML 1.6 in XMI for Papyrus, uml/*.uml"
    is_default: bool = False
    needs: tuple[str, ...] = ()

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add ``uml/<unit>.uml`` and the shipped libraries; report what UML cannot express."""
        unit = name_compile_unit(graph, options)
        path = f"uml/{assign_file_names([unit])[unit]}.uml"
        output.add(path, write_document(graph, sink), (), self.name, name=unit)
        for library in list_shipped_libraries(graph):
            text = resources.read_text("metamodels", f"{library}.uml")
            output.add(f"uml/libraries/{library}.uml", text, (), self.name)


BACKEND = UmlBackend()


def write_document(graph: Graph, sink: Sink) -> str:
    """Return the graph as XMI; report what UML cannot express."""
    losses = Losses(graph)
    context = Context(graph, losses)
    if is_plant(graph):
        losses.round_trip = RoundTripFacts(graph, context.ids)
        losses.round_trip.store_libraries()
        losses.round_trip.store_caex_ids()
    # All nodes come first, because content refers only to elements that are written.
    for root in graph.roots():
        _add_nodes(context, root)
    for connector in graph.of_kind(Kind.CONNECTOR):
        # The classes that hold connectors of instances may be anywhere in the model.
        if _is_in_instance(graph, connector) and connector.owner in context.nodes:
            _add_nodes(context, connector)
    _write_content(context)
    document = Node("xmi:XMI", children=context.roots)
    stereotypes = StereotypeWriter(context, document)
    stereotypes.write_applications()
    write_profiles(context, stereotypes.packages)
    _write_round_trip_comment(context)
    _note_respelt_ids(context)
    namespaces = _NAMESPACES | stereotypes.namespaces
    document.attributes = {"xmi:version": "20131001"}
    text, replaced = print_tree(document, namespaces, lambda node: node.children)
    losses.report(sink)
    if replaced:
        subject = next((graph.subject(root) for root in graph.roots()), Subject())
        sink.report(ILLEGAL_CHARACTERS, subject, count=count(replaced, "character"))
    return text


def _note_respelt_ids(context: Context) -> None:
    """Count the values that name an element by an id which the saved element does not have."""
    respelt = {id for id, new_id in context.ids.items() if id != new_id}
    if not respelt:
        return
    for element in context.graph:
        if any(element.attrs.get(key) in respelt for key in _VALUES):
            context.losses.record(RESPELT_ID, element)


# -- nodes -------------------------------------------------------------------------------------


def _add_nodes(context: Context, root: Element) -> None:
    """Add nodes for an element and all elements below it, except connectors of instances."""
    stack = [root]
    while stack:
        element = stack.pop()
        if element is not root and _is_in_instance(context.graph, element):
            continue
        if _has_node(context, element):
            _add_node(context, element)
            stack.extend(reversed(context.graph.owned(element)))


def _is_in_instance(graph: Graph, element: Element) -> bool:
    """Whether the element is a connector that an instance owns."""
    owner = graph.owner(element)
    return element.kind is Kind.CONNECTOR and owner is not None and owner.kind is Kind.INSTANCE


def _has_node(context: Context, element: Element) -> bool:
    """Whether the element and those below it get nodes; count them if UML has none."""
    if is_external(element) or element.kind is Kind.APPLICATION:
        return False
    if element.kind in _DERIVED_KINDS and "origin" in element.attrs:
        return False
    if element.kind in UNSUPPORTED_KINDS:
        for member in context.graph.subtree(element):
            context.losses.record(UNSUPPORTED_KIND, member, kind=str(member.kind))
        return False
    return True


def _add_node(context: Context, element: Element) -> None:
    metaclass, is_complete = find_metaclass(context.graph, element)
    parent, feature = _find_container(context, element)
    if parent is None:
        node = Node(f"uml:{metaclass}", is_element=True)
        context.roots.append(node)
    else:
        node = Node(feature, {"xmi:type": f"uml:{metaclass}"}, is_element=True)
        parent.add(node)
    node.attributes["xmi:id"] = context.ids[element.id]
    _write_name(context, element, node)
    context.nodes[element.id] = node
    if element.kind in RECLASSIFIED_KINDS:
        context.losses.record_approximation(element, f"kind {spell_kind(element.kind)}", metaclass)
    elif not is_complete:
        original = f"{spell_kind(element.kind)} ({element.subkind})"
        context.losses.record_approximation(element, original, metaclass)


def _write_name(context: Context, element: Element, node: Node) -> None:
    if not element.name or element.kind is Kind.TEMPLATE_PARAMETER:
        return
    if element.kind not in _UNNAMED:
        node.attributes["name"] = element.name
        return
    feature = context.graph.target(element, Edge.INSTANCE_OF)
    if feature is None or feature.name != element.name:
        context.losses.record_attribute(element, "name")
    elif context.losses.round_trip is not None:
        # A slot is named after its feature, so that the name is no loss.
        context.losses.round_trip.store_attribute(element, "name")


def _find_container(context: Context, element: Element) -> tuple[Node | None, str]:
    """Return the node of the nearest owner that UML allows, and the feature.

    The node is None if the element has no such owner: it goes to the top of the document.
    """
    graph = context.graph
    if _is_in_instance(graph, element):
        _note_move(context, element)
        parent = _find_instance_class(context, element)
        return parent, "ownedConnector" if parent is not None else ""
    for depth, owner in enumerate(graph.ancestors(element)):
        feature = find_containing_feature(graph, owner, element)
        if feature:
            if depth:
                _note_move(context, element)
            if element.kind is Kind.TEMPLATE_PARAMETER:
                return find_or_add_signature(context, owner), feature
            return context.find_node(owner), feature
    if element.owner is not None:
        _note_move(context, element)
    return None, ""


def _find_instance_class(context: Context, connector: Element) -> Node | None:
    """Return the class of the instance that owns a connector: in UML instances own none."""
    owner = context.graph.owner(connector)
    classes = context.graph.targets(owner, Edge.INSTANCE_OF) if owner is not None else []
    return next((context.nodes[item.id] for item in classes if item.id in context.nodes), None)


def _note_move(context: Context, element: Element) -> None:
    owner = context.graph.owner(element)
    owner_kind = str(owner.kind) if owner is not None else "file"
    context.losses.record(MOVED, element, owner=owner_kind, kind=str(element.kind))


# -- content -----------------------------------------------------------------------------------


def _write_content(context: Context) -> None:
    graph = context.graph
    for id in list(context.nodes):
        write_edges(context, graph[id])
    write_events(context)
    for id in list(context.nodes):
        element = graph[id]
        write_attributes(context, element)
        if element.kind is Kind.CONSTRAINT:
            _write_condition_reference(context, element)
        if element.subkind == "collaboration":
            members = graph.owned(element)
            roles = [member for member in members if member.kind is Kind.PROPERTY]
            node = context.find_node(element)
            context.write_references(element, node, "collaborationRole", roles, "role")


def _write_condition_reference(context: Context, constraint: Element) -> None:
    """Refer from the owner to its pre- or postcondition, which is an owned rule among others."""
    owner = context.graph.owner(constraint)
    if owner is None or context.find_node(constraint).tag != "ownedRule":
        return
    feature = _find_condition_feature(owner, constraint)
    if feature:
        attributes = context.find_node(owner).attributes
        ids, id = attributes.get(feature), context.ids[constraint.id]
        attributes[feature] = f"{ids} {id}" if ids else id


def _find_condition_feature(owner: Element, rule: Element) -> str:
    """Return the feature by which an owner refers to one of its rules, or the empty string."""
    if owner.kind is Kind.TRANSITION:
        return _TRANSITION_CONDITIONS.get(rule.subkind, "")
    if rule.subkind == "invariant":
        return "stateInvariant" if owner.kind in (Kind.STATE, Kind.FINAL_STATE) else ""
    if owner.kind is Kind.OPERATION and rule.subkind == "body":
        return "bodyCondition"
    if owner.kind in (Kind.OPERATION, Kind.ACTIVITY, Kind.STATE_MACHINE, Kind.INTERACTION):
        return _CONDITIONS.get(rule.subkind, "")
    return ""


def _write_round_trip_comment(context: Context) -> None:
    """Add the comment for what UML cannot express of a plant to the first package."""
    round_trip = context.losses.round_trip
    if round_trip is None:
        return
    package = next((node for node in context.roots if node.tag == "uml:Package"), None)
    if package is None:
        id = make_part_id("kept", "package")
        package = Node("uml:Package", {"xmi:id": id, "name": "AutomationML"})
        context.roots.insert(0, package)
        round_trip.added.append(package.id)
    id = make_part_id(package.id, "kept")
    comment = Node("ownedComment", {"xmi:type": "uml:Comment", "xmi:id": id})
    comment.add(Node("body", text=round_trip.encode()))
    package.children.insert(0, comment)
