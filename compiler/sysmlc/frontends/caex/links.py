"""Internal links: connectors between the ports of parts (thesis, Table 3.1).

A side of CAEX 3.0 is the ID of an interface. Sides of CAEX 2.15 are ``ID:name`` of an element and
its interface, and some tools write ``path:name``. Names of interfaces may contain ``:``.
"""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.component import Component
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.findings import report_inexact_id
from sysmlc.frontends.caex.hierarchies import Components
from sysmlc.frontends.caex.identifiers import LocatedNode
from sysmlc.frontends.caex.types import Type, split_path
from sysmlc.frontends.caex.vocabulary import ORDER_INTERFACE, PPR
from sysmlc.ir import Edge, Element, Kind

SIDES = {"A": "RefPartnerSideA", "B": "RefPartnerSideB"}

_MIN_ID_LENGTH = 32
"""Length of a GUID without hyphens; the message tells apart ids and free texts."""


class LinkEnd(NamedTuple):
    """The port to which a side of a link refers, and the component that has the port."""

    port: str
    component: Component


_make_end: Callable[[tuple[str, Component]], LinkEnd] = partial(tuple.__new__, LinkEnd)
"""Makes a link end in a third of the time of ``LinkEnd(...)``."""


class Problem(NamedTuple):
    """The reason why a side does not resolve, and the id of the element that it names anyway."""

    text: str
    element_id: str = ""


class LinkEndResolver:
    """Finds the ends of the links of a unit."""

    def __init__(self, context: Context, components: Components) -> None:
        self._context = context
        self._components = components
        self._ends_by_id: dict[str, LinkEnd] = {}
        self._interfaces: dict[Node, dict[str, Node]] = {}
        self._path_steps: dict[Node, dict[str, list[Node]]] = {}

    def find_by_id(self, text: str) -> LinkEnd | None:
        """Return the end whose side is only the ID of an interface, as in CAEX 3.0."""
        end = self._ends_by_id.get(text)
        if end is not None:
            return end
        location = self._context.ids.find_unique_row(text)
        if location is None:
            return None
        document, row = location
        tags, port = document.tags, document.element_ids[row]
        if not port or tags[row] != "ExternalInterface":
            return None
        components = self._components.by_row(document)
        parent = document.parents[row]
        component = components[parent]
        while component is None and tags[parent] == "ExternalInterface":
            parent = document.parents[parent]
            component = components[parent]
        if component is None:
            return None
        end = self._ends_by_id[text] = _make_end((port, component))
        return end

    def resolve_side(self, node: Node, document: Document, side: str) -> LinkEnd | Problem | None:
        """Return the end that a side means, None if the side is open; report what is wrong."""
        text = node.attributes.get(SIDES[side], "").strip()
        if not text:
            self._context.findings.report(
                rules.OPEN_LINK, document, node, element=node.name, side=side
            )
            return None
        end = self._resolve_text(text, document, node)
        if isinstance(end, Problem):
            facts = {"side": side, "reference": text, "problem": end.text}
            self._context.findings.report(
                rules.DANGLING_LINK, document, node, f"no end {text}", element=node.name, **facts
            )
        return end

    def _resolve_text(self, text: str, document: Document, node: Node) -> LinkEnd | Problem:
        """Find an interface by its ID, else by the ID or path of its owner, ``:`` and its name.

        Names may contain ``:``, so the text is split at each one in turn."""
        interface = self._context.ids.find(text, document)
        if interface is not None:
            report_inexact_id(self._context.findings, self._context.ids, document, node, text)
            return self._make_end_of_node(interface[1])
        for position in (index for index, character in enumerate(text) if character == ":"):
            prefix = text[:position]
            owner = self._context.ids.find(prefix, document) or self._find_by_path(prefix)
            if owner is not None:
                report_inexact_id(self._context.findings, self._context.ids, document, node, prefix)
                return self._make_end_of_name(owner[1], text[position + 1 :])
        is_id = len(text) >= _MIN_ID_LENGTH and " " not in text
        return Problem("no element has that id" if is_id else "it names no interface")

    def _find_by_path(self, path: str) -> LocatedNode | None:
        """Return the only internal element with a path that starts at a hierarchy or library."""
        root_name, *names = split_path(path).names
        for document in self._context.documents:
            nodes = self._index_path_steps(document.root).get(root_name, [])
            for name in names:
                nodes = [
                    child
                    for parent in nodes
                    for child in self._index_path_steps(parent).get(name, ())
                ]
            if len(nodes) == 1:
                return document, nodes[0]
        return None

    def _index_path_steps(self, node: Node) -> dict[str, list[Node]]:
        """Return the nodes below *node* that a path can name next, by name; memoised."""
        steps = self._path_steps.get(node)
        if steps is None:
            steps = self._path_steps[node] = {}
            is_root = node.row == 0
            for child in node.children if is_root else node.iter_children("InternalElement"):
                steps.setdefault(child.name, []).append(child)
        return steps

    def _make_end_of_node(self, node: Node) -> LinkEnd | Problem:
        """Return the end at an interface; a node of another kind is a problem."""
        parent = node.parent
        while parent is not None and parent.tag == "ExternalInterface":
            parent = parent.parent
        component = self._components.find(parent) if parent is not None else None
        if node.tag == "ExternalInterface" and component is not None and node.element_id:
            return LinkEnd(node.element_id, component)
        return Problem(f"that is not an interface but '{node.name}'", node.element_id)

    def _make_end_of_name(self, owner: Node, name: str) -> LinkEnd | Problem:
        """Return the end at an interface of *owner*, or of its class, that has this name."""
        node = self._index_interfaces(owner).get(name)
        if node is not None:
            return self._make_end_of_node(node)
        component = self._components.find(owner)
        if component is not None and component.type is not None:
            member = component.type.find_member("ExternalInterface", name)
            if member is not None:
                return LinkEnd(member.id, component)
        return Problem(f"'{owner.name}' has no interface '{name}'", owner.element_id)

    def _index_interfaces(self, owner: Node) -> dict[str, Node]:
        """Return the interfaces of an element by name, the first of each name; memoised."""
        interfaces = self._interfaces.get(owner)
        if interfaces is None:
            interfaces = self._interfaces[owner] = {}
            for node in owner.iter_children("ExternalInterface"):
                interfaces.setdefault(node.name, node)
        return interfaces


# -- links -----------------------------------------------------------------------------------------


_LinkKey = frozenset[tuple[str, ...]]
"""The ends of a link, each as the parts and the port that lead to it from the top."""

# Access to a member of an enumeration takes twice as long as to a global variable.
_MAPPED = Verdict.MAPPED
_CONNECTOR = Kind.CONNECTOR
_CONNECTOR_END = Kind.CONNECTOR_END
_END = Edge.END
_PATH = Edge.PATH

_RELATION_MEANINGS = (PPR, ORDER_INTERFACE)
"""Meanings of interfaces whose links are dependencies instead of connectors."""

_CLIENT_ORDER = ("process", "resource", "product")
"""A process depends on the resource that performs it, and both depend on the product."""


class LinkLowering:
    """Lowers the links of a unit."""

    def __init__(self, context: Context, components: Components) -> None:
        self._context = context
        self._components = components
        self._resolver = LinkEndResolver(context, components)
        self._class_links: set[tuple[str, _LinkKey]] = set()
        """Links of classes: id of the class, and the ends."""
        self._linked_classes: set[str] = set()
        """Ids of the classes with links of their own."""
        self._linked_ancestors: dict[Type, list[str]] = {}
        """Ids of the classes with links among the ones that a class is or specialises."""
        self._paths: dict[Component, list[Element]] = {}
        self._ends: list[Element] = []
        """All connector ends."""
        self._ports: list[Element] = []
        """The ports of the connector ends."""

    def lower(self) -> None:
        """Add a connector for each link; links of classes come first, as instances repeat them."""
        for is_in_hierarchy in (False, True):
            for document in self._context.documents:
                for row in document.child_rows(0):
                    if (document.tags[row] == "InstanceHierarchy") is is_in_hierarchy:
                        self._lower_below(row, document)
        for end, port in zip(self._ends, self._ports, strict=True):
            self._context.graph.connect(Edge.ROLE, end, port)

    def _lower_below(self, root: int, document: Document) -> None:
        components, find_by_id = self._components.by_row(document), self._resolver.find_by_id
        for row in document.iter_rows("InternalLink", root, document.ends[root]):
            document.verdicts[row] = _MAPPED
            holder, attributes = components[document.parents[row]], document.attributes[row]
            first = find_by_id(attributes.get("RefPartnerSideA", ""))
            second = find_by_id(attributes.get("RefPartnerSideB", ""))
            if holder is None or first is None or second is None:
                self._lower_other_style(document.node(row), document, holder)
            else:
                self._lower_link(row, document, holder, [first, second])

    def _lower_other_style(self, node: Node, document: Document, holder: Component | None) -> None:
        """Lower a link whose sides are not both IDs of interfaces."""
        sides = {side: self._resolver.resolve_side(node, document, side) for side in SIDES}
        ends = [end for end in sides.values() if isinstance(end, LinkEnd)]
        if holder is None or len(ends) < len(sides):
            self._add_partial_dependency(node, document, holder, sides)
        else:
            self._lower_link(node.row, document, holder, ends)

    def _lower_link(
        self, row: int, document: Document, holder: Component, ends: list[LinkEnd]
    ) -> None:
        if self._is_link_of_class(holder, ends):
            return
        meanings = self._context.interface_meanings
        meaning = meanings.get(ends[0].port, "")
        if meaning in _RELATION_MEANINGS and meanings.get(ends[1].port, "") == meaning:
            self._add_relation(document.node(row), document, holder, ends, meaning)
        else:
            self._add_connector(row, document, holder, ends)

    # -- connectors --------------------------------------------------------------------------------

    def _is_link_of_class(self, holder: Component, ends: list[LinkEnd]) -> bool:
        """Whether the class that *holder* is an instance of has the link already."""
        declared = holder.declared_type
        if declared is None or not self._linked_classes:
            return False
        linked = self._linked_ancestors.get(declared)
        if linked is None:
            chain = declared.iter_chain()
            linked = [type.id for type in chain if type.id in self._linked_classes]
            self._linked_ancestors[declared] = linked
        key = _make_key(ends, holder) if linked else None
        return key is not None and any((id, key) in self._class_links for id in linked)

    def _add_connector(
        self, row: int, document: Document, holder: Component, ends: list[LinkEnd]
    ) -> None:
        root = holder.root
        owner = _find_frame(root)
        leaves_tree = ends[0].component.root is not root or ends[1].component.root is not root
        if leaves_tree and owner is not None:
            owner = self._context.graph[owner].owner
        connector = self._context.add_row(_CONNECTOR, document, row, owner)
        self._add_ends(connector, ends, leaves_tree)
        self._record_link_of_class(root, owner, ends)

    def _record_link_of_class(
        self, root: Component, owner: str | None, ends: list[LinkEnd]
    ) -> None:
        """Record a link of a class for its instances, which repeat it."""
        if root.instance_id or owner is None:
            return
        key = _make_key(ends, root)
        if key is not None:
            self._class_links.add((owner, key))
            self._linked_classes.add(owner)
            self._linked_ancestors.clear()

    def _add_ends(self, connector: Element, ends: list[LinkEnd], leaves_tree: bool) -> None:
        """Add the ends of a connector, each with the parts and ports from the owner to its port."""
        graph, owner = self._context.graph, connector.id
        source, ordinal = connector.source, connector.ordinal
        connector_ends: list[Element] = []
        for side, (port, component) in zip(SIDES, ends, strict=True):
            id = f"{owner}#{side}"
            if id in graph:
                id = f"{id}~{ordinal}"
            end = graph.add(Element(id, _CONNECTOR_END, "", owner, ordinal, source))
            connector_ends.append(end)
            self._ports.append(graph[port])
            path = self._find_path(component)
            # The Instance at the top owns the connector unless that leaves its tree.
            starts_at_owner = bool(component.root.instance_id) and not leaves_tree
            for step in path[1:] if starts_at_owner else path:
                graph.connect(_PATH, end, step)
            for step in self._list_enclosing_ports(port):
                graph.connect(_PATH, end, step)
        self._ends += connector_ends
        for end in connector_ends:
            graph.connect(_END, connector, end)

    def _list_enclosing_ports(self, port: str) -> list[Element]:
        """Return the ports around a nested port (CAEX 3.0), the outermost first."""
        graph = self._context.graph
        enclosing_ports: list[Element] = []
        block = graph.owner(graph[port])
        while block is not None and block.subkind == "external-interface":
            enclosing_ports.insert(0, graph[block.id.removesuffix("#type")])
            block = graph.owner(block)
        return enclosing_ports

    def _find_path(self, component: Component) -> list[Element]:
        """Return the Instance at the top, if any, and the parts down to a component; memoised."""
        path = self._paths.get(component)
        if path is None:
            if component.parent is None:
                above: list[Element] = []
                step = self._components.find_instance(component)
            else:
                above = self._find_path(component.parent)
                step = self._components.find_part(component)
            path = above if step is None or step in above else [*above, step]
            self._paths[component] = path
        return path

    # -- dependencies ------------------------------------------------------------------------------

    def _add_relation(
        self,
        node: Node,
        document: Document,
        holder: Component,
        ends: list[LinkEnd],
        meaning: str,
    ) -> None:
        """Add a dependency for a link of PPR connectors or of order interfaces."""
        graph, root = self._context.graph, holder.root
        owner = _find_frame(root)
        is_order = meaning == ORDER_INTERFACE
        subkind = "succession" if is_order else PPR
        dependency = self._context.add_element(
            Kind.DEPENDENCY, node, document, owner, subkind=subkind
        )
        client, supplier = self._order_by_direction(ends) if is_order else _order_by_ppr(ends)
        graph.set(dependency, ports=(client.port, supplier.port))
        if {client.component.ppr, supplier.component.ppr} == {"process", "resource"}:
            graph.set(dependency, role="allocate")
        graph.connect(Edge.CLIENT, dependency.id, _find_representative(client.component))
        graph.connect(Edge.SUPPLIER, dependency.id, _find_representative(supplier.component))
        self._record_link_of_class(root, owner, ends)

    def _order_by_direction(self, ends: list[LinkEnd]) -> tuple[LinkEnd, LinkEnd]:
        """Return the later element first, which depends on the earlier one with direction out."""
        first, second = ends
        graph = self._context.graph
        directions = [graph[end.port].attrs.get("direction") for end in ends]
        is_first_later = directions[1] == "out" or directions[0] == "in"
        return (first, second) if is_first_later else (second, first)

    def _add_partial_dependency(
        self,
        node: Node,
        document: Document,
        holder: Component | None,
        sides: dict[str, LinkEnd | Problem | None],
    ) -> None:
        """Add a dependency between the elements that the sides of an unusable link name."""
        graph = self._context.graph
        ids = [
            end.port if isinstance(end, LinkEnd) else end.element_id
            for end in sides.values()
            if end is not None
        ]
        known_ids = [id for id in ids if id and id in graph]
        owner = _find_frame(holder.root) if holder else None
        dependency = self._context.add_element(
            Kind.DEPENDENCY, node, document, owner, subkind="internal-link"
        )
        dependency.attrs["sides"] = tuple(node.attributes.get(key, "") for key in SIDES.values())
        for edge, id in zip((Edge.CLIENT, Edge.SUPPLIER), known_ids, strict=False):
            graph.connect(edge, dependency.id, id)


def _find_frame(root: Component) -> str | None:
    """Return the id of the Instance or class that owns the links below *root*."""
    return root.instance_id or (root.own_type.id if root.own_type else None)


def _order_by_ppr(ends: list[LinkEnd]) -> tuple[LinkEnd, LinkEnd]:
    """Return the ends in the order of dependency; ends without a rank come last."""
    ranks = {ppr: rank for rank, ppr in enumerate(_CLIENT_ORDER)}
    first, second = sorted(ends, key=lambda end: ranks.get(end.component.ppr, len(ranks)))
    return first, second


def _find_representative(component: Component) -> str:
    """Return the id of the element that represents a component in a dependency."""
    own_id = component.own_type.id if component.own_type is not None else ""
    return component.instance_id or component.part_id or own_id


def _make_key(ends: list[LinkEnd], root: Component) -> _LinkKey | None:
    """Return the ends as seen from *root*; None when one of them is not below it."""
    first, second = _find_end_path(ends[0], root), _find_end_path(ends[1], root)
    return None if first is None or second is None else frozenset((first, second))


def _find_end_path(end: LinkEnd, root: Component) -> tuple[str, ...] | None:
    """Return the ids of the parts and the port that lead to an end."""
    component = end.component
    # Most ends are at a child or at the top itself.
    if component.parent is root:
        return component.part_id, end.port
    if component is root:
        return (end.port,)
    parts = component.find_part_path(root)
    return None if parts is None else (*parts, end.port)
