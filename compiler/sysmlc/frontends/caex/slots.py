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

# To look a member of an enumeration up takes ten times as long as to look this up.
_SLOT = Kind.SLOT


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
        while waiting:
            made = self._alike(owner)
            if not made:
                made.append(self._context.add_at(_SLOT, self._document, waiting[0][0], owner))
            self._fill(made)
            del waiting[: len(made)]

    def _alike(self, owner: str) -> list[Element]:
        """Slots named by their attributes, up to the first that has an ID, or no free one."""
        ids, ordinals = self._document.ids, self._document.ordinals
        rows = [
            ("" if ids[row] else owner + known.suffix, known.name, ordinals[row])
            for row, known, _, _ in self.waiting
        ]
        return self._context.graph.new_below(owner, _SLOT, self._document.name, rows)

    def _fill(self, slots: list[Element]) -> None:
        """Give the first slots that wait their values."""
        elements, inner = self._document.elements, self._inner
        for slot, (row, known, text, path) in zip(slots, self.waiting, strict=False):
            value: AttrValue = text
            if known.read is not None:
                try:
                    value = known.read(text)
                except ValueError:
                    value = self._unfit(row, known, text)
            if value != "":
                slot.attrs = {"value": value}
            elements[row] = slot.id
            if path:
                inner += [slot] * len(path)
                self._outer += path
        self._slots += slots
        self._features += [known.element for _, known, _, _ in self.waiting[: len(slots)]]

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
