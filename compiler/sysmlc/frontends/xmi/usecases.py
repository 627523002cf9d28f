"""Use cases: what extends them, and where (UML 2.5.1 clause 18.1)."""

from sysmlc.frontends.xmi.behaviour import references
from sysmlc.frontends.xmi.context import Context
from sysmlc.frontends.xmi.elements import Reader, reading
from sysmlc.ir import Edge, Element


def _extend(context: Context, element: Element, row: int) -> None:
    """The use case extends as well, so that questions about use cases need not know Extend."""
    for target, at, is_href in references(context.document, row, "extendedCase"):
        owner = element.owner
        if owner is not None:
            context.link(Edge.EXTENDS, owner, target, at, "extendedCase", is_href)


TYPES: dict[str, Reader] = {"Extend": reading("Extend", _extend)}
