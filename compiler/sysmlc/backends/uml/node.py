"""XML elements of XMI."""

from collections.abc import Iterator
from dataclasses import dataclass, field


@dataclass(slots=True, eq=False)
class Node:
    """One XML element; *attributes* and *children* are in the order in which they are printed."""

    tag: str
    attributes: dict[str, str] = field(default_factory=dict)
    children: list["Node"] = field(default_factory=list)
    text: str = ""
    is_element: bool = False
    """Whether the node represents an element of the graph, not a part of one."""

    def add(self, child: "Node") -> "Node":
        """Add a child and return it."""
        self.children.append(child)
        return child

    @property
    def id(self) -> str:
        """The ``xmi:id``, or the empty string."""
        return self.attributes.get("xmi:id", "")

    @property
    def metaclass(self) -> str:
        """The ``xmi:type`` without prefix, or the empty string."""
        return self.attributes.get("xmi:type", "").removeprefix("uml:")

    @property
    def root_metaclass(self) -> str:
        """The metaclass; a node at the top of the document has it in its tag."""
        return self.metaclass or self.tag.removeprefix("uml:")

    def iter_parts(self) -> Iterator["Node"]:
        """Yield the nodes below that belong to the same element of the graph, in preorder."""
        stack = [child for child in reversed(self.children) if not child.is_element]
        while stack:
            node = stack.pop()
            yield node
            stack.extend(child for child in reversed(node.children) if not child.is_element)
