"""Back ends for the whole graph: ``graph`` as JSON for programs, ``ir`` as text for people."""

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.diagnostics import Place, Sink
from sysmlc.ir import Element, Graph
from sysmlc.ir.text import print_text
from sysmlc.support.output import Output, encode_json


class GraphBackend(Struct, frozen=True):
    """Writes elements sorted by qualified name and ordinal, and edges in their order."""

    name: str = "graph"
    summary: str = "the refined graph as graph.json"
    is_default: bool = False
    needs: tuple[str, ...] = ()

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add ``graph.json`` (metamodels/sysmlc-graph.schema.json)."""
        names = {element.id: graph.qualified_name(element) for element in graph}
        elements = sorted(graph, key=lambda e: (names[e.id], e.ordinal, e.id))
        ranks = {element.id: rank for rank, element in enumerate(elements)}
        places = {element.id: Place(element.source, element.ordinal) for element in elements}
        located = options.locate(place for place in places.values() if place.file)
        edges = sorted(graph.edges(), key=lambda edge: (ranks[edge[1]], edge[0]))
        content = {
            "format": "sysmlc-graph/2",
            "elements": [
                _describe_element(element, names[element.id], located.get(places[element.id]))
                for element in elements
            ],
            "edges": [
                {"kind": kind, "from": source, "to": target} for kind, source, target in edges
            ],
        }
        output.add("graph.json", encode_json(content), trace=(), backend=self.name)


class IrBackend(Struct, frozen=True):
    """Writes the text that ``ir.text.parse_text`` and the front end ``ir`` read back."""

    name: str = "ir"
    summary: str = "the refined graph in readable text, graph.ir"
    is_default: bool = False
    needs: tuple[str, ...] = ()

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add ``graph.ir``."""
        output.add("graph.ir", print_text(graph), backend=self.name)


def _describe_element(
    element: Element, qualified_name: str, location: Place | None
) -> dict[str, object]:
    return {
        "id": element.id,
        "kind": _format_role(element),
        "name": element.name,
        "qualified_name": qualified_name,
        "owner": element.owner,
        "source": _describe_location(location),
        "attrs": dict(sorted(element.attrs.items())),
    }


def _format_role(element: Element) -> str:
    """Return the role in CamelCase (``Block``, ``FullPort``); the kind if there is no role."""
    return "".join(word.capitalize() for word in element.role.split()) or str(element.kind)


def _describe_location(location: Place | None) -> dict[str, object] | None:
    if location is None:
        return None
    return {
        "file": location.file,
        "line": location.line or None,
        "column": location.column or None,
    }


JSON = GraphBackend()
TEXT = IrBackend()
