"""Mirrors: second places of one element; the last master of a chain is what is meant."""

from collections.abc import Iterable

from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.context import Context, reference_of
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Edge, Element

_REFERENCE = {
    "InternalElement": "RefBaseSystemUnitPath",
    "ExternalInterface": "RefBaseClassPath",
    "Attribute": "RefAttributeType",
}
FAMILIES = {"Attribute": Family.ATTRIBUTE, "ExternalInterface": Family.INTERFACE}
"""Families of the classes that members of internal elements name."""

_GUID = 36


def master_id(node: Node) -> str:
    """The id that a reference holds in place of a class path, or the empty string."""
    text = node.attributes.get(_REFERENCE.get(node.tag, ""), "").strip()
    return text.partition("/")[0] if node.tag == "Attribute" else text


def is_mirror(context: Context, node: Node) -> bool:
    """Whether the node names another element and no class."""
    if is_reference(context, master_id(node)):
        return True
    return node.tag == "Attribute" and _is_dotted(context, master_id(node))


def _is_dotted(context: Context, text: str) -> bool:
    """Whether a text is ``ID.name``: meant as a mirror, but names are parted by ``/`` (rule 12)."""
    return "." in text and is_reference(context, text.partition(".")[0])


def named_class(context: Context, node: Node, document: Document) -> Type | None:
    """The class that an attribute or external interface names; what mirrors another is noted."""
    path = reference_of(node)
    if not path:
        return None
    if is_mirror(context, node):
        context.mirrors.append((document, node))
        return None
    return context.type(path, FAMILIES[node.tag], document, node)


def is_reference(context: Context, id: str) -> bool:
    """Whether a text in the place of a class path is an id."""
    known = context.references.get(id)
    if known is None:
        known = bool(id) and (context.find(id) is not None or _looks_like_id(id))
        context.references[id] = known
    return known


def master(context: Context, document: Document, node: Node) -> Node | None:
    """What the mirror stands for in the end; a missing one and a circle are reported."""
    seen: dict[Node, None] = {}
    while is_mirror(context, node) and node not in seen and node not in context.endless:
        seen[node] = None
        found = context.masters.get((document, node)) or _next(context, document, node)
        if isinstance(found, str):
            _remember(context, document, seen, found)
            _report(context, document, next(iter(seen)), found)
            return None
        node = found
    first = next(iter(seen), node)
    if seen:
        context.tell_lenient(document, first, master_id(first))
    if node in seen or node in context.endless:
        context.endless.update(seen)
        _report(context, document, first, master_id(first), is_circle=True)
        return None
    _remember(context, document, seen, node)
    return node


def _next(context: Context, document: Document, mirror: Node) -> Node | str:
    """What a mirror names, or the reference with which it leads nowhere."""
    found = context.find(master_id(mirror), document)
    if found is None:
        return reference_of(mirror)
    if mirror.tag == "Attribute":
        return _attribute(found[1], mirror) or reference_of(mirror)
    return found[1]


def _remember(context: Context, document: Document, seen: Iterable[Node], end: Node | str) -> None:
    """Where all mirrors of a chain end: others that name them need not go along it again."""
    context.masters.update(((document, one), end) for one in seen)


def draw(context: Context, document: Document, node: Node, element: Element) -> Node | None:
    """The edge from the mirror's element to its master's; the master."""
    found = master(context, document, node)
    if found is not None and found.element in context.graph:
        context.graph.connect(Edge.MIRRORS, element.id, found.element)
        return found
    return None


def finish(context: Context) -> None:
    """Tie the mirrors of interfaces and attributes to their masters, and type them alike."""
    for document, node in context.mirrors:
        found = draw(context, document, node, context.graph[node.element])
        type = context.graph.target(context.graph[found.element], Edge.TYPED_BY) if found else None
        if type is not None:
            context.graph.connect(Edge.TYPED_BY, node.element, type)


def _attribute(owner: Node, mirror: Node) -> Node | None:
    """``ID/name`` or ``ID/name/inner``: the attribute of the element with that id."""
    names = mirror.attributes["RefAttributeType"].strip().split("/")[1:] or [mirror.name]
    node: Node | None = owner
    for name in names:
        node = next((n for n in node.of("Attribute") if n.name == name), None) if node else None
    return node


def _report(
    context: Context, document: Document, node: Node, reference: str, is_circle: bool = False
) -> None:
    rule = rules.MIRROR_CYCLE if is_circle else rules.MIRROR_WITHOUT_MASTER
    if node.element in context.graph:
        context.keep_path(context.graph[node.element], node)
    context.report(rule, document, node, element=node.name, reference=reference)


def _looks_like_id(text: str) -> bool:
    plain = text.strip("{}")
    return len(plain) == _GUID and plain.count("-") == 4 and "/" not in plain
