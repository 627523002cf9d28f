"""The way that most rows of a plant go: what an instance says again of what its class says.

An attribute or interface without more to say than values needs a look into the table of its
class and perhaps a slot. Everything else goes the general way (``members``), which gives the
same result for every row.
"""

from sysmlc.diagnostics import Verdict
from sysmlc.frontends.caex import members
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.holders import instance, own
from sysmlc.frontends.caex.plans import Known, Plan
from sysmlc.frontends.caex.sameness import says_more
from sysmlc.frontends.caex.site import NO_ROWS, Site
from sysmlc.frontends.caex.slots import Slots
from sysmlc.frontends.caex.types import Type
from sysmlc.frontends.caex.vocabulary import Family
from sysmlc.ir import Element

# To look a member of an enumeration up takes twice as long as to look this up.
_MAPPED = Verdict.MAPPED


class Swift:
    """Lowers the members of the internal elements of one file."""

    def __init__(self, context: Context, document: Document) -> None:
        self._context = context
        self._document = document
        self._plain = context.plain[document]
        self._plans: dict[Type | None, Plan] = {}
        texts = document.texts
        self._odd = texts["DefaultValue"].keys() | texts["Description"].keys()
        """Rows that say something beside their value."""
        self._other = self._odd | set(document.parents)
        """Those, and rows with others inside."""
        self._slots = Slots(context, document)

    def lower(self, site: Site) -> None:
        """The members of an internal element."""
        declared, document = site.declared, self._document
        steps = (self._plans.get(declared) or self._plan(declared)).steps
        alike, other, verdicts = document.alike, self._other, document.verdicts
        value_of, ids, elements = document.texts["Value"].get, document.ids, document.elements
        add = self._slots.add
        for row in site.members:
            known = steps.get(alike[row])
            if known is None or row in other:
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
                    add(site.instance or instance(self._context, site), row, known, text)
        site.members = NO_ROWS

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
        if not is_read:
            members.lower_one(context, site, document.node(row))

    def _plan(self, declared: Type | None) -> Plan:
        plan = self._plans[declared] = Plan(self._context, declared)
        return plan

    def _interface(self, site: Site, row: int, plan: Plan) -> bool:
        """An interface: the port that the class has, or a new one; False when more is said."""
        document, values = self._document, self._document.attributes[row]
        port = plan.interfaces.get(values.get("Name", ""))
        if port is None:
            return self._plain.interface(site.own or own(self._context, site), row)
        if document.ends[row] > row + 1 or row in self._odd:
            return False
        if values.get("RefBaseClassPath") and self._is_another(site, document.node(row)):
            return False
        plan.steps[document.alike[row]] = port
        document.verdicts[row] = _MAPPED
        document.elements[row] = port
        if document.ids[row]:
            site.interface_ids.append((port, document.ids[row]))
        return True

    def _is_another(self, site: Site, node: Node) -> bool:
        """Whether an interface is of another class than that of its class, or of none."""
        path, context = node.attributes["RefBaseClassPath"], self._context
        known = site.declared.find(node.tag, node.name) if site.declared else None
        if known is None or context.known(path, Family.INTERFACE, self._document) is None:
            return True
        return members.is_of_another_class(context, node, known)

    def _repeats(self, row: int, known: Known) -> bool:
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

    def _structure(self, site: Site, top: int, known: Known) -> bool:
        """An attribute with attributes; False when there is more to it."""
        document = self._document
        tags, attributes = document.tags, document.attributes
        waiting: list[tuple[int, Known, tuple[Element, ...]]] = [(top, known, ())]
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
                owner = site.instance or instance(self._context, site)
                self._slots.lead(self._slots.add(owner, row, one, text), path)
        return True

    def finish(self) -> None:
        """Tie the slots to the attributes that they have the values of."""
        self._slots.finish()
