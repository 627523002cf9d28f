"""XML elements of CAEX 3.0, and values in the lexical forms of XML Schema."""

import math
from dataclasses import dataclass, field

from lxml import etree

from sysmlc.ir import AttrValue
from sysmlc.sources.caex_vocabulary import NAMESPACE, ORDER
from sysmlc.support.xml_text import print_tree

_UNORDERED = frozenset({"AdditionalInformation"})
"""Elements that may hold any XML, so that their children stay in the author's order."""


@dataclass(slots=True, eq=False)
class Node:
    """One XML element.

    A node with *is_copy* only repeats a feature of a class. *parts* and *interfaces* find the
    internal elements and external interfaces below the node by the ids of their parts and ports.
    """

    tag: str
    attributes: dict[str, str] = field(default_factory=dict)
    children: list["Node"] = field(default_factory=list)
    text: str = ""
    is_copy: bool = False
    parts: dict[str, "Node"] = field(default_factory=dict)
    interfaces: dict[str, "Node"] = field(default_factory=dict)

    def add(self, child: "Node") -> "Node":
        """Add a child and return it."""
        self.children.append(child)
        return child

    def add_text(self, tag: str, text: str) -> None:
        """Add a child that holds only text."""
        self.add(Node(tag, text=text))

    def find_child(self, tag: str, name: str) -> "Node | None":
        """Return the first child with this tag and ``Name``, or None."""
        for child in self.children:
            if child.tag == tag and child.attributes.get("Name") == name:
                return child
        return None

    @property
    def id(self) -> str:
        """The ``ID``, or the empty string."""
        return self.attributes.get("ID", "")


def print_document(root: Node) -> tuple[str, int]:
    """Return the document as text, and the number of illegal characters replaced in it."""
    return print_tree(root, {"": NAMESPACE}, _sort_children)


def _sort_children(node: Node) -> list[Node]:
    """Return the children in the order of the schema; children of one tag keep their order."""
    if node.tag in _UNORDERED:
        return node.children
    return sorted(node.children, key=lambda child: ORDER.get(child.tag, len(ORDER)))


def parse_fragment(text: str) -> Node:
    """Return the tree of an XML fragment that the front end ``caex`` stored in the graph."""
    # The front end accepts any depth, so the parser must not stop at 256 levels: huge_tree.
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=True
    )
    source = etree.fromstring(text.encode(), parser)
    root = _convert_element(source)
    stack = [(source, root)]
    while stack:
        element, node = stack.pop()
        for child in element:
            stack.append((child, node.add(_convert_element(child))))
    return root


def _convert_element(source: "etree._Element") -> Node:
    attributes = {str(name): str(value) for name, value in source.attrib.items()}
    return Node(str(source.tag), attributes, text=source.text or "")


def format_value(value: AttrValue) -> str:
    """Return the lexical form of a value; the items of a list are separated by blanks."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and not math.isfinite(value):
        return "NaN" if math.isnan(value) else "INF" if value > 0 else "-INF"
    if isinstance(value, tuple):
        return " ".join(map(format_value, value))
    return "" if value is None else str(value)


def find_data_type(value: AttrValue) -> str:
    """Return the XML Schema type of a number or truth value; empty for other values."""
    if isinstance(value, bool):
        return "xs:boolean"
    if isinstance(value, int):
        return "xs:integer"
    return "xs:double" if isinstance(value, float) else ""
