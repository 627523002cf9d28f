"""Slots: the values that internal elements give to what their class has."""

from sysmlc.frontends.caex import fitting
from sysmlc.frontends.caex.context import Context
from sysmlc.frontends.caex.document import Document
from sysmlc.frontends.caex.holders import instance
from sysmlc.frontends.caex.plans import Known
from sysmlc.frontends.caex.site import Site
from sysmlc.ir import AttrValue, Edge, Element, Kind

_Given = tuple[int, Known, str, tuple[Element, ...]]
"""A row, the attribute that it repeats, its value, and the features that this one lies in."""


class Slots:
    """Makes the slots of one file, those of an internal element in one go."""

    def __init__(self, context: Context, document: Document) -> None:
        self._context = context
        self._document = document
        self.waiting: list[_Given] = []
        """Values of the internal element that is read now."""
        self._slots: list[Element] = []
        self._features: list[Element] = []
        self._inner: list[Element] = []
        self._outer: list[Element] = []

    def place(self, site: Site) -> None:
        """Add the slots of the values that wait."""
        waiting = self.waiting
        if not waiting:
            return
        owner = site.instance or instance(self._context, site)
        start = 0
        while start < len(waiting):
            made = self._alike(owner, waiting[start:])
            if not made:
                made = [self._context.add_at(Kind.SLOT, self._document, waiting[start][0], owner)]
            for slot, given in zip(made, waiting[start:], strict=False):
                self._fill(slot, given)
            start += len(made)
        waiting.clear()

    def _alike(self, owner: str, waiting: list[_Given]) -> list[Element]:
        """Slots named by their attributes, up to the first that has an ID, or no free one."""
        ids, ordinals = self._document.ids, self._document.ordinals
        rows = [
            ("" if ids[row] else f"{owner}/{known.name or 'Attribute'}", known.name, ordinals[row])
            for row, known, _, _ in waiting
        ]
        return self._context.graph.new_below(owner, Kind.SLOT, self._document.name, rows)

    def _fill(self, slot: Element, given: _Given) -> None:
        row, known, text, path = given
        try:
            value: AttrValue = text if known.read is None else known.read(text)
        except ValueError:
            value = self._unfit(row, known, text)
        if value != "":
            slot.attrs = {"value": value}
        self._document.elements[row] = slot.id
        self._slots.append(slot)
        self._features.append(known.element)
        if path:
            self._inner += [slot] * len(path)
            self._outer += path

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
