"""Pairs of elements that were renamed, rewired or moved: most of their facts are equal."""

from collections import Counter
from collections.abc import Iterator
from difflib import SequenceMatcher

from sysmlc.ir.compare.content import MOVABLE, is_external
from sysmlc.ir.compare.facts import BETWEEN, FROM_TO
from sysmlc.ir.compare.pairs import Pairs, Token
from sysmlc.ir.compare.side import Side
from sysmlc.ir.element import Element

_THRESHOLD = 0.5
"""Least likeness of two elements of a pair."""
_COMMON = 64
"""A fact about more elements than these does not distinguish them."""
_Portrait = Counter[Token]
"""Facts about an element, its children and its incoming edges, with the number of each."""


def pair_by_likeness(pairs: Pairs) -> None:
    """Pair unpaired siblings of one kind and type, the most similar first."""
    for olds, news in list(pairs.iter_unpaired()):
        old_own = [element for element in olds if not is_external(element)]
        new_own = [element for element in news if not is_external(element)]
        for old, new in _iter_best_pairs(pairs, old_own, new_own):
            pairs.add(old, new)


def pair_by_move(pairs: Pairs) -> None:
    """Pair similar elements with different owners whose kind and name are unique on each side."""
    olds = _by_kind_and_name(_iter_unpaired(pairs.old, pairs.new_of))
    news = _by_kind_and_name(_iter_unpaired(pairs.new, pairs.old_of))
    for key, old in olds.items():
        new = news.get(key)
        if new is None:
            continue
        old_portrait = _portray(pairs, old, is_old=True)
        if _likeness(old_portrait, _portray(pairs, new, is_old=False)) >= _THRESHOLD:
            pairs.add(old, new)


def _iter_unpaired(side: Side, paired: dict[str, Element]) -> Iterator[Element]:
    for members in side.members.values():
        for element in members:
            if element.id not in paired and not is_external(element):
                yield element


def _by_kind_and_name(elements: Iterator[Element]) -> dict[tuple[str, str], Element]:
    index: dict[tuple[str, str], Element | None] = {}
    for element in elements:
        if element.kind in MOVABLE and element.name:
            key = (str(element.kind), element.name)
            index[key] = None if key in index else element
    return {key: element for key, element in index.items() if element is not None}


# -- likeness ----------------------------------------------------------------------------------


def _iter_best_pairs(
    pairs: Pairs, olds: list[Element], news: list[Element]
) -> Iterator[tuple[Element, Element]]:
    old_portraits = [_portray(pairs, element, is_old=True) for element in olds]
    new_portraits = [_portray(pairs, element, is_old=False) for element in news]
    ranking = []
    for i, j in _iter_candidates(old_portraits, new_portraits):
        score = _score(olds[i], news[j], old_portraits[i], new_portraits[j])
        if score >= _THRESHOLD:
            ranking.append((-score, -_name_likeness(olds[i], news[j]), i, j))
    used_olds: set[int] = set()
    used_news: set[int] = set()
    for *_, i, j in sorted(ranking):
        if i not in used_olds and j not in used_news:
            used_olds.add(i)
            used_news.add(j)
            yield olds[i], news[j]


def _iter_candidates(
    old_portraits: list[_Portrait], new_portraits: list[_Portrait]
) -> Iterator[tuple[int, int]]:
    """Iterate over positions of elements that share a fact; over all pairs if there are few."""
    if len(old_portraits) * len(new_portraits) <= _COMMON * _COMMON:
        for i in range(len(old_portraits)):
            yield from ((i, j) for j in range(len(new_portraits)))
        return
    positions: dict[Token, list[int]] = {}
    for j, portrait in enumerate(new_portraits):
        for token in portrait:
            positions.setdefault(token, []).append(j)
    for i, portrait in enumerate(old_portraits):
        sharing = [positions.get(token, []) for token in portrait]
        yield from ((i, j) for j in sorted({j for js in sharing if len(js) <= _COMMON for j in js}))


def _score(old: Element, new: Element, old_portrait: _Portrait, new_portrait: _Portrait) -> float:
    if old.kind is not new.kind or bool(old.name) != bool(new.name):
        return 0.0
    if old.name and _types(old_portrait) != _types(new_portrait):
        return 0.0
    if old.name and not old_portrait and not new_portrait:
        return _name_likeness(old, new)
    return _likeness(old_portrait, new_portrait)


def _types(portrait: _Portrait) -> set[Token]:
    """Return the facts about types; general classifiers may change together with the name."""
    return {fact for fact in portrait if isinstance(fact, tuple) and fact[0] == ("typed-by",)}


def _likeness(left: _Portrait, right: _Portrait) -> float:
    """Return the Dice coefficient of two portraits; 0 for two empty ones."""
    common = sum((left & right).values())
    return 2 * common / ((left.total() + right.total()) or 1)


def _name_likeness(old: Element, new: Element) -> float:
    return SequenceMatcher(None, old.name, new.name, autojunk=False).ratio()


def _portray(pairs: Pairs, element: Element, *, is_old: bool) -> _Portrait:
    side = pairs.old if is_old else pairs.new
    to_token = pairs.old_token if is_old else pairs.new_token
    facts = pairs.old_facts(element) if is_old else pairs.new_facts(element)
    portrait: _Portrait = Counter(part for tokens, _ in facts for part in _split_ends(tokens))
    portrait.update(("owns", child.kind, child.name) for child in side.children(element))
    incoming = side.incoming.get(element.id, ())
    portrait.update((str(edge), to_token(source)) for edge, source in incoming)
    return portrait


def _split_ends(fact: tuple[Token, Token]) -> Iterator[Token]:
    """Iterate over the ends of a relation, because one may have changed; else over the fact."""
    key, value = fact
    if key in (FROM_TO, BETWEEN) and isinstance(value, tuple):
        for position, end in enumerate(value):
            yield (key, position if key == FROM_TO else 0, end)
    else:
        yield fact
