"""The nodes of the graph, and their ids."""

import re
from hashlib import sha1

from sysmlc.ir.kinds import Kind

AttrValue = str | int | float | bool | None | tuple["AttrValue", ...]
"""Value of an attribute: a JSON value, with tuples for lists.

The text of an expression may be a ``ParsedText`` (``ir.expressions``), which has its syntax tree.
"""


def list_items(value: AttrValue) -> tuple[AttrValue, ...]:
    """Return the items of a list value; empty for None and any other value."""
    return value if isinstance(value, tuple) else ()


def as_items(value: AttrValue) -> tuple[AttrValue, ...]:
    """Return the items of a list value; any other value is the only item."""
    return value if isinstance(value, tuple) else (value,)


def as_texts(value: AttrValue) -> tuple[str, ...]:
    """Return the items of a list value as texts; any other value is the only item."""
    return tuple(map(str, as_items(value)))


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


# -- ids ---------------------------------------------------------------------------------------

_TOOL_ID = re.compile(
    r"_[\w-]{22}|_\w+_\d+_\d+_\d+|EA(ID|PK)_[0-9A-F]{8}_\w+|eee_\d+_\d+_\d+", re.ASCII
)
_SHORTEST_UNIQUE = 20
"""Ids of this length are unique in the world: Papyrus writes 23 characters, MagicDraw about 41,
Enterprise Architect 43."""
ROOT = "eee_1045467100313_"
"""Prefix of the ids of MagicDraw's roots, which are the same in every project."""
_NAMESPACE = bytes.fromhex("6f1d7a543f0c5d3a9a520c2f6f2d7b11")
_VARIANT = dict(zip("0123456789abcdef", "89ab" * 4, strict=True))
"""Digit of a UUID whose upper two bits state the variant of RFC 9562."""


def is_globally_unique(id: str) -> bool:
    """Whether no two models can have this id, because a tool has generated it."""
    return len(id) >= _SHORTEST_UNIQUE and not id.startswith(ROOT)


def is_generated(id: str) -> bool:
    """Whether *id* has the form that Eclipse, MagicDraw or Enterprise Architect generate."""
    return _TOOL_ID.fullmatch(id) is not None


def derived_id(origin: str, role: str) -> str:
    """Return the id of the element that is derived from the element *origin* in the role *role*.

    It is a UUID of version 5 (RFC 9562, 5.5), the same on every machine.
    """
    # uuid.uuid5() takes three times as long.
    name = f"{origin}\x1f{role}".encode()
    digest = sha1(_NAMESPACE + name, usedforsecurity=False).hexdigest()
    variant = _VARIANT[digest[16]]
    return f"{digest[:8]}-{digest[8:12]}-5{digest[13:16]}-{variant}{digest[17:20]}-{digest[20:32]}"
