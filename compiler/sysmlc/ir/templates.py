"""Questions about templates: formal parameters, and what takes their places (UML 2.5.1, 7.3)."""

from dataclasses import dataclass

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind


@dataclass(frozen=True, slots=True)
class Substitution:
    """What takes the place of one parameter; ``value`` when that is no element."""

    formal: Element | None
    actual: Element | None
    value: AttrValue = None


@dataclass(frozen=True, slots=True)
class Binding:
    """A template from which an element is made."""

    template: Element | None
    substitutions: tuple[Substitution, ...]


def parameters(graph: Graph, template: Element) -> list[Element]:
    """Formal parameters of the template, in order; none for what is no template."""
    return [item for item in graph.owned(template) if item.kind is Kind.TEMPLATE_PARAMETER]


def bindings(graph: Graph, element: Element) -> list[Binding]:
    """The bindings by which the element is made of templates."""
    return [
        Binding(graph.target(item, Edge.BINDS), _substitutions(graph, item))
        for item in graph.owned(element)
        if item.kind is Kind.TEMPLATE_BINDING
    ]


def _substitutions(graph: Graph, binding: Element) -> tuple[Substitution, ...]:
    return tuple(
        Substitution(
            graph.target(item, Edge.INSTANCE_OF),
            graph.target(item, Edge.REFERENCES),
            item.attrs.get("value"),
        )
        for item in graph.owned(binding)
        if item.kind is Kind.TEMPLATE_SUBSTITUTION
    )
