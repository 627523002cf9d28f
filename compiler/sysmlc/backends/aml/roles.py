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
    mappings = list(_mappings(book, players))
    for player in players:
        for role in book.graph.targets(player, Edge.REALIZES):
            if path := _path(book, role, file):
                book.say(Edge.REALIZES, player, role)
                made = _role(node, tag, path)
                _map(book, made, role, mappings)
        _unresolved(player, node)
        _required(book, player, node)


def inherited(book: Book, node: Node, file: File, type_: Element | None) -> None:
    """Let an instance play the roles that its class supports, as AutomationML wants."""
    seen: set[str] = set()
    while type_ is not None and type_.id not in seen:
        seen.add(type_.id)
        for role in book.graph.targets(type_, Edge.REALIZES):
            if path := _path(book, role, file):
                _role(node, "RoleRequirements", path)
        type_ = book.graph.target(type_, Edge.SPECIALIZES)


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
            attribute.say("Value", text_of(one.attrs.get("required", "")))
            book.said.add(one.id)
            for target in book.graph.targets(one, Edge.REFERENCES):
                book.say(Edge.REFERENCES, one, target)


# -- mapping objects ---------------------------------------------------------------------------


def _mappings(book: Book, players: tuple[Element, ...]) -> Iterator[tuple[Element, Element]]:
    """Features of the players, with those of roles that they redefine."""
    for player in players:
        for feature in book.graph.owned(player):
            if feature.kind in (Kind.PROPERTY, Kind.PORT):
                for target in book.graph.targets(feature, Edge.REDEFINES):
                    yield feature, target


def _map(book: Book, node: Node, role: Element, mappings: list[tuple[Element, Element]]) -> None:
    chain = {one.id for one in _chain(book, role)}
    for feature, target in mappings:
        if target.owner in chain and (Edge.REDEFINES, feature.id, target.id) not in book.relations:
            holder = next((c for c in node.children if c.tag == "MappingObject"), None)
            holder = holder or node.add(Node("MappingObject"))
            holder.add(_mapping(book, feature, target))
            book.say(Edge.REDEFINES, feature, target)


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
