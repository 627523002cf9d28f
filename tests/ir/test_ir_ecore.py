"""The back end ``ecore``: pyecore, an independent implementation, reads its output unchanged."""

import json
from collections.abc import Iterator

from hypothesis import given
from pyecore.ecore import EObject
from pyecore.resources import ResourceSet
from random_graphs import graphs

from sysmlc.backends.ecore import feature_name, print_xmi
from sysmlc.ir import AttrValue, Edge, Element, Graph, Kind, print_text
from sysmlc.support import resources


def read_ecore_xmi(path: str) -> Graph:
    """Read a graph that the back end ``ecore`` wrote."""
    files = ResourceSet()
    metamodel = files.get_resource(str(resources.path("metamodels", "ir.ecore"))).contents[0]
    files.metamodel_registry[metamodel.nsURI] = metamodel
    graph = Graph()
    objects = list(_iter_objects(files.get_resource(path).contents[0]))
    for obj, owner in objects:
        graph.add(_read_element(obj, owner))
    for obj, _ in objects:
        for edge in Edge:
            if edge is not Edge.OWNS:
                for target in getattr(obj, feature_name(edge)):
                    graph.connect(edge, _unescape(obj.id), _unescape(target.id))
    return graph


def _iter_objects(root: EObject) -> Iterator[tuple[EObject, str | None]]:
    stack: list[tuple[EObject, str | None]] = [(top, None) for top in reversed(root.roots)]
    while stack:
        obj, owner = stack.pop()
        yield obj, owner
        stack.extend((child, _unescape(obj.id)) for child in reversed(obj.owns))


def _read_element(obj: EObject, owner: str | None) -> Element:
    attrs: dict[str, AttrValue] = {
        _unescape(pair.key): _convert_lists(json.loads(pair.value)) for pair in obj.attrs
    }
    return Element(
        _unescape(obj.id),
        Kind(obj.eClass.name),
        _unescape(obj.name),
        owner,
        obj.ordinal,
        _unescape(obj.source),
        attrs,
    )


def _convert_lists(value: object) -> AttrValue:
    if isinstance(value, list):
        return tuple(_convert_lists(item) for item in value)
    assert value is None or isinstance(value, str | int | float | bool)
    return value


def _unescape(text: str | None) -> str:
    return str(json.loads(f'"{text or ""}"'))


@given(graph=graphs(max_size=6))
def test_pyecore_loads_a_saved_graph_unchanged(graph, tmp_path_factory):
    saved = tmp_path_factory.mktemp("ecore") / "graph.xmi"
    saved.write_text(print_xmi(graph), encoding="utf-8")
    assert print_text(read_ecore_xmi(str(saved))) == print_text(graph)


def test_an_empty_graph_is_saved_too(tmp_path):
    saved = tmp_path / "graph.xmi"
    saved.write_text(print_xmi(Graph()), encoding="utf-8")
    assert len(read_ecore_xmi(str(saved))) == 0
