"""The differences of two models: pairs first, then what the two of each pair say."""

from collections import Counter
from collections.abc import Callable, Collection, Iterator
from functools import partial

from sysmlc.ir.compare.change import Change, Ref, What
from sysmlc.ir.compare.content import IMPLIED, IN_ORDER, is_external
from sysmlc.ir.compare.facts import BETWEEN, Fact
from sysmlc.ir.compare.likeness import by_likeness, by_move
from sysmlc.ir.compare.pairs import Pairs, Token, by_id, by_name
from sysmlc.ir.compare.plants import (
    holders,
    is_own_class,
    is_part_instance,
    is_told_of_another,
    own_classes,
    represented,
)
from sysmlc.ir.compare.refinement import Palette, by_choice, by_surroundings
from sysmlc.ir.compare.side import Side
from sysmlc.ir.compare.titles import ends_in_full, exactly, title, whole, word
from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind

_Said = list[tuple[tuple[Token, Token], Fact]]


def compare(old: Graph, new: Graph, ignore: Collection[str] = ()) -> list[Change]:
    """All differences, sorted by owner and name.

    The graphs are as written, with references resolved and no pass behind that. ``ignore`` may
    hold ``id`` (equal ids do not make a pair) and names of attributes.
    """
    pairs = paired(Side(old), Side(new), has_ids="id" not in ignore)
    changes = [
        *only(pairs, pairs.old, What.REMOVED),
        *only(pairs, pairs.new, What.ADDED),
        *(change for pair in _pairs(pairs) for change in _between(pairs, *pair, ignore)),
    ]
    return sorted(changes, key=_by_owner)


def paired(old: Side, new: Side, *, has_ids: bool = True) -> Pairs:
    """Who is who: by id, by name, then by the surest step that still finds something."""
    pairs = Pairs(old, new)
    if has_ids:
        by_id(pairs)
    by_name(pairs)
    palette = Palette(pairs)
    around = (partial(by_surroundings, palette), partial(by_choice, palette))
    for _ in range(_MOST):
        if not any(_finds(pairs, step) for step in (*around, by_likeness, by_move)):
            break
        by_name(pairs)
    return pairs


_MOST = 100
"""Rounds after which the rest is different: one more for each level of elements without names."""


def _finds(pairs: Pairs, step: Callable[[Pairs], None]) -> bool:
    known = len(pairs.new_of)
    step(pairs)
    return len(pairs.new_of) > known


def _by_owner(change: Change) -> tuple[str, ...]:
    return (change.owner, change.name, change.kind, change.what, change.aspect, change.before)


def _pairs(pairs: Pairs) -> Iterator[tuple[Element, Element]]:
    for id, new in pairs.new_of.items():
        old = pairs.old.graph[id]
        if not (is_external(old) or is_external(new)):
            yield old, new


# -- what the two of a pair say ----------------------------------------------------------------


def _between(pairs: Pairs, old: Element, new: Element, ignore: Collection[str]) -> Iterator[Change]:
    if old.name != new.name and not _is_renamed_with(pairs, old, new):
        yield _change(pairs, old, new, What.RENAMED, "name", old.name, new.name)
    if old.kind is not new.kind:
        yield _change(pairs, old, new, What.RETYPED, "kind", str(old.kind), str(new.kind))
    if _is_moved(pairs, old, new):
        there, here = owner_of(pairs.old, old), owner_of(pairs.new, new)
        yield _change(pairs, old, new, What.MOVED, "owner", there, here)
    yield from _reordered(pairs, old, new)
    differing = _without_consequences(pairs, old, new, _differing(pairs, old, new))
    said = [one for one in differing if not one[0] & set(ignore) and not _is_unsaid(one)]
    telling = [found for found in said if not found[0] & IMPLIED]
    for _, what, label, before, after in telling or said:
        if what is What.RETYPED and _is_part_retyped(pairs, new):
            continue
        yield _change(pairs, old, new, what, label, before, after)


def _without_consequences(
    pairs: Pairs, old: Element, new: Element, found: "list[_Differing]"
) -> "list[_Differing]":
    """The differences without those that another unit brings along."""
    if not any(names == UNIT for names, *_ in found):
        return found
    is_same = is_same_but_for_unit(pairs, old, new)
    return [
        one
        for one in found
        if not (one[0] & MEASURES or (is_same and one[0] == {Edge.TYPED_BY.value}))
    ]


def _is_unsaid(found: "_Differing") -> bool:
    """Whether it is a role that only one of the two formats says: the other implies it."""
    names, _, _, before, after = found
    return names == {"role"} and not (before and after)


def _is_renamed_with(pairs: Pairs, old: Element, new: Element) -> bool:
    """Whether the name is that of an InternalElement, which is told of its part or instance."""
    if is_own_class(old) and is_own_class(new):
        return any(_is_renamed(pairs, one) for one in holders(pairs.new, new))
    part = _part_of(pairs, new)
    return part is not None and _is_renamed(pairs, part)


def _is_renamed(pairs: Pairs, new: Element) -> bool:
    old = pairs.old_of.get(new.id)
    return old is not None and old.name != new.name


def _is_part_retyped(pairs: Pairs, new: Element) -> bool:
    """Whether the same is told of the part whose values it holds."""
    part = _part_of(pairs, new)
    if part is None:
        return False
    said = _differing(pairs, pairs.old_of[part.id], part)
    return any(what is What.RETYPED for _, what, *_ in said)


def _part_of(pairs: Pairs, new: Element) -> Element | None:
    """The part, in both models, whose values an element holds."""
    part = represented(pairs.new, new) if is_part_instance(new) else None
    return part if part is not None and part.id in pairs.old_of else None


def _is_moved(pairs: Pairs, old: Element, new: Element) -> bool:
    there, here = pairs.old.graph.owner(old), pairs.new.graph.owner(new)
    if there is None or here is None:
        return there is not here
    return pairs.old_token(there) != pairs.new_token(here)


def _reordered(pairs: Pairs, old: Element, new: Element) -> Iterator[Change]:
    kinds = IN_ORDER.get(new.kind)
    if kinds is None:
        return
    left = [one for one in pairs.old.children(old) if one.kind in kinds]
    right = [one for one in pairs.new.children(new) if one.kind in kinds]
    both = {one.id for one in right if one.id in pairs.old_of}
    left = [one for one in left if one.id in pairs.new_of and pairs.new_of[one.id].id in both]
    right = [one for one in right if one.id in both]
    if [pairs.new_of[one.id].id for one in left] != [one.id for one in right]:
        before = ", ".join(title(pairs.old, one) for one in left)
        after = ", ".join(title(pairs.new, one) for one in right)
        yield _change(pairs, old, new, What.REORDERED, "order", before, after)


_Differing = tuple[frozenset[str], What, str, str, str]
"""Names of the attribute concerned, what happened, label, texts before and after."""


def _differing(pairs: Pairs, old: Element, new: Element) -> list[_Differing]:
    before, after = pairs.old_facts(old), pairs.new_facts(new)
    if [both for both, _ in before] == [both for both, _ in after]:
        return []
    gone = _minus(before, after)
    come = _minus(after, before)
    keys = dict.fromkeys(key for (key, _), _ in (*gone, *come))
    found = [_of_key(pairs, key, gone, come) for key in keys]
    texts = {(before, after) for _, _, label, before, after in found if label != "constraint"}
    return [one for one in found if one[2] != "constraint" or one[3:] not in texts]


def _minus(said: _Said, other: _Said) -> _Said:
    left = Counter(both for both, _ in other)
    kept = []
    for both, fact in said:
        if left[both]:
            left[both] -= 1
        else:
            kept.append((both, fact))
    return kept


def _of_key(pairs: Pairs, key: Token, gone: _Said, come: _Said) -> _Differing:
    olds = [fact for (k, _), fact in gone if k == key]
    news = [fact for (k, _), fact in come if k == key]
    fact = (news or olds)[0]
    names = frozenset(part for part in fact.key if isinstance(part, str))
    before = ", ".join(one.text(pairs.old) for one in olds)
    after = ", ".join(one.text(pairs.new) for one in news)
    if before == after and fact.key == BETWEEN:
        before = ", ".join(ends_in_full(pairs.old, one.about) for one in olds if one.about)
        after = ", ".join(ends_in_full(pairs.new, one.about) for one in news if one.about)
    if before == after:
        before = ", ".join(exactly(pairs.old, one.value) for one in olds)
        after = ", ".join(exactly(pairs.new, one.value) for one in news)
    return (names, fact.what, fact.label, before, after)


def _change(
    pairs: Pairs, old: Element, new: Element, what: What, aspect: str, before: str, after: str
) -> Change:
    return Change(
        what=what,
        owner=owner_of(pairs.new, new),
        name=title(pairs.new, new),
        kind=word(pairs.new, new),
        aspect=aspect,
        before=before,
        after=after,
        old=ref_of(pairs.old, old),
        new=ref_of(pairs.new, new),
    )


def only(pairs: Pairs, side: Side, what: What) -> Iterator[Change]:
    """Additions or removals: the topmost elements that are in no pair."""
    known = pairs.new_of if side is pairs.old else pairs.old_of
    for owner, children in side.things.items():
        if owner is None or owner in known or _is_transparent(side, side.graph[owner], known):
            for child in children:
                if not (child.id in known or is_external(child) or _follows(side, child, known)):
                    yield _alone(side, child, what, known)


def _is_transparent(side: Side, owner: Element, known: Collection[str]) -> bool:
    """Whether what it owns is told by itself: a new class of an InternalElement that is not new."""
    is_new = owner.id not in known and is_own_class(owner)
    return is_new and any(one.id in known for one in holders(side, owner))


def _follows(side: Side, element: Element, known: Collection[str]) -> bool:
    """Whether it is there only because of something else that is told.

    What a message does at its ends comes and goes with the message.
    """
    if element.kind is Kind.OCCURRENCE:
        into = side.into.get(element.id, ())
        return any(one.kind is Kind.MESSAGE and one.id not in known for _, one in into)
    return is_told_of_another(side, element, known)


def _alone(side: Side, element: Element, what: What, known: Collection[str]) -> Change:
    tops = [element, *own_classes(side, element)]
    contents = sum(one.id not in known for top in tops for one in side.below(top)) - len(tops)
    ref = ref_of(side, element)
    is_old = what is What.REMOVED
    return Change(
        what=what,
        owner=owner_of(side, element),
        name=title(side, element),
        kind=word(side, element),
        contents=contents,
        old=ref if is_old else None,
        new=None if is_old else ref,
    )


def ref_of(side: Side, element: Element) -> Ref:
    """The element for who wants to find it again."""
    return Ref(element.id, whole(side, element), element.source, element.ordinal)


def owner_of(side: Side, element: Element) -> str:
    """Qualified name of the owner; empty when there is none."""
    owner = side.graph.owner(element)
    return "" if owner is None else whole(side, owner)


UNIT = frozenset({"unit"})
"""Names of the attribute that tells the unit."""
MEASURES = frozenset({Kind.UNIT.value, Kind.QUANTITY_KIND.value})
"""Names of what a type says of its unit in details."""


def is_same_but_for_unit(pairs: Pairs, old: Element, new: Element) -> bool:
    """Whether the types of two values differ in nothing but the unit."""
    return _types(pairs.old, old, pairs.old_token) == _types(pairs.new, new, pairs.new_token)


def _types(side: Side, element: Element, to_token: Callable[[Element], Token]) -> list[Token]:
    found = side.out.get(element.id, {}).get(Edge.TYPED_BY, ())
    return [to_token(_without_unit(side, one)) for one in found]


def _without_unit(side: Side, type_: Element) -> Element:
    """The type behind one that only ties it to a unit (docs/automationml.md)."""
    is_made = type_.kind is Kind.DATA_TYPE and type_.attrs.get("library") and not type_.source
    if not (is_made and type_.name.endswith("]")):
        return type_
    return next(iter(side.out.get(type_.id, {}).get(Edge.SPECIALIZES, ())), type_)
