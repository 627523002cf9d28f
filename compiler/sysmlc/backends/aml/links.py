"""Internal links, and the references by ID that are written when all objects have their IDs."""

from collections.abc import Iterable

from sysmlc.backends.aml.class_kinds import is_inline
from sysmlc.backends.aml.context import Context, File
from sysmlc.backends.aml.header import write_header
from sysmlc.backends.aml.interfaces import find_or_repeat
from sysmlc.backends.aml.node import Node
from sysmlc.ir import Edge, Element, Kind
from sysmlc.ir.element import derived_id

_SIDES = ("RefPartnerSideA", "RefPartnerSideB")
_HOLDERS = frozenset({"InternalElement", "SystemUnitClass"})
"""Tags of elements that may hold an InternalLink."""


def write_links(context: Context) -> None:
    """Add a link for each connector, and for each dependency that was a link in CAEX."""
    for connector in context.graph.of_kind(Kind.CONNECTOR):
        _write_connector(context, connector)
    dependencies = context.graph.of_kind(Kind.DEPENDENCY)
    has_dangling = any("sides" in dependency.attrs for dependency in dependencies)
    ids = _collect_ids(context) if has_dangling else frozenset()
    for dependency in dependencies:
        if "sides" in dependency.attrs:
            _write_dangling_link(context, dependency, ids)
        elif "ports" in dependency.attrs:
            _write_relation(context, dependency)


def _write_connector(context: Context, connector: Element) -> None:
    ends = context.graph.targets(connector, Edge.END)
    holder = _find_holder(context, connector, ends)
    if holder is None or len(ends) != 2:
        return
    sides = [_resolve_end(context, connector, holder, end) for end in ends]
    if all(sides):
        _add_link(context, connector, holder, sides)
        context.written.update(end.id for end in ends)


def _find_holder(context: Context, element: Element, ends: Iterable[Element]) -> Node | None:
    """Return the node that holds a link, or None.

    The holder is the node of the owner, unless this is a hierarchy, which cannot hold links. If
    both ends are in the same top element of the hierarchy, another top element holds the link;
    if not, the top element of the first end does.
    """
    owner = context.graph.owner(element)
    node = context.nodes.get(owner.id) if owner is not None else None
    if node is None or node.tag != "InstanceHierarchy":
        return node if node is not None and node.tag in _HOLDERS else None
    tops = [context.graph.target(end, Edge.PATH) for end in ends]
    linked = [context.nodes[top.id] for top in tops if top is not None and top.id in context.nodes]
    is_one_element = bool(linked) and all(item is linked[0] for item in linked)
    if is_one_element:
        for child in node.children:
            if child.tag == "InternalElement" and child not in linked:
                return child
    return linked[0] if linked else None


def _add_link(context: Context, element: Element, holder: Node, sides: list[str]) -> None:
    name = element.name or "link"
    node = Node("InternalLink", {"Name": name} | dict(zip(_SIDES, sides, strict=True)))
    context.copy_id(element, node)
    write_header(context, element, node)
    context.register(element, holder.add(node))


def _resolve_end(context: Context, connector: Element, holder: Node, end: Element) -> str:
    """Return the ID of the interface at an end of a connector, or the empty string.

    Parts and interfaces of the class that the internal elements on the path do not repeat are
    added to them.
    """
    graph = context.graph
    port = graph.target(end, Edge.ROLE)
    if port is None or port.kind is not Kind.PORT:
        return ""
    file = context.find_file(graph.owner(connector) or connector)
    node: Node | None = holder
    for step in graph.targets(end, Edge.PATH):
        if step.kind is Kind.INSTANCE:
            node = context.nodes.get(step.id)
        elif node is not None and step.kind is Kind.PROPERTY:
            node = node.parts.get(step.id) or _repeat_part(context, node, step, file)
        elif step.kind is not Kind.PORT:
            # The interface at the end of a link is found by its ID, without the ones around it.
            node = None
    return "" if node is None else _find_interface_id(context, node, port, file)


def _repeat_part(context: Context, parent: Node, part: Element, file: File) -> Node | None:
    """Add a copy of a part of the class to an internal element."""
    if parent.tag not in _HOLDERS or not parent.id:
        return None
    node = Node("InternalElement", {"Name": part.name, "ID": derived_id(parent.id, part.id)})
    type_ = context.graph.target(part, Edge.TYPED_BY)
    if type_ is not None and not is_inline(type_):
        path = context.make_class_path(type_, file)
        if path:
            node.attributes["RefBaseSystemUnitPath"] = path
    parent.parts[part.id] = node
    return parent.add(node)


def _find_interface_id(context: Context, node: Node, port: Element, file: File) -> str:
    """Return the ID of the interface for a port in a node; a copy gets a derived ID."""
    interface = find_or_repeat(context, port, file, node)
    if not interface.id:
        origin = f"{node.id} {node.attributes.get('Name')}"
        interface.attributes["ID"] = derived_id(origin, port.id)
    return interface.id


# -- dependencies ------------------------------------------------------------------------------


def _collect_ids(context: Context) -> frozenset[str]:
    """Return all IDs in the files."""
    ids = set()
    stack = [file.root for file in context.files]
    while stack:
        node = stack.pop()
        ids.add(node.id)
        stack += node.children
    return frozenset(ids)


def _write_dangling_link(context: Context, element: Element, ids: frozenset[str]) -> None:
    """Write a link with an unresolved side as it was in the source.

    Its edges count as written if the resolved sides still name an object of the files.
    """
    holder = _find_holder(context, element, ())
    sides = element.attrs["sides"]
    if holder is None or not isinstance(sides, tuple):
        return
    texts = [str(side) for side in sides]
    _add_link(context, element, holder, texts)
    edges = sum(len(context.graph.targets(element, e)) for e in (Edge.CLIENT, Edge.SUPPLIER))
    if sum(bool(text) and _is_resolvable(text, ids) for text in texts) >= edges:
        _mark_ends(context, element)


def _is_resolvable(text: str, ids: frozenset[str]) -> bool:
    """Whether a side may name an object of the files: an ID, an ``ID:name`` or a path.

    IDs may contain colons.
    """
    colons = [index for index, char in enumerate(text) if char == ":"]
    return text in ids or any(text[:index] in ids for index in colons) or "/" in text


def _mark_ends(context: Context, element: Element) -> None:
    for edge in (Edge.CLIENT, Edge.SUPPLIER):
        for target in context.graph.targets(element, edge):
            context.mark_edge(edge, element, target)


def _write_relation(context: Context, element: Element) -> None:
    """Write a dependency between two interfaces as a link: a relation of a process, a succession.

    The supplier of a succession is the first side, because without directions the first side is
    the earlier step.
    """
    holder = _find_holder(context, element, ())
    ports = element.attrs["ports"]
    if holder is None or not isinstance(ports, tuple):
        return
    sides = []
    for edge, id in zip((Edge.CLIENT, Edge.SUPPLIER), ports, strict=True):
        target, port = context.graph.target(element, edge), context.graph.get(str(id))
        node = context.nodes.get(target.id) if target is not None else None
        if node is not None and port is not None and target is not None:
            sides.append(_find_interface_id(context, node, port, context.find_file(target)))
    if len(sides) == 2:
        if element.subkind == "succession":
            sides.reverse()
        _add_link(context, element, holder, sides)
        _mark_ends(context, element)


# -- references by ID --------------------------------------------------------------------------


def resolve_pending_references(context: Context) -> None:
    """Write the IDs of masters into their mirrors."""
    for node, attribute, master in context.pending_references:
        reference = _make_reference(context, master)
        if reference:
            node.attributes[attribute] = reference


def _make_reference(context: Context, master: Element) -> str:
    """Return the ID of a master, or for an attribute ``ID/outer/inner`` with its object's ID."""
    names: list[str] = []
    element: Element | None = master
    while element is not None:
        node = context.nodes.get(element.id)
        if node is not None and node.id:
            return "/".join([node.id, *reversed(names)])
        if element.kind in (Kind.PROPERTY, Kind.SLOT):
            names.append(element.name)
        element = _find_outer(context, element)
    return ""


def _find_outer(context: Context, element: Element) -> Element | None:
    """Return the owner, or for an inner attribute the outer one instead of its inline type."""
    owner = context.graph.owner(element)
    if owner is not None and is_inline(owner) and owner.subkind == "attribute":
        return context.graph.source(owner, Edge.TYPED_BY)
    return owner
