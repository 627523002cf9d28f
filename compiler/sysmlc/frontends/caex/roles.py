"""Roles: realizations of components (thesis, Table 3.1), and features mapped to those of a role."""

from collections.abc import Iterable, Iterator

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.component import Component, ensure_instance
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Node
from sysmlc.frontends.caex.findings import Findings
from sysmlc.frontends.caex.hierarchies import Components
from sysmlc.frontends.caex.identifiers import Identifiers
from sysmlc.frontends.caex.interfaces import read_port_properties
from sysmlc.frontends.caex.types import Member, Type, find_meaning
from sysmlc.frontends.caex.vocabulary import BASE_ROLE, PPR_ROLES, ROLE_REFERENCES, Family
from sysmlc.ir import Edge, Graph

# Access to a member of an enumeration takes twice as long as to a global variable.
_MAPPED = Verdict.MAPPED

_PORT_PROPERTIES = ("direction", "multiplicity", "category")


def lower_roles(context: Context, components: Components) -> None:
    """Add each realization of a role once, unless the class of the component realises the role.

    Classes come first among the components, so that the roles of a class are known when its
    instances repeat them.
    """
    class_roles = _ClassRoles()
    realizations: list[tuple[str, str]] = []
    for component in components:
        if component.type is None:
            continue
        inherited, component.ppr = class_roles.find_inherited(component)
        for role in _resolve_roles(context, component):
            if role in inherited:
                continue
            ppr, is_port = class_roles.classify(role)
            if ppr:
                _set_ppr(context, component, ppr, class_roles)
            if is_port:
                _mark_port_object(context.graph, context.findings, component)
            realizations.append((_find_client(context, component), role.id))
            if component.own_type is not None:
                class_roles.add(component.own_type, role)
    for client, role_class in realizations:
        context.graph.connect(Edge.REALIZES, client, role_class)


class _ClassRoles:
    """The roles that classes realise, with a cache of inherited roles."""

    def __init__(self) -> None:
        self._roles: dict[Type, set[Type]] = {}
        self._ppr: dict[Type, str] = {}
        self._inherited: dict[Type, tuple[set[Type], str]] = {}
        self._cached_types: set[Type] = set()
        """Classes on which an entry of ``_inherited`` depends."""
        self._kinds: dict[Type, tuple[str, bool]] = {}

    def classify(self, role: Type) -> tuple[str, bool]:
        """Return product, process, resource or nothing, and whether the role is that of a port."""
        kinds = self._kinds.get(role)
        if kinds is None:
            is_port = role.conforms_to(*BASE_ROLE, "Port")
            kinds = self._kinds[role] = find_meaning(role, PPR_ROLES), is_port
        return kinds

    def add(self, type: Type, role: Type) -> None:
        """Record that a class realises a role."""
        self._roles.setdefault(type, set()).add(role)
        self._invalidate(type)

    def set_ppr(self, type: Type, ppr: str) -> None:
        """Record that a class is a product, process or resource; the first role counts."""
        self._ppr.setdefault(type, ppr)
        self._invalidate(type)

    def find_inherited(self, component: Component) -> tuple[set[Type], str]:
        """Return the roles that an internal element has by its class, and its ``ppr``.

        Nothing for a class of a library, which repeats the roles of its base class.
        """
        declared, own_type = component.declared_type, component.own_type
        is_library_class = (
            own_type is not None and own_type.row == component.row and bool(own_type.path)
        )
        if is_library_class or declared is None:
            return set(), ""
        inherited = self._inherited.get(declared)
        if inherited is None:
            chain = list(declared.iter_chain())
            self._cached_types.update(chain)
            roles = {role for type in chain for role in self._roles.get(type, ())}
            ppr = next((self._ppr[type] for type in chain if type in self._ppr), "")
            inherited = self._inherited[declared] = roles, ppr
        return inherited

    def _invalidate(self, type: Type) -> None:
        if type in self._cached_types:
            self._inherited.clear()
            self._cached_types.clear()


def _mark_port_object(graph: Graph, findings: Findings, component: Component) -> None:
    """Mark a part with the role Port of CAEX 2.15 with the properties of a port."""
    if component.part_id and not component.is_inherited:
        values = read_port_properties(findings, component.node)
        properties = {key: values[key] for key in _PORT_PROPERTIES if key in values}
        part = graph[component.part_id]
        graph.set(part, subkind="port-object", **properties)


def _set_ppr(context: Context, component: Component, ppr: str, class_roles: _ClassRoles) -> None:
    """Mark a component as a product, process or resource."""
    component.ppr = ppr
    context.graph.set(context.graph[_find_client(context, component)], ppr=ppr)
    if component.own_type is not None:
        class_roles.set_ppr(component.own_type, ppr)


def _find_client(context: Context, component: Component) -> str:
    """Return the id of the element that realises the roles of a component."""
    if component.own_type is not None:
        return component.own_type.id
    if component.is_inherited or not component.part_id:
        return ensure_instance(context, component)
    return component.part_id


def _resolve_roles(context: Context, component: Component) -> list[Type]:
    """Return the role classes that a component names, each once; missing ones are recorded."""
    document = component.document
    roles: dict[Type, None] = {}
    for row in component.role_rows:
        document.verdicts[row] = _MAPPED
        path = _read_role_path(component, row)
        role = None
        if path:
            role = context.resolve_type(path, Family.ROLE, document, document.node(row))
        if role is not None:
            roles[role] = None
    return list(roles)


def _read_role_path(component: Component, row: int) -> str:
    document = component.document
    return document.attributes[row].get(ROLE_REFERENCES[document.tags[row]], "").strip()


# -- mapping objects -------------------------------------------------------------------------------

_MAPPINGS = {
    "AttributeNameMapping": (
        "Attribute",
        "SystemUnitAttributeName",
        ("RoleAttributeName", "RefRoleAttributeName"),
    ),
    "InterfaceNameMapping": (
        "ExternalInterface",
        "SystemUnitInterfaceName",
        ("RoleInterfaceName", "RefRoleInterfaceName"),
    ),
    "InterfaceIDMapping": (
        "ExternalInterface",
        "SystemUnitInterfaceID",
        ("RoleInterfaceID", "RefRoleInterfaceID"),
    ),
}
"""By tag: tag of the features, XML attribute with the own feature, those with the role's feature.

The XML attribute with the feature of the role has different names in the versions of CAEX.
"""


def lower_mappings(context: Context, components: Components) -> None:
    """Let each feature that a mapping object names redefine the feature of the role."""
    if not any("MappingObject" in document.tags for document in context.documents):
        return
    for component in components:
        for node in _iter_mapping_objects(component.node):
            node.verdict = Verdict.MAPPED
            for mapping in node.iter_children(*_MAPPINGS):
                _lower_mapping(context, component, mapping)


def _iter_mapping_objects(node: Node) -> Iterator[Node]:
    """Yield mapping objects of an element (CAEX 2.15) and of its role requirements (CAEX 3.0)."""
    yield from node.iter_children("MappingObject")
    for role in node.iter_children("RoleRequirements", "SupportedRoleClass"):
        yield from role.iter_children("MappingObject")


def _lower_mapping(context: Context, component: Component, node: Node) -> None:
    node.verdict = Verdict.MAPPED
    tag, own_key, role_keys = _MAPPINGS[node.tag]
    own_name = node.attributes.get(own_key, "")
    role_name = next((node.attributes[key] for key in role_keys if key in node.attributes), "")
    own_feature = _find_feature(context.ids, _list_mapped_types(context, component), tag, own_name)
    role_feature = _find_feature(context.ids, _iter_known_roles(context, component), tag, role_name)
    if own_feature and role_feature:
        context.graph.connect(Edge.REDEFINES, own_feature, role_feature)
        _realize_property_set(context, component, own_feature, role_feature)
        return
    missing = role_name if own_feature else own_name
    facts = {"element": component.node.name, "feature": missing}
    context.findings.report(rules.MAPPING_OF_NOTHING, component.document, node, **facts)


def _realize_property_set(
    context: Context, component: Component, own_feature: str, role_feature: str
) -> None:
    """Let the owner of a mapped feature realise the role, if the role is that of a property set."""
    graph = context.graph
    owner, role = graph.owner(graph[own_feature]), graph.owner(graph[role_feature])
    is_own = component.type is not None and owner is graph[component.type.id]
    if owner is None or role is None or is_own or not _is_property_set(context, component):
        return
    if role not in graph.targets(owner, Edge.REALIZES):
        graph.connect(Edge.REALIZES, owner, role)


def _list_mapped_types(context: Context, component: Component) -> list[Type]:
    """Return the types whose features a mapping of the component names.

    A property set maps those of the element around it, whose properties it is (IEC 62714-1).
    """
    types = [component.type]
    parent: Component | None = component
    while parent is not None and _is_property_set(context, parent):
        parent = parent.parent
        types += [] if parent is None else [parent.type]
    return [type for type in types if type is not None]


def _is_property_set(context: Context, component: Component) -> bool:
    roles = _iter_known_roles(context, component)
    return any(role.conforms_to(*BASE_ROLE, "PropertySet") for role in roles)


def _find_feature(ids: Identifiers, types: Iterable[Type], tag: str, name: str) -> str:
    """Return the id of the feature with an ID, or of the first class that has its name."""
    located = ids.find(name)
    if located is not None and located[1].element_id:
        return located[1].element_id
    members = (_find_nested_member(type, tag, name) for type in types)
    return next((member.id for member in members if member is not None), "")


def _find_nested_member(type: Type | None, tag: str, name: str) -> Member | None:
    """Return a feature by name; ``.`` leads to nested features, unless it is part of a name."""
    if type is None:
        return None
    member = type.find_member(tag, name)
    if member is not None:
        return member
    for position in (index for index, character in enumerate(name) if character == "."):
        outer = type.find_member(tag, name[:position])
        if outer is not None:
            inner = _find_nested_member(outer.type, tag, name[position + 1 :])
            if inner is not None:
                return inner
    return None


def _iter_known_roles(context: Context, component: Component) -> Iterator[Type]:
    """Yield the role classes that a component names and that exist."""
    for row in component.role_rows:
        path = _read_role_path(component, row)
        role = context.look_up_type(path, Family.ROLE, component.document) if path else None
        if isinstance(role, Type):
            yield role
