"""XML elements of CAEX 3.0 as they are written: children in the order of its schema."""

import re
from dataclasses import dataclass, field
from typing import Any

from lxml import etree

from sysmlc.sources.caex import NAMESPACE, ORDER

_ILLEGAL = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_FREE = frozenset({"AdditionalInformation"})
"""What may hold any XML: its inner order is that of the author."""


@dataclass(slots=True, eq=False)
class Node:
    """One XML element.

    ``is_copy`` tells what only repeats a feature of the class. ``parts`` and ``interfaces`` find
    internal elements and external interfaces below it by the ids of the parts and ports that
    they stand for.
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

    def say(self, tag: str, text: str) -> None:
        """Add a child that holds text alone."""
        self.add(Node(tag, text=text))

    def child(self, tag: str, name: str) -> "Node | None":
        """The first child of this tag and ``Name``."""
        found = (c for c in self.children if c.tag == tag and c.attributes.get("Name") == name)
        return next(found, None)

    @property
    def id(self) -> str:
        """Its ``ID``, or the empty string."""
        return self.attributes.get("ID", "")


def printed(root: Node) -> tuple[str, int]:
    """The document as text, and how many characters XML cannot hold were replaced in it."""
    replaced = 0

    def legal(text: str) -> str:
        nonlocal replaced
        made, count = _ILLEGAL.subn("\ufffd", text)
        replaced += count
        return made

    # The stubs of lxml do not know that None is the prefix of the default namespace.
    spaces: Any = {None: NAMESPACE}
    top = etree.Element(f"{{{NAMESPACE}}}{root.tag}", nsmap=spaces)
    waiting = [(root, top)]
    while waiting:
        node, made = waiting.pop()
        for name, value in node.attributes.items():
            made.set(name, legal(value))
        if node.text:
            made.text = legal(node.text)
        below = [(c, etree.SubElement(made, f"{{{NAMESPACE}}}{c.tag}")) for c in ordered(node)]
        waiting.extend(reversed(below))
    data = etree.tostring(top, pretty_print=True, xml_declaration=True, encoding="UTF-8")
    return data.decode(), replaced


def ordered(node: Node) -> list[Node]:
    """The children in the order of the schema; those of one tag as they were added."""
    if node.tag in _FREE:
        return node.children
    return sorted(node.children, key=lambda child: ORDER.get(child.tag, len(ORDER)))


def parsed(text: str) -> Node:
    """The nodes that a text means; it is XML that a front end wrote, as deep as it reads any."""
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=True
    )
    source = etree.fromstring(text.encode(), parser)
    root = _node(source)
    waiting = [(source, root)]
    while waiting:
        one, node = waiting.pop()
        for child in one:
            waiting.append((child, node.add(_node(child))))
    return root


def _node(source: "etree._Element") -> Node:
    attributes = {str(name): str(value) for name, value in source.attrib.items()}
    return Node(str(source.tag), attributes, text=source.text or "")
