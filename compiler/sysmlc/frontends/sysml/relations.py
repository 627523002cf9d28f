"""Dependencies, derivations, allocations, imports and aliases; filters and exposed elements."""

from sysmlc.frontends.sysml import annotations, nodes, values
from sysmlc.frontends.sysml.definitions import visibility_attributes
from sysmlc.frontends.sysml.elements import NodeElements
from sysmlc.frontends.sysml.lowering import Lowering
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, list_items
from sysmlc.language.tree import Node

_ROLES = {
    "Trace": "trace",
    "Copies": "copy",
    "Satisfies": "satisfy",
    "Verifies": "verify",
    "Derives": "derive",
    "Allocates": "allocate",
    "Conforms": "conform",
    "Exposes": "expose",
}
"""Roles of dependencies by keyword."""
_SUBKINDS = {
    "Realization": "realization",
    "Substitution": "substitution",
    "Usage": "usage",
    "Abstraction": "abstraction",
    "Manifestation": "manifestation",
    "Deployment": "deployment",
    "RoleBinding": "role-binding",
    "InternalLink": "internal-link",
    "ProcessLink": "ppr",
    "OrderLink": "succession",
}
_EDGES = {"Generalization": Edge.SPECIALIZES, "Constrains": Edge.REFERENCES}
"""Keywords of dependencies that are edges, not elements."""
_REFINEMENT = "Refinement"
_ALLOCATION: dict[str, AttrValue] = {"role": "allocate", "subkind": "abstraction"}
_DERIVATION: dict[str, AttrValue] = {"role": "derive", "subkind": "abstraction"}


# -- dependencies ------------------------------------------------------------------------------


def lower_dependency(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a dependency by its keyword: to an element, or to edges."""
    keywords = _list_keywords(node)
    clients = nodes.list_references(node, "client")
    edge = next((_EDGES[keyword] for keyword in keywords if keyword in _EDGES), None)
    client = lowering.elements.find(clients[0].target) if clients else None
    is_from_owner = client is not None and client is owner
    if "Realization" in keywords and not node.name and is_from_owner:
        edge = Edge.REALIZES
    if edge is not None and clients:
        lowering.queue.defer_until_elements(lambda: _connect_ends(lowering, edge, node))
    elif "Extension" in keywords:
        _lower_extension(lowering, node, owner)
    else:
        _add_dependency(lowering, node, owner, keywords)


def _add_dependency(
    lowering: Lowering, node: Node, owner: Element | None, keywords: list[str]
) -> None:
    attributes = _dependency_attributes(keywords)
    dependency = lowering.add_element(node, Kind.DEPENDENCY, node.name or "", owner, **attributes)
    lowering.set_attributes(dependency, **visibility_attributes(node))
    for client in nodes.list_references(node, "client"):
        lowering.connect_reference(Edge.CLIENT, dependency, client)
    for supplier in nodes.list_references(node, "supplier"):
        lowering.connect_reference(Edge.SUPPLIER, dependency, supplier)
    members = [member for member in nodes.body_of(node) if not _is_refinement_keyword(member)]
    lowering.lower_all(members, dependency)


def _dependency_attributes(keywords: list[str]) -> dict[str, AttrValue]:
    role = next((_ROLES[keyword] for keyword in keywords if keyword in _ROLES), "")
    if _REFINEMENT in keywords:
        role = "refine"
    subkind = next((_SUBKINDS[keyword] for keyword in keywords if keyword in _SUBKINDS), "")
    return {"role": role, "subkind": subkind or ("abstraction" if role else "dependency")}


def _is_refinement_keyword(node: Node) -> bool:
    """Whether a member is the keyword of the standard library that the role already states."""
    definition = nodes.find_target(node, "FeatureTyping") if _is_keyword(node) else None
    if definition is None or definition.owner is None:
        return False
    return (definition.owner.name, definition.name) == ("ModelingMetadata", _REFINEMENT)


def _list_keywords(node: Node) -> list[str]:
    """Return the names of metadata definitions of our library and of ``#`` keywords of a node."""
    keywords = list(nodes.shipped_metadata_of(node))
    for metadata in nodes.iter_by_metaclass(node, "MetadataUsage"):
        reference = nodes.find_reference(metadata, "FeatureTyping")
        if reference is None or not _is_keyword(metadata):
            continue
        if reference.target is not None and reference.target.name:
            keywords.append(reference.target.name)
        else:
            keywords.append(nodes.last_name(reference).capitalize())
    return keywords


def _is_keyword(node: Node) -> bool:
    return bool(node.attributes.get("isPrefix"))


def _connect_ends(lowering: Lowering, edge: Edge, node: Node) -> None:
    """Connect each client of a dependency to each supplier."""
    for client in nodes.list_references(node, "client"):
        source = lowering.elements.find(client.target)
        if source is None:
            continue
        for supplier in nodes.list_references(node, "supplier"):
            lowering.connect_node(edge, source, supplier.target)


def _lower_extension(lowering: Lowering, node: Node, owner: Element | None) -> None:
    extension = lowering.add_element(node, Kind.EXTEND, node.name or "", owner)
    lowering.queue.defer_until_elements(lambda: _connect_extended(lowering, node, extension, owner))


def _connect_extended(
    lowering: Lowering, node: Node, extension: Element, owner: Element | None
) -> None:
    """Connect an extension to the extended use cases, and to its extension points."""
    for reference in nodes.list_references(node, "supplier"):
        target = lowering.elements.find(reference.target)
        is_case = target is not None and target.kind is Kind.USE_CASE
        edge = Edge.EXTENDS if is_case else Edge.REFERENCES
        lowering.connect_node(edge, extension, reference.target)
        is_owned_by_case = owner is not None and owner.kind is Kind.USE_CASE
        if is_case and is_owned_by_case and target is not None and owner is not None:
            lowering.graph.connect(Edge.EXTENDS, owner, target)


# -- derivations -------------------------------------------------------------------------------


def is_derivation(node: Node) -> bool:
    """Whether a connection is a derivation connection of the standard library."""
    return any(keyword.startswith("Derivation") for keyword in _list_keywords(node))


def lower_derivation(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a derivation: its clients are the derived requirements, its supplier the original."""
    derivation = lowering.add_element(node, Kind.DEPENDENCY, node.name or "", owner, **_DERIVATION)
    ends_in_body = [member for member in node.members if member.attributes.get("isEnd")]
    for end in nodes.ends_of(node) + ends_in_body:
        is_original = any(keyword.startswith("Original") for keyword in _list_keywords(end))
        edge = Edge.SUPPLIER if is_original else Edge.CLIENT
        for reference in nodes.list_references(end, "ReferenceSubsetting"):
            lowering.connect_reference(edge, derivation, reference)
    for member in node.members:
        if nodes.is_annotation(member) and not _is_keyword(member):
            lowering.lower(member, derivation)


# -- allocations -------------------------------------------------------------------------------


def lower_allocation(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower an allocation between usages; allocations inside it belong to its owner."""
    allocation = lowering.add_element(node, Kind.DEPENDENCY, node.name or "", owner, **_ALLOCATION)
    lowering.queue.defer_until_elements(lambda: _connect_allocation(lowering, node, allocation))
    nested = list(nodes.iter_by_metaclass(node, "AllocationUsage"))
    annotations.lower_only_annotations(lowering, node, allocation, "an allocation", nested)
    lowering.lower_all(nested, owner)


def _connect_allocation(lowering: Lowering, node: Node, allocation: Element) -> None:
    for edge, end in zip((Edge.CLIENT, Edge.SUPPLIER), nodes.ends_of(node), strict=False):
        path = nodes.path_of_end(end)
        lowering.connect_node(edge, allocation, path[-1] if path else None)


def lower_allocation_definition(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower an allocation between definitions."""
    allocation = lowering.add_element(
        node, Kind.DEPENDENCY, nodes.name_of(node), owner, **_ALLOCATION
    )
    edges = iter((Edge.CLIENT, Edge.SUPPLIER))
    for member in node.members:
        if not nodes.is_end(member):
            lowering.lower(member, allocation)
            continue
        edge = next(edges, None)
        if edge is not None:
            for type_ in nodes.list_references(member, "FeatureTyping"):
                lowering.connect_reference(edge, allocation, type_)


def allocate_steps(lowering: Lowering, node: Node, owner: Element) -> None:
    """Allocate steps of a definition to the actions of the plant that a usage binds to them.

    ``action :>> place references cell.place`` states which action performs the step ``place``.
    """
    for member in node.walk():
        if member is node:
            continue
        step = nodes.find_target(member, "Redefinition")
        action = nodes.find_reference(member, "ReferenceSubsetting")
        if step is not None and action is not None:
            path = list(action.targets or ())
            allocation = _add_allocation(lowering, member, owner, step, path)
            lowering.connect_reference(Edge.SUPPLIER, allocation, action)
        elif _has_only_members(member):
            lowering.elements.redundant.add(id(member))


def _has_only_members(node: Node) -> bool:
    """Whether a node is neither an annotation nor an expression, and has no value."""
    is_content = nodes.is_annotation(node) or node.kind in nodes.EXPRESSIONS
    return not is_content and nodes.value_of(node) is None


def allocate_arguments(lowering: Lowering, node: Node, owner: Element) -> None:
    """Allocate parameters of a definition to the features of the plant that a usage binds to them.

    ``in :>> machine = cell.robot`` states which machine the parameter ``machine`` is.
    """
    for member in nodes.body_of(node):
        parameter, value = nodes.find_target(member, "Redefinition"), nodes.value_of(member)
        if parameter is None or value is None or "direction" not in member.attributes:
            continue
        path = nodes.path_of_expression(value)
        features = [feature for feature in path if feature is not None]
        is_in_plant = all(feature.kind.endswith("Usage") for feature in features)
        if features and len(features) == len(path) and is_in_plant:
            allocation = _add_allocation(lowering, member, owner, parameter, features)
            lowering.defer_edges(Edge.SUPPLIER, allocation, [features[-1]])


def _add_allocation(
    lowering: Lowering, node: Node, owner: Element, client: Node, path: list[Node]
) -> Element:
    """Add an allocation of a feature to the last feature of a path, in the context of *owner*."""
    allocation = lowering.add_element(node, Kind.DEPENDENCY, "", owner, **_ALLOCATION)
    lowering.queue.defer_until_elements(
        lambda: lowering.connect_node(
            Edge.CLIENT, allocation, _find_feature_with_element(lowering.elements, client)
        )
    )
    if len(path) > 1:
        lowering.queue.defer_until_elements(
            lambda: _set_target_path(lowering, allocation, owner, path[:-1])
        )
    return allocation


def _set_target_path(
    lowering: Lowering, allocation: Element, owner: Element, path: list[Node]
) -> None:
    """Set the path of a DirectedRelationshipPropertyPath (SysML 1.6, 8.3.2.4)."""
    elements = [lowering.elements.find(feature) for feature in path]
    ids = tuple(element.id for element in elements if element is not None)
    lowering.set_attributes(allocation, target_context=owner.id, target_path=ids)


def _find_feature_with_element(elements: NodeElements, feature: Node) -> Node:
    """Return the first feature with an element in a chain of redefinitions."""
    visited = set()
    while elements.own.get(id(feature)) is None and id(feature) not in visited:
        visited.add(id(feature))
        feature = nodes.find_target(feature, "Redefinition") or feature
    return feature


# -- imports and aliases -----------------------------------------------------------------------


def lower_import(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower an import of a package or an element of the unit; imports of libraries are external."""
    # The tree of an import with a filter is a package that contains the import.
    inner = [
        member for package in nodes.iter_by_metaclass(node, "Package") for member in package.members
    ]
    imported = next((member for member in inner if member.kind.endswith("Import")), node)
    target = nodes.find_target(imported, "importedNamespace", "importedMembership")
    if target is None or lowering.trees.document_of(target) is None or owner is None:
        lowering.verdicts.mark_external(node)
        return
    subkind = "package" if imported.kind == "NamespaceImport" else "element"
    import_ = lowering.add_element(node, Kind.IMPORT, "", owner, subkind=subkind)
    if node.visibility != "public":
        lowering.set_attributes(import_, visibility=node.visibility or "private")
    lowering.set_attributes(
        import_,
        recursive=bool(imported.attributes.get("isRecursive")),
        import_all=bool(node.attributes.get("isImportAll")),
    )
    lowering.lower_annotations(node, import_)
    lowering.queue.defer_until_elements(
        lambda: _connect_imported(lowering.graph, lowering.elements, import_, target)
    )
    if imported is not node:
        conditions = [member for member in inner if member.kind in nodes.EXPRESSIONS]
        for condition in conditions:
            lower_filter(lowering, condition, import_)
        lowering.verdicts.skipped.update(id(member) for member in node.walk() if member is not node)


def _connect_imported(graph: Graph, elements: NodeElements, import_: Element, target: Node) -> None:
    imported = elements.find(target)
    if imported is not None:
        graph.connect(Edge.REFERENCES, import_, imported)


def lower_alias(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Lower a membership with a name to an alias; ignore a membership without a name."""
    name = node.name or node.short_name
    if not name:
        lowering.verdicts.mark_ignored(node)
        return
    attributes = visibility_attributes(node)
    alias = lowering.add_element(node, Kind.ALIAS, name, owner, **attributes)
    lowering.lower_annotations(node, alias)
    reference = nodes.find_reference(node, "Membership")
    lowering.connect_reference(Edge.REFERENCES, alias, reference)


# -- filters and exposed elements ------------------------------------------------------------------

_EXPOSE = "expose "


def lower_filter(lowering: Lowering, condition: Node, owner: Element | None) -> None:
    """Add the condition that the members of a package or view fulfil to its ``filters``."""
    if owner is None:
        lowering.verdicts.mark_ignored(condition)
    else:
        _append_text(lowering.graph, owner, "filters", values.expression_text(condition, lowering))


def lower_expose(lowering: Lowering, node: Node, owner: Element | None) -> None:
    """Add what a view exposes to its ``exposed``, with the condition in brackets."""
    if owner is None:
        lowering.verdicts.mark_ignored(node)
        return
    document = lowering.trees.document_of(node)
    source = "" if document is None else nodes.quote_source(node, document.text)
    names = ", ".join(str(relation.reference) for relation in node.relations)
    text = source.partition(_EXPOSE)[2].removesuffix(";") or names
    _append_text(lowering.graph, owner, "exposed", text)


def _append_text(graph: Graph, element: Element, key: str, text: str) -> None:
    texts = list_items(element.attrs.get(key))
    graph.set(element, **{key: (*texts, text)})
