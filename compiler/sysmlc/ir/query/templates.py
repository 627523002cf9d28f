"""Templates: formal parameters, bindings and substitutions (UML 2.5.1, 7.3)."""

from msgspec import Struct

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind


class Substitution(Struct, frozen=True):
    """The actual parameter for one formal parameter: an element, else a value."""

    formal: Element | None
    actual: Element | None
    value: AttrValue = None


class Binding(Struct, frozen=True):
    """``bound`` is derived from ``template``, None when the model does not name the template."""

    bound: Element
    template: Element | None
    substitutions: tuple[Substitution, ...]


def parameters(graph: Graph, template: Element) -> list[Element]:
    """Return the formal parameters of a template in order; an empty list for other elements."""
    return [element for element in graph.owned(template) if element.kind is Kind.TEMPLATE_PARAMETER]


def read_binding(graph: Graph, bound: Element, element: Element) -> Binding:
    """Return the binding of *bound* that the TemplateBinding *element* states."""
    substitutions = tuple(
        Substitution(
            graph.target(substitution, Edge.INSTANCE_OF),
            graph.target(substitution, Edge.REFERENCES),
            substitution.attrs.get("value"),
        )
        for substitution in graph.owned(element)
        if substitution.kind is Kind.TEMPLATE_SUBSTITUTION
    )
    return Binding(bound, graph.target(element, Edge.BINDS), substitutions)
