"""The colours of elements that are in no pair yet: equal colours, equal surroundings.

Colour refinement (Weisfeiler and Leman): elements that say the same have the same colour; in every
round the colours of their neighbours are mixed in.
"""

from collections.abc import Sequence
from typing import NamedTuple

from sysmlc.ir.compare.pairs import Pairs
from sysmlc.ir.compare.sayings import Numbers, Sayings
from sysmlc.ir.element import Element

_ROUNDS = 12

Colours = dict[str, int]
Group = tuple[list[Element], list[Element]]
"""Unpaired elements of one owner, of the old and of the new model."""


class _Surroundings(NamedTuple):
    """What leads from an element and to it, and how."""

    leftovers: list[tuple[str, Element]]
    rest: int
    """The colour of all that is no leftover: it stays in all rounds."""


class Refinement:
    """The colours of the leftovers of one side.

    What lies below a leftover belongs to it: a flow from its pin is a flow from itself. ``mixed``
    gives new colours; what is said gives the first ones, which are not negative.
    """

    def __init__(self, sayings: Sayings, elements: list[Element], mixed: Numbers) -> None:
        self._sayings = sayings
        self._side = sayings.side
        self._mixed = mixed
        self._elements = elements
        self._part_of = {part.id: one for one in elements for part in self._side.below(one)}
        self._surroundings: dict[str, _Surroundings] = {}
        sayings.update()
        self.colours: Colours = {one.id: sayings.whole(one) for one in elements}

    def count(self) -> int:
        """How many colours there are."""
        return len(set(self.colours.values()))

    def mix(self) -> None:
        """One more round."""
        now, made = self.colours, self._mixed
        self.colours = {}
        for one in self._elements:
            around = self._around(one)
            near = sorted([(how, now[other.id]) for how, other in around.leftovers])
            self.colours[one.id] = -1 - made[now[one.id], around.rest, *near]

    def around(self, element: Element) -> list[tuple[str, Element]]:
        """What leads from the element and to it, and how; leftovers for what lies in them."""
        return self._around(element).leftovers

    def _around(self, element: Element) -> _Surroundings:
        known = self._surroundings.get(element.id)
        if known is None:
            known = self._surroundings[element.id] = self._look_around(element)
        return known

    def _look_around(self, element: Element) -> _Surroundings:
        part_of, named = self._part_of, self._sayings.named
        near, far = [], []
        for how, one in self._ties(element):
            leftover = part_of.get(one.id)
            if leftover is None:
                far.append((how, named(one)))
            else:
                near.append((how, leftover))
        return _Surroundings(near, self._mixed[tuple(sorted(far))])

    def _ties(self, element: Element) -> list[tuple[str, Element]]:
        found: list[tuple[str, Element]] = []
        for part in self._side.below(element):
            ties = self._side.ties.get(part.id, ())
            found += [(f"{part.name} {how}", one) for how, one in ties]
        return found


class Palette:
    """What gives the first colours, for as long as pairs are looked for."""

    def __init__(self, pairs: Pairs) -> None:
        numbers = Numbers()
        self.old = Sayings(pairs, pairs.old, numbers)
        self.new = Sayings(pairs, pairs.new, numbers)


class Refined:
    """The colours of both sides after each round, the last round first."""

    def __init__(self, palette: Palette, groups: Sequence[Group]) -> None:
        mixed = Numbers()
        left = [one for olds, _ in groups for one in olds]
        right = [one for _, news in groups for one in news]
        self.old = Refinement(palette.old, left, mixed)
        self.new = Refinement(palette.new, right, mixed)
        self.rounds = [(self.old.colours, self.new.colours)]
        self._refine()
        self.rounds.reverse()

    def _refine(self) -> None:
        known = 0
        while known < self.old.count() and len(self.rounds) <= _ROUNDS:
            known = self.old.count()
            self.old.mix()
            self.new.mix()
            self.rounds.append((self.old.colours, self.new.colours))
