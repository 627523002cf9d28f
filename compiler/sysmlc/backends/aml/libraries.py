"""Libraries: every class gets its place first, so that paths are known, and then its content."""

from sysmlc.backends.aml import attributes, elements, header, interfaces, roles
from sysmlc.backends.aml.attributes import unresolved
from sysmlc.backends.aml.book import Book, File, Place
from sysmlc.backends.aml.families import HIERARCHY, LIBRARIES, Family
from sysmlc.backends.aml.node import Node
from sysmlc.backends.aml.rules import APPROXIMATED, MOVED
from sysmlc.ir import Edge, Element, Kind


def place(book: Book) -> None:
    """Give every library and class a node, those of the standard that no file holds a path."""
    waiting = list(reversed(book.graph.roots()))
    while waiting:
        one = waiting.pop()
        waiting += reversed(book.graph.owned(one))
        if one.subkind in LIBRARIES and one.kind is Kind.PACKAGE:
            _library(book, one)
        else:
            family = book.families.of(one)
            if family is not None and (not one.attrs.get("external") or _is_held(book, one)):
                _class(book, one, family)


def _library(book: Book, package: Element) -> None:
    if package.attrs.get("external") and not _is_held(book, package):
        return
    file = book.file_of(package)
    _new_library(book, package, LIBRARIES[package.subkind], file, package.name)


def _is_held(book: Book, element: Element) -> bool:
    """Whether it stands in a file of the unit, or is of a standard library that none holds."""
    return book.ids.is_ours(element) or (not element.source and _is_standard(book, element))


def _is_standard(book: Book, element: Element) -> bool:
    return element.subkind not in LIBRARIES and any(
        one.subkind in LIBRARIES for one in book.graph.ancestors(element)
    )


def _new_library(book: Book, package: Element, family: Family, file: File, name: str) -> Node:
    node = file.root.add(Node(family.library, {"Name": name}))
    if book.ids.literal(package):
        node.attributes["ID"] = book.ids.literal(package)
    book.put(package, node)
    header.write(book, package, node)
    return node


def _class(book: Book, element: Element, family: Family) -> None:
    owner = book.graph.owner(element)
    above = book.places.get(owner.id) if owner is not None else None
    if above is not None and above.family is not family and owner is not None:
        facts = {"kind": f"{family} {element.kind}", "owner": str(above.family)}
        book.losses.note(MOVED, element, kind=str(element.kind), owner=facts["owner"])
        above = None
    if above is not None:
        holder, names, file = above.node, above.names, above.file
    else:
        holder, names, file = _holder(book, element, family)
    if file is None:
        book.enter(element, Place(None, (*names, element.name), None, family))
        return
    node = Node(family.value, {"Name": _name(element, holder, book)})
    if book.ids.literal(element):
        node.attributes["ID"] = book.ids.literal(element)
    if holder is not None:
        holder.add(node)
    book.put(element, node)
    book.enter(element, Place(node, (*names, node.attributes["Name"]), file, family))


def _name(element: Element, holder: Node | None, book: Book) -> str:
    """The name; in a model of UML made different from that of another sort of class."""
    name, number = element.name, 1
    if holder is not None and not book.ids.is_ours(element):
        taken = {child.attributes.get("Name") for child in holder.children}
        while name in taken:
            number += 1
            name = f"{element.name} ({number})"
    if number > 1:
        facts = {"said": "a second class of one name", "written": "one with a number"}
        book.losses.note(APPROXIMATED, element, **facts)
    return name


def _holder(
    book: Book, element: Element, family: Family
) -> tuple[Node | None, tuple[str, ...], File | None]:
    """The library for a class that is in no other: that of the nearest package."""
    package = next((p for p in book.graph.ancestors(element) if p.kind is Kind.PACKAGE), None)
    if package is not None and package.subkind in LIBRARIES:
        known = book.nodes.get(package.id)
        file = book.file_of(element) if known is not None else None
        return known, (package.name,), file
    file = book.file_of(element)
    name = library_name(book, package)
    for node in file.root.children:
        if node.tag == family.library and node.attributes["Name"] == name:
            return node, (name,), file
    made = file.root.add(Node(family.library, {"Name": name}))
    if package is not None:
        book.put(package, made)
        header.write(book, package, made)
        _nested(book, package)
    return made, (name,), file


def library_name(book: Book, package: Element | None) -> str:
    """Name of the library for the classes of a package: its whole name."""
    name = book.graph.qualified_name(package) if package is not None else "Model"
    return name.replace("::", ".")


def _nested(book: Book, package: Element) -> None:
    if package.owner is not None:
        facts = {"said": "a package in a package", "written": "a library with its whole name"}
        book.losses.note(APPROXIMATED, package, **facts)


def fill(book: Book) -> None:
    """Add what classes hold."""
    book.mapped = roles.mapped(book)
    for id, place in list(book.places.items()):
        if place.node is None or place.file is None:
            continue
        element = book.graph[id]
        _base(book, element, place)
        header.write(book, element, place.node)
        if place.family is Family.ATTRIBUTE:
            attributes.fill_type(book, element, place.node, place.file)
        elif place.family is Family.INTERFACE:
            _interface_class(book, element, place.node, place.file)
        else:
            elements.fill_class(book, element, place.node, place.file)


def _base(book: Book, element: Element, place: Place) -> None:
    if place.node is None or place.file is None:
        return
    for general in book.graph.targets(element, Edge.SPECIALIZES):
        known = book.places.get(general.id)
        if known is None and place.family is Family.ATTRIBUTE:
            book.say(Edge.SPECIALIZES, element, general)
        elif known is not None and known.family is place.family:
            path = book.path(general, place.file)
            if path and place.family.base not in place.node.attributes:
                place.node.attributes[place.family.base] = path
                book.say(Edge.SPECIALIZES, element, general)
    missing = unresolved(element, place.family.value)
    if missing:
        place.node.attributes.setdefault(place.family.base, missing)


def _interface_class(book: Book, element: Element, node: Node, file: File) -> None:
    for one in book.graph.owned(element):
        if attributes.is_attribute(book, one):
            node.add(attributes.write(book, one, file))
        elif one.kind is Kind.PORT:
            interfaces.write(book, one, file, node)


def hierarchies(book: Book) -> None:
    """Add the instance hierarchies: those of files, and packages that hold instances."""
    for package in book.graph.of_kind(Kind.PACKAGE):
        if package.subkind == HIERARCHY:
            node = Node("InstanceHierarchy", {"Name": package.name})
            if book.ids.literal(package):
                node.attributes["ID"] = book.ids.literal(package)
            book.put(package, book.file_of(package).root.add(node))
            header.write(book, package, node)
            elements.fill_hierarchy(book, package, node, book.file_of(package))
        elif package.subkind not in LIBRARIES and elements.has_instances(book, package):
            name = library_name(book, package)
            node = Node("InstanceHierarchy", {"Name": name})
            book.put(package, book.file_of(package).root.add(node))
            elements.fill_hierarchy(book, package, node, book.file_of(package))
