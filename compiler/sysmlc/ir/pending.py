"""What front ends store for passes: references to resolve, and the diagrams of authors."""

from typing import NamedTuple

from msgspec import Struct

from sysmlc.ir.kinds import Edge, Kind


class Reference(NamedTuple):
    """An edge to an element that the front end has not found.

    ``target`` is an id of the graph, or an ``href`` (``file#id``) into another file. ``kind`` and
    ``name`` describe an external target as far as the source does; the external stub takes them
    when the file is not part of the compile unit. ``ordinal`` is the position of the reference in
    its file, -1 for the position of its source.
    """

    edge: Edge
    source: str
    target: str
    kind: Kind = Kind.CLASS
    name: str = ""
    ordinal: int = -1


class Drawing(Struct, frozen=True):
    """A diagram as its author drew it, which the pass ``views`` turns into a View element.

    All references are ids of ``file`` or hrefs, as the tool wrote them. ``type`` is the type of the
    diagram in the tool's words, ``diagram`` in those of docs/ir.md. ``source`` and ``ordinal`` are
    the position of the diagram. ``paths`` are nested elements, outermost first. ``listed`` are
    elements that the diagram shows only in a compartment of another element. ``relations`` are
    lines for edges of the graph, which have no element of their own.
    """

    id: str
    name: str
    type: str
    diagram: str
    file: str
    source: str
    ordinal: int
    owner: str = ""
    context: str = ""
    shown: tuple[str, ...] = ()
    paths: tuple[tuple[str, ...], ...] = ()
    listed: tuple[str, ...] = ()
    relations: tuple[tuple[Edge, str, str], ...] = ()
