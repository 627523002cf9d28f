"""What of the libraries and stubs outside the model the text needs, so that its names are found."""

from collections.abc import Iterator

from sysmlc.backends.sysml.library import SHIPPED
from sysmlc.backends.sysml.stereotypes import is_standard
from sysmlc.ir import Edge, Element, Graph, Kind

_EDGES = (
    Edge.TYPED_BY,
    Edge.SPECIALIZES,
    Edge.REALIZES,
    Edge.REDEFINES,
    Edge.SUBSETS,
    Edge.INSTANCE_OF,
    Edge.CALLS,
    Edge.CLIENT,
    Edge.SUPPLIER,
    Edge.CONVEYS,
    Edge.ROLE,
    Edge.PATH,
    Edge.REPRESENTS,
    Edge.SUBJECT,
    Edge.INCLUDES,
    Edge.REFERENCES,
    Edge.FLOW_SOURCE,
    Edge.FLOW_TARGET,
)
_MEASURES = (Kind.UNIT, Kind.QUANTITY_KIND)
_NO_REFERENCES = (Kind.IMPORT, Kind.DATA_TYPE, Kind.APPLICATION, *_MEASURES)


def used_outside(graph: Graph) -> set[str]:
    """Ids of elements outside the model that its text refers to, with what these need."""
    found: set[str] = set()
    stack = [one for one in graph if not one.attrs.get("external")]
    while stack:
        for target in _needed(graph, stack.pop()):
            if target.attrs.get("external") and target.id not in found:
                found.add(target.id)
                stack.append(target)
    return found


def _needed(graph: Graph, element: Element) -> Iterator[Element]:
    if element.attrs.get("external"):
        owner = graph.owner(element)
        if owner is not None:
            yield owner
    if element.kind is Kind.APPLICATION and is_standard(element):
        return
    if _is_of_measure(graph, element):
        return
    methods = graph.targets(element, Edge.METHOD)
    yield from (one for one in methods if one.source.startswith(SHIPPED))
    for edge in _EDGES:
        if edge is Edge.REFERENCES and element.kind in _NO_REFERENCES:
            continue
        for target in graph.targets(element, edge):
            if target.kind not in _MEASURES:
                yield target


def _is_of_measure(graph: Graph, element: Element) -> bool:
    """Units and their slots refer to SysML's own library of units."""
    for one in (element, graph.owner(element)):
        if one is not None and one.role in ("unit", "quantity kind"):
            return True
    return False
