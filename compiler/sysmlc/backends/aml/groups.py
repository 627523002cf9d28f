"""Facets and groups: internal elements that only show others (IEC 62714-1)."""

from sysmlc.backends.aml import header, roles
from sysmlc.backends.aml.book import Book, File
from sysmlc.backends.aml.node import Node
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.identity import derived_id

_BASE = "AutomationMLBaseRoleClassLib/AutomationMLBaseRole"
ROLES = {Kind.FACET: f"{_BASE}/Facet", Kind.GROUP: f"{_BASE}/Group"}
"""Role classes of the standard that make an internal element one of these."""
_TAGS = {
    Kind.PROPERTY: ("Attribute", "RefAttributeType"),
    Kind.PORT: ("ExternalInterface", "RefBaseClassPath"),
}

_ELEMENT = ("InternalElement", "RefBaseSystemUnitPath")


def write(book: Book, element: Element, file: File) -> Node:
    """The internal element of a facet or group, with mirrors of what it shows."""
    node = book.put(element, Node("InternalElement", {"Name": element.name}))
    node.attributes["ID"] = book.ids.of(element)
    header.write(book, element, node)
    if "associated_facet" in element.attrs:
        facet = node.add(Node("Attribute", {"Name": "AssociatedFacet"}))
        facet.attributes["AttributeDataType"] = "xs:string"
        facet.say("Value", str(element.attrs["associated_facet"]))
    for target in book.graph.targets(element, Edge.REFERENCES):
        book.say(Edge.REFERENCES, element, target)
        for name, id in _called(element, target):
            _mirror(book, element, node, target, name, id)
    for one in book.owned(element):
        if one.kind is Kind.GROUP:
            node.add(write(book, one, file))
    roles.write(book, node, file, element)
    if all(one.tag != "RoleRequirements" for one in node.children):
        node.add(Node("RoleRequirements", {"RefBaseRoleClassPath": _role(book, element, file)}))
    return node


def _called(element: Element, target: Element) -> list[tuple[str, str]]:
    """Name and ID of each mirror of a target; those of the target's name may have no ID."""
    kept = element.attrs.get("mirrors")
    given = [one for one in kept if isinstance(one, tuple)] if isinstance(kept, tuple) else []
    found = [(str(name), str(id)) for known, name, id in given if known == target.id]
    return found or [(target.name, "")]


def _role(book: Book, element: Element, file: File) -> str:
    """The role class as it is written in this file: it may be behind an alias."""
    plain = ROLES[element.kind]
    for id, place in book.places.items():
        if "/".join(place.names) == plain:
            return book.path(book.graph[id], file) or plain
    return plain


def _mirror(book: Book, element: Element, above: Node, target: Element, name: str, id: str) -> None:
    is_facet = element.kind is Kind.FACET
    tag, attribute = _TAGS.get(target.kind, _ELEMENT) if is_facet else _ELEMENT
    node = above.add(Node(tag, {"Name": name}))
    if id or tag != "Attribute":
        node.attributes["ID"] = id or derived_id(element.id, f"caex mirror {target.id}")
    book.late.append((node, attribute, target))
