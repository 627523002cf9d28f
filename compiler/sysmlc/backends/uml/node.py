"""XML elements of XMI, printed as Eclipse prints them."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from sysmlc.support.escapes import replace_illegal_in_xml

_TEXT = {"&": "&amp;", "<": "&lt;", ">": "&gt;", "\r": "&#xD;"}
# A parser replaces line ends and tabs in values of attributes by blanks (XML 1.0, 3.3.3).
_VALUE = {"&": "&amp;", "<": "&lt;", '"': "&quot;", "\r": "&#xD;", "\n": "&#xA;", "\t": "&#x9;"}
_ESCAPED_IN_TEXT, _ESCAPED_IN_VALUE = re.compile("[&<>\r]"), re.compile('[&<"\r\n\t]')


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


def print_document(root: Node) -> tuple[str, int]:
    """Return the document as text, and the number of illegal characters replaced in it."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>']
    # A stack instead of recursion: models nest more deeply than Python's stack. A string on the
    # stack is an end tag.
    stack: list[tuple[Node | str, int]] = [(root, 0)]
    while stack:
        node, depth = stack.pop()
        if isinstance(node, str):
            lines.append(node)
        elif node.children:
            lines.append(f"{'  ' * depth}{_format_start(node)}>")
            stack.append((f"{'  ' * depth}</{node.tag}>", depth))
            stack.extend((child, depth + 1) for child in reversed(node.children))
        else:
            end = f">{_escape_text(node.text)}</{node.tag}>" if node.text else "/>"
            lines.append(f"{'  ' * depth}{_format_start(node)}{end}")
    lines.append("")
    return replace_illegal_in_xml("\n".join(lines))


def _format_start(node: Node) -> str:
    pairs = (f' {name}="{_escape_value(value)}"' for name, value in node.attributes.items())
    return f"<{node.tag}{''.join(pairs)}"


def _escape_text(text: str) -> str:
    return _ESCAPED_IN_TEXT.sub(lambda match: _TEXT[match[0]], text)


def _escape_value(text: str) -> str:
    return _ESCAPED_IN_VALUE.sub(lambda match: _VALUE[match[0]], text)
