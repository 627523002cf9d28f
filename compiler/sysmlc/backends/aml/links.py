"""Internal links, and the references by id that wait until everything has its id."""

from collections.abc import Iterable

from sysmlc.backends.aml import header, interfaces
from sysmlc.backends.aml.book import Book, File
from sysmlc.backends.aml.families import is_inline
from sysmlc.backends.aml.node import Node
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.identity import derived_id

_SIDES = ("RefPartnerSideA", "RefPartnerSideB")


def write(book: Book) -> None:
    """Add a link for each connector, and for each dependency that was a link."""
    for one in book.graph.of_kind(Kind.CONNECTOR):
        _connector(book, one)
    dependencies = book.graph.of_kind(Kind.DEPENDENCY)
    is_open = any("sides" in one.attrs for one in dependencies)
    ids = _written(book) if is_open else frozenset()
    for one in dependencies:
        if "sides" in one.attrs:
            _as_written(book, one, ids)
        elif "ports" in one.attrs:
            _relation(book, one)


def _connector(book: Book, connector: Element) -> None:
    ends = book.graph.targets(connector, Edge.END)
    holder = _holder(book, connector, ends)
    if holder is None or len(ends) != 2:
        return
    sides = [_end(book, connector, holder, end) for end in ends]
    if all(sides):
        _link(book, connector, holder, sides)
        for end in ends:
            book.said.add(end.id)


def _holder(book: Book, connector: Element, ends: Iterable[Element]) -> Node | None:
    """What holds the link: its owner; of one across a hierarchy the first element at the top."""
    owner = book.graph.owner(connector)
    node = book.nodes.get(owner.id) if owner is not None else None
    if node is None or node.tag != "InstanceHierarchy":
        return node if node is not None and node.tag in _HOLDERS else None
    tops = [book.graph.target(end, Edge.PATH) for end in ends]
    known = [book.nodes[top.id] for top in tops if top is not None and top.id in book.nodes]
    others = [one for one in node.children if one.tag == "InternalElement" and one not in known]
    if known and known.count(known[0]) == len(known) and others:
        return others[0]
    return known[0] if known else None


_HOLDERS = frozenset({"InternalElement", "SystemUnitClass"})


def _link(book: Book, element: Element, holder: Node, sides: list[str]) -> None:
    name = element.name or "link"
    node = Node("InternalLink", {"Name": name} | dict(zip(_SIDES, sides, strict=True)))
    if book.ids.literal(element):
        node.attributes["ID"] = book.ids.literal(element)
    header.write(book, element, node)
    book.put(element, holder.add(node))


def _end(book: Book, connector: Element, holder: Node, end: Element) -> str:
    """The ID of the interface at an end; the interface is repeated where it must be."""
    graph = book.graph
    port = graph.target(end, Edge.ROLE)
    if port is None or port.kind is not Kind.PORT:
        return ""
    owner = graph.owner(connector)
    file = book.file_of(owner or connector)
    node: Node | None = holder
    for step in graph.targets(end, Edge.PATH):
        if step.kind is Kind.INSTANCE:
            node = book.nodes.get(step.id)
        elif node is not None and step.kind is Kind.PROPERTY:
            node = node.parts.get(step.id) or _part(book, node, step, file)
        elif step is not port:
            node = None
    return "" if node is None else _interface(book, node, port, file)


def _part(book: Book, above: Node, part: Element, file: File) -> Node | None:
    """A part of the class that the internal element does not repeat: it is repeated for a link."""
    type_ = book.graph.target(part, Edge.TYPED_BY)
    if above.tag not in _HOLDERS or not above.id:
        return None
    node = Node("InternalElement", {"Name": part.name, "ID": derived_id(above.id, part.id)})
    path = book.path(type_, file) if type_ is not None and not is_inline(type_) else ""
    if path:
        node.attributes["RefBaseSystemUnitPath"] = path
    above.parts[part.id] = node
    return above.add(node)


def _interface(book: Book, node: Node, port: Element, file: File) -> str:
    found = interfaces.repeated(book, port, file, node)
    if not found.id:
        found.attributes["ID"] = derived_id(f"{node.id} {node.attributes.get('Name')}", port.id)
    return found.id


# -- dependencies ------------------------------------------------------------------------------


def _written(book: Book) -> frozenset[str]:
    """All IDs in the files."""
    found = set()
    waiting = [file.root for file in book.files]
    while waiting:
        node = waiting.pop()
        found.add(node.id)
        waiting += node.children
    return frozenset(found)


def _as_written(book: Book, element: Element, ids: frozenset[str]) -> None:
    """A link that leads nowhere, as it was: the side that leads somewhere has an ID."""
    holder = _holder(book, element, ())
    sides = element.attrs["sides"]
    if holder is None or not isinstance(sides, tuple):
        return
    texts = [str(side) for side in sides]
    _link(book, element, holder, texts)
    edges = sum(len(book.graph.targets(element, edge)) for edge in (Edge.CLIENT, Edge.SUPPLIER))
    if sum(bool(text) and _is_known(text, ids) for text in texts) >= edges:
        _said(book, element)


def _is_known(text: str, ids: frozenset[str]) -> bool:
    ends = [at for at, sign in enumerate(text) if sign == ":"]
    return text in ids or any(text[:at] in ids for at in ends) or "/" in text


def _said(book: Book, element: Element) -> None:
    for edge in (Edge.CLIENT, Edge.SUPPLIER):
        for target in book.graph.targets(element, edge):
            book.say(edge, element, target)


def _relation(book: Book, element: Element) -> None:
    """Who does what with what, or what follows on what: a link between two interfaces.

    The supplier stands first: without directions the first side is the earlier one.
    """
    holder = _holder(book, element, ())
    ports = element.attrs["ports"]
    if holder is None or not isinstance(ports, tuple):
        return
    sides = []
    for edge, id in zip((Edge.CLIENT, Edge.SUPPLIER), ports, strict=True):
        target, port = book.graph.target(element, edge), book.graph.get(str(id))
        node = book.nodes.get(target.id) if target is not None else None
        if node is not None and port is not None and target is not None:
            sides.append(_interface(book, node, port, book.file_of(target)))
    if len(sides) == 2:
        if element.subkind == "succession":
            sides.reverse()
        _link(book, element, holder, sides)
        _said(book, element)


# -- references by id --------------------------------------------------------------------------


def tie(book: Book) -> None:
    """Write the ids of masters into their mirrors."""
    for node, attribute, master in book.late:
        reference = _reference(book, master)
        if reference:
            node.attributes[attribute] = reference


def _reference(book: Book, master: Element) -> str:
    """The ID of a master; of an attribute that of its object, and the names that lead to it."""
    names: list[str] = []
    one: Element | None = master
    while one is not None:
        node = book.nodes.get(one.id)
        if node is not None and node.id:
            return "/".join([node.id, *reversed(names)])
        if one.kind in (Kind.PROPERTY, Kind.SLOT):
            names.append(one.name)
        one = _above(book, one)
    return ""


def _above(book: Book, element: Element) -> Element | None:
    owner = book.graph.owner(element)
    if owner is not None and is_inline(owner) and owner.subkind == "attribute":
        return book.graph.source(owner, Edge.TYPED_BY)
    return owner
