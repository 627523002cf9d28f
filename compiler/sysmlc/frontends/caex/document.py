"""A CAEX file as a tree of nodes, made in one pass; texts that every file is full of are folded."""

from collections.abc import Iterator

from sysmlc.diagnostics import Place, Verdict
from sysmlc.sources import DEFAULT_LIMITS, Source, SourceError
from sysmlc.sources.xml import Parser, parse, parser, too_deep

FOLDED = frozenset({"Value", "DefaultValue", "Description", "Version"})
"""Elements that are kept as text of their parent: a third of the elements of a plant."""

_STRUCTURE = frozenset(
    {
        "Attribute",
        "AttributeType",
        "ExternalInterface",
        "InterfaceClass",
        "InternalElement",
        "InternalLink",
        "RefSemantic",
        "RoleClass",
        "RoleRequirements",
        "SupportedRoleClass",
        "SystemUnitClass",
    }
)
"""Elements that hold no text of their own."""

_NONE: list["Node"] = []
"""Shared by all nodes without children; never changed."""


class Node:
    """One XML element of CAEX. ``tag`` is its local name, ``ordinal`` its place in the file.

    ``texts`` holds the folded children by tag, and under the empty name the text of the
    element itself. ``element`` is the id of what it became in the graph.
    """

    __slots__ = (
        "attributes",
        "children",
        "element",
        "ordinal",
        "parent",
        "tag",
        "texts",
        "verdict",
    )

    children: "list[Node]"
    texts: dict[str, str] | None
    verdict: Verdict | None

    def __init__(
        self, tag: str, attributes: dict[str, str], parent: "Node | None", ordinal: int
    ) -> None:
        self.tag = tag
        self.attributes = attributes
        self.parent = parent
        self.ordinal = ordinal
        self.children = _NONE
        self.texts = None
        self.verdict = None
        self.element = ""

    @property
    def name(self) -> str:
        """The attribute ``Name``."""
        return self.attributes.get("Name", "")

    def text(self, tag: str) -> str | None:
        """Text of a child, or None when there is no such child."""
        if self.texts is not None and tag in self.texts:
            return self.texts[tag]
        child = next(self.of(tag), None)
        return None if child is None else (child.texts or {}).get("", "")

    def all_texts(self, tag: str) -> list[str]:
        """Texts of all children with this tag."""
        folded = [self.texts[tag]] if self.texts is not None and tag in self.texts else []
        return folded + [(child.texts or {}).get("", "") for child in self.of(tag)]

    def of(self, *tags: str) -> Iterator["Node"]:
        """Children with these tags, in order."""
        return (child for child in self.children if child.tag in tags)

    def above(self) -> Iterator["Node"]:
        """The nodes that the node lies in, nearest first."""
        node = self.parent
        while node is not None:
            yield node
            node = node.parent

    def walk(self) -> Iterator["Node"]:
        """The node and all below it, in document order."""
        waiting = [self]
        while waiting:
            node = waiting.pop()
            yield node
            waiting.extend(reversed(node.children))


class Document:
    """One file: its root, and all its nodes in document order."""

    __slots__ = ("is_built_in", "name", "nodes", "root")

    def __init__(self, name: str, nodes: list[Node], is_built_in: bool = False) -> None:
        self.name = name
        self.root = nodes[0]
        self.nodes = nodes
        self.is_built_in = is_built_in

    @property
    def version(self) -> str:
        """Version of the schema as the file states it: "2.15", "3.0", or the empty string."""
        return self.root.attributes.get("SchemaVersion", "")

    def place(self, node: Node) -> Place:
        """Place of a node."""
        return Place(self.name, node.ordinal)


def read(source: Source, is_built_in: bool = False) -> Document:
    """The tree of the file. Raises SourceError."""
    top = Node("", {}, None, -1)
    made = parser()
    nodes: list[Node] = []
    _fill(top, nodes, made, source)
    parse(source, made)
    root = nodes[0]
    if root.tag != "CAEXFile":
        raise SourceError("its root element is no CAEXFile", source.name, 0)
    root.parent = None
    return Document(source.name, nodes, is_built_in)


class _Local(dict[str, str]):
    """Local name of each tag, found once."""

    def __missing__(self, tag: str) -> str:
        self[tag] = name = tag.rpartition("}")[2]
        return name


def _fill(top: Node, nodes: list[Node], made: Parser, source: Source) -> None:
    """Set the handlers that build the tree; they are called for every element.

    Text is listened to only where CAEX has some: between the other elements stand line ends.
    """
    stack = [top]
    local = _Local()
    limit = DEFAULT_LIMITS.depth
    ordinal = -1
    folding = ""
    depth = 0
    listening = False

    def start(tag: str, values: dict[str, str]) -> None:
        nonlocal ordinal, folding, depth, listening
        ordinal += 1
        name = local[tag]
        parent = stack[-1]
        if name not in _STRUCTURE:
            made.CharacterDataHandler = text
            listening = True
            if not values and not folding and _folds(parent, name):
                folding, depth = name, len(stack)
                return
        node = Node(name, values, parent, ordinal)
        nodes.append(node)
        if parent.children is _NONE:
            parent.children = [node]
        else:
            parent.children.append(node)
        stack.append(node)
        if len(stack) > limit:
            too_deep(source, made)

    def end(_tag: str) -> None:
        nonlocal folding, listening
        if listening:
            made.CharacterDataHandler = None
            listening = False
        if folding and len(stack) == depth:
            folding = ""
        else:
            stack.pop()

    def text(data: str) -> None:
        holder = stack[-1]
        if holder.texts is None:
            holder.texts = {}
        key = folding if len(stack) == depth else ""
        holder.texts[key] = holder.texts.get(key, "") + data

    made.StartElementHandler = start
    made.EndElementHandler = end


def _folds(parent: Node, name: str) -> bool:
    """Whether the text becomes one of its parent's; a second one of a name stays an element."""
    if name not in FOLDED:
        return False
    if parent.texts is None:
        parent.texts = {}
    if name in parent.texts:
        return False
    parent.texts[name] = ""
    return True
