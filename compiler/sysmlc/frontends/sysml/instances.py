"""Usages in packages: lowered to instances if they only give values, else to classes."""

from sysmlc.frontends.sysml import annotations, nodes, quantities, values
from sysmlc.frontends.sysml.definitions import (
    foreign_attributes,
    lower_definition,
    read_kind,
    visibility_attributes,
)
from sysmlc.frontends.sysml.features import read_interface_id
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.frontends.sysml.preserved_facts import parse_fact_value
from sysmlc.frontends.sysml.trees import Trees
from sysmlc.ir import Edge, Element, Graph, Kind, as_items
from sysmlc.language.tree import Node

_UNIT_ROLES = {"SimpleUnit": "unit", "DerivedUnit": "unit", "QuantityDimension": "quantity kind"}
"""Roles of instances by their type in the standard library."""
_CLASS_ROLES = {"PortUsage": "interface block", "AttributeUsage": "value type"}
_LINK_NAMES = """
    ConnectionUsage InterfaceUsage BindingConnectorAsUsage FlowUsage Dependency AllocationUsage
"""
_LINKS = frozenset(_LINK_NAMES.split())


def lower_package_usage(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a usage that no definition owns: to a unit, an instance or a class."""
    type_names = [type_.name or "" for type_ in lowering.trees.types_of(node)]
    unit_role = next((_UNIT_ROLES[name] for name in type_names if name in _UNIT_ROLES), "")
    if unit_role:
        _lower_unit(lowering, node, owner, unit_role)
    elif _is_instance(node):
        _lower_instance(lowering, node, owner)
    else:
        kind = Kind.DATA_TYPE if node.kind == "AttributeUsage" else Kind.CLASS
        role = _CLASS_ROLES.get(node.kind, "block")
        class_ = lower_definition(lowering, node, owner, kind, role, usage=True)
        multiplicity = values.multiplicity_of(lowering.trees, node)
        lowering.set_attributes(class_, multiplicity=multiplicity)


def _lower_unit(lowering: Lowering, node: Node, owner: Element | None, role: str) -> None:
    unit = lowering.add_element(
        node, Kind.INSTANCE, node.name or "", owner, role=role, symbol=node.short_name
    )
    lowering.lower_annotations(node, unit)


def _is_instance(node: Node) -> bool:
    """Whether a usage only gives values to features of its type and links them."""
    return all(
        member.kind in _LINKS or (_is_redefinition(member) and _is_instance(member))
        for member in nodes.body_of(node)
        if not nodes.is_annotation(member)
    )


def _is_redefinition(node: Node) -> bool:
    """Whether a member redefines a structural feature."""
    is_structural = not node.kind.startswith(("Action", "State", "Perform", "Exhibit"))
    return nodes.find_reference(node, "Redefinition") is not None and is_structural


# -- instances and slots -----------------------------------------------------------------------


def _lower_instance(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a usage to an instance of its types, with a slot for each value."""
    _, subkind = read_kind(node, Kind.INSTANCE)
    attributes = visibility_attributes(node) | foreign_attributes(node)
    instance = lowering.add_element(
        node, Kind.INSTANCE, nodes.name_of(node), owner, subkind=subkind, **attributes
    )
    value = nodes.value_of(node)
    if value is not None:
        values.set_value(lowering, instance, "value", value)
    lowering.queue.defer_until_elements(lambda: _connect_types(lowering, node, instance))
    _lower_members(lowering, node, instance)


def _connect_types(lowering: Lowering, node: Node, instance: Element) -> None:
    lowering.connect_nodes(Edge.INSTANCE_OF, instance, lowering.trees.types_of(node))
    for reference in nodes.list_subsettings(node):
        subsetted = lowering.elements.find(reference.target)
        if subsetted is not None:
            lowering.graph.connect(Edge.INSTANCE_OF, instance, subsetted)


def _lower_members(lowering: Lowering, node: Node, instance: Element) -> None:
    for member in nodes.body_of(node):
        if nodes.is_annotation(member) or member.kind in _LINKS:
            lowering.lower(member, instance)
        elif read_interface_id(lowering, member, instance):
            continue
        elif _is_part(member):
            lower_part(lowering, member, instance)
        else:
            _lower_slot(lowering, member, instance)


def _is_part(node: Node) -> bool:
    """Whether a member of an instance contains further members, or is a part without a value."""
    is_part_usage = node.kind == "PartUsage" and nodes.value_of(node) is None
    return is_part_usage or not all(map(nodes.is_annotation, nodes.body_of(node)))


def is_marked_part(node: Node) -> bool:
    """Whether metadata marks a member of a class as values for a part: AutomationML repeats it."""
    return node.kind == "PartUsage" and read_kind(node, Kind.PROPERTY)[1] == "part"


def lower_part(lowering: Lowering, node: Node, owner: Element) -> None:
    """Lower values for a part of an instance or of a class to an instance inside it."""
    attributes = foreign_attributes(node)
    part = lowering.add_element(
        node, Kind.INSTANCE, nodes.name_of(node), owner, subkind="part", **attributes
    )
    reference = nodes.find_reference(node, "Redefinition", *nodes.SUBSETTINGS)
    lowering.connect_reference(Edge.REPRESENTS, part, reference)
    lowering.defer_edges(Edge.INSTANCE_OF, part, lowering.trees.types_of(node))
    lowering.queue.defer_until_edges(lambda: _name_after_part(lowering.graph, part))
    _lower_members(lowering, node, part)


def _name_after_part(graph: Graph, instance: Element) -> None:
    """Give the values for a part its name in the source, which metadata of the part may state."""
    part = graph.target(instance, Edge.REPRESENTS)
    if part is not None and part.name:
        graph.rename(instance, part.name)


def _lower_slot(lowering: Lowering, node: Node, owner: Element) -> None:
    slot = lowering.add_element(node, Kind.SLOT, nodes.name_of(node), owner)
    reference = nodes.find_reference(node, "Redefinition")
    lowering.connect_reference(Edge.INSTANCE_OF, slot, reference)
    value = nodes.value_of(node)
    if value is not None:
        _set_slot_value(lowering, slot, value)
    _set_interface_values(lowering.graph, node, slot)
    lowering.lower_annotations(node, slot)


def _set_interface_values(graph: Graph, node: Node, slot: Element) -> None:
    """Set the values that an instance gives to attributes of an interface of AutomationML."""
    texts = annotations.metadata_value(node, "AutomationML", "values")
    for text in () if texts is None else as_items(texts):
        name, _, value = str(text).partition("=")
        graph.set(slot, **{f"value.{name}": parse_fact_value(value)})


def _set_slot_value(lowering: Lowering, slot: Element, value: Node) -> None:
    """Set the value of a slot, or connect it to instances or enumeration literals of the unit."""
    instances = _list_instances(lowering.trees, value)
    if not instances:
        values.set_value(lowering, slot, "value", value)
        return
    quantities.set_kind(lowering.graph, slot, "value", value)
    lowering.defer_edges(Edge.REFERENCES, slot, instances)


def _list_instances(trees: Trees, value: Node) -> list[Node]:
    """Return the instances and literals of the unit to which each value of a sequence refers.

    A value that is no sequence is the only one. The list is empty if a value refers to nothing of
    the unit, or if an instance recurs: two elements have at most one edge of a kind.
    """
    instances: list[Node] = []
    expressions = [value]
    while expressions:
        expression = expressions.pop()
        if expression.attributes.get("operator") == ",":
            expressions.extend(reversed(nodes.list_arguments(expression)))
            continue
        is_reference = expression.kind == "FeatureReferenceExpression"
        target = nodes.find_target(expression, "Membership") if is_reference else None
        if target is None or trees.document_of(target) is None:
            return []
        instances.append(target)
    return instances if len(set(instances)) == len(instances) else []
