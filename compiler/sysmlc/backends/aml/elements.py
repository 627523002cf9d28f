"""Internal elements: parts of classes, instances, facets and groups."""

from sysmlc.backends.aml import roles
from sysmlc.backends.aml.attributes import is_attribute, make_attribute
from sysmlc.backends.aml.class_kinds import ClassKind, find_class_kind, is_inline
from sysmlc.backends.aml.context import Context, File, find_unresolved
from sysmlc.backends.aml.header import write_header
from sysmlc.backends.aml.instances import (
    SystemUnit,
    is_part,
    write_feature_description,
    write_interface_ids,
    write_slot,
)
from sysmlc.backends.aml.interfaces import write_interface
from sysmlc.backends.aml.node import Node
from sysmlc.ir import Edge, Element, Kind, list_items
from sysmlc.ir.element import derived_id

_REFERENCE = "RefBaseSystemUnitPath"
_INTERNAL_ELEMENT = ("InternalElement", _REFERENCE)
_BASE_ROLE = "AutomationMLBaseRoleClassLib/AutomationMLBaseRole"
_GROUP_ROLES = {Kind.FACET: f"{_BASE_ROLE}/Facet", Kind.GROUP: f"{_BASE_ROLE}/Group"}
"""Role classes that make an internal element a facet or a group (IEC 62714-1)."""
_FACET_MIRRORS = {
    Kind.PROPERTY: ("Attribute", "RefAttributeType"),
    Kind.PORT: ("ExternalInterface", "RefBaseClassPath"),
}
"""Tag of the mirror, and its XML attribute that names the master, by the kind of the master."""


def fill_class(context: Context, element: Element, node: Node, file: File) -> None:
    """Write the content of a system unit class or role class, with all internal elements in it."""
    _fill_unit(context, SystemUnit(node, file, own_class=element))


def fill_hierarchy(context: Context, package: Element, node: Node, file: File) -> None:
    """Write the internal elements of an instance hierarchy, with all internal elements in them."""
    for element in context.graph.owned(package):
        if _is_plant_object(context, element):
            _fill_unit(context, _make_unit(context, node, file, None, element))
        elif element.kind in _GROUP_ROLES:
            node.add(_make_group(context, element, file))


def has_plant_objects(context: Context, package: Element) -> bool:
    """Whether a package owns instances that an instance hierarchy holds."""
    return any(_is_plant_object(context, element) for element in context.graph.owned(package))


def _is_plant_object(context: Context, element: Element) -> bool:
    """Whether the element is an instance of a block, or any instance in AutomationML."""
    if element.kind is not Kind.INSTANCE:
        return False
    if context.ids.is_from_caex(element):
        return True
    type_ = context.graph.target(element, Edge.INSTANCE_OF)
    if type_ is None or element.role or type_.attrs.get("external"):
        return False
    return find_class_kind(context.graph, type_) is ClassKind.SYSTEM_UNIT


def _fill_unit(context: Context, root: SystemUnit) -> None:
    stack = [root]
    while stack:
        unit = stack.pop()
        _write_members(context, unit)
        _write_roles(context, unit)
        stack += reversed(unit.children)


def _write_roles(context: Context, unit: SystemUnit) -> None:
    """Write the roles of a unit and of its class, and the mappings to features of these roles."""
    elements = unit.elements
    if unit.own_class is not None and unit.part is not None:
        # The inline class has the roles that the file states; the part repeats some of them.
        elements = [item for item in elements if item is not unit.part] + [unit.part]
    roles.write_roles(context, unit.node, unit.file, elements)
    declared = _find_declared_class(context, unit)
    is_internal_element = unit.elements != [unit.own_class]
    if declared is not None and is_internal_element and not _is_mirror(context, unit):
        roles.repeat_class_roles(context, unit.node, unit.file, declared)
        context.copies.append((unit.node, declared))
    for type_ in (unit.own_class, declared):
        if type_ is not None:
            roles.map_features(context, unit.node, unit.file, type_)


def _write_members(context: Context, unit: SystemUnit) -> None:
    """Write the members that the class declares, then the values that the instance gives."""
    graph = context.graph
    for member in context.list_owned(unit.own_class):
        if is_attribute(context, member):
            unit.node.add(make_attribute(context, member, unit.file))
        elif member.kind is Kind.PORT:
            write_interface(context, member, unit.file, unit.node)
        elif is_part(context, member):
            instance = _find_part_instance(context, unit, member)
            unit.children.append(_make_unit(context, unit.node, unit.file, member, instance))
        elif member.kind in _GROUP_ROLES:
            unit.node.add(_make_group(context, member, unit.file))
    write_interface_ids(context, unit)
    for member in [*context.list_owned(unit.instance), *_list_class_values(context, unit)]:
        if member.kind is Kind.SLOT:
            write_slot(context, unit, member)
        elif member.kind is Kind.INSTANCE:
            if member.subkind == "part" and member.id not in context.written:
                unit.children.append(_make_unit(context, unit.node, unit.file, None, member))
        elif member.kind is Kind.COMMENT and graph.targets(member, Edge.REFERENCES):
            write_feature_description(context, unit, member)


def _list_class_values(context: Context, unit: SystemUnit) -> list[Element]:
    """Return the slots, comments and instances of parts that a class itself owns."""
    if unit.instance is not None:
        return []
    kinds = (Kind.INSTANCE, Kind.SLOT, Kind.COMMENT)
    return [member for member in context.list_owned(unit.own_class) if member.kind in kinds]


def _find_part_instance(context: Context, unit: SystemUnit, part: Element) -> Element | None:
    """Return the instance that holds the values of a part in this unit, or None."""
    owners = {owner.id for owner in (unit.instance, unit.own_class) if owner is not None}
    for source in context.graph.sources(part, Edge.REPRESENTS):
        if source.owner in owners and source.kind is Kind.INSTANCE:
            return source
    return None


def _make_unit(
    context: Context, parent: Node, file: File, part: Element | None, instance: Element | None
) -> SystemUnit:
    """Add an internal element for a part, for an instance, or for both if they correspond."""
    named = part or instance
    node = parent.add(Node("InternalElement", {"Name": named.name if named else ""}))
    unit = SystemUnit(node, file, part, instance)
    unit.own_class = _find_inline_class(context, unit)
    node.attributes["ID"] = context.ids.choose(part, instance, unit.own_class)
    for element in unit.elements:
        context.register(element, node)
        write_header(context, element, node)
    _write_class_reference(context, unit)
    _index_parts(context, parent, unit)
    return unit


def _index_parts(context: Context, parent: Node, unit: SystemUnit) -> None:
    """Register the node at its parent by the ids of the parts that it stands for.

    These are its own part, parts that its instance represents, and parts that they redefine. Links
    need this index, because their paths consist of parts of the class.
    """
    graph = context.graph
    stack = [unit.part] if unit.part is not None else []
    if unit.instance is not None:
        for represented in graph.targets(unit.instance, Edge.REPRESENTS):
            context.mark_edge(Edge.REPRESENTS, unit.instance, represented)
            stack.append(represented)
    while stack:
        part = stack.pop()
        if part.id not in parent.parts:
            parent.parts[part.id] = unit.node
            stack += graph.targets(part, Edge.REDEFINES)


# -- classes of internal elements --------------------------------------------------------------


def _list_types(context: Context, unit: SystemUnit) -> list[Element]:
    """Return the types of the part and of the instance."""
    types = []
    for element, edge in ((unit.part, Edge.TYPED_BY), (unit.instance, Edge.INSTANCE_OF)):
        if element is not None:
            for type_ in context.graph.targets(element, edge):
                context.mark_edge(edge, element, type_)
                types.append(type_)
    return types


def _find_inline_class(context: Context, unit: SystemUnit) -> Element | None:
    """Return the class that the front end made for this internal element alone, or None."""
    owner = unit.part.owner if unit.part is not None else None
    if unit.part is None and unit.instance is not None and unit.instance.subkind != "part":
        owner = unit.instance.owner
    master_types = _list_master_types(context, unit)
    for type_ in _list_types(context, unit):
        is_internal = type_.kind is Kind.CLASS and type_.subkind == "internal-element"
        if is_internal and type_.owner == owner and type_.id not in master_types:
            return type_
    return None


def _list_master_types(context: Context, unit: SystemUnit) -> set[str]:
    """Return the ids of the masters' classes; a mirror has the class of its master."""
    graph = context.graph
    sources = [element for element in (unit.part, unit.instance) if element is not None]
    masters = [master for source in sources for master in graph.targets(source, Edge.MIRRORS)]
    edges = (Edge.TYPED_BY, Edge.INSTANCE_OF)
    return {
        type_.id for master in masters for edge in edges for type_ in graph.targets(master, edge)
    }


def _find_declared_class(context: Context, unit: SystemUnit) -> Element | None:
    """Return the class that an internal element references, or the base class of a class."""
    if unit.own_class is not None:
        return context.graph.target(unit.own_class, Edge.SPECIALIZES)
    return next(iter(_list_types(context, unit)), None)


def _write_class_reference(context: Context, unit: SystemUnit) -> None:
    """Write the path of the class. A mirror object gets the ID of its master later."""
    for element in unit.elements:
        for master in context.graph.targets(element, Edge.MIRRORS):
            context.mark_edge(Edge.MIRRORS, element, master)
            context.pending_references.append((unit.node, _REFERENCE, master))
    declared = _find_declared_class(context, unit)
    if unit.own_class is not None and declared is not None:
        context.mark_edge(Edge.SPECIALIZES, unit.own_class, declared)
    if _is_mirror(context, unit):
        return
    path = context.make_class_path(declared, unit.file) if declared is not None else ""
    unresolved = (find_unresolved(element, "InternalElement") for element in unit.elements)
    path = path or next(filter(None, unresolved), "")
    if path:
        unit.node.attributes[_REFERENCE] = path
    elif declared is not None and not is_inline(declared):
        context.losses.record_untyped(unit.elements[0], "part", declared)


def _is_mirror(context: Context, unit: SystemUnit) -> bool:
    return any(context.graph.targets(element, Edge.MIRRORS) for element in unit.elements)


# -- facets and groups -------------------------------------------------------------------------


def _make_group(context: Context, element: Element, file: File) -> Node:
    """Return the internal element of a facet or group, with mirrors of its references."""
    node = context.register(element, Node("InternalElement", {"Name": element.name}))
    node.attributes["ID"] = context.ids.choose(element)
    write_header(context, element, node)
    if "associated_facet" in element.attrs:
        facet = node.add(Node("Attribute", {"Name": "AssociatedFacet"}))
        facet.attributes["AttributeDataType"] = "xs:string"
        facet.add_text("Value", str(element.attrs["associated_facet"]))
    for target in context.graph.targets(element, Edge.REFERENCES):
        context.mark_edge(Edge.REFERENCES, element, target)
        for name, id in _list_mirrors(element, target):
            _write_mirror(context, element, node, target, name, id)
    for member in context.list_owned(element):
        if member.kind is Kind.GROUP:
            node.add(_make_group(context, member, file))
    roles.write_roles(context, node, file, [element])
    if all(child.tag != "RoleRequirements" for child in node.children):
        path = _find_group_role(context, element, file)
        node.add(Node("RoleRequirements", {"RefBaseRoleClassPath": path}))
    return node


def _list_mirrors(element: Element, target: Element) -> list[tuple[str, str]]:
    """Return name and ID of each stored mirror of *target*, else its name and an empty ID."""
    mirrors = [
        (str(triple[1]), str(triple[2]))
        for triple in list_items(element.attrs.get("mirrors"))
        if isinstance(triple, tuple) and triple[0] == target.id
    ]
    return mirrors or [(target.name, "")]


def _find_group_role(context: Context, element: Element, file: File) -> str:
    """Return the path of the role class as it is written in *file*, with an alias if needed."""
    path = _GROUP_ROLES[element.kind]
    for id, entry in context.classes.items():
        if "/".join(entry.names) == path:
            return context.make_class_path(context.graph[id], file) or path
    return path


def _write_mirror(
    context: Context, element: Element, parent: Node, target: Element, name: str, id: str
) -> None:
    """Add a mirror; groups mirror only objects, facets also attributes and interfaces."""
    is_facet = element.kind is Kind.FACET
    tag, attribute = (
        _FACET_MIRRORS.get(target.kind, _INTERNAL_ELEMENT) if is_facet else _INTERNAL_ELEMENT
    )
    node = parent.add(Node(tag, {"Name": name}))
    if id or tag != "Attribute":
        node.attributes["ID"] = id or derived_id(element.id, f"caex mirror {target.id}")
    context.pending_references.append((node, attribute, target))
