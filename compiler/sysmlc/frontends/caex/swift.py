"""The way that most rows of a plant go: what an instance says again of what its class says.

An attribute or interface without anything inside, and without more to say than a value, needs
a look into the table of its class and perhaps a slot. Everything else goes the general way
(``members``), which gives the same result for every row.
"""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import members
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.holders import instance, own
from sysmlc.frontends.caex.sameness import says_more
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import reader_of
from sysmlc.ir import Edge, Element, Kind

_Stated = tuple[str | None, ...]


class _Known:
    """An attribute of a class, and how instances repeat it."""

    __slots__ = ("alike", "element", "member", "read", "template", "text")

    def __init__(self, member: Member, element: Element) -> None:
        node = member.node
        self.member = member
        self.element = element
        self.text = node.text("Value")
        self.read = reader_of(node.attributes.get("AttributeDataType", ""))
        self.template: dict[str, str] = {}
        """Attributes of the last row that said the same: nearly all rows have equal ones."""
        self.alike: set[_Stated] = set()
        """What rows stated that said no more than the class."""


class _Plan:
    """The attributes and interfaces that a class has, inherited ones included, by name."""

    __slots__ = ("attributes", "interfaces")

    def __init__(self, context: Context, type: Type | None) -> None:
        self.attributes: dict[str, _Known] = {}
        self.interfaces: dict[str, str] = {}
        for one in reversed(list(type.chain())) if type is not None else ():
            for (tag, name), member in one.members.items():
                if tag == "Attribute":
                    self.attributes[name] = _Known(member, context.graph[member.id])
                elif tag == "ExternalInterface":
                    self.interfaces[name] = member.id


class Swift:
    """Lowers the members of the internal elements of one file."""

    def __init__(self, context: Context, document: Document) -> None:
        self._context = context
        self._document = document
        self._plans: dict[Type | None, _Plan] = {}
        self._plain = context.plain[document]
        self._slots: list[str] = []
        self._features: list[Element | None] = []

    def lower(self, site: Site) -> None:
        """The members of an internal element."""
        declared, document, context = site.declared, self._document, self._context
        plan = self._plan(declared)
        tags, ends, attributes = document.tags, document.ends, document.attributes
        for row in site.members:
            tag, name = tags[row], attributes[row].get("Name", "")
            if ends[row] > row + 1 or not (
                (tag == "Attribute" and self._attribute(site, row, name, plan))
                or (tag == "ExternalInterface" and self._interface(site, row, name, plan))
            ):
                members.lower_one(context, site, document.node(row))

    def _plan(self, declared: Type | None) -> _Plan:
        plan = self._plans.get(declared)
        if plan is None:
            plan = self._plans[declared] = _Plan(self._context, declared)
        return plan

    def _attribute(self, site: Site, row: int, name: str, plan: _Plan) -> bool:
        known = plan.attributes.get(name)
        if known is None:
            return self._plain.attribute(site.own or own(self._context, site), row)
        if not self._repeats(row, known):
            return False
        self._document.verdicts[row] = Verdict.MAPPED
        self._value(site, row, name, known)
        return True

    def _interface(self, site: Site, row: int, name: str, plan: _Plan) -> bool:
        port = plan.interfaces.get(name)
        document = self._document
        if port is None:
            return self._plain.interface(site.own or own(self._context, site), row)
        document.verdicts[row] = Verdict.MAPPED
        document.elements[row] = port
        id = document.attributes[row].get("ID")
        if id:
            site.interface_ids.append((port, id))
        return True

    def _repeats(self, row: int, known: _Known) -> bool:
        """Whether a row without rows inside says what the class says, but for its value."""
        document = self._document
        values, texts = document.attributes[row], document.texts
        if row in texts["DefaultValue"] or row in texts["Description"]:
            return False
        if values == known.template:
            document.attributes[row] = known.template
            return True
        stated = (
            values.get("Unit"),
            values.get("AttributeDataType"),
            values.get("RefAttributeType"),
        )
        if stated not in known.alike:
            node = document.node(row)
            if says_more(self._context.types, document, node, known.member):
                return False
            known.alike.add(stated)
        if "ID" not in values:
            known.template = values
        return True

    def _value(self, site: Site, row: int, name: str, known: _Known) -> None:
        """A slot for the value, unless it is the one that the class gives."""
        document = self._document
        text = document.texts["Value"].get(row)
        if text is None or text == known.text:
            return
        owner = site.instance or instance(self._context, site)
        id = f"{owner}/{name or 'Attribute'}"
        slot = None
        if not document.attributes[row].get("ID"):
            new = self._context.graph.new
            slot = new(id, Kind.SLOT, name, owner, document.ordinals[row], document.name)
        value = text if known.read is None else known.read(text)
        if slot is None:
            node = document.node(row)
            slot = self._context.add(Kind.SLOT, node, document, owner, value=value)
        elif value != "":
            slot.attrs = {"value": value}
        document.elements[row] = slot.id
        self._slots.append(slot.id)
        self._features.append(known.element)

    def finish(self) -> None:
        """Tie the slots to the attributes that they have the values of."""
        edges = [Edge.INSTANCE_OF] * len(self._slots)
        self._context.graph.connect_all(edges, self._slots, self._features)
        self._slots.clear()
        self._features.clear()
