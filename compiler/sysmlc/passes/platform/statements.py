"""What a model says about where a machine or a service of a recipe is in the plant."""

from collections.abc import Iterator
from typing import NamedTuple

from sysmlc.ir import Edge, Element, Graph, Kind, query
from sysmlc.recipe.model import Machine

_OVERLAY = ".overlay.yaml"


class Statement(NamedTuple):
    """Where, how it is said (``tag``, ``allocation``, ``overlay``), and what says it."""

    target: Element
    how: str
    by: Element


def allocations(graph: Graph, element: Element) -> Iterator[Statement]:
    """Everything that an element is allocated to (SysML 1.6 clause 15.3.1.1)."""
    said: set[str] = set()
    for one in graph.sources(element, Edge.CLIENT):
        if one.role == "allocate":
            how = "overlay" if one.source.endswith(_OVERLAY) else "allocation"
            for target in graph.targets(one, Edge.SUPPLIER):
                said.add(target.id)
                yield Statement(target, how, one)
    for target in graph.targets(element, Edge.ALLOCATED_TO):
        if target.id not in said:
            yield Statement(target, "allocation", element)


def of_machine(graph: Graph, machine: Machine) -> Iterator[Statement]:
    """What is said about a machine: its tag ``plantElement``, and allocations.

    What is said about the block of a machine that is a part or an instance holds when nothing
    is said about itself.
    """
    element = graph[machine.element]
    own = [*_tagged(graph, element), *allocations(graph, element)]
    type_ = query.type_of(graph, element) or graph.target(element, Edge.INSTANCE_OF)
    if not own and type_ is not None:
        own = [*_tagged(graph, type_), *allocations(graph, type_)]
    yield from own


def _tagged(graph: Graph, element: Element) -> Iterator[Statement]:
    for application in query.applications(graph, element):
        value = application.attrs.get("tag.plantElement")
        target = graph.get(value) if isinstance(value, str) else None
        if target is not None:
            yield Statement(target, "tag", application)


def is_structure(element: Element) -> bool:
    """Whether an element without AutomationML may be one of a plant: block, part, instance."""
    return element.kind in (Kind.CLASS, Kind.COMPONENT, Kind.PROPERTY, Kind.INSTANCE)
