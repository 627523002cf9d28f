"""External interfaces: ports, with direction, cardinality, category and values."""

from sysmlc.backends.aml import attributes, header
from sysmlc.backends.aml.attributes import unresolved
from sysmlc.backends.aml.book import Book, File
from sysmlc.backends.aml.families import Family, is_inline
from sysmlc.backends.aml.node import Node
from sysmlc.backends.aml.rules import UNSAID_EDGE
from sysmlc.backends.aml.values import text_of, type_of
from sysmlc.ir import AttrValue, Edge, Element, Kind

_DIRECTIONS = {"in": "In", "out": "Out", "inout": "InOut"}
_VALUE = "value."


def write(book: Book, port: Element, file: File, above: Node) -> Node:
    """Add the external interface of a port, with those below it, up to one that holds itself."""
    top = _interface(book, port, file, above)
    waiting: list[tuple[Node, Element | None, frozenset[str]]]
    waiting = [(top, _own_type(book, port), frozenset())]
    while waiting:
        node, type_, around = waiting.pop()
        if type_ is None or type_.id in around:
            continue
        for one in book.owned(type_):
            if one.kind is Kind.PORT:
                inner = _interface(book, one, file, node)
                waiting.append((inner, _own_type(book, one), around | {type_.id}))
            elif attributes.is_attribute(book, one):
                _full(node, attributes.write(book, one, file))
    return top


def _full(interface: Node, attribute: Node) -> None:
    """Put an attribute with all that it says in the place of that with its value alone."""
    known = interface.child("Attribute", attribute.attributes["Name"])
    interface.add(attribute)
    if known is not None:
        said = {child.tag for child in attribute.children}
        attribute.children += [child for child in known.children if child.tag not in said]
        interface.children.remove(known)


def _interface(book: Book, port: Element, file: File, above: Node) -> Node:
    node = book.put(port, Node("ExternalInterface", {"Name": port.name}))
    node.attributes["ID"] = book.ids.of(port)
    above.add(node)
    above.interfaces[port.id] = node
    for target in book.graph.targets(port, Edge.REDEFINES):
        above.interfaces.setdefault(target.id, node)
    _refer(book, port, node, file)
    say(book, port, port, node)
    header.write(book, port, node)
    return node


def _refer(book: Book, port: Element, node: Node, file: File) -> None:
    graph = book.graph
    master = graph.target(port, Edge.MIRRORS)
    types = graph.targets(port, Edge.TYPED_BY)
    if master is not None:
        for one in types:
            book.say(Edge.TYPED_BY, port, one)
        book.say(Edge.MIRRORS, port, master)
        book.late.append((node, "RefBaseClassPath", master))
        return
    path = class_path(book, port, file) or unresolved(port, "ExternalInterface")
    if path:
        node.attributes["RefBaseClassPath"] = path


def class_path(book: Book, port: Element, file: File) -> str:
    """Path of the interface class that types a port, or the empty string."""
    graph = book.graph
    for one in graph.targets(port, Edge.TYPED_BY):
        declared = graph.target(one, Edge.SPECIALIZES) if is_inline(one) else one
        if is_inline(one):
            book.said.add(one.id)
            book.say(Edge.TYPED_BY, port, one)
        if declared is None:
            continue
        place = book.places.get(declared.id)
        if place is not None and place.family is Family.INTERFACE:
            path = book.path(declared, file)
            if path:
                book.say(Edge.TYPED_BY, port, one)
                return path
        facts = {"edge": "typed-by", "kind": str(port.kind), "target": str(declared.kind)}
        book.losses.note(UNSAID_EDGE, port, **facts)
        book.say(Edge.TYPED_BY, port, one)
    return ""


def _own_type(book: Book, port: Element) -> Element | None:
    """The class that was made for an interface with interfaces of its own."""
    type_ = book.graph.target(port, Edge.TYPED_BY)
    return type_ if type_ is not None and is_inline(type_) else None


def say(book: Book, element: Element, port: Element, node: Node) -> None:
    """Add as attributes what a port, or a slot for it, says."""
    attrs = element.attrs
    direction = _DIRECTIONS.get(str(attrs.get("direction")))
    if direction:
        _attribute(node, "Direction", direction)
    if "multiplicity" in attrs:
        _cardinality(node, str(attrs["multiplicity"]))
    if "category" in attrs:
        _attribute(node, "Category", str(attrs["category"]))
    for key in sorted(attrs):
        if key.startswith(_VALUE):
            _value(node, key.removeprefix(_VALUE).split("."), attrs[key])
    _type_as_in_class(book, book.graph.target(port, Edge.TYPED_BY), node)


def _type_as_in_class(book: Book, type_: Element | None, above: Node) -> None:
    """Let attributes have the data types that the class of their interface gives them."""
    waiting = [(type_, above)]
    while waiting:
        one, node = waiting.pop()
        features = _values_of(book, one)
        for child in node.children:
            feature = features.get(child.attributes.get("Name", ""))
            if child.tag != "Attribute" or feature is None:
                continue
            if child.attributes.pop("AttributeDataType", None) and "data_type" in feature.attrs:
                child.attributes["AttributeDataType"] = str(feature.attrs["data_type"])
            waiting.append((book.graph.target(feature, Edge.TYPED_BY), child))


def _values_of(book: Book, type_: Element | None) -> dict[str, Element]:
    """The value properties of a type and of those that it specialises, the nearest first."""
    found: dict[str, Element] = {}
    seen: set[str] = set()
    while type_ is not None and type_.id not in seen:
        seen.add(type_.id)
        for one in book.graph.owned(type_):
            if one.kind is Kind.PROPERTY:
                found.setdefault(one.name, one)
        type_ = book.graph.target(type_, Edge.SPECIALIZES)
    return found


def _cardinality(node: Node, multiplicity: str) -> None:
    lower, between, upper = multiplicity.partition("..")
    made = node.add(Node("Attribute", {"Name": "Cardinality"}))
    _attribute(made, "MinOccur", lower)
    _attribute(made, "MaxOccur", upper if between else lower)


def _attribute(node: Node, name: str, value: AttrValue) -> None:
    made = node.child("Attribute", name) or node.add(Node("Attribute", {"Name": name}))
    if type_of(value):
        made.attributes["AttributeDataType"] = type_of(value)
    made.say("Value", text_of(value))


def _value(node: Node, names: list[str], value: AttrValue) -> None:
    for name in names[:-1]:
        node = node.child("Attribute", name) or node.add(Node("Attribute", {"Name": name}))
    _attribute(node, names[-1], value)


# -- in an instance ----------------------------------------------------------------------------


def repeated(book: Book, port: Element, file: File, above: Node) -> Node:
    """The interface of an internal element that its class has too; added when it is not there."""
    for one in [*reversed(_around(book, port)), port]:
        known = above.interfaces.get(one.id)
        if known is None:
            known = above.add(Node("ExternalInterface", {"Name": one.name}, is_copy=True))
            above.interfaces[one.id] = known
            path = class_path(book, one, file)
            if path:
                known.attributes["RefBaseClassPath"] = path
        above = known
    return above


def _around(book: Book, port: Element) -> list[Element]:
    """The ports that a port is nested in, nearest first."""
    graph, found = book.graph, []
    owner = graph.owner(port)
    while owner is not None and is_inline(owner) and owner.subkind == "external-interface":
        outer = graph.source(owner, Edge.TYPED_BY)
        if outer is None or outer in found:
            break
        found.append(outer)
        owner = graph.owner(outer)
    return found
