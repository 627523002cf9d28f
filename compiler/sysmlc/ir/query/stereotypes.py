"""Stereotypes that apply to elements, and their tagged values."""

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind


def applications(graph: Graph, element: Element) -> list[Element]:
    """Stereotype applications on the element, in order."""
    found = graph.sources(element, Edge.SUBJECT)
    return [one for one in found if one.kind is Kind.APPLICATION]


def lineage(application: Element) -> tuple[str, ...]:
    """Local names from the applied stereotype to the most general one.

    Before ``classify`` has run it is the applied stereotype's name alone.
    """
    names = application.attrs.get("lineage")
    if isinstance(names, tuple):
        return tuple(str(name) for name in names)
    return (str(application.attrs.get("stereotype", "")),)


def stereotypes(graph: Graph, element: Element) -> tuple[str, ...]:
    """Local names of the stereotypes that apply, general ones included, each once."""
    names = (name for one in applications(graph, element) for name in lineage(one))
    return tuple(dict.fromkeys(names))


def has_stereotype(graph: Graph, element: Element, *names: str) -> bool:
    """Whether one of the stereotypes, or one that specialises it, applies."""
    return not set(names).isdisjoint(stereotypes(graph, element))


def tag(graph: Graph, element: Element, name: str) -> AttrValue:
    """First tagged value of this name on the element, or None; an exact name goes first.

    MagicDraw writes ``Text`` and ``Id`` where Papyrus writes ``text`` and ``id``, so that case
    is ignored when no name fits exactly. Enterprise Architect may tell tags of the element
    itself, beside a stereotype that has none.
    """
    found = applications(graph, element)
    for application in found:
        if f"tag.{name}" in application.attrs:
            return application.attrs[f"tag.{name}"]
    for application in found:
        for key, value in application.attrs.items():
            if key.lower() == f"tag.{name.lower()}":
                return value
    return element.attrs.get(f"tag.{name}")
