"""Pairs of elements of two models that are the same element: by id, by name and by likeness.

Elements that were renamed, rewired or moved are paired if most of their facts are equal.
"""

from collections import Counter
from collections.abc import Callable, Iterator
from difflib import SequenceMatcher

from sysmlc.ir.compare.content import MOVABLE, is_external, name_in_comparison
from sysmlc.ir.compare.facts import BETWEEN, FROM_TO, Fact, iter_facts
from sysmlc.ir.compare.side import Side, alternate_id
from sysmlc.ir.element import Element
from sysmlc.ir.kinds import Kind
from sysmlc.ir.query import CLASSIFIERS

Token = object
"""A hashable value that is equal for equal values of both models; paired elements are equal."""


class Pairs:
    """The pairs, and the unpaired children of paired owners."""

    def __init__(self, old: Side, new: Side) -> None:
        self.old = old
        self.new = new
        self.new_of: dict[str, Element] = {}
        self.old_of: dict[str, Element] = {}
        self.owners: list[tuple[Element | None, Element | None]] = [(None, None)]
        """Paired owners that may have unpaired children; (None, None) are the models."""

    def add(self, old: Element, new: Element) -> None:
        """Pair two unpaired elements."""
        self.new_of[old.id] = new
        self.old_of[new.id] = old
        self.owners.append((old, new))

    def unpaired_old(self, owner: Element | None) -> list[Element]:
        """Return the unpaired children of an owner of the old model."""
        return [child for child in self.old.children(owner) if child.id not in self.new_of]

    def unpaired_new(self, owner: Element | None) -> list[Element]:
        """Return the unpaired children of an owner of the new model."""
        return [child for child in self.new.children(owner) if child.id not in self.old_of]

    def iter_unpaired(self) -> Iterator[tuple[list[Element], list[Element]]]:
        """Iterate over the unpaired children of each pair of owners, if both sides have some."""
        remaining = []
        for old_owner, new_owner in self.owners:
            olds, news = self.unpaired_old(old_owner), self.unpaired_new(new_owner)
            if olds and news:
                remaining.append((old_owner, new_owner))
                yield olds, news
        self.owners = remaining

    # -- tokens --------------------------------------------------------------------------------

    def old_token(self, element: Element) -> Token:
        """Return the token of an element of the old model; it equals the token of its partner."""
        partner = self.new_of.get(element.id)
        if partner is not None:
            return ("new", partner.id)
        return self._unpaired_token(self.old, element)

    def new_token(self, element: Element) -> Token:
        """Return the token of an element of the new model; it equals the token of its partner."""
        if element.id in self.old_of:
            return ("new", element.id)
        return self._unpaired_token(self.new, element)

    def _unpaired_token(self, side: Side, element: Element) -> Token:
        if is_external(element):
            return ("outside", str(element.attrs.get("qualified_name") or element.name))
        if element.id in side.hidden:
            owner = side.find_visible(element)
            to_token = self.old_token if side is self.old else self.new_token
            return ("of", None if owner is None else to_token(owner), element.kind, element.name)
        return ("old only" if side is self.old else "new only", element.id)

    def old_facts(self, element: Element) -> "list[TokenisedFact]":
        """Return the facts about an element of the old model, with the tokens of key and value."""
        return tokenise(iter_facts(self.old, element), self.old_token)

    def new_facts(self, element: Element) -> "list[TokenisedFact]":
        """Return the facts about an element of the new model, with the tokens of key and value."""
        return tokenise(iter_facts(self.new, element), self.new_token)


TokenisedFact = tuple[tuple[Token, Token], Fact]
"""Tokens of key and value, and the fact."""


def tokenise(facts: Iterator[Fact], to_token: Callable[[Element], Token]) -> list[TokenisedFact]:
    """Return facts with the tokens of their keys and values."""
    return [(fact_token(fact, to_token), fact) for fact in facts]


def fact_token(fact: Fact, to_token: Callable[[Element], Token]) -> tuple[Token, Token]:
    """Return the tokens of the key and the value of a fact.

    The ends of a connector are sorted, because they have no order.
    """
    value = _value_token(fact.value, to_token)
    if fact.key == BETWEEN and isinstance(value, tuple):
        value = tuple(sorted(value, key=repr))
    return _value_token(fact.key, to_token), value


def _value_token(value: object, to_token: Callable[[Element], Token]) -> Token:
    if isinstance(value, Element):
        return to_token(value)
    if isinstance(value, tuple):
        return tuple([_value_token(item, to_token) for item in value])
    # True equals 1 in Python, but not in a model.
    return ("truth", value) if isinstance(value, bool) else value


# -- by id -------------------------------------------------------------------------------------

_FEW = 2
_SHARE = 10


def pair_by_id(pairs: Pairs) -> None:
    """Pair elements with the same id, unless the tool has assigned the ids anew."""
    common = [
        (old, pairs.new.graph[old.id])
        for old in pairs.old.graph
        if old.id in pairs.new.graph
        if old.id not in pairs.old.hidden and old.id not in pairs.new.hidden
    ]
    if not _are_ids_stable(pairs, common):
        return
    for old, new in common:
        if _are_kinds_compatible(old, new) and (old.name == new.name or not is_external(old)):
            pairs.add(old, new)
    _pair_by_alternate_id(pairs)


def _are_kinds_compatible(old: Element, new: Element) -> bool:
    """Whether an element can have changed its kind: a class may become a component."""
    return old.kind is new.kind or (old.kind in CLASSIFIERS and new.kind in CLASSIFIERS)


def _pair_by_alternate_id(pairs: Pairs) -> None:
    for old in pairs.old.graph.of_kind(Kind.INSTANCE):
        new = pairs.new.graph.get(alternate_id(old))
        if new is None or new.kind is not Kind.INSTANCE:
            continue
        if old.id not in pairs.new_of and new.id not in pairs.old_of:
            pairs.add(old, new)


def _are_ids_stable(pairs: Pairs, common: list[tuple[Element, Element]]) -> bool:
    """Whether equal ids denote the same elements.

    If a tool numbers the elements anew in each export, ids are shifted: the kind and name of an id
    in one model belong to another id in the other model.
    """
    unequal = [(old, new) for old, new in common if _kind_and_name(old) != _kind_and_name(new)]
    if len(unequal) <= _FEW:
        return True
    before = {_kind_and_name(element) for element in pairs.old.graph}
    after = {_kind_and_name(element) for element in pairs.new.graph}
    shifted = sum(
        _kind_and_name(old) in after and _kind_and_name(new) in before for old, new in unequal
    )
    return shifted <= max(_FEW, len(common) // _SHARE)


def _kind_and_name(element: Element) -> tuple[str, str]:
    return (element.kind, element.name)


# -- by name -----------------------------------------------------------------------------------


def pair_by_name(pairs: Pairs) -> None:
    """Pair elements with the same name and kind below paired owners, from the roots down.

    A second run ignores the kind. Names that several children have are left to other steps.
    """
    for with_kind in (True, False):
        pending = pairs.owners
        while pending:
            number = len(pairs.owners)
            for old_owner, new_owner in pending:
                _pair_children(pairs, old_owner, new_owner, with_kind=with_kind)
            pending = pairs.owners[number:]


def _pair_children(
    pairs: Pairs, old_owner: Element | None, new_owner: Element | None, *, with_kind: bool
) -> None:
    olds = _by_unique_name(pairs.unpaired_old(old_owner), with_kind=with_kind)
    news = _by_unique_name(pairs.unpaired_new(new_owner), with_kind=with_kind) if olds else {}
    for key, old in olds.items():
        if key in news:
            pairs.add(old, news[key])


def _by_unique_name(elements: list[Element], *, with_kind: bool) -> dict[tuple[str, str], Element]:
    index: dict[tuple[str, str], Element] = {}
    ambiguous: set[tuple[str, str]] = set()
    for element in elements:
        name = name_in_comparison(element) or str(element.attrs.get("req_id", ""))
        key = (element.kind if with_kind else "", name)
        if name and key in index:
            ambiguous.add(key)
        elif name:
            index[key] = element
    return {key: element for key, element in index.items() if key not in ambiguous}


# -- likeness ----------------------------------------------------------------------------------

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
    """Iterate over positions of old and new elements that share a fact that is not too common.

    If there are few elements, iterate over all pairs.
    """
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
    has_name = bool(name_in_comparison(old))
    if old.kind is not new.kind or has_name != bool(name_in_comparison(new)):
        return 0.0
    has_same_name = name_in_comparison(old) == name_in_comparison(new)
    if has_name and not has_same_name and _types(old_portrait) != _types(new_portrait):
        return 0.0
    if has_name and not old_portrait and not new_portrait:
        return _name_likeness(old, new)
    if bool(old.role) != bool(new.role):
        return _likeness(_omit_role(old_portrait), _omit_role(new_portrait))
    return _likeness(old_portrait, new_portrait)


def _omit_role(portrait: _Portrait) -> _Portrait:
    """Return a portrait without the role, which only one of two file formats may state."""
    return Counter({token: n for token, n in portrait.items() if not _is_about(token, "role")})


def _is_about(token: Token, key: str) -> bool:
    return isinstance(token, tuple) and token[0] == (key,)


def _types(portrait: _Portrait) -> set[Token]:
    """Return the tokens of the facts about the type.

    Facts about general classifiers are not included, because they may change with the name.
    """
    return {token for token in portrait if _is_about(token, "typed-by")}


def _likeness(left: _Portrait, right: _Portrait) -> float:
    """Return the Dice coefficient of two multisets of tokens; 0 if both are empty."""
    common = sum((left & right).values())
    return 2 * common / ((left.total() + right.total()) or 1)


def _name_likeness(old: Element, new: Element) -> float:
    names = name_in_comparison(old), name_in_comparison(new)
    return SequenceMatcher(None, *names, autojunk=False).ratio()


def _portray(pairs: Pairs, element: Element, *, is_old: bool) -> _Portrait:
    side = pairs.old if is_old else pairs.new
    to_token = pairs.old_token if is_old else pairs.new_token
    facts = pairs.old_facts(element) if is_old else pairs.new_facts(element)
    portrait: _Portrait = Counter(part for tokens, _ in facts for part in _split_ends(tokens))
    portrait.update(
        ("owns", child.kind, name_in_comparison(child)) for child in side.children(element)
    )
    incoming = side.incoming.get(element.id, ())
    portrait.update((str(edge), to_token(source)) for edge, source in incoming)
    return portrait


def _split_ends(fact: tuple[Token, Token]) -> Iterator[Token]:
    """Iterate over the ends of a relation, because a single end may have changed.

    For any other fact, yield the fact itself.
    """
    key, value = fact
    if key in (FROM_TO, BETWEEN) and isinstance(value, tuple):
        for position, end in enumerate(value):
            yield (key, position if key == FROM_TO else 0, end)
    else:
        yield fact
