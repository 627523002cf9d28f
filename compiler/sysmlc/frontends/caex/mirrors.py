"""Mirrors: elements that stand for another one, their master, at a second place.

A mirror names an ID where other elements name a class. The master may be a mirror itself: a chain
of mirrors stands for its last master.
"""

from collections.abc import Iterable

from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.context import Context, read_class_reference
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Edge, Element

_MIRROR_REFERENCES = {
    "InternalElement": "RefBaseSystemUnitPath",
    "ExternalInterface": "RefBaseClassPath",
    "Attribute": "RefAttributeType",
}
MEMBER_FAMILIES = {"Attribute": Family.ATTRIBUTE, "ExternalInterface": Family.INTERFACE}
"""Families of the classes that members of internal elements name."""

_GUID_LENGTH = 36


def _read_master_id(node: Node) -> str:
    """Return the ID that a reference holds in place of a class path, or the empty string."""
    text = node.attributes.get(_MIRROR_REFERENCES.get(node.tag, ""), "").strip()
    return text.partition("/")[0] if node.tag == "Attribute" else text


def is_mirror(context: Context, node: Node) -> bool:
    """Whether the node names another element and no class."""
    id = _read_master_id(node)
    if is_id_reference(context, id):
        return True
    if node.tag != "Attribute" or "." not in id:
        return False
    # AML.Engine calls `ID.name` a mirror, too, but only finds the master of `ID/name`.
    return is_id_reference(context, id.partition(".")[0])


def is_id_reference(context: Context, text: str) -> bool:
    """Whether a text in the place of a class path is an ID."""
    is_id = context.id_references.get(text)
    if is_id is None:
        is_id = bool(text) and (context.find_node(text) is not None or _looks_like_guid(text))
        context.id_references[text] = is_id
    return is_id


def _looks_like_guid(text: str) -> bool:
    id = text.strip("{}")
    return len(id) == _GUID_LENGTH and id.count("-") == 4 and "/" not in id


def resolve_member_class(context: Context, node: Node, document: Document) -> Type | None:
    """Return the class that an attribute or external interface names.

    A mirror is recorded for ``connect_mirrors``.
    """
    path = read_class_reference(node)
    if not path:
        return None
    if is_mirror(context, node):
        context.mirror_nodes.append((document, node))
        return None
    return context.resolve_type(path, MEMBER_FAMILIES[node.tag], document, node)


def connect_mirrors(context: Context) -> None:
    """Connect the mirrors of interfaces and attributes to their masters, and type them alike."""
    for document, node in context.mirror_nodes:
        master = connect_to_master(context, document, node, context.graph[node.element_id])
        if master is not None:
            type = context.graph.target(context.graph[master.element_id], Edge.TYPED_BY)
            if type is not None:
                context.graph.connect(Edge.TYPED_BY, node.element_id, type)


def connect_to_master(
    context: Context, document: Document, node: Node, element: Element
) -> Node | None:
    """Connect the element of a mirror to that of its master; return the master."""
    master = find_master(context, document, node)
    if master is not None and master.element_id in context.graph:
        context.graph.connect(Edge.MIRRORS, element.id, master.element_id)
        return master
    return None


def find_master(context: Context, document: Document, node: Node) -> Node | None:
    """Return the last master of a chain of mirrors; report a missing master and a cycle."""
    chain: dict[Node, None] = {}
    circular = context.circular_mirrors
    while is_mirror(context, node) and node not in chain and node not in circular:
        chain[node] = None
        master = context.masters.get((document, node)) or _find_next(context, document, node)
        if isinstance(master, str):
            _store_masters(context, document, chain, master)
            _report_missing(context, document, next(iter(chain)), master)
            return None
        node = master
    first = next(iter(chain), node)
    if chain:
        context.report_inexact_id(document, first, _read_master_id(first))
    if node in chain or node in circular:
        circular.update(chain)
        _report_cycle(context, document, first)
        return None
    _store_masters(context, document, chain, node)
    return node


def _find_next(context: Context, document: Document, mirror: Node) -> Node | str:
    """Return the node that a mirror names, or its reference if that leads nowhere."""
    located = context.find_node(_read_master_id(mirror), document)
    if located is None:
        return read_class_reference(mirror)
    if mirror.tag == "Attribute":
        return _find_attribute(located[1], mirror) or read_class_reference(mirror)
    return located[1]


def _find_attribute(owner: Node, mirror: Node) -> Node | None:
    """Return the attribute of *owner* that ``ID/name`` or ``ID/name/inner`` means."""
    names = mirror.attributes["RefAttributeType"].strip().split("/")[1:] or [mirror.name]
    node: Node | None = owner
    for name in names:
        if node is not None:
            inner = node.iter_children("Attribute")
            node = next((attribute for attribute in inner if attribute.name == name), None)
    return node


def _store_masters(
    context: Context, document: Document, chain: Iterable[Node], master: Node | str
) -> None:
    """Store the end of a chain for each of its mirrors, so that no chain is followed twice."""
    context.masters.update(((document, mirror), master) for mirror in chain)


def _report_missing(context: Context, document: Document, node: Node, reference: str) -> None:
    _record_path(context, node)
    facts = {"element": node.name, "reference": reference}
    context.report(rules.MIRROR_WITHOUT_MASTER, document, node, f"no master {reference}", **facts)


def _report_cycle(context: Context, document: Document, node: Node) -> None:
    _record_path(context, node)
    facts = {"element": node.name, "reference": _read_master_id(node)}
    context.report(rules.MIRROR_CYCLE, document, node, **facts)


def _record_path(context: Context, node: Node) -> None:
    if node.element_id in context.graph:
        context.record_unresolved_path(context.graph[node.element_id], node)
