"""The nodes of the graph, and references to nodes that are not resolved yet."""

from typing import NamedTuple

from sysmlc.ir.kinds import Edge, Kind

AttrValue = str | int | float | bool | None | tuple["AttrValue", ...]
"""Value of an attribute: a JSON value, with tuples for lists."""


class Element:
    """One element of the model. It has identity and is changed only through its ``Graph``.

    ``owner`` is the id of the owner. ``source`` is the file, relative to the root of the compile
    unit, and ``ordinal`` the position in document order. A derived element has no source; its
    attribute ``origin`` is the id of the element that it is derived from.
    """

    __slots__ = ("attrs", "id", "kind", "name", "ordinal", "owner", "source")

    def __init__(
        self,
        id: str,
        kind: Kind,
        name: str = "",
        owner: str | None = None,
        ordinal: int = -1,
        source: str = "",
        attrs: dict[str, AttrValue] | None = None,
    ) -> None:
        self.id = id
        self.kind = kind
        self.name = name
        self.owner = owner
        self.ordinal = ordinal
        self.source = source
        self.attrs = {} if attrs is None else attrs

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name or self.id}>"

    @property
    def role(self) -> str:
        """The role that the pass ``classify`` assigned ("block", "part", ...), or ""."""
        return str(self.attrs.get("role", ""))

    @property
    def subkind(self) -> str:
        """The subdivision of the kind ("decision", "call-operation", ...), or ""."""
        return str(self.attrs.get("subkind", ""))


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
