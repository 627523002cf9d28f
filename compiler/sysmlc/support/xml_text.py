"""XML documents as text: the one way in which sysmlc writes XML."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Protocol, TypeVar

from lxml import etree

from sysmlc.support.escapes import replace_illegal_in_xml


class XmlNode(Protocol):
    """One XML element. Names may have a prefix; attributes are in the order of the document."""

    tag: str
    attributes: dict[str, str]
    text: str


_N = TypeVar("_N", bound=XmlNode)


def print_element(root: "etree._Element") -> str:
    """Return a document with this root, indented."""
    text = etree.tostring(root, pretty_print=True, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}'


def print_tree(
    root: _N,
    namespaces: Mapping[str, str],
    list_children: Callable[[_N], Iterable[_N]],
) -> tuple[str, int]:
    """Return the document as text, and the number of illegal characters replaced in it.

    *namespaces* are those of the prefixes in names; a tag without prefix has the empty one.
    """
    replaced = 0

    def make_legal(text: str) -> str:
        nonlocal replaced
        legal, count = replace_illegal_in_xml(text)
        replaced += count
        return legal

    top = make_root(_qualify(root.tag, namespaces), namespaces)
    # A stack instead of recursion: models nest more deeply than Python's stack.
    stack = [(root, top)]
    while stack:
        node, target = stack.pop()
        for name, value in node.attributes.items():
            target.set(_qualify(name, namespaces) if ":" in name else name, make_legal(value))
        if node.text:
            target.text = make_legal(node.text)
        for child in list_children(node):
            stack.append((child, etree.SubElement(target, _qualify(child.tag, namespaces))))
    return print_element(top), replaced


def make_root(tag: str, namespaces: Mapping[str, str]) -> "etree._Element":
    """Return a root that declares the namespaces of these prefixes."""
    # The stubs of lxml do not know that None is the prefix of the default namespace.
    prefixes: Any = {prefix or None: namespace for prefix, namespace in namespaces.items()}
    return etree.Element(tag, nsmap=prefixes)


def _qualify(name: str, namespaces: Mapping[str, str]) -> str:
    """Return a name with the namespace of its prefix, as lxml spells it."""
    prefix, _, local_name = name.rpartition(":")
    namespace = namespaces.get(prefix, "")
    return f"{{{namespace}}}{local_name}" if namespace else name
