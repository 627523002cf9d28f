"""Back end ``graph``: the whole graph as ``graph.json``, for other programs."""

from msgspec import Struct

from sysmlc.backends.base import EmitOptions
from sysmlc.diagnostics import Place, Sink
from sysmlc.ir import Element, Graph
from sysmlc.support.json_text import encode_json
from sysmlc.support.output import Output


class GraphBackend(Struct, frozen=True):
    """Writes elements sorted by qualified name and ordinal, and edges in their order."""

    name: str = "graph"
    summary: str = "the refined graph as graph.json"
    is_default: bool = False

    def emit(self, graph: Graph, output: Output, sink: Sink, options: EmitOptions) -> None:
        """Add ``graph.json`` (design, section 6)."""
        names = {element.id: graph.qualified_name(element) for element in graph}
        ordered = sorted(graph, key=lambda e: (names[e.id], e.ordinal, e.id))
        rank = {element.id: number for number, element in enumerate(ordered)}
        places = {element.id: Place(element.source, element.ordinal) for element in ordered}
        found = options.locate(place for place in places.values() if place.file)
        content = {
            "format": "sysmlc-graph/2",
            "elements": [
                _element(element, names[element.id], found.get(places[element.id]))
                for element in ordered
            ],
            "edges": [
                {"kind": kind, "from": source, "to": target}
                for kind, source, target in sorted(
                    graph.edges(), key=lambda edge: (rank[edge[1]], edge[0])
                )
            ],
        }
        output.add("graph.json", encode_json(content), trace=(), backend=self.name)


def _element(element: Element, qualified_name: str, place: Place | None) -> dict[str, object]:
    return {
        "id": element.id,
        "kind": outward_kind(element),
        "name": element.name,
        "qualified_name": qualified_name,
        "owner": element.owner,
        "source": _source(place),
        "attrs": dict(sorted(element.attrs.items())),
    }


def _source(place: Place | None) -> dict[str, object] | None:
    if place is None:
        return None
    return {"file": place.file, "line": place.line or None, "column": place.column or None}


def outward_kind(element: Element) -> str:
    """The role in CamelCase where there is one (``Block``, ``FullPort``), else the kind."""
    return "".join(word.capitalize() for word in element.role.split()) or str(element.kind)


BACKEND = GraphBackend()

__all__ = ["BACKEND", "GraphBackend", "outward_kind"]
