"""Questions about templates: formal parameters, and what takes their places (UML 2.5.1, 7.3)."""

from msgspec import Struct

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind

_PARAMETER = Kind.TEMPLATE_PARAMETER
"""By a name of the module: in Python 3.11 members of a class take twice as long."""


class Substitution(Struct, frozen=True):
    """What takes the place of one parameter; ``value`` when that is no element."""

    formal: Element | None
    actual: Element | None
    value: AttrValue = None


class Binding(Struct, frozen=True):
    """``bound`` is made of ``template`` (None when the model does not say which)."""

    bound: Element
    template: Element | None
    substitutions: tuple[Substitution, ...]


def parameters(graph: Graph, template: Element) -> list[Element]:
    """Formal parameters of the template, in order; none for what is no template."""
    return [item for item in graph.owned(template) if item.kind is _PARAMETER]


def bindings(graph: Graph, bound: Element) -> list[Binding]:
    """The bindings by which the element is made of templates."""
    owned = (item for item in graph.owned(bound) if item.kind is Kind.TEMPLATE_BINDING)
    return [binding(graph, bound, item) for item in owned]


def binding(graph: Graph, bound: Element, item: Element) -> Binding:
    """What one TemplateBinding of ``bound`` says."""
    substitutions = tuple(
        Substitution(
            graph.target(one, Edge.INSTANCE_OF),
            graph.target(one, Edge.REFERENCES),
            one.attrs.get("value"),
        )
        for one in graph.owned(item)
        if one.kind is Kind.TEMPLATE_SUBSTITUTION
    )
    return Binding(bound, graph.target(item, Edge.BINDS), substitutions)
