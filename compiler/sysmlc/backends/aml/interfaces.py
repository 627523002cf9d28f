"""External interfaces: ports, with direction, cardinality, category and values."""

from sysmlc.backends.aml.attributes import is_attribute, make_attribute
from sysmlc.backends.aml.class_kinds import ClassKind, is_inline
from sysmlc.backends.aml.context import Context, File, find_unresolved
from sysmlc.backends.aml.header import write_header
from sysmlc.backends.aml.node import Node, find_data_type, format_value
from sysmlc.ir import AttrValue, Edge, Element, Kind

_DIRECTIONS = {"in": "In", "out": "Out", "inout": "InOut"}
"""Values of the attribute Direction of the class Port (IEC 62714-1)."""
_VALUE = "value."
"""Prefix of the attributes of a port, or slot, that hold values of interface attributes."""


def write_interface(context: Context, port: Element, file: File, parent: Node) -> Node:
    """Add the external interface of a port with all interfaces and attributes below it.

    A port whose type contains ports of the same type is written down to the first repetition.
    """
    root = _add_interface(context, port, file, parent)
    stack: list[tuple[Node, Element | None, frozenset[str]]]
    stack = [(root, _find_inline_type(context, port), frozenset())]
    while stack:
        node, type_, outer_types = stack.pop()
        if type_ is None or type_.id in outer_types:
            continue
        for member in context.list_owned(type_):
            if member.kind is Kind.PORT:
                inner = _add_interface(context, member, file, node)
                inner_type = _find_inline_type(context, member)
                stack.append((inner, inner_type, outer_types | {type_.id}))
            elif is_attribute(context, member):
                _replace_attribute(node, make_attribute(context, member, file))
    return root


def _replace_attribute(interface: Node, attribute: Node) -> None:
    """Add an attribute, and merge into it one of the same name that has only a value."""
    previous = interface.find_child("Attribute", attribute.attributes["Name"])
    interface.add(attribute)
    if previous is not None:
        present = {child.tag for child in attribute.children}
        attribute.children += [c for c in previous.children if c.tag not in present]
        interface.children.remove(previous)


def _add_interface(context: Context, port: Element, file: File, parent: Node) -> Node:
    node = context.register(port, Node("ExternalInterface", {"Name": port.name}))
    node.attributes["ID"] = context.ids.choose(port)
    parent.add(node)
    parent.interfaces[port.id] = node
    for target in context.graph.targets(port, Edge.REDEFINES):
        parent.interfaces.setdefault(target.id, node)
    _write_class_reference(context, port, node, file)
    write_port_attributes(context, port, port, node)
    write_header(context, port, node)
    return node


def _write_class_reference(context: Context, port: Element, node: Node, file: File) -> None:
    """Write the path of the interface class. A mirror gets the ID of its master later."""
    graph = context.graph
    master = graph.target(port, Edge.MIRRORS)
    if master is not None:
        for type_ in graph.targets(port, Edge.TYPED_BY):
            context.mark_edge(Edge.TYPED_BY, port, type_)
        context.mark_edge(Edge.MIRRORS, port, master)
        context.pending_references.append((node, "RefBaseClassPath", master))
        return
    path = _find_class_path(context, port, file) or find_unresolved(port, "ExternalInterface")
    if path:
        node.attributes["RefBaseClassPath"] = path


def _find_class_path(context: Context, port: Element, file: File) -> str:
    """Return the path of the interface class that types a port, or the empty string."""
    graph = context.graph
    for type_ in graph.targets(port, Edge.TYPED_BY):
        declared: Element | None = type_
        if is_inline(type_):
            declared = graph.target(type_, Edge.SPECIALIZES)
            context.written.add(type_.id)
            context.mark_edge(Edge.TYPED_BY, port, type_)
        if declared is None:
            continue
        context.mark_edge(Edge.TYPED_BY, port, type_)
        entry = context.classes.get(declared.id)
        if entry is not None and entry.kind is ClassKind.INTERFACE:
            path = context.make_class_path(declared, file)
            if path:
                return path
        context.losses.record_untyped(port, str(port.kind), declared)
    return ""


def _find_inline_type(context: Context, port: Element) -> Element | None:
    """Return the type that the front end made for an interface with members of its own."""
    type_ = context.graph.target(port, Edge.TYPED_BY)
    return type_ if type_ is not None and is_inline(type_) else None


# -- attributes --------------------------------------------------------------------------------


def write_port_attributes(context: Context, element: Element, port: Element, node: Node) -> None:
    """Add the attributes for direction, multiplicity, category and values of *element*.

    *element* is the port itself, or a slot with the values that an instance gives to the port.
    """
    attrs = element.attrs
    direction = _DIRECTIONS.get(str(attrs.get("direction")))
    if direction:
        _write_value(node, ["Direction"], direction)
    if "multiplicity" in attrs:
        lower, dots, upper = str(attrs["multiplicity"]).partition("..")
        cardinality = node.add(Node("Attribute", {"Name": "Cardinality"}))
        _write_value(cardinality, ["MinOccur"], lower)
        _write_value(cardinality, ["MaxOccur"], upper if dots else lower)
    if "category" in attrs:
        _write_value(node, ["Category"], str(attrs["category"]))
    for key in sorted(attrs):
        if key.startswith(_VALUE):
            _write_value(node, key.removeprefix(_VALUE).split("."), attrs[key])
    _use_data_types_of_class(context, context.graph.target(port, Edge.TYPED_BY), node)


def _write_value(node: Node, path: list[str], value: AttrValue) -> None:
    """Add a value to the attribute at a path of names; add the attributes that are absent."""
    for name in path:
        node = node.find_child("Attribute", name) or node.add(Node("Attribute", {"Name": name}))
    if find_data_type(value):
        node.attributes["AttributeDataType"] = find_data_type(value)
    node.add_text("Value", format_value(value))


def _use_data_types_of_class(context: Context, type_: Element | None, interface: Node) -> None:
    """Replace the data types derived from values by those that the interface class declares."""
    stack = [(type_, interface)]
    while stack:
        node_type, node = stack.pop()
        features = _find_value_properties(context, node_type)
        for child in node.children:
            feature = features.get(child.attributes.get("Name", ""))
            if child.tag != "Attribute" or feature is None:
                continue
            if child.attributes.pop("AttributeDataType", None) and "data_type" in feature.attrs:
                child.attributes["AttributeDataType"] = str(feature.attrs["data_type"])
            stack.append((context.graph.target(feature, Edge.TYPED_BY), child))


def _find_value_properties(context: Context, type_: Element | None) -> dict[str, Element]:
    """Return the own and inherited properties of a type by name; the nearest hides the others."""
    properties: dict[str, Element] = {}
    for base in context.iter_bases(type_):
        for member in context.graph.owned(base):
            if member.kind is Kind.PROPERTY:
                properties.setdefault(member.name, member)
    return properties


# -- interfaces of internal elements -----------------------------------------------------------


def find_or_repeat(context: Context, port: Element, file: File, parent: Node) -> Node:
    """Return the node for a port of the class in an internal element; add a copy if it is absent.

    The copy of a nested port stands in copies of the outer ports.
    """
    for step in [*reversed(_list_outer_ports(context, port)), port]:
        node = parent.interfaces.get(step.id)
        if node is None:
            node = parent.add(Node("ExternalInterface", {"Name": step.name}, is_copy=True))
            parent.interfaces[step.id] = node
            path = _find_class_path(context, step, file)
            if path:
                node.attributes["RefBaseClassPath"] = path
        parent = node
    return parent


def _list_outer_ports(context: Context, port: Element) -> list[Element]:
    """Return the ports that a port is nested in, the nearest first."""
    graph = context.graph
    outer_ports: list[Element] = []
    owner = graph.owner(port)
    while owner is not None and is_inline(owner) and owner.subkind == "external-interface":
        outer = graph.source(owner, Edge.TYPED_BY)
        if outer is None or outer in outer_ports:
            break
        outer_ports.append(outer)
        owner = graph.owner(outer)
    return outer_ports
