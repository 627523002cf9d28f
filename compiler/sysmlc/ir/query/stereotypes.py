"""Stereotypes that apply to elements, and their tagged values."""

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind


def applications(graph: Graph, element: Element) -> list[Element]:
    """Return the stereotype applications on *element*, in order."""
    sources = graph.sources(element, Edge.SUBJECT)
    return [source for source in sources if source.kind is Kind.APPLICATION]


def lineage(application: Element) -> tuple[str, ...]:
    """Return the local names from the applied stereotype to the most general one.

    Before the pass ``classify``, this is the name of the applied stereotype alone.
    """
    names = application.attrs.get("lineage")
    if isinstance(names, tuple):
        return tuple(str(name) for name in names)
    return (str(application.attrs.get("stereotype", "")),)


def stereotypes(graph: Graph, element: Element) -> tuple[str, ...]:
    """Return the local names of the stereotypes of *element*, general ones included, each once."""
    names = (name for item in applications(graph, element) for name in lineage(item))
    return tuple(dict.fromkeys(names))


def has_stereotype(graph: Graph, element: Element, *names: str) -> bool:
    """Return whether one of the stereotypes, or one that specialises it, applies to *element*."""
    return not set(names).isdisjoint(stereotypes(graph, element))


def tag(graph: Graph, element: Element, name: str) -> AttrValue:
    """Return the first tagged value of this name on *element*, or None.

    Case is ignored if no tag has exactly this name, because MagicDraw writes ``Text`` and ``Id``
    where Papyrus writes ``text`` and ``id``. Enterprise Architect can write tags on the element
    itself, without a stereotype.
    """
    items = applications(graph, element)
    for application in items:
        if f"tag.{name}" in application.attrs:
            return application.attrs[f"tag.{name}"]
    for application in items:
        for key, value in application.attrs.items():
            if key.lower() == f"tag.{name.lower()}":
                return value
    return element.attrs.get(f"tag.{name}")
