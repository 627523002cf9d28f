"""Class libraries and instance hierarchies.

``place_classes`` gives every class its node and path; ``fill_classes`` and ``write_hierarchies``
then write the content, which refers to classes by their paths.
"""

from sysmlc.backends.aml.attributes import fill_attribute_type, is_attribute, make_attribute
from sysmlc.backends.aml.class_kinds import LIBRARIES, ClassKind, find_class_kind, is_hierarchy
from sysmlc.backends.aml.context import ClassEntry, Context, File, find_unresolved
from sysmlc.backends.aml.elements import fill_class, fill_hierarchy, has_plant_objects
from sysmlc.backends.aml.header import write_header
from sysmlc.backends.aml.interfaces import write_interface
from sysmlc.backends.aml.node import Node
from sysmlc.backends.aml.roles import find_role_features
from sysmlc.backends.aml.rules import MOVED
from sysmlc.ir import Edge, Element, Kind


def place_classes(context: Context) -> None:
    """Give every library and class a node.

    A class of a standard library that no file of the unit holds gets only a path.
    """
    stack = list(reversed(context.graph.roots()))
    while stack:
        element = stack.pop()
        stack += reversed(context.graph.owned(element))
        if element.subkind in LIBRARIES and element.kind is Kind.PACKAGE:
            _place_library(context, element)
        else:
            kind = find_class_kind(context.graph, element)
            is_external = element.attrs.get("external") and not _is_in_library(context, element)
            if kind is not None and not is_external:
                _place_class(context, element, kind)


def _is_in_library(context: Context, element: Element) -> bool:
    """Whether the element is in a file of the unit or in a standard library."""
    if context.ids.is_from_caex(element):
        return True
    is_content = not element.source and element.subkind not in LIBRARIES
    return is_content and any(a.subkind in LIBRARIES for a in context.graph.ancestors(element))


def _place_library(context: Context, package: Element) -> None:
    if package.attrs.get("external") and not _is_in_library(context, package):
        return
    root = context.find_file(package).root
    node = root.add(Node(LIBRARIES[package.subkind].library, {"Name": package.name}))
    context.copy_id(package, node)
    context.register(package, node)
    write_header(context, package, node)


def _place_class(context: Context, element: Element, kind: ClassKind) -> None:
    """Add a class to the class that owns it, or to a library if the owner is of another kind."""
    owner = context.classes.get(element.owner or "")
    if owner is not None and owner.kind is not kind:
        context.losses.record(MOVED, element, kind=str(element.kind), owner=str(owner.kind))
        owner = None
    if owner is not None:
        parent, names, file = owner.node, owner.names, owner.file
    else:
        parent, names, file = _find_or_add_library(context, element, kind)
    if file is None:
        context.add_class(element, ClassEntry(None, (*names, element.name), None, kind))
        return
    name = _choose_name(context, element, parent)
    node = Node(kind.value, {"Name": name})
    context.copy_id(element, node)
    if parent is not None:
        parent.add(node)
    context.register(element, node)
    context.add_class(element, ClassEntry(node, (*names, name), file, kind))


def _choose_name(context: Context, element: Element, parent: Node | None) -> str:
    """Return the name of a class, with a number if a sibling has the same name.

    UML allows classifiers of different kinds to have one name. An AutomationML file keeps its
    names, however wrong they are.
    """
    name, number = element.name, 1
    if parent is not None and not context.ids.is_from_caex(element):
        used = {child.attributes.get("Name") for child in parent.children}
        while name in used:
            number += 1
            name = f"{element.name} ({number})"
    if number > 1:
        context.losses.record_approximation(
            element, "a second class of one name", "one with a number"
        )
    return name


def _find_or_add_library(
    context: Context, element: Element, kind: ClassKind
) -> tuple[Node | None, tuple[str, ...], File | None]:
    """Return the library of the nearest package: its node, the path to it, and its file.

    Node and file are None for a library that no file of the unit holds.
    """
    ancestors = context.graph.ancestors(element)
    package = next((item for item in ancestors if item.kind is Kind.PACKAGE), None)
    file = context.find_file(element)
    if package is not None and package.subkind in LIBRARIES:
        node = context.nodes.get(package.id)
        return node, (package.name,), file if node is not None else None
    name = _make_library_name(context, package)
    for node in file.root.children:
        if node.tag == kind.library and node.attributes["Name"] == name:
            return node, (name,), file
    library = file.root.add(Node(kind.library, {"Name": name}))
    if package is not None:
        context.register(package, library)
        write_header(context, package, library)
        if package.owner is not None:
            context.losses.record_approximation(
                package, "a package in a package", "a library with its whole name"
            )
    return library, (name,), file


def _make_library_name(context: Context, package: Element | None) -> str:
    """Return the qualified name of a package with dots: libraries are not nested."""
    name = context.graph.qualified_name(package) if package is not None else "Model"
    return name.replace("::", ".")


# -- content -----------------------------------------------------------------------------------


def fill_classes(context: Context) -> None:
    """Write the content of all classes."""
    context.role_features = find_role_features(context)
    for id, entry in list(context.classes.items()):
        node, file = entry.node, entry.file
        if node is None or file is None:
            continue
        element = context.graph[id]
        _write_base_class(context, element, node, file, entry.kind)
        write_header(context, element, node)
        if entry.kind is ClassKind.ATTRIBUTE:
            fill_attribute_type(context, element, node, file)
        elif entry.kind is ClassKind.INTERFACE:
            _fill_interface_class(context, element, node, file)
        else:
            fill_class(context, element, node, file)


def _write_base_class(
    context: Context, element: Element, node: Node, file: File, kind: ClassKind
) -> None:
    """Write the path of the first base class of the same kind; CAEX has single inheritance."""
    for general in context.graph.targets(element, Edge.SPECIALIZES):
        base = context.classes.get(general.id)
        if base is None and kind is ClassKind.ATTRIBUTE:
            # A primitive type: the attribute's data type expresses it.
            context.mark_edge(Edge.SPECIALIZES, element, general)
        elif base is not None and base.kind is kind:
            path = context.make_class_path(general, file)
            if path and kind.base not in node.attributes:
                node.attributes[kind.base] = path
                context.mark_edge(Edge.SPECIALIZES, element, general)
    unresolved = find_unresolved(element, kind.value)
    if unresolved:
        node.attributes.setdefault(kind.base, unresolved)


def _fill_interface_class(context: Context, element: Element, node: Node, file: File) -> None:
    for member in context.graph.owned(element):
        if is_attribute(context, member):
            node.add(make_attribute(context, member, file))
        elif member.kind is Kind.PORT:
            write_interface(context, member, file, node)


def write_hierarchies(context: Context) -> None:
    """Add an instance hierarchy for each one in the source and each package with instances."""
    for package in context.graph.of_kind(Kind.PACKAGE):
        file = context.find_file(package)
        if is_hierarchy(package):
            node = file.root.add(Node("InstanceHierarchy", {"Name": package.name}))
            context.copy_id(package, node)
            context.register(package, node)
            write_header(context, package, node)
            fill_hierarchy(context, package, node, file)
        elif package.subkind not in LIBRARIES and has_plant_objects(context, package):
            name = _make_library_name(context, package)
            node = file.root.add(Node("InstanceHierarchy", {"Name": name}))
            context.register(package, node)
            fill_hierarchy(context, package, node, file)
