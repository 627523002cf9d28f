"""Attributes and interfaces of components: values for members of the class, and new members."""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import data_types, mirrors
from sysmlc.frontends.caex.attributes import lower_attribute
from sysmlc.frontends.caex.component import Component, ensure_instance, ensure_own_type
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Node
from sysmlc.frontends.caex.findings import read_class_reference
from sysmlc.frontends.caex.interfaces import (
    add_external_document,
    lower_interface,
    read_port_properties,
)
from sysmlc.frontends.caex.overrides import iter_overriding_attributes, overrides_attribute
from sysmlc.frontends.caex.scales import check_scales
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Edge, Element, Graph, Kind

_REPEATED_TAGS = frozenset({"Constraint", "RefSemantic"})
"""Content of a repeated attribute that repeats the definition in the class."""

_FeaturePath = tuple[str, ...]
"""Ids of the features around a nested feature, outermost first."""


def lower_members(context: Context, component: Component) -> None:
    """Lower the members: those that the class declares to values, all others to features."""
    for child in component.node.children:
        if child.tag == "Attribute":
            _lower_attribute(context, component, child)
        elif child.tag == "ExternalInterface":
            _lower_interface(context, component, child)
        elif child.tag == "RoleRequirements" and child.children:
            _lower_requirements(context, component, child)


# -- members that a role requires ------------------------------------------------------------------


def _lower_requirements(context: Context, component: Component, requirements: Node) -> None:
    """Add the members that the role of a component requires and that the component lacks."""
    document = component.document
    for node in requirements.iter_children("Attribute", "ExternalInterface"):
        type = component.type
        member = type.find_member(node.tag, node.name) if type is not None else None
        if member is not None and node.tag == "Attribute":
            _add_required_value(context, component, node, requirements, member)
        elif (
            member is not None
            and member.document is document
            and component.row < member.row < document.ends[component.row]
        ):
            # The component itself declares the interface.
            node.verdict, node.element_id = Verdict.MAPPED, member.id
        elif node.tag == "ExternalInterface":
            _lower_interface(context, component, node)
        else:
            lower_attribute(context, ensure_own_type(context, component), node, document)


def _add_required_value(
    context: Context, component: Component, node: Node, requirements: Node, member: Member
) -> None:
    """Add metadata for a value that the role requires of an attribute of the component."""
    value = node.child_text("Value")
    own_type = component.own_type
    owner = own_type.id if own_type is not None else component.instance_id or component.part_id
    node.verdict = Verdict.MAPPED
    if not overrides_attribute(context.types, component.document, node, member):
        node.mark_subtree()
    if value is None or not owner:
        return
    role = requirements.attributes.get("RefBaseRoleClassPath", "")
    id = context.make_unique(f"{owner}/{node.name}#required", node)
    metadata = Element(id, Kind.METADATA, "RoleRequirements", owner, node.ordinal)
    metadata.source = component.document.name
    metadata.attrs.update({"role_class": role, "attribute": node.name, "required": value})
    unit = node.attributes.get("Unit", "")
    if unit and unit != member.node.attributes.get("Unit"):
        metadata.attrs["unit"] = unit
    context.graph.add(metadata)
    context.graph.connect(Edge.REFERENCES, id, owner)


# -- attributes ------------------------------------------------------------------------------------


def _lower_attribute(context: Context, component: Component, node: Node) -> None:
    """Add slots for the values of an inherited attribute, else a property of the own class."""
    declared, document = component.declared_type, component.document
    inherited = declared.find_member("Attribute", node.name) if declared else None
    if inherited is None or overrides_attribute(context.types, document, node, inherited):
        lower_attribute(context, ensure_own_type(context, component), node, document)
        return
    worklist: list[tuple[Node, Member, _FeaturePath]] = [(node, inherited, ())]
    while worklist:
        attribute, member, path = worklist.pop()
        attribute.verdict = Verdict.MAPPED
        _check_class(context, attribute, component)
        _add_value(context, component, attribute, member, path)
        _add_description(context, component, attribute, member, path)
        for child in attribute.children:
            inner = member.type.find_member(child.tag, child.name) if member.type else None
            if child.tag == "Attribute" and inner is not None:
                worklist.append((child, inner, (*path, member.id)))
            elif child.tag in _REPEATED_TAGS:
                child.mark_subtree()


def _check_class(context: Context, node: Node, component: Component) -> None:
    """Record the class that an instance names if it does not exist."""
    path = read_class_reference(node)
    if path and not context.mirrors.is_mirror(node):
        context.resolve_type(path, mirrors.MEMBER_FAMILIES[node.tag], component.document, node)


def _add_value(
    context: Context, component: Component, node: Node, member: Member, path: _FeaturePath
) -> None:
    """Add a slot for the value of an attribute, unless the class gives the same value."""
    text = node.child_text("Value")
    if text is None or text == member.node.child_text("Value"):
        return
    owner = ensure_instance(context, component)
    data_type = member.node.attributes.get("AttributeDataType", "")
    value = data_types.convert_value(context.findings, node, text, data_type, member.type)
    check_scales(context.findings, component.document, node, [node, member.node], member.type)
    slot = context.add_element(Kind.SLOT, node, component.document, owner, value=value)
    context.graph.connect(Edge.INSTANCE_OF, slot.id, member.id)
    _connect_path(context.graph, slot.id, path)


def _connect_path(graph: Graph, id: str, path: _FeaturePath) -> None:
    """Connect an element to the features around a nested one, whose type several features share."""
    for outer in path:
        graph.connect(Edge.PATH, id, outer)


def _add_description(
    context: Context, component: Component, node: Node, member: Member, path: _FeaturePath
) -> None:
    """Add a comment for a description that only the instance gives, unless a slot carries it."""
    text = node.child_text("Description")
    has_slot = bool(node.element_id) and node.tag == "Attribute"
    if has_slot or not (text or "").strip() or text == member.node.child_text("Description"):
        return
    owner = ensure_instance(context, component)
    id = context.make_unique(f"{owner}/{node.name}/Description", node)
    comment = Element(id, Kind.COMMENT, "", owner, node.ordinal, component.document.name)
    comment.attrs["body"] = str(text).strip()
    context.graph.add(comment)
    context.graph.connect(Edge.REFERENCES, id, member.id)
    _connect_path(context.graph, id, path)


# -- interfaces ------------------------------------------------------------------------------------


def _lower_interface(context: Context, component: Component, node: Node) -> None:
    """Lower an interface: slots for the values of an inherited one, else a port.

    The port belongs to the class for members that the declared class lacks."""
    declared = component.declared_type
    inherited = declared.find_member(node.tag, node.name) if declared else None
    if (
        inherited is None
        or _is_of_other_class(context, node, inherited)
        or _overrides_interface(context, node, inherited)
    ):
        lower_interface(context, ensure_own_type(context, component), node, component.document)
        return
    worklist: list[tuple[Node, Member, _FeaturePath]] = [(node, inherited, ())]
    while worklist:
        interface, member, path = worklist.pop()
        interface.verdict, interface.element_id = Verdict.MAPPED, member.id
        _check_class(context, interface, component)
        _add_port_values(context, component, interface, member, path)
        _add_description(context, component, interface, member, path)
        id = interface.attributes.get("ID")
        if id:
            component.interface_ids.append((member.id, id))
        for child in interface.iter_children("ExternalInterface"):
            inner = member.type.find_member(child.tag, child.name) if member.type else None
            if inner is not None:
                worklist.append((child, inner, (*path, member.id)))


def _overrides_interface(context: Context, node: Node, inherited: Member) -> bool:
    """Whether an interface adds nested interfaces, or attributes that define more than values."""
    worklist = [(node, inherited)]
    while worklist:
        interface, member = worklist.pop()
        overriding = iter_overriding_attributes(
            context.types, interface.document, interface, member.type
        )
        if any(True for _ in overriding):
            return True
        for child in interface.iter_children("ExternalInterface"):
            inner = member.type.find_member(child.tag, child.name) if member.type else None
            if inner is None:
                return True
            worklist.append((child, inner))
    return False


def _is_of_other_class(context: Context, node: Node, inherited: Member) -> bool:
    """Whether an interface names a class that the inherited interface does not conform to."""
    path = node.attributes.get("RefBaseClassPath", "").strip()
    if not path or context.mirrors.is_mirror(node):
        return False
    type = context.look_up_type(path, Family.INTERFACE, node.document)
    if not isinstance(type, Type):
        return False
    return inherited.type is None or not inherited.type.specializes(type)


def _add_port_values(
    context: Context, component: Component, node: Node, member: Member, path: _FeaturePath
) -> None:
    """Add a slot for properties of a port that differ from those in the class."""
    properties = read_port_properties(context.findings, node)
    inherited = context.graph[member.id].attrs
    changed = {key: value for key, value in properties.items() if inherited.get(key) != value}
    for child in node.iter_children("Attribute"):
        child.mark_subtree()
    if not changed:
        return
    owner, document = ensure_instance(context, component), component.document
    id = context.make_unique(f"{owner}/{node.name}", node)
    slot = Element(id, Kind.SLOT, node.name, owner, node.ordinal, document.name)
    slot.attrs.update(changed)
    context.graph.add(slot)
    context.graph.connect(Edge.INSTANCE_OF, id, member.id)
    _connect_path(context.graph, id, path)
    add_external_document(context, node, document, owner, member.id, changed)
