"""XML elements as they are written: a tree that is printed without recursion."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

_ILLEGAL = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_TEXT = {"&": "&amp;", "<": "&lt;", ">": "&gt;", "\r": "&#xD;"}
_VALUE = {"&": "&amp;", "<": "&lt;", '"': "&quot;", "\r": "&#xD;", "\n": "&#xA;", "\t": "&#x9;"}
_IN_TEXT, _IN_VALUE = re.compile("[&<>\r]"), re.compile('[&<"\r\n\t]')


@dataclass(slots=True, eq=False)
class Node:
    """One XML element; ``attributes`` and ``children`` in the order in which they are written."""

    tag: str
    attributes: dict[str, str] = field(default_factory=dict)
    children: list["Node"] = field(default_factory=list)
    text: str = ""
    is_element: bool = False
    """Whether it stands for an element of the graph, not for a part of one."""

    def add(self, child: "Node") -> "Node":
        """Add a child and return it."""
        self.children.append(child)
        return child

    @property
    def id(self) -> str:
        """Its ``xmi:id``, or the empty string."""
        return self.attributes.get("xmi:id", "")

    @property
    def metaclass(self) -> str:
        """Its ``xmi:type`` without prefix, or the empty string."""
        return self.attributes.get("xmi:type", "").removeprefix("uml:")

    def parts(self) -> Iterator["Node"]:
        """What is below it and belongs to the same element of the graph, in document order."""
        stack = [child for child in reversed(self.children) if not child.is_element]
        while stack:
            top = stack.pop()
            yield top
            stack.extend(child for child in reversed(top.children) if not child.is_element)


def printed(root: Node) -> tuple[str, int]:
    """The document as text, and how many characters XML cannot hold were replaced in it."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>']
    stack: list[tuple[Node | str, int]] = [(root, 0)]
    while stack:
        top, depth = stack.pop()
        if isinstance(top, str):
            lines.append(top)
        elif top.children:
            lines.append(f"{'  ' * depth}{_start(top)}>")
            stack.append((f"{'  ' * depth}</{top.tag}>", depth))
            stack.extend((child, depth + 1) for child in reversed(top.children))
        else:
            end = f">{_text(top.text)}</{top.tag}>" if top.text else "/>"
            lines.append(f"{'  ' * depth}{_start(top)}{end}")
    lines.append("")
    return _ILLEGAL.subn("\ufffd", "\n".join(lines))


def _start(node: Node) -> str:
    written = (f' {name}="{_value(value)}"' for name, value in node.attributes.items())
    return f"<{node.tag}{''.join(written)}"


def _text(text: str) -> str:
    return _IN_TEXT.sub(lambda found: _TEXT[found[0]], text)


def _value(text: str) -> str:
    return _IN_VALUE.sub(lambda found: _VALUE[found[0]], text)
