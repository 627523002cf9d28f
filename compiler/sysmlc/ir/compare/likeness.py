"""Pairs what was renamed, rewired or moved: most of what is said is still the same."""

from collections import Counter
from collections.abc import Iterator
from difflib import SequenceMatcher

from sysmlc.ir.compare.content import MOVABLE, is_external
from sysmlc.ir.compare.facts import BETWEEN, FROM_TO
from sysmlc.ir.compare.pairs import Pairs, Token
from sysmlc.ir.compare.side import Side
from sysmlc.ir.element import Element

_MOST = 0.5
"""Share of what two elements say that must be equal."""
_COMMON = 64
"""What more elements than these say tells none of them from the others."""


def by_likeness(pairs: Pairs) -> None:
    """Pair leftovers below one owner that are of one kind and type and agree in most."""
    for olds, news in list(pairs.leftovers()):
        own = [[one for one in found if not is_external(one)] for found in (olds, news)]
        for old, new in _best(pairs, *own):
            pairs.put(old, new)


def by_move(pairs: Pairs) -> None:
    """Pair what has a new owner: one of its kind and name on each side, alike in most."""
    olds = _movable(_tops(pairs.old, pairs.new_of))
    news = _movable(_tops(pairs.new, pairs.old_of))
    for key, old in olds.items():
        new = news.get(key)
        if new is not None and _likeness(*_portraits(pairs, old, new)) >= _MOST:
            pairs.put(old, new)


def _tops(side: Side, paired: dict[str, Element]) -> Iterator[Element]:
    """What is in no pair, of the model itself."""
    alone = (one for found in side.things.values() for one in found if one.id not in paired)
    return (one for one in alone if not is_external(one))


def _movable(elements: Iterator[Element]) -> dict[tuple[str, str], Element]:
    found: dict[tuple[str, str], Element | None] = {}
    for one in elements:
        if one.kind in MOVABLE and one.name:
            key = (str(one.kind), one.name)
            found[key] = None if key in found else one
    return {key: one for key, one in found.items() if one is not None}


# -- likeness ----------------------------------------------------------------------------------

_Portrait = Counter[Token]


def _best(
    pairs: Pairs, olds: list[Element], news: list[Element]
) -> Iterator[tuple[Element, Element]]:
    """The likest pairs of one kind, the likest first; each element once."""
    left = {one.id: _portrait(pairs, one, is_old=True) for one in olds}
    right = {one.id: _portrait(pairs, one, is_old=False) for one in news}
    scored = []
    for i, j in _candidates(olds, news, left, right):
        score = _score(olds[i], news[j], left[olds[i].id], right[news[j].id])
        if score >= _MOST:
            scored.append((-score, -_names_alike(olds[i], news[j]), i, j))
    taken_left: set[int] = set()
    taken_right: set[int] = set()
    for *_, i, j in sorted(scored):
        if i not in taken_left and j not in taken_right:
            taken_left.add(i)
            taken_right.add(j)
            yield olds[i], news[j]


def _candidates(
    olds: list[Element],
    news: list[Element],
    left: dict[str, _Portrait],
    right: dict[str, _Portrait],
) -> Iterator[tuple[int, int]]:
    """Pairs of places that share something; everything with everything when there are few."""
    if len(olds) * len(news) <= _COMMON * _COMMON:
        yield from ((i, j) for i in range(len(olds)) for j in range(len(news)))
        return
    saying: dict[Token, list[int]] = {}
    for j, new in enumerate(news):
        for said in right[new.id]:
            saying.setdefault(said, []).append(j)
    for i, old in enumerate(olds):
        found = (saying.get(said, ()) for said in left[old.id])
        yield from ((i, j) for j in sorted({j for f in found if len(f) <= _COMMON for j in f}))


def _score(old: Element, new: Element, left: _Portrait, right: _Portrait) -> float:
    if old.kind is not new.kind or (old.name and new.name and _types(left) != _types(right)):
        return 0.0
    if old.name and new.name and not left and not right:
        return _names_alike(old, new)
    return _likeness(left, right) if bool(old.name) == bool(new.name) else 0.0


def _types(portrait: _Portrait) -> set[Token]:
    """The types among what an element says; general classifiers may change with the name."""
    return {said for said in portrait if isinstance(said, tuple) and said[0] == ("typed-by",)}


def _likeness(left: _Portrait, right: _Portrait) -> float:
    """Twice what both say by what each says (Dice); nothing and nothing is alike in nothing."""
    both = sum((left & right).values())
    return 2 * both / ((left.total() + right.total()) or 1)


def _names_alike(old: Element, new: Element) -> float:
    return SequenceMatcher(None, old.name, new.name, autojunk=False).ratio()


def _portraits(pairs: Pairs, old: Element, new: Element) -> tuple[_Portrait, _Portrait]:
    return _portrait(pairs, old, is_old=True), _portrait(pairs, new, is_old=False)


def _portrait(pairs: Pairs, element: Element, *, is_old: bool) -> _Portrait:
    """What an element says, what it owns, and what leads to it."""
    side = pairs.old if is_old else pairs.new
    to_token = pairs.old_token if is_old else pairs.new_token
    said = pairs.old_facts(element) if is_old else pairs.new_facts(element)
    found: _Portrait = Counter(part for both, _ in said for part in _parts(both))
    found.update(("owns", one.kind, one.name) for one in side.children(element))
    found.update((str(edge), to_token(one)) for edge, one in side.into.get(element.id, ()))
    return found


def _parts(said: tuple[Token, Token]) -> Iterator[Token]:
    """What is said, and of a relation each end for itself: one of them may be another now."""
    key, value = said
    if key in (FROM_TO, BETWEEN) and isinstance(value, tuple):
        yield from ((key, place if key == FROM_TO else 0, end) for place, end in enumerate(value))
    else:
        yield said
