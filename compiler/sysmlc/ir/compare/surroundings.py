"""Pairs what has no name, or one that its neighbours have too, by what surrounds it."""

from collections.abc import Iterable, Iterator

from sysmlc.ir.compare.colours import Colours, Group, Palette, Refined
from sysmlc.ir.compare.pairs import Pairs
from sysmlc.ir.element import Element

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
