"""Dependencies, derivations, allocations, imports."""

from typing import TYPE_CHECKING

from sysmlc.frontends.sysml import annotations, nodes
from sysmlc.frontends.sysml.connections import steps_of
from sysmlc.frontends.sysml.definitions import visibility
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.language.tree import Node

if TYPE_CHECKING:
    from sysmlc.frontends.sysml.lowering import Lowering

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
_REFINEMENT = "Refinement"


def dependency(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A dependency by what its keyword says; some are no elements but edges."""
    words = keywords(node)
    clients, suppliers = nodes.references(node, "client"), nodes.references(node, "supplier")
    edge = next((_EDGES[one] for one in words if one in _EDGES), None)
    if "Realization" in words and not node.name and _is_inside(low, clients[:1], owner):
        edge = Edge.REALIZES
    if edge is not None and clients:
        low.later(lambda: _edge(low, edge, node))
        return
    if "Extension" in words:
        _extend(low, node, owner)
        return
    made = low.add(node, Kind.DEPENDENCY, node.name or "", owner, **_attrs(words))
    low.set(made, **visibility(node))
    for client in clients:
        low.refer(Edge.CLIENT, made, client)
    for supplier in suppliers:
        low.refer(Edge.SUPPLIER, made, supplier)
    low.lower_all((one for one in nodes.body_of(node) if not _is_refinement(one)), made)


def _is_refinement(node: Node) -> bool:
    """Whether it is the keyword of the standard library that the role of a dependency says."""
    target = nodes.target(node, "FeatureTyping") if _is_prefix(node) else None
    if target is None or target.owner is None:
        return False
    return (target.owner.name, target.name) == ("ModelingMetadata", _REFINEMENT)


def keywords(node: Node) -> list[str]:
    """Names of the metadata definitions that a node has, of our library or of the standard's."""
    found = list(annotations.ours(node))
    for one in nodes.members(node, "MetadataUsage"):
        target = nodes.target(one, "FeatureTyping")
        named = nodes.reference(one, "FeatureTyping")
        if target is not None and target.name and one.attributes.get("isPrefix"):
            found.append(target.name)
        elif named is not None and one.attributes.get("isPrefix"):
            found.append(nodes.last_name(named).capitalize())
    return found


def _is_inside(low: "Lowering", clients: "list", owner: Element | None) -> bool:  # type: ignore[type-arg]
    return bool(clients) and owner is not None and low.element(clients[0].target) is owner


def _edge(low: "Lowering", edge: Edge, node: Node) -> None:
    for client in nodes.references(node, "client"):
        source = low.element(client.target)
        for supplier in nodes.references(node, "supplier") if source is not None else ():
            if source is not None:
                low.lead(edge, source, supplier.target)


def _attrs(words: list[str]) -> dict[str, AttrValue]:
    role = next((_ROLES[one] for one in words if one in _ROLES), "")
    if _REFINEMENT in words:
        role = "refine"
    subkind = next((_SUBKINDS[one] for one in words if one in _SUBKINDS), "")
    return {"role": role, "subkind": subkind or ("abstraction" if role else "dependency")}


def _extend(low: "Lowering", node: Node, owner: Element | None) -> None:
    made = low.add(node, Kind.EXTEND, node.name or "", owner)
    low.later(lambda: _extended(low, node, made, owner))


def _extended(low: "Lowering", node: Node, made: Element, owner: Element | None) -> None:
    for found in nodes.references(node, "supplier"):
        target = low.element(found.target)
        is_case = target is not None and target.kind is Kind.USE_CASE
        low.lead(Edge.EXTENDS if is_case else Edge.REFERENCES, made, found.target)
        if is_case and owner is not None and owner.kind is Kind.USE_CASE and target is not None:
            low.graph.connect(Edge.EXTENDS, owner, target)


# -- connections that mean a dependency --------------------------------------------------------


def derivation(low: "Lowering", node: Node, owner: Element | None) -> None:
    """A derivation connection of the standard library: derived requirements and their original."""
    attrs: dict[str, AttrValue] = {"role": "derive", "subkind": "abstraction"}
    made = low.add(node, Kind.DEPENDENCY, node.name or "", owner, **attrs)
    for end in nodes.ends_of(node) + [one for one in node.members if one.attributes.get("isEnd")]:
        is_original = any(one.startswith("Original") for one in keywords(end))
        edge = Edge.SUPPLIER if is_original else Edge.CLIENT
        for found in nodes.references(end, "ReferenceSubsetting"):
            low.refer(edge, made, found)
    low.lower_all((one for one in node.members if nodes.is_text(one) and not _is_prefix(one)), made)


def _is_prefix(node: Node) -> bool:
    return bool(node.attributes.get("isPrefix"))


def is_derivation(node: Node) -> bool:
    """Whether a connection is a derivation."""
    return any(one.startswith("Derivation") for one in keywords(node))


def allocation(low: "Lowering", node: Node, owner: Element | None) -> None:
    """An allocation between usages."""
    attrs: dict[str, AttrValue] = {"role": "allocate", "subkind": "abstraction"}
    made = low.add(node, Kind.DEPENDENCY, node.name or "", owner, **attrs)
    low.later(lambda: _allocate(low, node, made))
    inner = list(nodes.members(node, "AllocationUsage"))
    annotations.texts(low, node, made, "an allocation", inner)
    low.lower_all(inner, owner)


def _allocate(low: "Lowering", node: Node, made: Element) -> None:
    for edge, end in zip((Edge.CLIENT, Edge.SUPPLIER), nodes.ends_of(node), strict=False):
        steps = steps_of(end)
        low.lead(edge, made, steps[-1] if steps else None)


def import_(low: "Lowering", node: Node, owner: Element | None) -> None:
    """An import of a package or an element; those of libraries need no element."""
    filtered = [one for package in nodes.members(node, "Package") for one in package.members]
    said = next((one for one in filtered if one.kind.endswith("Import")), node)
    found = nodes.reference(said, "importedNamespace", "importedMembership")
    target = None if found is None else found.target
    if target is None or low.document(target) is None or owner is None:
        low.external(node)
        return
    subkind = "package" if said.kind == "NamespaceImport" else "element"
    made = low.add(node, Kind.IMPORT, "", owner, subkind=subkind)
    if node.visibility != "public":
        low.set(made, visibility=node.visibility or "private")
    low.lower_texts(node, made)
    low.later(lambda: _imported(low, made, target))
    if said is not node:
        low.approximated(node, "an import with a filter", "one without")
        low.skipped.update(id(one) for one in node.walk() if one is not node)


def _imported(low: "Lowering", made: Element, target: Node) -> None:
    known = low.element(target)
    if known is not None:
        low.graph.connect(Edge.REFERENCES, made, known)


def membership(low: "Lowering", node: Node, owner: Element | None) -> None:
    """An alias: a second name for an element."""
    if not node.name and not node.short_name:
        low.ignored(node)
        return
    name = node.name or node.short_name or ""
    made = low.add(node, Kind.ALIAS, name, owner, **visibility(node))
    low.lower_texts(node, made)
    low.refer(Edge.REFERENCES, made, nodes.reference(node, "Membership"))
