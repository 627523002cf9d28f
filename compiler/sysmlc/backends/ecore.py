"""Back end ``ecore``: the graph as EMF XMI after ``metamodels/ir.ecore``.

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

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add ``graph.xmi``."""
        output.add("graph.xmi", to_xmi(graph), backend=self.name)


BACKEND = EcoreBackend()


def feature_name(edge: Edge) -> str:
    """Name of the Ecore reference that holds edges of this kind: ``typed-by`` -> ``typedBy``."""
    return re.sub(r"-(\w)", lambda match: match[1].upper(), edge)


# -- writing -----------------------------------------------------------------------------------


def to_xmi(graph: Graph) -> str:
    """The graph as EMF XMI; ids become ``xmi:id``-free attributes that EMF resolves by path."""

    root = etree.Element(etree.QName(_IR, "Graph"), nsmap={"ir": _IR, "xmi": _XMI, "xsi": _XSI})
    root.set(etree.QName(_XMI, "version"), "2.0")
    paths: dict[str, str] = {}
    nodes: list[tuple[Element, Node]] = []
    for number, element in enumerate(graph.roots()):
        _write(graph, element, root, f"//@roots.{number}", "roots", paths, nodes)
    for element, node in nodes:
        _write_edges(graph, element, node, paths)
    etree.indent(root, " ")
    return etree.tostring(root, encoding="unicode") + "\n"


def _write(
    graph: Graph,
    top: Element,
    parent: "Node",
    path: str,
    feature: str,
    paths: dict[str, str],
    nodes: list[tuple[Element, "Node"]],
) -> None:
    stack = [(top, parent, path, feature)]
    while stack:
        element, above, at, name = stack.pop()
        node = _node(element, above, name)
        paths[element.id] = at
        nodes.append((element, node))
        children = list(enumerate(graph.owned(element)))
        stack.extend((c, node, f"{at}/@owns.{n}", "owns") for n, c in reversed(children))


def _node(element: Element, parent: "Node", feature: str) -> "Node":

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


def _write_edges(graph: Graph, element: Element, node: "Node", paths: dict[str, str]) -> None:
    for edge in Edge:
        targets = graph.targets(element, edge)
        if targets and edge is not Edge.OWNS:
            node.set(feature_name(edge), " ".join(paths[target.id] for target in targets))


def _escape_text(text: str) -> str:
    """Return *text* as JSON without its quotes, so that control characters survive in XML
    attributes.
    """
    return json.dumps(text)[1:-1]
