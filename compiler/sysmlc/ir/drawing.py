"""Diagrams as their authors drew them; the pass ``views`` adds them to the graph."""

from msgspec import Struct

from sysmlc.ir.kinds import Edge


class Drawing(Struct, frozen=True):
    """One diagram. References are ids of ``file`` or hrefs, as the tool wrote them.

    ``type`` is the type of the diagram in the tool's words, ``diagram`` in those of docs/ir.md.
    ``source`` and ``ordinal`` are its position. ``paths`` are nested elements, outermost first,
    ``listed`` elements that only a compartment of another one names, and ``relations`` lines that
    are edges of the graph, not elements.
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
