"""References of a model that are not resolved to edges yet."""

from typing import NamedTuple

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
