"""The node of the graph."""

from sysmlc.ir.kinds import Kind

AttrValue = str | int | float | bool | None | tuple["AttrValue", ...]
"""What an attribute may hold: JSON values, with tuples for lists."""


class Element:
    """One element of the model. It has identity and is changed only through its ``Graph``.

    ``source`` is the file, relative to the unit's root, and ``ordinal`` the place in document
    order; what a pass made has the empty source and the attribute ``origin``.
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
        """What ``classify`` found it to be ("block", "part", ...), or the empty string."""
        return str(self.attrs.get("role", ""))

    @property
    def subkind(self) -> str:
        """Subdivision of its kind ("decision", "call-operation", ...), or the empty string."""
        return str(self.attrs.get("subkind", ""))
