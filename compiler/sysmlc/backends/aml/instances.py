"""What an internal element repeats of its class: values, descriptions, ids and attributes.

Instances are copies in AutomationML: a tool that reads an internal element does not look up the
attributes of its class.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.backends.aml.attributes import (
    find_declared_unit,
    is_attribute,
    write_attribute_type,
)
from sysmlc.backends.aml.class_kinds import ClassKind, is_inline
from sysmlc.backends.aml.context import Context, File
from sysmlc.backends.aml.header import add_description, write_header
from sysmlc.backends.aml.interfaces import find_or_repeat, write_port_attributes
from sysmlc.backends.aml.node import Node, format_value
from sysmlc.ir import AttrValue, Edge, Element, Kind, list_items
from sysmlc.ir.query.classifiers import name_value_unit

_COPIED = frozenset({"DefaultValue", "Value", "RefSemantic", "Constraint", "Attribute"})
"""Children of an attribute that its copy repeats."""
_FEATURES = frozenset({"Attribute", "ExternalInterface"})
_TYPE = "RefAttributeType"
_NOT_COPIED = frozenset({"ID", "ChangeMode"})
"""XML attributes that belong to one object only."""


@dataclass(slots=True, eq=False)
class SystemUnit:
    """An internal element, or a class, with the elements of the graph that it represents."""

    node: Node
    file: File
    part: Element | None = None
    instance: Element | None = None
    own_class: Element | None = None
    """The class itself, or the inline class of an internal element that extends its class."""
    children: list["SystemUnit"] = field(default_factory=list)

    @property
    def elements(self) -> list[Element]:
        """The elements that the node represents."""
        elements = (self.own_class, self.part, self.instance)
        return [element for element in elements if element is not None]


def is_part(context: Context, element: Element) -> bool:
    """Whether a property is written as an internal element."""
    if element.kind is not Kind.PROPERTY:
        return False
    if element.role == "part":
        type_ = context.graph.target(element, Edge.TYPED_BY)
        return type_ is None or _is_system_unit_type(context, type_)
    # The front end ``caex`` reads a mirror as a reference property.
    return element.role == "reference" and context.ids.is_from_caex(element)


def _is_system_unit_type(context: Context, type_: Element) -> bool:
    if is_inline(type_):
        return True
    entry = context.classes.get(type_.id)
    return entry is None or entry.kind is ClassKind.SYSTEM_UNIT


# -- values of the instance --------------------------------------------------------------------


def write_slot(context: Context, unit: SystemUnit, slot: Element) -> None:
    """Write the value that an instance gives to an attribute or interface of its class."""
    feature = context.graph.target(slot, Edge.INSTANCE_OF)
    if feature is None:
        return
    if feature.kind is not Kind.PORT and not is_attribute(context, feature):
        return
    context.mark_edge(Edge.INSTANCE_OF, slot, feature)
    path = _list_path(context, slot)
    if feature.kind is Kind.PORT:
        for port in path:
            find_or_repeat(context, port, unit.file, unit.node)
        node = find_or_repeat(context, feature, unit.file, unit.node)
        write_port_attributes(context, slot, feature, node)
    else:
        node = _find_or_repeat_attribute(context, unit, [*path, feature])
        has_value = any(child.tag == "Value" for child in node.children)
        value = _read_value(context, slot)
        if value is not None or not has_value:
            node.add_text("Value", format_value("" if value is None else value))
        if "value_unit" in slot.attrs or "default_unit" in feature.attrs:
            _write_value_unit(context, slot, feature, node)
    context.register(slot, node)
    write_header(context, slot, node)


def _read_value(context: Context, slot: Element) -> AttrValue:
    """Return the value of a slot: its literal value, or the names of enumeration literals.

    References to other instances are no values of an attribute; the loss report lists them.
    """
    targets = context.graph.targets(slot, Edge.REFERENCES)
    literals = [target for target in targets if target.kind is Kind.ENUMERATION_LITERAL]
    for literal in literals:
        context.mark_edge(Edge.REFERENCES, slot, literal)
    names = tuple(literal.name for literal in literals)
    return slot.attrs.get("value") if not names else names[0] if len(names) == 1 else names


def _write_value_unit(context: Context, slot: Element, feature: Element, node: Node) -> None:
    """Write the unit of a value, which may differ from that of the default value."""
    unit = name_value_unit(context.graph, slot, "value") or find_declared_unit(context, feature)
    if unit:
        node.attributes["Unit"] = unit
    else:
        node.attributes.pop("Unit", None)


def _list_path(context: Context, element: Element) -> list[Element]:
    """Return the outer features of a nested feature, the outermost first."""
    path = context.graph.targets(element, Edge.PATH)
    for feature in path:
        context.mark_edge(Edge.PATH, element, feature)
    return path


def _find_or_repeat_attribute(context: Context, unit: SystemUnit, path: list[Element]) -> Node:
    """Return the attribute at *path* in an internal element; add missing attributes as copies."""
    node = unit.node
    for feature in path:
        attribute = node.find_child("Attribute", feature.name)
        if attribute is None:
            attribute = node.add(Node("Attribute", {"Name": feature.name}, is_copy=True))
            write_attribute_type(context, feature, attribute, unit.file)
        node = attribute
    return node


def write_feature_description(context: Context, unit: SystemUnit, comment: Element) -> None:
    """Write the comment of an instance about an attribute of its class."""
    for feature in context.graph.targets(comment, Edge.REFERENCES):
        if feature.kind is Kind.PROPERTY and not is_part(context, feature):
            path = [*_list_path(context, comment), feature]
            add_description(context, comment, _find_or_repeat_attribute(context, unit, path))
            context.mark_edge(Edge.REFERENCES, comment, feature)


def write_interface_ids(context: Context, unit: SystemUnit) -> None:
    """Write the ids that interfaces of the class have in an internal element."""
    for element in unit.elements:
        for pair in list_items(element.attrs.get("interface_ids")):
            if isinstance(pair, tuple) and len(pair) == 2:
                port = context.graph.get(str(pair[0]))
                if port is not None:
                    node = find_or_repeat(context, port, unit.file, unit.node)
                    node.attributes["ID"] = str(pair[1])


# -- copies of attributes ----------------------------------------------------------------------


def copy_class_attributes(context: Context) -> None:
    """Add to every internal element the attributes that its classes have and it lacks."""
    type_paths = {path for _, kind, path in context.class_ids if kind is ClassKind.ATTRIBUTE}
    for node, declared in context.copies:
        for feature in _iter_features(context, declared):
            if feature.tag == "Attribute":
                _copy_attribute(node, feature, type_paths)
            else:
                _copy_interface_attributes(node, feature, type_paths)


def _iter_features(context: Context, type_: Element) -> Iterator[Node]:
    """Yield the own and inherited features of a class; a feature hides those of its name."""
    visited: set[tuple[str, str]] = set()
    for base in context.iter_bases(type_):
        node = context.nodes.get(base.id)
        if node is not None:
            for child in node.children:
                key = (child.tag, child.attributes.get("Name", ""))
                if child.tag in _FEATURES and key not in visited:
                    visited.add(key)
                    # A copy holds the value of one part; it is no feature that instances inherit.
                    if not child.is_copy:
                        yield child


def _copy_interface_attributes(node: Node, class_interface: Node, type_paths: set[str]) -> None:
    """Copy the attributes of an interface to the internal element's copy of the interface."""
    interface = node.find_child("ExternalInterface", class_interface.attributes["Name"])
    if interface is not None and interface.is_copy:
        for child in class_interface.children:
            if child.tag == "Attribute":
                _copy_attribute(interface, child, type_paths)


def _copy_attribute(node: Node, class_attribute: Node, type_paths: set[str]) -> None:
    """Add a copy of the attribute, or add to an existing copy what it lacks.

    The copy has the attribute type of the original only if *type_paths* contains it: a reference
    that could not be resolved is reported once, at the original.
    """
    stack = [(node, class_attribute)]
    while stack:
        parent, original = stack.pop()
        copy = parent.find_child("Attribute", original.attributes["Name"])
        if copy is None:
            copy = parent.add(Node("Attribute", is_copy=True))
            copy.attributes = {
                name: value
                for name, value in original.attributes.items()
                if name not in _NOT_COPIED
            }
            if copy.attributes.get(_TYPE) not in type_paths:
                copy.attributes.pop(_TYPE, None)
        if not copy.is_copy:
            continue
        present = {child.tag for child in copy.children}
        for child in original.children:
            if child.tag == "Attribute":
                stack.append((copy, child))
            elif child.tag in _COPIED and child.tag not in present:
                copy.add(child)
