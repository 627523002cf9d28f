"""The colours of elements that are in no pair yet: equal colours, equal surroundings.

Colour refinement (Weisfeiler and Leman): elements that say the same have the same colour; in every
round the colours of their neighbours are mixed in.
"""

from collections.abc import Sequence

from sysmlc.ir.compare.facts import facts
from sysmlc.ir.compare.pairs import Pairs, Token, fact_token
from sysmlc.ir.compare.side import Side
from sysmlc.ir.element import Element

_ROUNDS = 12

Colours = dict[str, int]
Group = tuple[list[Element], list[Element]]
"""Unpaired elements of one owner, of the old and of the new model."""


class Refinement:
    """The colours of the leftovers of one side.

    What lies below a leftover belongs to it: a flow from its pin is a flow from itself.
    """

    def __init__(
        self, pairs: Pairs, side: Side, elements: list[Element], numbers: dict[Token, int]
    ) -> None:
        self._to_token = pairs.old_token if side is pairs.old else pairs.new_token
        self._side = side
        self._numbers = numbers
        self._elements = elements
        self._part_of = {part.id: one for one in elements for part in side.below(one)}
        self.colours: Colours = {one.id: self._said(one) for one in elements}

    def _said(self, element: Element) -> int:
        """A number for what the element and all below it say; depth does no harm."""
        below = list(self._side.below(element))
        numbers: dict[str, int] = {}
        for one in reversed(below):
            said = (self._number(fact_token(f, self._blind)) for f in facts(self._side, one))
            inside = sorted(numbers[child.id] for child in self._side.children(one))
            whole = (one.kind, one.name, tuple(sorted(said)), tuple(inside))
            numbers[one.id] = self._number(whole)
        return numbers[element.id]

    def _blind(self, element: Element) -> Token:
        """A token that is the same for all of a kind and name while partners are unknown."""
        if element.id in self._side.hidden:
            owner = self._side.visible(element)
            return ("of", owner and self._blind(owner), element.kind, element.name)
        found = self._to_token(element)
        is_known = isinstance(found, tuple) and found[0] in ("new", "outside")
        return found if is_known else ("?", element.kind, element.name)

    def count(self) -> int:
        """How many colours there are."""
        return len(set(self.colours.values()))

    def mix(self) -> None:
        """One more round."""
        self.colours = {
            one.id: self._number((self.colours[one.id], *self._mixed(one)))
            for one in self._elements
        }

    def _mixed(self, element: Element) -> list[tuple[str, int]]:
        return sorted((how, self._colour(one)) for how, one in self.around(element))

    def _colour(self, element: Element) -> int:
        known = self.colours.get(element.id)
        return self._number(self._blind(element)) if known is None else known

    def around(self, element: Element) -> list[tuple[str, Element]]:
        """What leads from the element and to it, and how; leftovers for what lies in them."""
        found = []
        for part in self._side.below(element):
            out = self._side.out.get(part.id, {})
            found += [(f"{part.name} {edge} >", one) for edge, to in out.items() for one in to]
            into = self._side.into.get(part.id, ())
            found += [(f"{part.name} < {edge}", one) for edge, one in into]
        return [(how, self._part_of.get(one.id, one)) for how, one in found]

    def _number(self, value: Token) -> int:
        return self._numbers.setdefault(value, len(self._numbers))


class Refined:
    """The colours of both sides after each round, the last round first."""

    def __init__(self, pairs: Pairs, groups: Sequence[Group]) -> None:
        numbers: dict[Token, int] = {}
        left = [one for olds, _ in groups for one in olds]
        right = [one for _, news in groups for one in news]
        self.old = Refinement(pairs, pairs.old, left, numbers)
        self.new = Refinement(pairs, pairs.new, right, numbers)
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
