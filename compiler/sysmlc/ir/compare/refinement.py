"""The colours of elements that are in no pair yet: equal colours, equal surroundings.

Colour refinement (Weisfeiler and Leman): elements that say the same have the same colour; in every
round the colours of their neighbours are mixed in.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import NamedTuple

from sysmlc.ir.compare.facts import facts
from sysmlc.ir.compare.pairs import Pairs, Token, fact_token
from sysmlc.ir.compare.side import Side
from sysmlc.ir.element import Element


class Numbers(dict[Token, int]):
    """A number for each value that was asked for, the same one for equal values."""

    def __missing__(self, value: Token) -> int:
        self[value] = number = len(self)
        return number


class Sayings:
    """The numbers of one side. Equal numbers, equal sayings, on both sides.

    What is said of elements that are in no pair is said of any of that kind and name. A number is
    kept until one of those gets a partner: elements without names are paired level by level, and
    each level has all below it.
    """

    def __init__(self, pairs: Pairs, side: Side, numbers: Numbers) -> None:
        self.side = side
        self._pairs = pairs
        self._is_old = side is pairs.old
        self._to_token = pairs.old_token if self._is_old else pairs.new_token
        self._numbers = numbers
        self._known_pairs = 0
        self._own: dict[str, int] = {}
        self._whole: dict[str, int] = {}
        self._readers: dict[str, list[str]] = {}
        """Who says something of an element."""

    def whole(self, element: Element) -> int:
        """The number of what the element and all below it say; depth does no harm."""
        known = self._whole
        stack, unknown = [element], []
        while stack:
            top = stack.pop()
            if top.id not in known:
                unknown.append(top)
                stack += self.side.children(top)
        for one in reversed(unknown):
            inside = sorted([known[child.id] for child in self.side.children(one)])
            known[one.id] = self._numbers[self._said(one), *inside]
        return known[element.id]

    def _said(self, element: Element) -> int:
        """The number of what the element says itself."""
        known = self._own.get(element.id)
        if known is None:

            def to_token(other: Element) -> Token:
                seen = self.side.visible(other)
                if seen is not None:
                    self._readers.setdefault(seen.id, []).append(element.id)
                return self._blind(other)

            tokens = [fact_token(one, to_token) for one in facts(self.side, element)]
            said = sorted([self._numbers[one] for one in tokens])
            known = self._own[element.id] = self._numbers[element.kind, element.name, tuple(said)]
        return known

    def named(self, element: Element) -> int:
        """The number of an element that is spoken of."""
        return self._numbers[self._blind(element)]

    def _blind(self, element: Element) -> Token:
        """A token that is the same for all of a kind and name while partners are unknown."""
        if element.id in self.side.hidden:
            owner = self.side.visible(element)
            return ("of", owner and self._blind(owner), element.kind, element.name)
        found = self._to_token(element)
        is_known = isinstance(found, tuple) and found[0] in ("new", "outside")
        return found if is_known else ("?", element.kind, element.name)

    def update(self) -> None:
        """Forget what says something of elements that got partners since the last time."""
        new_of = self._pairs.new_of
        for old_id, new in islice(new_of.items(), self._known_pairs, None):
            for reader in self._readers.pop(old_id if self._is_old else new.id, ()):
                self._forget(reader)
        self._known_pairs = len(new_of)

    def _forget(self, reader: str) -> None:
        self._own.pop(reader, None)
        above: str | None = reader
        while above is not None and self._whole.pop(above, None) is not None:
            above = self.side.graph[above].owner


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


_Classes = Iterator[tuple[list[Element], list[Element]]]


def by_surroundings(palette: Palette, pairs: Pairs) -> None:
    """Pair what is the only one on each side, below one owner, that says what it says."""
    groups = list(pairs.leftovers())
    for one, other in Refined(palette, groups).rounds if groups else ():
        for group in groups:
            for olds, news in list(_classes(pairs, group, one, other)):
                if len(olds) == len(news) == 1:
                    pairs.put(olds[0], news[0])


def by_choice(palette: Palette, pairs: Pairs) -> None:
    """Where several say the same, any may be chosen; what surrounds it follows the choice.

    Only the most telling colours are used that find anything: what they leave is looked at anew.
    """
    groups = list(pairs.leftovers())
    refined = Refined(palette, groups)
    for group in groups:
        for one, other in refined.rounds:
            found = list(_classes(pairs, group, one, other))
            walk = _Walk(pairs, refined, one, other)
            for olds, news in found:
                _choose(pairs, olds, news, walk)
            if found:
                break


def _choose(pairs: Pairs, olds: list[Element], news: list[Element], walk: "_Walk") -> None:
    for old in olds:
        new = next((one for one in news if one.id not in pairs.old_of), None)
        if new is not None and old.id not in pairs.new_of:
            walk.pair(old, new)


def _classes(pairs: Pairs, group: Group, one: Colours, other: Colours) -> _Classes:
    """Unpaired elements of one owner that have one colour on both sides."""
    olds = _by_colour((old for old in group[0] if old.id not in pairs.new_of), one)
    news = _by_colour((new for new in group[1] if new.id not in pairs.old_of), other)
    return ((found, news[colour]) for colour, found in olds.items() if colour in news)


def _by_colour(elements: Iterable[Element], colours: Colours) -> dict[int, list[Element]]:
    found: dict[int, list[Element]] = {}
    for one in elements:
        found.setdefault(colours[one.id], []).append(one)
    return found


class _Walk:
    """Pairs two elements, and what leads from and to them as far as the colours agree."""

    def __init__(self, pairs: Pairs, refined: Refined, one: Colours, other: Colours) -> None:
        self._pairs = pairs
        self._refined = refined
        self._one = one
        self._other = other

    def pair(self, old: Element, new: Element) -> None:
        """Pair the two, their neighbours, the neighbours of those ..."""
        self._pairs.put(old, new)
        waiting = [(old, new)]
        while waiting:
            left, right = waiting.pop()
            for pair in self._neighbours(left, right):
                self._pairs.put(*pair)
                waiting.append(pair)

    def _neighbours(self, old: Element, new: Element) -> Iterator[tuple[Element, Element]]:
        free: dict[tuple[object, ...], list[Element]] = {}
        for how, one in reversed(self._refined.new.around(new)):
            if one.id in self._other and one.id not in self._pairs.old_of:
                free.setdefault((how, self._other[one.id]), []).append(one)
        for how, one in self._refined.old.around(old):
            equals = free.get((how, self._one.get(one.id)))
            if equals and one.id not in self._pairs.new_of:
                other = equals.pop()
                if self._are_siblings(one, other):
                    yield one, other

    def _are_siblings(self, old: Element, new: Element) -> bool:
        """Whether both are free, below owners that are a pair."""
        if new.id in self._pairs.old_of:
            return False
        there, here = self._pairs.old.graph.owner(old), self._pairs.new.graph.owner(new)
        if there is None or here is None:
            return there is here
        return self._pairs.new_of.get(there.id) is here
