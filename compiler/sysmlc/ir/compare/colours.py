"""Pairs what has no name, or one that its neighbours have too, by what surrounds it.

Colour refinement (Weisfeiler and Leman): elements that say the same have the same colour; in every
round the colours of their neighbours are mixed in. Pairs are made of the last round first.
"""

from collections.abc import Callable, Iterable, Sequence

from sysmlc.ir.compare.facts import facts
from sysmlc.ir.compare.pairs import Pairs, Token, fact_token
from sysmlc.ir.compare.side import Side
from sysmlc.ir.element import Element

_ROUNDS = 4

_Colours = dict[str, int]
_Group = tuple[list[Element], list[Element]]


def by_surroundings(pairs: Pairs) -> None:
    """Pair what is the only one on each side, below one owner, that says what it says."""
    groups = list(pairs.leftovers())
    for old, new in _refined(pairs, groups):
        for group in groups:
            _pair(pairs, group, old, new, _single)


def by_choice(pairs: Pairs) -> None:
    """Where several say the same, any may be chosen: of each owner only some, in order.

    What the others are paired with depends on that choice.
    """
    groups = list(pairs.leftovers())
    rounds = _refined(pairs, groups)
    for group in groups:
        any(_pair(pairs, group, old, new, _first) for old, new in rounds)


def _refined(pairs: Pairs, groups: Sequence[_Group]) -> list[tuple[_Colours, _Colours]]:
    """The colours of both sides after each round, the last one first."""
    numbers: dict[Token, int] = {}
    old = _Refinement(pairs, pairs.old, [one for left, _ in groups for one in left], numbers)
    new = _Refinement(pairs, pairs.new, [one for _, right in groups for one in right], numbers)
    rounds = [(old.colours, new.colours)]
    for _ in range(_ROUNDS if groups else 0):
        old.mix()
        new.mix()
        rounds.append((old.colours, new.colours))
    return rounds[::-1]


_Classes = list[tuple[list[Element], list[Element]]]


def _single(classes: _Classes) -> _Classes:
    return [(olds, news) for olds, news in classes if len(olds) == len(news) == 1]


def _first(classes: _Classes) -> _Classes:
    return classes[:1]


def _pair(
    pairs: Pairs,
    group: _Group,
    old: _Colours,
    new: _Colours,
    choose: Callable[[_Classes], _Classes],
) -> int:
    """Pair the chosen classes of one colour; how many pairs that makes."""
    olds = _classes((one for one in group[0] if one.id not in pairs.new_of), old)
    news = _classes((one for one in group[1] if one.id not in pairs.old_of), new)
    both = [(found, news[colour]) for colour, found in olds.items() if colour in news]
    made = [two for left, right in choose(both) for two in zip(left, right, strict=False)]
    for one, other in made:
        pairs.put(one, other)
    return len(made)


def _classes(elements: Iterable[Element], colours: _Colours) -> dict[int, list[Element]]:
    found: dict[int, list[Element]] = {}
    for one in elements:
        found.setdefault(colours[one.id], []).append(one)
    return found


class _Refinement:
    """The colours of the leftovers of one side."""

    def __init__(
        self, pairs: Pairs, side: Side, elements: list[Element], numbers: dict[Token, int]
    ) -> None:
        self._to_token = pairs.old_token if side is pairs.old else pairs.new_token
        self._side = side
        self._inside = {one.id for one in elements}
        self._elements = elements
        self._numbers = numbers
        self.colours = {one.id: self._number(self._said(one)) for one in elements}

    def _said(self, element: Element) -> Token:
        said = [repr(fact_token(fact, self._blind)) for fact in facts(self._side, element)]
        inside = sorted(f"{one.kind} {one.name}" for one in self._side.children(element))
        return (element.kind, element.name, tuple(sorted(said)), tuple(inside))

    def _blind(self, element: Element) -> Token:
        """A token that is the same for all of a kind and name while partners are unknown."""
        found = self._to_token(element)
        is_known = isinstance(found, tuple) and found[0] in ("new", "outside", "of")
        return found if is_known else ("?", element.kind, element.name)

    def mix(self) -> None:
        """One more round."""
        self.colours = {
            one.id: self._number((self.colours[one.id], *self._around(one)))
            for one in self._elements
        }

    def _around(self, element: Element) -> tuple[Token, ...]:
        edges = self._side.out.get(element.id, {})
        out = sorted((str(e), self._colour(one)) for e, found in edges.items() for one in found)
        into = self._side.into.get(element.id, ())
        return (tuple(out), tuple(sorted((str(e), self._colour(one)) for e, one in into)))

    def _colour(self, element: Element) -> int:
        if element.id in self._inside:
            return self.colours[element.id]
        return self._number(self._blind(element))

    def _number(self, value: Token) -> int:
        return self._numbers.setdefault(value, len(self._numbers))
