"""Elements of interchange files, before they are written."""

from collections.abc import Iterator

from sysmlc.language.tree import AttributeValue, Node, Reference


class Element:
    """An element of an interchange file: metaclass, attributes, references, owned elements.

    ``node`` is the node that it represents, for a membership the node of its member. Elements that
    the tree folds or omits have none. ``targets`` are the references: the name of a feature with an
    element of the same file, or with a link of a reference of the tree.
    """

    __slots__ = ("attributes", "id", "kind", "node", "owned", "targets")

    def __init__(self, kind: str, node: Node | None = None) -> None:
        self.kind = kind
        self.node = node
        self.attributes: dict[str, AttributeValue] = {}
        self.targets: list[tuple[str, Element | Link]] = []
        self.owned: list[Element] = []
        self.id = ""

    def add_owned(self, element: "Element") -> "Element":
        """Append ``element`` to the owned elements, and return it."""
        self.owned.append(element)
        return element


class Link:
    """One link of a reference of the tree, as the target of a feature."""

    __slots__ = ("index", "reference")

    def __init__(self, reference: Reference, index: int = -1) -> None:
        self.reference = reference
        self.index = index % len(reference.chain) if reference.chain else 0

    @property
    def node(self) -> Node | None:
        """The element that the link leads to, or None if it is unresolved."""
        targets = self.reference.targets
        return targets[self.index] if targets and self.index < len(targets) else None

    @property
    def text(self) -> str:
        """The name that the reference has for the element."""
        return "::".join(self.reference.chain[self.index]) if self.reference.chain else ""


def walk_elements(root: Element) -> Iterator[tuple[Element, Element | None]]:
    """Yield the element and all below it with their owners, owners first."""
    stack: list[tuple[Element, Element | None]] = [(root, None)]
    while stack:
        element, owner = stack.pop()
        yield element, owner
        stack.extend((owned, element) for owned in reversed(element.owned))
