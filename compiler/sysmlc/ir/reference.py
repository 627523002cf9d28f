"""References as a front end found them, before they are edges."""

from typing import NamedTuple

from sysmlc.ir.kinds import Edge, Kind


class Reference(NamedTuple):
    """An edge whose target is still to be found.

    ``target`` is an id of the graph, or an ``href`` (``file#id``) to another file. ``kind``
    and ``name`` are what the source says about an external target: they make the stub that
    stands for it when the file is not part of the compile unit. ``ordinal`` is the place of
    the reference in its file, -1 when it is the owner's.
    """

    edge: Edge
    source: str
    target: str
    kind: Kind = Kind.CLASS
    name: str = ""
    ordinal: int = -1
