"""Resolves the sides of internal links to interfaces, in every style that files have.

A side of CAEX 3.0 is the ID of an interface. Sides of CAEX 2.15 are ``ID:name`` of an element and
its interface, and some tools write ``path:name``. Names of interfaces may contain ``:``.
"""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from sysmlc.frontends.caex import rules
from sysmlc.frontends.caex.component import Component
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.hierarchies import Components
from sysmlc.frontends.caex.identifiers import LocatedNode
from sysmlc.frontends.caex.types import split_path

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
            self._context.report(rules.OPEN_LINK, document, node, element=node.name, side=side)
            return None
        end = self._resolve_text(text, document, node)
        if isinstance(end, Problem):
            facts = {"side": side, "reference": text, "problem": end.text}
            self._context.report(
                rules.DANGLING_LINK, document, node, f"no end {text}", element=node.name, **facts
            )
        return end

    def _resolve_text(self, text: str, document: Document, node: Node) -> LinkEnd | Problem:
        """Find an interface by its ID, else by the ID or path of its owner, ``:`` and its name.

        Names may contain ``:``, so the text is split at each one in turn."""
        interface = self._context.find_node(text, document)
        if interface is not None:
            self._context.report_inexact_id(document, node, text)
            return self._make_end_of_node(interface[1])
        for position in (index for index, character in enumerate(text) if character == ":"):
            prefix = text[:position]
            owner = self._context.find_node(prefix, document) or self._find_by_path(prefix)
            if owner is not None:
                self._context.report_inexact_id(document, node, prefix)
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
