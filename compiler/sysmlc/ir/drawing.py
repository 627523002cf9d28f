"""Diagrams as their authors drew them, before the pass ``views`` makes them part of the graph."""

from msgspec import Struct

from sysmlc.ir.kinds import Edge


class Drawing(Struct, frozen=True):
    """One diagram; every reference is an id of ``file`` or an ``href``, as its tool wrote it.

    ``type`` is what the tool calls it, ``diagram`` our word (docs/ir.md). ``source`` and
    ``ordinal`` say where it is written. ``paths`` are the elements that are drawn inside
    others, outermost first; ``listed`` those that are only named in a compartment of another
    one; ``relations`` those lines that are no elements of the graph.
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
