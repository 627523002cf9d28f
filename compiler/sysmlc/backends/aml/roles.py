"""Roles: what a class supports, what an internal element requires, and mapping objects."""

from collections.abc import Iterator

from sysmlc.backends.aml.book import Book, File
from sysmlc.backends.aml.families import Family
from sysmlc.backends.aml.node import Node
from sysmlc.backends.aml.values import text_of
from sysmlc.ir import Edge, Element, Kind

_TAGS = ("SupportedRoleClass", "RoleRequirements")
_PATHS = {"SupportedRoleClass": "RefRoleClassPath", "RoleRequirements": "RefBaseRoleClassPath"}


def write(book: Book, node: Node, file: File, *players: Element) -> None:
    """Add the roles that some elements play, which one node stands for."""
    tag = _TAGS[node.tag == "InternalElement"]
    for player in players:
        for role in book.graph.targets(player, Edge.REALIZES):
            if path := _path(book, role, file):
                book.say(Edge.REALIZES, player, role)
                _role(node, tag, path)
        _unresolved(player, node)
        _required(book, player, node)


def inherited(book: Book, node: Node, file: File, type_: Element) -> None:
    """Let an instance play the roles that its class supports, as AutomationML wants."""
    for one in _chain(book, type_):
        for role in book.graph.targets(one, Edge.REALIZES):
            if path := _path(book, role, file):
                _role(node, "RoleRequirements", path)


def _path(book: Book, role: Element, file: File) -> str:
    place = book.places.get(role.id)
    return book.path(role, file) if place is not None and place.family is Family.ROLE else ""


def _role(node: Node, tag: str, path: str) -> Node:
    """The element that names a role; there is one for each role."""
    for child in node.children:
        if child.tag == tag and child.attributes.get(_PATHS[tag]) == path:
            return child
    return node.add(Node(tag, {_PATHS[tag]: path}))


def _unresolved(player: Element, node: Node) -> None:
    found = player.attrs.get("unresolved_paths")
    for pair in found if isinstance(found, tuple) else ():
        if isinstance(pair, tuple) and pair[0] in _TAGS:
            tag = "SupportedRoleClass" if node.tag != "InternalElement" else str(pair[0])
            _role(node, tag, str(pair[1]))


def _required(book: Book, player: Element, node: Node) -> None:
    for one in book.graph.owned(player):
        if one.kind is Kind.METADATA and one.name == "RoleRequirements":
            path = str(one.attrs.get("role_class", ""))
            made = _role(node, "RoleRequirements", path)
            name = str(one.attrs.get("attribute", ""))
            attribute = made.add(Node("Attribute", {"Name": name}))
            if one.attrs.get("unit"):
                attribute.attributes["Unit"] = str(one.attrs["unit"])
            attribute.say("Value", text_of(one.attrs.get("required", "")))
            book.said.add(one.id)
            for target in book.graph.targets(one, Edge.REFERENCES):
                book.say(Edge.REFERENCES, one, target)


# -- mapping objects ---------------------------------------------------------------------------


def mapped(book: Book) -> dict[str, list[tuple[Element, Element]]]:
    """Features that redefine those of roles, by the id of the class that has them."""
    found: dict[str, list[tuple[Element, Element]]] = {}
    for _, source, target in book.graph.edges(Edge.REDEFINES):
        feature, of_role = book.graph[source], book.graph[target]
        place = book.places.get(of_role.owner or "")
        if place is not None and place.family is Family.ROLE and feature.owner is not None:
            found.setdefault(feature.owner, []).append((feature, of_role))
    return found


def map_features(book: Book, node: Node, file: File, type_: Element) -> None:
    """Add the mapping objects for features of a class and of those that it specialises."""
    for one in _chain(book, type_) if book.mapped else ():
        for feature, target in book.mapped.get(one.id, ()):
            if (Edge.REDEFINES, feature.id, target.id) in book.relations:
                continue
            role = _role_with(book, node, file, target)
            if role is not None:
                holder = next((c for c in role.children if c.tag == "MappingObject"), None)
                holder = holder or role.add(Node("MappingObject"))
                holder.add(_mapping(book, feature, target))
                book.say(Edge.REDEFINES, feature, target)


def _role_with(book: Book, node: Node, file: File, target: Element) -> Node | None:
    """The role of an element that has a feature, of its own or inherited."""
    for child in node.children:
        if child.tag in _TAGS:
            path = child.attributes.get(_PATHS[child.tag], "")
            role = book.class_at(path, Family.ROLE, file)
            if role is not None and any(one.id == target.owner for one in _chain(book, role)):
                return child
    return None


def _mapping(book: Book, feature: Element, target: Element) -> Node:
    if feature.kind is Kind.PORT:
        ids = {
            "SystemUnitInterfaceID": book.ids.of(feature),
            "RoleInterfaceID": book.ids.of(target),
        }
        return Node("InterfaceIDMapping", ids)
    names = {"SystemUnitAttributeName": feature.name, "RoleAttributeName": target.name}
    return Node("AttributeNameMapping", names)


def _chain(book: Book, role: Element) -> Iterator[Element]:
    seen: set[str] = set()
    one: Element | None = role
    while one is not None and one.id not in seen:
        seen.add(one.id)
        yield one
        one = book.graph.target(one, Edge.SPECIALIZES)
