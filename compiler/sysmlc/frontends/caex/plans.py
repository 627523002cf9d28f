"""What instances of a class repeat of it: its attributes and ports by name, inherited ones too."""

from sysmlc.frontends.caex import fitting
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.ir.shared import Shared

KEPT = 64
"""Texts of an attribute that are remembered: those that come often are among the first."""


class Known:
    """An attribute of a class, and how instances repeat it."""

    __slots__ = (
        "_inner",
        "alike",
        "element",
        "member",
        "name",
        "read",
        "said",
        "stated",
        "suffix",
        "text",
    )

    def __init__(self, context: Context, member: Member) -> None:
        node = member.node
        self.member = member
        self.element = context.graph[member.id]
        self.name = node.name
        self.suffix = f"/{node.name or 'Attribute'}"
        """What makes the id of a slot of the id of its owner."""
        self.text = node.text("Value")
        self.stated = node.attributes.get("AttributeDataType", "")
        self.read = fitting.reader(self.stated, member.type)
        self.alike: set[int] = set()
        """Rows that state no more than the class, and with each all that are like it."""
        self.said: dict[str, Shared] = {}
        """Attributes of slots by the text of their value."""
        self._inner: dict[str, Known | None] = {}

    def inner(self, context: Context, name: str) -> "Known | None":
        """The attribute of that name in it."""
        if name not in self._inner:
            type = self.member.type
            found = type.find("Attribute", name) if type is not None else None
            self._inner[name] = None if found is None else Known(context, found)
        return self._inner[name]


class Plan:
    """The attributes and interfaces that a class has, inherited ones included, by name."""

    __slots__ = ("attributes", "interfaces", "steps")

    def __init__(self, context: Context, type: Type | None) -> None:
        self.attributes: dict[str, Known] = {}
        self.interfaces: dict[str, str] = {}
        self.steps: dict[int, Known | str] = {}
        """The attribute, or the port, that rows repeat: by the first row that says the same."""
        for one in reversed(list(type.chain())) if type is not None else ():
            for (tag, name), member in one.members.items():
                if tag == "Attribute":
                    self.attributes[name] = Known(context, member)
                elif tag == "ExternalInterface":
                    self.interfaces[name] = member.id
