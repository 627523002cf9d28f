"""Which node of the syntax tree became which element of the graph."""

from sysmlc.frontends.sysml import nodes
from sysmlc.ir import Element
from sysmlc.language.tree import Node


class NodeElements:
    """Elements by node. Keys that are integers are identities of nodes."""

    def __init__(self) -> None:
        self.own: dict[int, Element] = {}
        """The element that a node is."""
        self.usage_classes: dict[int, Element] = {}
        """Classes that are added for usages with members of their own."""
        self.spans: dict[int, tuple[Element, Element]] = {}
        """Entry and exit of steps that become several nodes of an activity."""
        self.starts_and_ends: dict[tuple[str, str], Element] = {}
        """Elements for ``start`` and ``done`` by the id of the behaviour or region."""
        self.redundant: set[int] = set()
        """Redefinitions that add nothing to the feature that they redefine."""
        self.origins: dict[str, Node] = {}
        """The node for which an element was added, by the element's id."""

    def find(self, node: Node | None) -> Element | None:
        """Return the element of the node, or of what it redefines if it is redundant."""
        if node is None:
            return None
        element = self.own.get(id(node))
        if element is None and id(node) in self.redundant:
            return self.find(nodes.find_target(node, "Redefinition"))
        return element

    def id_of(self, node: Node) -> str:
        """Return the id of the element of the node, or the empty string."""
        element = self.find(node)
        return "" if element is None else element.id

    def flow_node_of(self, step: Node, *, is_target: bool) -> Element | None:
        """Return the node at which flows enter a step (*is_target*), or at which they leave it."""
        entry_and_exit = self.spans.get(id(step))
        if entry_and_exit is None:
            return self.own.get(id(step))
        return entry_and_exit[0] if is_target else entry_and_exit[1]

    def text_name_of(self, element: Element) -> str:
        """Return the name that an element has in the text; metadata may give it another one."""
        node = self.origins.get(element.id)
        return element.name if node is None else nodes.name_of(node)
