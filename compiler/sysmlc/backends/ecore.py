"""Back end ``ecore``: the graph as EMF XMI, an instance of ``metamodels/ir.ecore``.

The XMI is written with lxml (pyecore costs 25 times the CPU); tests load it with pyecore.
"""

import json
import re
from typing import TYPE_CHECKING

from lxml import etree
from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.diagnostics import Sink
from sysmlc.ir import Edge, Element, Graph
from sysmlc.support.output import Output
from sysmlc.support.xml_text import make_root, print_element

if TYPE_CHECKING:
    from lxml.etree import _Element as Node

_XMI = "http://www.omg.org/XMI"
_XSI = "http://www.w3.org/2001/XMLSchema-instance"
_IR = "urn:sysmlc:ir:1"


class EcoreBackend(Struct, frozen=True):
    """Writes ``graph.xmi``, an instance of our own metamodel."""

    name: str = "ecore"
    summary: str = "the refined graph as EMF XMI of metamodels/ir.ecore, graph.xmi"
    is_default: bool = False
    needs: tuple[str, ...] = ()

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add ``graph.xmi``."""
        output.add("graph.xmi", print_xmi(graph), backend=self.name)


BACKEND = EcoreBackend()


def feature_name(edge: Edge) -> str:
    """Return the Ecore reference that holds edges of a kind: ``typed-by`` -> ``typedBy``."""
    return re.sub(r"-(\w)", lambda match: match[1].upper(), edge)


def print_xmi(graph: Graph) -> str:
    """Return the graph as EMF XMI.

    References between elements are EMF paths such as ``//@roots.0/@owns.2``, because an ``xmi:id``
    may not contain all characters of our ids, which are plain attributes instead.
    """
    root = make_root(f"{{{_IR}}}Graph", {"ir": _IR, "xmi": _XMI, "xsi": _XSI})
    root.set(etree.QName(_XMI, "version"), "2.0")
    paths: dict[str, str] = {}
    nodes: list[tuple[Element, Node]] = []
    for number, element in enumerate(graph.roots()):
        _add_tree(graph, element, root, f"//@roots.{number}", paths, nodes)
    for element, node in nodes:
        _set_references(graph, element, node, paths)
    return print_element(root)


def _add_tree(
    graph: Graph,
    top: Element,
    root: "Node",
    top_path: str,
    paths: dict[str, str],
    nodes: list[tuple[Element, "Node"]],
) -> None:
    """Add the nodes of an element and of all that it owns, and fill *paths* and *nodes*.

    A worklist instead of recursion: models may be nested deeper than Python's stack.
    """
    worklist = [(top, root, top_path, "roots")]
    while worklist:
        element, parent, path, feature = worklist.pop()
        node = _add_node(element, parent, feature)
        paths[element.id] = path
        nodes.append((element, node))
        children = list(enumerate(graph.owned(element)))
        worklist.extend(
            (child, node, f"{path}/@owns.{number}", "owns") for number, child in reversed(children)
        )


def _add_node(element: Element, parent: "Node", feature: str) -> "Node":
    node = etree.SubElement(parent, feature)
    node.set(etree.QName(_XSI, "type"), f"ir:{element.kind}")
    node.set("id", _escape_text(element.id))
    node.set("name", _escape_text(element.name))
    node.set("source", _escape_text(element.source))
    node.set("ordinal", str(element.ordinal))
    for key in sorted(element.attrs):
        value = json.dumps(element.attrs[key])
        etree.SubElement(node, "attrs", key=_escape_text(key), value=value)
    return node


def _set_references(graph: Graph, element: Element, node: "Node", paths: dict[str, str]) -> None:
    for edge in Edge:
        targets = graph.targets(element, edge)
        if targets and edge is not Edge.OWNS:
            node.set(feature_name(edge), " ".join(paths[target.id] for target in targets))


def _escape_text(text: str) -> str:
    """Return *text* as JSON without its quotes: XML attributes cannot hold control characters."""
    return json.dumps(text)[1:-1]
