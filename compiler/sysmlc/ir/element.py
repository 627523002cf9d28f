"""The node of the graph."""

from sysmlc.ir.kinds import Kind

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
