"""Features of classifiers: properties, ports, enumeration literals."""

from sysmlc.frontends.sysml import annotations, nodes, values
from sysmlc.frontends.sysml.definitions import (
    foreign_attributes,
    read_kind,
    variation_attributes,
    visibility_attributes,
)
from sysmlc.frontends.sysml.elements import NodeElements
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, list_items
from sysmlc.ir.query import BEHAVIORS, generals
from sysmlc.language.tree import Node, Relation

_COMPOSITE = frozenset({"PartUsage", "ItemUsage", "OccurrenceUsage", "ConstraintUsage"})
_CLASS_ROLES = {"PortUsage": "interface block", "AttributeUsage": "value type"}
"""Roles of classes for usages with members of their own; others are blocks."""
_ROLES_WITH_FLOWS = frozenset({"block", "interface block", "value type", ""})
"""Roles of owners whose directed features are flow properties."""
_FLAGS = {
    "isAbstract": "abstract",
    "isDerived": "derived",
    "isConstant": "readonly",
    "isOrdered": "ordered",
    "isIndividual": "individual",
}
_RELATIONS_TO_FEATURES = frozenset({"Redefinition", *nodes.SUBSETTINGS})
_PART_PORTS = {"FullPort": "full port", "BlockPort": "port"}
"""Roles of ports of SysML v1 that a block types, by the keyword of the part in SysML v2."""


def lower_classifier_feature(lowering: Lowering, node: Node, owner: Element) -> Element:
    """Lower a feature of a classifier by its metaclass."""
    if owner.kind is Kind.ENUMERATION and node.kind in ("EnumerationUsage", "AttributeUsage"):
        return _lower_literal(lowering, node, owner)
    if node.kind == "PortUsage":
        return _lower_port(lowering, node, owner)
    for keyword in nodes.shipped_metadata_of(node):
        if keyword in _PART_PORTS:
            return _lower_part_port(lowering, node, owner, _PART_PORTS[keyword])
    return lower_property(lowering, node, owner)


def lower_property(lowering: Lowering, node: Node, owner: Element) -> Element:
    """Lower a feature; if it has members of its own, a class that is added for it types it."""
    kind, subkind = read_kind(node, Kind.PROPERTY)
    attributes = _feature_attributes(node, owner)
    property_ = lowering.add_element(
        node, kind, nodes.name_of(node), owner, subkind=subkind, **attributes
    )
    describe_feature(lowering, node, property_)
    _set_aggregation(node, property_)
    return property_


def _lower_literal(lowering: Lowering, node: Node, owner: Element) -> Element:
    literal = lowering.add_element(node, Kind.ENUMERATION_LITERAL, nodes.name_of(node), owner)
    value = nodes.value_of(node)
    if value is not None:
        values.set_value(lowering, literal, "value", value)
    annotations.lower_only_annotations(lowering, node, literal, "an enumerated value")
    return literal


def _feature_attributes(node: Node, owner: Element) -> dict[str, AttrValue]:
    direction = node.attributes.get("direction")
    attributes = visibility_attributes(node) | foreign_attributes(node) | variation_attributes(node)
    if direction is not None and owner.role == "constraint block":
        if direction != "in":
            attributes["direction"] = direction
    elif direction is not None:
        attributes["direction"] = direction
        attributes["role"] = "flow property" if owner.role in _ROLES_WITH_FLOWS else ""
    return attributes


def _set_aggregation(node: Node, property_: Element) -> None:
    keywords = nodes.shipped_metadata_of(node)
    is_owned = not node.attributes.get("isReference") and "direction" not in node.attributes
    # What an attribute has is referential (SysML 2.0, 8.2.2.6.2, note 1).
    is_owned &= node.owner is None or not node.owner.kind.startswith("Attribute")
    if "shared" in keywords or "SharedAggregation" in keywords:
        property_.attrs["aggregation"] = "shared"
    elif node.kind in _COMPOSITE and is_owned and not node.attributes.get("isEnd"):
        property_.attrs["aggregation"] = "composite"


# -- declarations of features ------------------------------------------------------------------


def describe_feature(lowering: Lowering, node: Node, feature: Element) -> None:
    """Add what a declaration states: flags, multiplicity, types, generals, value, members."""
    multiplicity = values.multiplicity_of(lowering.trees, node)
    # A cross feature has the flags of an end, like its multiplicity.
    holders = [holder for holder in (node, nodes.cross_feature_of(node)) if holder is not None]
    for holder in holders:
        lowering.set_attributes(feature, **_flags_of(holder), multiplicity=multiplicity)
    if any(holder.attributes.get("isUnique") is False for holder in holders):
        lowering.graph.set(feature, unique=False)
    _connect_relations(lowering, node, feature)
    value = nodes.value_of(node)
    if value is not None:
        values.set_value(lowering, feature, "default", value)
    if node.members:
        _lower_members(lowering, node, feature)


def _flags_of(node: Node) -> dict[str, AttrValue]:
    if _FLAGS.keys().isdisjoint(node.attributes):
        return {}
    return {flag: bool(node.attributes.get(attribute)) for attribute, flag in _FLAGS.items()}


def _connect_relations(lowering: Lowering, node: Node, feature: Element) -> None:
    """Connect a feature to its types and to the features that it redefines or subsets."""
    for relation in node.relations:
        _connect_relation(lowering, feature, relation)
    class_ = _add_usage_class(lowering, node, feature) if node.members else None
    if class_ is not None:
        lowering.graph.connect(Edge.TYPED_BY, feature, class_)
        return
    lowering.queue.defer_until_elements(lambda: connect_types(lowering, node, feature))


def _connect_relation(lowering: Lowering, feature: Element, relation: Relation) -> None:
    """Connect a redefined or subsetted feature; features of the library only give types."""
    if relation.kind == "ConjugatedPortTyping":
        lowering.set_attributes(feature, conjugated=True)
    if relation.kind not in _RELATIONS_TO_FEATURES:
        return
    reference = relation.reference
    if reference.target is not None and lowering.trees.document_of(reference.target) is None:
        return
    if relation.kind == "Redefinition":
        lowering.connect_reference(Edge.REDEFINES, feature, reference)
    else:
        lowering.queue.defer_until_elements(
            lambda: _connect_behaviour(lowering.graph, lowering.elements, feature, reference.target)
        )
        lowering.queue.defer_until_edges(
            lambda: _connect_subsetted(lowering, feature, reference.target)
        )


def _connect_behaviour(
    graph: Graph, elements: NodeElements, feature: Element, target: Node | None
) -> None:
    """Connect a subsetted behaviour as type: a behaviour of UML is no feature."""
    behaviour = elements.find(target)
    if behaviour is not None and _is_typed_by(feature, behaviour):
        graph.connect(Edge.TYPED_BY, feature, behaviour)


def _is_typed_by(feature: Element, subsetted: Element) -> bool:
    return subsetted.kind in BEHAVIORS and feature.kind is Kind.PROPERTY


def _connect_subsetted(lowering: Lowering, feature: Element, target: Node | None) -> None:
    """Connect a feature of the owner, or an inherited one, as subsetted; another as referenced."""
    subsetted = lowering.elements.find(target)
    if subsetted is not None and _is_typed_by(feature, subsetted):
        return
    classifier = lowering.graph.owner(feature)
    declaring = None if subsetted is None else lowering.graph.owner(subsetted)
    if subsetted is None or classifier is None or declaring is None:
        lowering.connect_node(Edge.SUBSETS, feature, target)
        return
    is_inherited = declaring is classifier or declaring in generals(lowering.graph, classifier)
    edge = Edge.SUBSETS if is_inherited else Edge.REFERENCES
    lowering.graph.connect(edge, feature, subsetted)


def connect_types(lowering: Lowering, node: Node, feature: Element) -> None:
    """Connect a feature to its types, stated or inherited; their elements must exist."""
    typings = nodes.list_references(node, "FeatureTyping", "ConjugatedPortTyping")
    for reference in typings:
        lowering.connect_node(Edge.TYPED_BY, feature, reference.target)
    if not typings:
        lowering.connect_nodes(Edge.TYPED_BY, feature, lowering.trees.types_of(node))


def _lower_members(lowering: Lowering, node: Node, feature: Element) -> None:
    """Lower annotations as members of the feature, and other members as those of its class."""
    class_ = lowering.elements.usage_classes.get(id(node))
    for member in nodes.body_of(node):
        if _describes_feature(member, node):
            lowering.lower(member, feature)
        elif class_ is not None and id(member) not in lowering.elements.redundant:
            lowering.lower(member, class_)


def _add_usage_class(lowering: Lowering, node: Node, feature: Element) -> Element | None:
    """Add a property-specific type for the members of a usage (SysML 1.6 clause 8.3.2.10)."""
    members = [
        member
        for member in nodes.body_of(node)
        if not _describes_feature(member, node) and not read_interface_id(lowering, member, feature)
    ]
    if not members:
        return None
    role = _CLASS_ROLES.get(node.kind, "block")
    class_ = lowering.add_derived(
        node,
        Kind.DATA_TYPE if role == "value type" else Kind.CLASS,
        feature.name,
        lowering.graph.owner(feature),
        role=role,
        property_specific=True,
    )
    if feature.attrs.pop("variation", False):
        lowering.set_attributes(class_, variation=True)
    lowering.elements.usage_classes[id(node)] = class_
    lowering.defer_edges(Edge.SPECIALIZES, class_, lowering.trees.types_of(node))
    # Metadata may give the feature another name than the text has.
    lowering.queue.defer_until_edges(lambda: lowering.graph.rename(class_, feature.name))
    return class_


def _describes_feature(member: Node, feature: Node) -> bool:
    """Whether a member is about the feature itself: an annotation, or what it realises."""
    if nodes.is_annotation(member):
        return not annotations.is_owned_by_type(member)
    is_realization = member.kind == "Dependency" and "Realization" in (
        nodes.shipped_metadata_of(member)
    )
    return is_realization and not member.name and nodes.find_target(member, "client") is feature


def read_interface_id(lowering: Lowering, node: Node, element: Element) -> bool:
    """Read a redefined port that only states its id in AutomationML; return whether it is one.

    The id becomes part of the attribute ``interface_ids`` of *element*, the usage with the port.
    """
    if node.kind != "PortUsage" or "AutomationML" not in nodes.shipped_metadata_of(node):
        return False
    target = nodes.find_target(node, "Redefinition")
    if len(nodes.body_of(node)) != 1 or target is None:
        return False
    interface_id = annotations.metadata_value(node, "AutomationML", "id")
    if interface_id is None:
        return False
    lowering.elements.redundant.add(id(node))
    lowering.verdicts.skipped.update(map(id, nodes.body_of(node)))
    lowering.queue.defer_until_elements(
        lambda: _add_interface_id(lowering.graph, lowering.elements, element, target, interface_id)
    )
    return True


def _add_interface_id(
    graph: Graph, elements: NodeElements, element: Element, target: Node, interface_id: AttrValue
) -> None:
    port = elements.find(target)
    if port is not None and element.kind is not Kind.CLASS:
        pairs = list_items(element.attrs.get("interface_ids"))
        graph.set(element, interface_ids=(*pairs, (port.id, interface_id)))


# -- ports -------------------------------------------------------------------------------------


def _lower_port(lowering: Lowering, node: Node, owner: Element) -> Element:
    """Lower a port; a port that only has a flow without a name is a flow port of SysML 1.2."""
    keywords = nodes.shipped_metadata_of(node)
    kind_name = annotations.metadata_value(node, "Kind", "name")
    role = "proxy port"
    if kind_name == "port" or "AutomationML" in keywords:
        role = "port"
    elif "FullPort" in keywords:
        role = "full port"
    attributes = _feature_attributes(node, owner)
    attributes |= {"role": role, "direction": node.attributes.get("direction")}
    port = lowering.add_element(node, Kind.PORT, nodes.name_of(node), owner, **attributes)
    flow = _find_only_flow(node)
    if flow is None:
        describe_feature(lowering, node, port)
        return port
    lowering.set_attributes(
        port,
        role="port" if kind_name == "port" else "flow port",
        direction=flow.attributes.get("direction"),
        multiplicity=values.multiplicity_of(lowering.trees, node),
    )
    for reference in nodes.list_references(flow, "FeatureTyping"):
        lowering.connect_reference(Edge.TYPED_BY, port, reference)
    lowering.verdicts.lowered.add(id(flow))
    lowering.lower_annotations(node, port)
    lowering.lower_annotations(flow, port)
    return port


def _find_only_flow(port: Node) -> Node | None:
    """Return the only member of an untyped port if this member is an unnamed reference."""
    members = [member for member in nodes.body_of(port) if not nodes.is_annotation(member)]
    if len(members) != 1 or port.relations:
        return None
    is_flow = members[0].kind == "ReferenceUsage" and not nodes.name_of(members[0])
    return members[0] if is_flow else None


def _lower_part_port(lowering: Lowering, node: Node, owner: Element, role: str) -> Element:
    """Lower a part whose keyword makes it a port of SysML v1 that a block types."""
    attributes = visibility_attributes(node)
    port = lowering.add_element(
        node, Kind.PORT, nodes.name_of(node), owner, role=role, **attributes
    )
    describe_feature(lowering, node, port)
    return port
