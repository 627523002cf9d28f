"""Edges: references, and relations that UML contains as parts of an element or as dependencies."""

from collections.abc import Callable, Sequence

from sysmlc.backends.uml.context import Context
from sysmlc.backends.uml.events import find_or_add_signature
from sysmlc.backends.uml.features import find_edge_feature
from sysmlc.backends.uml.hrefs import is_external, make_href
from sysmlc.backends.uml.node import Node
from sysmlc.backends.uml.sysml_profile import is_implied, iter_applications
from sysmlc.backends.uml.values import add_instance_value
from sysmlc.ir import Edge, Element, Kind, as_items
from sysmlc.ir.compare.titles import spell_kind

_Targets = Sequence[Element]
_Writer = Callable[[Context, Element, _Targets], None]
_BEHAVIORED = (
    Kind.CLASS,
    Kind.COMPONENT,
    Kind.ACTOR,
    Kind.USE_CASE,
    Kind.ACTIVITY,
    Kind.STATE_MACHINE,
    Kind.INTERACTION,
    Kind.ASSOCIATION,
)
"""Behaviored classifiers, which own interface realizations (UML 2.5.1 clause 10.4)."""
_DEPENDENCIES = {
    Edge.REALIZES: ("Realization", ""),
    Edge.DEPENDS: ("Dependency", ""),
    Edge.SATISFIES: ("Abstraction", "Satisfy"),
    Edge.DERIVES: ("Abstraction", "DeriveReqt"),
    Edge.VERIFIES: ("Abstraction", "Verify"),
    Edge.REFINES: ("Abstraction", "Refine"),
    Edge.TRACES: ("Abstraction", "Trace"),
    Edge.ALLOCATED_TO: ("Abstraction", "Allocate"),
}
"""Metaclass and stereotype of the dependency from which ``classify`` derives an edge."""


def write_edges(context: Context, element: Element) -> None:
    """Write all edges that leave an element."""
    for edge in context.edges:
        targets = context.graph.targets(element, edge)
        if not targets:
            continue
        writer = _WRITERS.get(edge) or _WRITERS_BY_KIND.get((element.kind, edge))
        if writer is not None:
            writer(context, element, targets)
        else:
            _write_references(context, element, edge, targets)


def _write_references(context: Context, element: Element, edge: Edge, targets: _Targets) -> None:
    """Write edges as references; an edge without a feature that nothing implies as a dependency."""
    by_feature: dict[str, list[Element]] = {}
    for target in targets:
        feature = find_edge_feature(element, edge, target)
        if feature and not _is_group_member(context, element, target):
            by_feature.setdefault(feature, []).append(target)
        elif not is_implied(context.graph, element, edge, target):
            _add_dependency(context, element, edge, target)
    node = context.find_node(element)
    for feature, elements in by_feature.items():
        context.write_references(element, node, feature, elements, edge.value)


def _write_classifier_behavior(context: Context, element: Element, targets: _Targets) -> None:
    """Write the first behaviour: a classifier of UML has at most one (UML 2.5.1, 10.5.1)."""
    first, *others = targets
    _write_references(context, element, Edge.CLASSIFIER_BEHAVIOR, [first])
    for target in others:
        context.note_lost_edge(element, Edge.CLASSIFIER_BEHAVIOR.value, target)


def _is_group_member(context: Context, comment: Element, target: Element) -> bool:
    """Whether the stereotype of an element group lists the target as a member."""
    if comment.kind is not Kind.COMMENT or comment.role != "element group":
        return False
    for application in iter_applications(context.graph, comment):
        for name in ("tag.member", "tag.orderedMember"):
            if target.id in as_items(application.attrs.get(name)):
                return True
    return False


def _write_subjects(context: Context, requirement: Element, subjects: _Targets) -> None:
    """Write the subjects of a requirement, which SysML v1 has not: they satisfy it."""
    satisfying = context.graph.sources(requirement, Edge.SATISFIES)
    for subject in subjects:
        if subject in satisfying:
            continue
        if not context.is_available(subject):
            context.note_lost_edge(requirement, Edge.SUBJECT.value, subject)
        else:
            dependency = _add_dependency(context, subject, Edge.SATISFIES, requirement)
            name = requirement.attrs.get("subject_name")
            if dependency is not None and name:
                # Formulas may call the subject by the name of the dependency.
                dependency.attributes["name"] = str(name)


def _add_dependency(context: Context, element: Element, edge: Edge, target: Element) -> Node | None:
    """Add a dependency that expresses an edge to the nearest package, or to the document.

    Return it, or None if the edge is lost.
    """
    if edge not in _DEPENDENCIES or not context.is_available(target):
        context.note_lost_edge(element, edge.value, target)
        return None
    metaclass, stereotype = _DEPENDENCIES[edge]
    owners = context.graph.ancestors(element)
    packages = (owner for owner in owners if owner.kind is Kind.PACKAGE)
    parent = next((context.nodes[p.id] for p in packages if p.id in context.nodes), None)
    dependency = context.add_part(element, parent or Node(""), "packagedElement", metaclass)
    dependency.attributes["client"] = context.ids[element.id]
    context.write_references(element, dependency, "supplier", [target], edge.value)
    if parent is None:
        dependency.tag = dependency.attributes.pop("xmi:type")
        context.roots.append(dependency)
    if stereotype:
        context.relation_stereotypes.append((stereotype, dependency.id))
    if context.losses.round_trip is not None:
        context.losses.round_trip.added.append(dependency.id)
        context.losses.round_trip.store_edge(edge, element, target)
    construct = f"'{edge}' from {spell_kind(element.kind)}"
    context.losses.record_approximation(element, construct, metaclass)
    return dependency


# -- parts of the source -----------------------------------------------------------------------


def _add_relation(
    context: Context, element: Element, tag: str, metaclass: str, feature: str, target: Element
) -> Node | None:
    """Add a directed relationship as a part of its source; None if the target is not written."""
    if not context.is_available(target):
        context.note_lost_edge(element, feature, target)
        return None
    relation = context.add_part(element, context.find_node(element), tag, metaclass)
    context.write_references(element, relation, feature, [target], feature)
    return relation


def _make_relation_writer(tag: str, metaclass: str, feature: str) -> _Writer:
    def write_relations(context: Context, element: Element, targets: _Targets) -> None:
        for target in targets:
            _add_relation(context, element, tag, metaclass, feature, target)

    return write_relations


def _write_realizations(context: Context, element: Element, targets: _Targets) -> None:
    for target in targets:
        if is_implied(context.graph, element, Edge.REALIZES, target):
            continue
        if element.kind is Kind.STATE_MACHINE and target.kind is Kind.STATE_MACHINE:
            tag, metaclass = "conformance", "ProtocolConformance"
            _add_relation(context, element, tag, metaclass, "generalMachine", target)
        elif element.kind in _BEHAVIORED and target.kind is Kind.INTERFACE:
            _add_interface_realization(context, element, target)
        else:
            _add_dependency(context, element, Edge.REALIZES, target)


def _add_interface_realization(context: Context, element: Element, target: Element) -> None:
    """Add an interface realization, which is a dependency and so has client and supplier, too."""
    tag, metaclass = "interfaceRealization", "InterfaceRealization"
    realization = _add_relation(context, element, tag, metaclass, "contract", target)
    if realization is not None:
        realization.attributes["client"] = context.ids[element.id]
        if not is_external(target):
            realization.attributes["supplier"] = context.ids[target.id]


def _write_extends(context: Context, element: Element, targets: _Targets) -> None:
    """Write the edges to extended use cases that no element Extend expresses."""
    extends = (part for part in context.graph.owned(element) if part.kind is Kind.EXTEND)
    expressed = {
        target.id for part in extends for target in context.graph.targets(part, Edge.EXTENDS)
    }
    for target in targets:
        if target.id not in expressed:
            _add_relation(context, element, "extend", "Extend", "extendedCase", target)


def _write_extensions(context: Context, stereotype: Element, metaclasses: _Targets) -> None:
    """Write each extension of a metaclass (UML 2.5.1 clause 12.3).

    It consists of a property of the stereotype, and an association that owns the opposite end.
    The profile owns the association.
    """
    node = context.find_node(stereotype)
    profile = context.graph.owner(stereotype)
    for metaclass in metaclasses:
        name = metaclass.name
        base = context.add_part(stereotype, node, "ownedAttribute", "Property")
        base.attributes["name"] = f"base_{name}"
        href = make_href(context.graph, metaclass)
        base.add(Node("type", {"xmi:type": "uml:Class", "href": href}))
        if profile is None:
            continue
        profile_node = context.find_node(profile)
        extension = context.add_part(stereotype, profile_node, "packagedElement", "Extension")
        base.attributes["association"] = extension.id
        extension.attributes["name"] = f"E_{stereotype.name}_{name}"
        end = context.add_part(stereotype, extension, "ownedEnd", "ExtensionEnd")
        end.attributes |= {
            "name": f"extension_{stereotype.name}",
            "type": context.ids[stereotype.id],
            "aggregation": "composite",
            "association": extension.id,
        }
        extension.attributes["memberEnd"] = f"{end.id} {base.id}"


# -- edges of single kinds ---------------------------------------------------------------------


def _write_guard(context: Context, element: Element, targets: _Targets) -> None:
    if element.kind is Kind.TRANSITION:
        node = context.find_node(element)
        context.write_references(element, node, "guard", targets, "guard")


def _note_foreign_behaviours(context: Context, element: Element, targets: _Targets) -> None:
    """Count behaviours of a state that another element owns; UML can only contain them."""
    for target in targets:
        if target.owner != element.id:
            context.note_lost_edge(element, "behaviour of another owner", target)


def _write_slot_instances(context: Context, slot: Element, targets: _Targets) -> None:
    for target in targets:
        if context.is_available(target):
            add_instance_value(context, slot, context.find_node(slot), "value", target)
        else:
            context.note_lost_edge(slot, "references", target)


def _write_part_with_port(context: Context, end: Element, targets: _Targets) -> None:
    """Write the last part on the path to the port; SysML's stereotype has the whole path."""
    if context.losses.round_trip is not None:
        for target in targets:
            context.losses.round_trip.store_edge(Edge.PATH, end, target)
    role = context.graph.target(end, Edge.ROLE)
    last = targets[-1]
    if role is None or role.kind is Kind.PORT or last is role or len(targets) == 1:
        node = context.find_node(end)
        context.write_references(end, node, "partWithPort", [last], "path")


def _write_generalization_set(context: Context, element: Element, targets: _Targets) -> None:
    """Refer to the first generalization of each classifier.

    The graph has edges to the classifiers, because its generalizations are no elements.
    """
    ids = []
    for target in targets:
        id = _find_generalization_id(context, target)
        if id:
            ids.append(id)
        else:
            context.note_lost_edge(element, "references", target)
    context.find_node(element).attributes["generalization"] = " ".join(ids)


def _find_generalization_id(context: Context, element: Element) -> str:
    """Return the id of the first generalization of an element, or the empty string."""
    node = context.nodes.get(element.id)
    if node is not None:
        for child in node.children:
            if child.tag == "generalization":
                return child.id
    return ""


def _write_template_binding(context: Context, binding: Element, targets: _Targets) -> None:
    node = context.find_node(binding)
    for target in targets:
        if target.id in context.nodes:
            node.attributes["signature"] = find_or_add_signature(context, target).id
        elif is_external(target):
            context.write_references(binding, node, "signature", [target], "binds")
            # The stub is the template, the reference leads to its signature.
            node.children[-1].attributes["xmi:type"] = "uml:TemplateSignature"


def _note_foreign_triggers(context: Context, element: Element, targets: _Targets) -> None:
    """Count triggers of other owners; ``events.py`` writes the events of triggers."""
    for target in targets:
        if element.kind is not Kind.TRIGGER and target.owner != element.id:
            context.note_lost_edge(element, "trigger", target)


def _note_ends_without_occurrence(context: Context, message: Element, targets: _Targets) -> None:
    """Count the lifelines of a message without events.

    UML relates a message to lifelines only by the occurrences at its ends (UML 2.5.1 clause 17.4).
    """
    edges = (Edge.SEND_EVENT, Edge.RECEIVE_EVENT)
    if not any(context.graph.targets(message, edge) for edge in edges):
        for target in targets:
            context.note_lost_edge(message, "end without occurrence", target)


def _make_message_event_writer(edge: Edge, feature: str) -> _Writer:
    def write_message_event(context: Context, message: Element, targets: _Targets) -> None:
        """Write the event of a message, and the message of the event."""
        node = context.find_node(message)
        context.write_references(message, node, feature, targets, edge.value)
        for target in targets:
            if target.id in context.nodes:
                context.find_node(target).attributes["message"] = context.ids[message.id]

    return write_message_event


def _write_member_ends(context: Context, association: Element, targets: _Targets) -> None:
    node = context.find_node(association)
    context.write_references(association, node, "memberEnd", targets, "end")
    for target in targets:
        if target.id in context.nodes:
            context.find_node(target).attributes["association"] = context.ids[association.id]


def _write_nothing(context: Context, element: Element, targets: _Targets) -> None:
    """Write nothing, because containment expresses the edge."""


_WRITERS: dict[Edge, _Writer] = {
    Edge.SPECIALIZES: _make_relation_writer("generalization", "Generalization", "general"),
    Edge.INCLUDES: _make_relation_writer("include", "Include", "addition"),
    Edge.REALIZES: _write_realizations,
    Edge.APPLIES: _make_relation_writer(
        "profileApplication", "ProfileApplication", "appliedProfile"
    ),
    Edge.CLASSIFIER_BEHAVIOR: _write_classifier_behavior,
    Edge.GUARD: _write_guard,
    Edge.ENTRY: _note_foreign_behaviours,
    Edge.DO: _note_foreign_behaviours,
    Edge.EXIT: _note_foreign_behaviours,
    Edge.EFFECT: _note_foreign_behaviours,
    Edge.TRIGGER: _note_foreign_triggers,
}
_WRITERS_BY_KIND: dict[tuple[Kind, Edge], _Writer] = {
    (Kind.CLASS, Edge.ASSUMES): _write_nothing,
    (Kind.CLASS, Edge.SUBJECT): _write_subjects,
    (Kind.REQUIREMENT, Edge.SUBJECT): _write_subjects,
    (Kind.USE_CASE, Edge.EXTENDS): _write_extends,
    (Kind.STEREOTYPE, Edge.EXTENDS): _write_extensions,
    (Kind.SLOT, Edge.REFERENCES): _write_slot_instances,
    (Kind.CONNECTOR_END, Edge.PATH): _write_part_with_port,
    (Kind.CONNECTOR, Edge.END): _write_nothing,
    (Kind.ASSOCIATION, Edge.END): _write_member_ends,
    (Kind.GENERALIZATION_SET, Edge.REFERENCES): _write_generalization_set,
    (Kind.TEMPLATE_BINDING, Edge.BINDS): _write_template_binding,
    (Kind.TRIGGER, Edge.TYPED_BY): _note_foreign_triggers,
    (Kind.TRIGGER, Edge.REFERENCES): _note_foreign_triggers,
    (Kind.MESSAGE, Edge.FLOW_SOURCE): _note_ends_without_occurrence,
    (Kind.MESSAGE, Edge.FLOW_TARGET): _note_ends_without_occurrence,
    (Kind.MESSAGE, Edge.SEND_EVENT): _make_message_event_writer(Edge.SEND_EVENT, "sendEvent"),
    (Kind.MESSAGE, Edge.RECEIVE_EVENT): _make_message_event_writer(
        Edge.RECEIVE_EVENT, "receiveEvent"
    ),
}
