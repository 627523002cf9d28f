"""The way that most rows of a plant go: what an instance says again of what its class says.

An attribute or interface without more to say than values needs a look into the table of its
class and perhaps a slot. Everything else goes the general way (``members``), which gives the
same result for every row.
"""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import fitting, members
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.holders import instance, own
from sysmlc.frontends.caex.sameness import says_more
from sysmlc.frontends.caex.site import Site
from sysmlc.frontends.caex.types import Member, Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.reference import End

# To look a member of an enumeration up takes ten times as long as to look these up.
_MAPPED = Verdict.MAPPED
_SLOT = Kind.SLOT
_INSTANCE_OF = Edge.INSTANCE_OF


class _Known:
    """An attribute of a class, and how instances repeat it."""

    __slots__ = ("_inner", "alike", "element", "member", "name", "read", "stated", "text")

    def __init__(self, context: Context, member: Member) -> None:
        node = member.node
        self.member = member
        self.element = context.graph[member.id]
        self.name = node.name
        self.text = node.text("Value")
        self.stated = node.attributes.get("AttributeDataType", "")
        self.read = fitting.reader(self.stated, member.type)
        self.alike: set[int] = set()
        """Rows that state no more than the class, and with each all that are like it."""
        self._inner: dict[str, _Known | None] = {}

    def inner(self, context: Context, name: str) -> "_Known | None":
        """The attribute of that name in it."""
        if name not in self._inner:
            type = self.member.type
            found = type.find("Attribute", name) if type is not None else None
            self._inner[name] = None if found is None else _Known(context, found)
        return self._inner[name]


class _Plan:
    """The attributes and interfaces that a class has, inherited ones included, by name."""

    __slots__ = ("attributes", "interfaces", "steps")

    def __init__(self, context: Context, type: Type | None) -> None:
        self.attributes: dict[str, _Known] = {}
        self.interfaces: dict[str, str] = {}
        self.steps: dict[int, _Known | str] = {}
        """The attribute, or the port, that rows repeat: by the first row that says the same."""
        for one in reversed(list(type.chain())) if type is not None else ():
            for (tag, name), member in one.members.items():
                if tag == "Attribute":
                    self.attributes[name] = _Known(context, member)
                elif tag == "ExternalInterface":
                    self.interfaces[name] = member.id


class Swift:
    """Lowers the members of the internal elements of one file."""

    def __init__(self, context: Context, document: Document) -> None:
        self._context = context
        self._document = document
        self._plain = context.plain[document]
        self._plans: dict[Type | None, _Plan] = {}
        texts = document.texts
        self._odd = texts["DefaultValue"].keys() | texts["Description"].keys()
        """Rows that say something beside their value."""
        self._edges: list[Edge] = []
        self._slots: list[End] = []
        self._features: list[Element | None] = []

    def lower(self, site: Site) -> None:
        """The members of an internal element."""
        declared, document = site.declared, self._document
        steps = (self._plans.get(declared) or self._plan(declared)).steps
        alike, ends, odd, verdicts = document.alike, document.ends, self._odd, document.verdicts
        value_of, ids, elements = document.texts["Value"].get, document.ids, document.elements
        for row in site.members:
            known = steps.get(alike[row])
            if known is None or ends[row] > row + 1 or row in odd:
                self._otherwise(site, row)
                continue
            verdicts[row] = _MAPPED
            if isinstance(known, str):
                elements[row] = known
                if ids[row]:
                    site.interface_ids.append((known, ids[row]))
            else:
                text = value_of(row)
                if text is not None and text != known.text:
                    self._slot(site, row, known, text)

    def _otherwise(self, site: Site, row: int) -> None:
        """A row that says more, or what no row of its class said before."""
        document, context = self._document, self._context
        plan, tag = self._plans[site.declared], document.tags[row]
        name, is_read = document.attributes[row].get("Name", ""), False
        if tag == "Attribute":
            known = plan.attributes.get(name)
            if known is None:
                is_read = self._plain.attribute(site.own or own(context, site), row)
            else:
                is_read = self._structure(site, row, known)
                if is_read and document.ends[row] == row + 1:
                    plan.steps[document.alike[row]] = known
        elif tag == "ExternalInterface":
            is_read = self._interface(site, row, plan)
        elif tag == "InternalLink":
            # Links come when all that they can lead to is there.
            is_read = True
        if not is_read:
            members.lower_one(context, site, document.node(row))

    def _plan(self, declared: Type | None) -> _Plan:
        plan = self._plans[declared] = _Plan(self._context, declared)
        return plan

    def _interface(self, site: Site, row: int, plan: _Plan) -> bool:
        """An interface: the port that the class has, or a new one; False when more is said."""
        document, values = self._document, self._document.attributes[row]
        port = plan.interfaces.get(values.get("Name", ""))
        if port is None:
            return self._plain.interface(site.own or own(self._context, site), row)
        if document.ends[row] > row + 1:
            return False
        path = values.get("RefBaseClassPath")
        if path and self._context.known(path, Family.INTERFACE, document) is None:
            return False
        plan.steps[document.alike[row]] = port
        document.verdicts[row] = _MAPPED
        document.elements[row] = port
        if document.ids[row]:
            site.interface_ids.append((port, document.ids[row]))
        return True

    def _repeats(self, row: int, known: _Known) -> bool:
        """Whether a row says what the class says, but for its value and rows inside."""
        document = self._document
        if row in self._odd:
            return False
        alike = document.alike[row]
        if alike not in known.alike:
            node, context = document.node(row), self._context
            path = node.attributes.get("RefAttributeType", "").strip()
            leads = not path or isinstance(context.look_up(path, Family.ATTRIBUTE, document), Type)
            if not leads or says_more(context.types, document, node, known.member):
                return False
            known.alike.add(alike)
        return True

    def _structure(self, site: Site, top: int, known: _Known) -> bool:
        """An attribute with attributes; False when there is more to it."""
        document = self._document
        tags, attributes = document.tags, document.attributes
        waiting: list[tuple[int, _Known, tuple[Element, ...]]] = [(top, known, ())]
        found = []
        while waiting:
            row, one, path = waiting.pop()
            if not self._repeats(row, one):
                return False
            found.append((row, one, path))
            for child in document.children(row):
                name = attributes[child].get("Name", "")
                inner = one.inner(self._context, name) if tags[child] == "Attribute" else None
                if inner is None:
                    return False
                waiting.append((child, inner, (*path, one.element)))
        for row, one, path in found:
            document.verdicts[row] = _MAPPED
            text = document.texts["Value"].get(row)
            if text is not None and text != one.text:
                slot = self._slot(site, row, one, text)
                for outer in path:
                    self._edges.append(Edge.PATH)
                    self._slots.append(slot)
                    self._features.append(outer)
        return True

    def _slot(self, site: Site, row: int, known: _Known, text: str) -> Element:
        """A slot for a value that the class does not give."""
        document, context = self._document, self._context
        owner = site.instance or instance(context, site)
        slot = None
        if not document.ids[row]:
            name, ordinal = known.name, document.ordinals[row]
            id = f"{owner}/{name or 'Attribute'}"
            slot = context.graph.new(id, _SLOT, name, owner, ordinal, document.name)
        if slot is None:
            slot = context.add_at(_SLOT, document, row, owner)
        try:
            value: AttrValue = text if known.read is None else known.read(text)
        except ValueError:
            data_type = fitting.data_type_of(known.stated, known.member.type)
            value = fitting.unfit(context, document, row, text, data_type, known.stated)
        if value != "":
            slot.attrs = {"value": value}
        document.elements[row] = slot.id
        self._edges.append(_INSTANCE_OF)
        self._slots.append(slot)
        self._features.append(known.element)
        return slot

    def finish(self) -> None:
        """Tie the slots to the attributes that they have the values of."""
        self._context.graph.connect_all(self._edges, self._slots, self._features)
        for column in (self._edges, self._slots, self._features):
            column.clear()
