"""Roles: those that a class supports, those that an internal element requires, and mappings."""

from collections.abc import Iterable

from sysmlc.backends.aml.class_kinds import ClassKind
from sysmlc.backends.aml.context import Context, File, iter_unresolved
from sysmlc.backends.aml.node import Node, format_value
from sysmlc.ir import Edge, Element, Kind

_SUPPORTED, _REQUIRED = "SupportedRoleClass", "RoleRequirements"
_TAGS = (_SUPPORTED, _REQUIRED)
_PATHS = {_SUPPORTED: "RefRoleClassPath", _REQUIRED: "RefBaseRoleClassPath"}
"""XML attribute that names the role class, by tag."""


def write_roles(context: Context, node: Node, file: File, elements: Iterable[Element]) -> None:
    """Add the roles of the elements that a node represents."""
    tag = _REQUIRED if node.tag == "InternalElement" else _SUPPORTED
    for element in elements:
        for role in context.graph.targets(element, Edge.REALIZES):
            if path := _make_role_path(context, role, file):
                context.mark_edge(Edge.REALIZES, element, role)
                _find_or_add_role(node, tag, path)
        # References to unknown role classes stay as they were written.
        for tag, path in iter_unresolved(element, *_TAGS):
            _find_or_add_role(node, tag if node.tag == "InternalElement" else _SUPPORTED, path)
        _write_requirements(context, element, node)


def repeat_class_roles(context: Context, node: Node, file: File, type_: Element) -> None:
    """Require in an instance the roles that its class supports, as AutomationML demands."""
    for base in context.iter_bases(type_):
        for role in context.graph.targets(base, Edge.REALIZES):
            if path := _make_role_path(context, role, file):
                _find_or_add_role(node, _REQUIRED, path)


def _make_role_path(context: Context, role: Element, file: File) -> str:
    entry = context.classes.get(role.id)
    is_role = entry is not None and entry.kind is ClassKind.ROLE
    return context.make_class_path(role, file) if is_role else ""


def _find_or_add_role(node: Node, tag: str, path: str) -> Node:
    """Return the child that names a role; add it if absent, since a role has only one child."""
    for child in node.children:
        if child.tag == tag and child.attributes.get(_PATHS[tag]) == path:
            return child
    return node.add(Node(tag, {_PATHS[tag]: path}))


def _write_requirements(context: Context, element: Element, node: Node) -> None:
    """Add the values that a role requirement demands of attributes."""
    for metadata in context.graph.owned(element):
        if metadata.kind is not Kind.METADATA or metadata.name != _REQUIRED:
            continue
        attrs = metadata.attrs
        role = _find_or_add_role(node, _REQUIRED, str(attrs.get("role_class", "")))
        attribute = role.add(Node("Attribute", {"Name": str(attrs.get("attribute", ""))}))
        if attrs.get("unit"):
            attribute.attributes["Unit"] = str(attrs["unit"])
        attribute.add_text("Value", format_value(attrs.get("required", "")))
        context.written.add(metadata.id)
        for target in context.graph.targets(metadata, Edge.REFERENCES):
            context.mark_edge(Edge.REFERENCES, metadata, target)


# -- mappings of features ----------------------------------------------------------------------


def find_role_features(context: Context) -> dict[str, list[tuple[Element, Element]]]:
    """Return the features that redefine features of roles, by the id of the owning class."""
    features: dict[str, list[tuple[Element, Element]]] = {}
    for _, source, target in context.graph.edges(Edge.REDEFINES):
        feature, role_feature = context.graph[source], context.graph[target]
        entry = context.classes.get(role_feature.owner or "")
        if entry is not None and entry.kind is ClassKind.ROLE and feature.owner is not None:
            features.setdefault(feature.owner, []).append((feature, role_feature))
    return features


def map_features(context: Context, node: Node, file: File, type_: Element) -> None:
    """Add the MappingObjects for features of a class and of its base classes."""
    if not context.role_features:
        return
    for base in context.iter_bases(type_):
        for feature, role_feature in context.role_features.get(base.id, ()):
            if (Edge.REDEFINES, feature.id, role_feature.id) in context.written_edges:
                continue
            role = _find_role_with(context, node, file, role_feature)
            if role is not None:
                _find_or_add_mapping_object(role).add(_make_mapping(context, feature, role_feature))
                context.mark_edge(Edge.REDEFINES, feature, role_feature)


def _find_role_with(context: Context, node: Node, file: File, role_feature: Element) -> Node | None:
    """Return the child of *node* that names a role with the feature, own or inherited."""
    for child in node.children:
        if child.tag in _TAGS:
            path = child.attributes.get(_PATHS[child.tag], "")
            role = context.find_class(path, ClassKind.ROLE, file)
            if any(base.id == role_feature.owner for base in context.iter_bases(role)):
                return child
    return None


def _find_or_add_mapping_object(role: Node) -> Node:
    for child in role.children:
        if child.tag == "MappingObject":
            return child
    return role.add(Node("MappingObject"))


def _make_mapping(context: Context, feature: Element, role_feature: Element) -> Node:
    """Return the mapping; CAEX 3.0 maps interfaces by ID and attributes by name."""
    if feature.kind is Kind.PORT:
        ids = {
            "SystemUnitInterfaceID": context.ids.choose(feature),
            "RoleInterfaceID": context.ids.choose(role_feature),
        }
        return Node("InterfaceIDMapping", ids)
    names = {"SystemUnitAttributeName": feature.name, "RoleAttributeName": role_feature.name}
    return Node("AttributeNameMapping", names)
