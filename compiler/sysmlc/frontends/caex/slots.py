"""Slots: the values that internal elements give to what their class has."""

from sysmlc.frontends.caex import fitting
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.plans import KEPT, Known
from sysmlc.ir import AttrValue, Edge, Element, Kind
from sysmlc.ir.shared import NOTHING, Shared

# To look a member of an enumeration up takes twice as long as to look this up.
_SLOT = Kind.SLOT


class Slots:
    """Makes the slots of one file."""

    def __init__(self, context: Context, document: Document) -> None:
        self._context = context
        self._document = document
        self._new = context.graph.new
        self._ids = document.ids
        self._ordinals = document.ordinals
        self._elements = document.elements
        self._name = document.name
        self._slots: list[Element] = []
        self._features: list[Element] = []
        self._inner: list[Element] = []
        self._outer: list[Element] = []

    def add(self, owner: str, row: int, known: Known, text: str) -> Element:
        """Add the slot of a value, named by its attribute, or with an ID of its own."""
        attrs: dict[str, AttrValue] | None = known.said.get(text)
        if attrs is None:
            attrs = self._said(row, known, text)
        made = None
        if not self._ids[row]:
            id, ordinal = owner + known.suffix, self._ordinals[row]
            made = self._new(id, _SLOT, known.name, owner, ordinal, self._name, attrs)
        if made is None:
            made = self._context.add_at(_SLOT, self._document, row, owner, attrs=attrs)
        self._elements[row] = made.id
        self._slots.append(made)
        self._features.append(known.element)
        return made

    def lead(self, slot: Element, path: tuple[Element, ...]) -> None:
        """Say which features the slot of an inner one lies in, outermost first."""
        self._inner += [slot] * len(path)
        self._outer += path

    def _said(self, row: int, known: Known, text: str) -> dict[str, AttrValue]:
        """The attributes of a slot; those of frequent values are kept for all that have them."""
        try:
            value = text if known.read is None else known.read(text)
        except ValueError:
            value = self._unfit(row, known, text)
            return {"value": value} if text else NOTHING
        said: dict[str, AttrValue] = {"value": value} if text else NOTHING
        if len(known.said) < KEPT:
            said = known.said[text] = Shared(said)
        return said

    def _unfit(self, row: int, known: Known, text: str) -> AttrValue:
        data_type = fitting.data_type_of(known.stated, known.member.type)
        return fitting.unfit(self._context, self._document, row, text, data_type, known.stated)

    def finish(self) -> None:
        """Tie the slots to the attributes that they have the values of."""
        graph = self._context.graph
        graph.connect_each(Edge.INSTANCE_OF, self._slots, self._features)
        graph.connect_each(Edge.PATH, self._inner, self._outer)
        for column in (self._slots, self._features, self._inner, self._outer):
            column.clear()
