"""Elements of interchange files before they are written."""

from collections.abc import Iterator

from sysmlc.language.tree import AttributeValue, Node, Reference


class Element:
    """An element of an interchange file: its metaclass, what it says, what it owns.

    ``node`` is what it comes from, for a membership its member; what the tree leaves out has
    none. ``targets`` are the references by feature: the name of one, an element of the same
    file, or a link of a reference of the tree.
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
        """Take the element as the last of what is owned; it is returned."""
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
        """The element that the link leads to, if it was found."""
        targets = self.reference.targets
        return targets[self.index] if targets and self.index < len(targets) else None

    @property
    def text(self) -> str:
        """How the reference names it."""
        return "::".join(self.reference.chain[self.index]) if self.reference.chain else ""


def walk(root: Element) -> Iterator[tuple[Element, Element | None]]:
    """The element and all below it, owners first, each with what owns it."""
    stack: list[tuple[Element, Element | None]] = [(root, None)]
    while stack:
        element, owner = stack.pop()
        yield element, owner
        stack.extend((owned, element) for owned in reversed(element.owned))
