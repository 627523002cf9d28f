"""Names of components, ids in attributes, bounds of multiplicities."""

from collections.abc import Iterator

from sysmlc.ir.element import AttrValue, Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind
from sysmlc.ir.query.classifiers import BEHAVIORS

_REQUIREMENT = Kind.REQUIREMENT
"""By a name of the module: in Python 3.11 that of a class takes twice as long."""


def component_name(graph: Graph, element: Element) -> str:
    """Qualified name of the component that a behaviour or requirement belongs to.

    A classifier behaviour is its classifier, another behaviour ``<Owner>.<behaviour>``, one
    that a package owns stands alone, a requirement is its subject (design, section 6).
    """
    subject = _satisfier(graph, element) if element.role == "requirement" else None
    component = subject or element
    if component.kind in BEHAVIORS:
        return _behavior_name(graph, component)
    return graph.qualified_name(component)


def _behavior_name(graph: Graph, behavior: Element) -> str:
    owner = graph.owner(behavior)
    if owner is None or owner.kind in (Kind.PACKAGE, Kind.PROFILE):
        return graph.qualified_name(behavior)
    above = component_name(graph, owner)
    if behavior in graph.targets(owner, Edge.CLASSIFIER_BEHAVIOR):
        return above
    return f"{above}.{behavior.name or f'<{behavior.kind}>'}"


def _satisfier(graph: Graph, requirement: Element) -> Element | None:
    return graph.target(requirement, Edge.SUBJECT) or graph.source(requirement, Edge.SATISFIES)


def is_requirement(element: Element) -> bool:
    """Whether it is a requirement, in SysML v1 or v2."""
    return element.attrs.get("role") == "requirement" or element.kind is _REQUIREMENT


def ids_in(value: object) -> Iterator[str]:
    """The ids that an attribute holds, at whatever depth of tuples (docs/ir.md, ``clauses``)."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from ids_in(part)


def bounds(multiplicity: AttrValue) -> tuple[int, int | None] | None:
    """Lower and upper bound of a multiplicity; upper None is unlimited.

    Absent means exactly 1. The result is None when the text is not numbers.
    """
    lower, dots, upper = str("1" if multiplicity is None else multiplicity).partition("..")
    if not dots:
        lower, upper = ("0", "*") if lower == "*" else (lower, lower)
    if not _is_number(lower) or not (upper == "*" or _is_number(upper)):
        return None
    return int(lower), None if upper == "*" else int(upper)


def _is_number(text: str) -> bool:
    return text.isascii() and text.isdecimal()
