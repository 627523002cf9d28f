"""The differences of two models: pairs of elements first, then what differs within each pair."""

from collections import Counter
from collections.abc import Callable, Collection, Container, Iterator
from typing import NamedTuple

from sysmlc.ir.compare.content import (
    DECLARATION,
    DECLARED_BY,
    IMPLIED,
    IN_ORDER,
    is_external,
    name_in_comparison,
)
from sysmlc.ir.compare.facts import BETWEEN, Change, Fact, Ref, What, iter_statements
from sysmlc.ir.compare.pairs import (
    Pairs,
    Token,
    TokenisedFact,
    pair_by_id,
    pair_by_likeness,
    pair_by_move,
    pair_by_name,
    tokenise,
)
from sysmlc.ir.compare.refinement import list_refinements
from sysmlc.ir.compare.side import (
    Side,
    follows_internal_element,
    is_own_class,
    is_part_instance,
    own_classes,
    represented_part,
    users_of_own_class,
)
from sysmlc.ir.compare.titles import (
    format_ends_with_owners,
    format_value_exactly,
    kind_title,
    qualified_title,
    title,
)
from sysmlc.ir.element import Element
from sysmlc.ir.graph import Graph
from sysmlc.ir.kinds import Edge, Kind

_MOST_ROUNDS = 100
"""Each round can pair one more level of elements without names."""


def compare(old: Graph, new: Graph, ignore: Collection[str] = ()) -> list[Change]:
    """Return all differences of two models, sorted by owner and name.

    The graphs are those of the pass ``resolve``; no later pass has run. ``ignore`` may hold ``id``
    (equal ids do not make a pair) and names of attributes.
    """
    pairs = _pair_elements(Side(old), Side(new), has_ids="id" not in ignore)
    changes = [
        *_iter_unpaired(pairs, pairs.old, What.REMOVED),
        *_iter_unpaired(pairs, pairs.new, What.ADDED),
        *(change for pair in _iter_pairs(pairs) for change in _compare_pair(pairs, *pair, ignore)),
    ]
    return sorted(changes, key=_sort_key)


def _pair_elements(old: Side, new: Side, *, has_ids: bool) -> Pairs:
    """Pair the elements by id, then by name, then by the most reliable step that finds a pair.

    After each success the steps start again with the most reliable one.
    """
    pairs = Pairs(old, new)
    if has_ids:
        pair_by_id(pairs)
    pair_by_name(pairs)
    steps: list[Callable[[Pairs], None]] = [
        *list_refinements(pairs),
        pair_by_likeness,
        pair_by_move,
    ]
    for _ in range(_MOST_ROUNDS):
        if not any(_finds_pairs(pairs, step) for step in steps):
            break
        pair_by_name(pairs)
    return pairs


def _finds_pairs(pairs: Pairs, step: Callable[[Pairs], None]) -> bool:
    number = len(pairs.new_of)
    step(pairs)
    return len(pairs.new_of) > number


def _sort_key(change: Change) -> tuple[str, ...]:
    return (change.owner, change.name, change.kind, change.what, change.aspect, change.before)


def _iter_pairs(pairs: Pairs) -> Iterator[tuple[Element, Element]]:
    for id, new in pairs.new_of.items():
        old = pairs.old.graph[id]
        if not (is_external(old) or is_external(new)):
            yield old, new


# -- additions and removals --------------------------------------------------------------------


def _iter_unpaired(pairs: Pairs, side: Side, what: What) -> Iterator[Change]:
    """Iterate over the topmost unpaired elements of a side as additions or removals."""
    paired = pairs.new_of if side is pairs.old else pairs.old_of
    for owner, children in side.members.items():
        if not (owner is None or owner in paired or _is_transparent(side, owner, paired)):
            continue
        if owner is not None and is_external(side.graph[owner]):
            # What an element outside of the model owns is known as far as the model uses it.
            continue
        for child in children:
            if child.id in paired or is_external(child):
                continue
            if not _is_consequence(side, child, paired):
                yield _unpaired_change(side, child, what, paired)


def _is_transparent(side: Side, owner_id: str, paired: Container[str]) -> bool:
    """Whether the owner is a new own class, whose children are reported without it.

    The InternalElement of the class has a partner in the other model; only the class is new.
    """
    owner = side.graph[owner_id]
    if owner_id in paired or not is_own_class(owner):
        return False
    return any(user.id in paired for user in users_of_own_class(side, owner))


def _is_consequence(side: Side, element: Element, paired: Container[str]) -> bool:
    """Whether an unpaired element is reported as part of another element's change.

    The occurrences at the ends of a message are added and removed with the message.
    """
    if element.kind is Kind.OCCURRENCE:
        incoming = side.incoming.get(element.id, ())
        return any(
            source.kind is Kind.MESSAGE and source.id not in paired for _, source in incoming
        )
    return follows_internal_element(side, element, paired)


def _unpaired_change(side: Side, element: Element, what: What, paired: Container[str]) -> Change:
    tops = [element, *own_classes(side, element)]
    unpaired = [e for top in tops for e in side.visible_subtree(top) if e.id not in paired]
    reference = _make_ref(side, element)
    is_old = what is What.REMOVED
    return Change(
        what=what,
        owner=_name_owner(side, element),
        name=title(side, element),
        kind=kind_title(side, element),
        contents=len(unpaired) - len(tops),
        old=reference if is_old else None,
        new=None if is_old else reference,
    )


# -- differences within a pair -----------------------------------------------------------------


class _Difference(NamedTuple):
    """A difference of the facts under one key."""

    names: frozenset[str]
    """The words of the key: names of the attribute or edge."""
    what: What
    label: str
    before: str
    after: str


def _compare_pair(
    pairs: Pairs, old: Element, new: Element, ignore: Collection[str]
) -> Iterator[Change]:
    if _is_renamed(pairs, new) and not _is_renamed_with_part(pairs, old, new):
        yield _pair_change(pairs, old, new, What.RENAMED, "name", old.name, new.name)
    if old.kind is not new.kind:
        yield _pair_change(pairs, old, new, What.RETYPED, "kind", str(old.kind), str(new.kind))
    if _is_moved(pairs, old, new):
        before, after = _name_owner(pairs.old, old), _name_owner(pairs.new, new)
        yield _pair_change(pairs, old, new, What.MOVED, "owner", before, after)
    yield from _compare_order(pairs, old, new)
    differences = [
        difference
        for difference in _omit_consequences_of_unit(pairs, old, new)
        if not difference.names & set(ignore) and not _is_implied_role(difference)
    ]
    telling = [difference for difference in differences if not difference.names & IMPLIED]
    declared = [] if DECLARATION in ignore else _list_declared(pairs, old, new, differences)
    for _, what, label, before, after in (*(telling or differences), *declared):
        if what is What.RETYPED and _is_retyped_with_part(pairs, new):
            continue
        yield _pair_change(pairs, old, new, what, label, before, after)


def _is_implied_role(difference: _Difference) -> bool:
    """Whether only one of two file formats states a role that the other one implies."""
    return difference.names == {"role"} and not (difference.before and difference.after)


def _is_renamed_with_part(pairs: Pairs, old: Element, new: Element) -> bool:
    """Whether the renaming is reported for another element of the InternalElement."""
    if is_own_class(old) and is_own_class(new):
        return any(_is_renamed(pairs, user) for user in users_of_own_class(pairs.new, new))
    part = _paired_part(pairs, new)
    return part is not None and _is_renamed(pairs, part)


def _is_renamed(pairs: Pairs, new: Element) -> bool:
    old = pairs.old_of.get(new.id)
    return old is not None and name_in_comparison(old) != name_in_comparison(new)


def _is_retyped_with_part(pairs: Pairs, new: Element) -> bool:
    """Whether *new* holds the values of a part whose change of type is reported."""
    part = _paired_part(pairs, new)
    if part is None:
        return False
    differences = _list_differences(pairs, pairs.old_of[part.id], part)
    return any(difference.what is What.RETYPED for difference in differences)


def _paired_part(pairs: Pairs, new: Element) -> Element | None:
    """Return the part whose values *new* holds, if the part has a partner in the old model."""
    part = represented_part(pairs.new, new) if is_part_instance(new) else None
    return part if part is not None and part.id in pairs.old_of else None


def _is_moved(pairs: Pairs, old: Element, new: Element) -> bool:
    old_owner, new_owner = pairs.old.graph.owner(old), pairs.new.graph.owner(new)
    if old_owner is None or new_owner is None:
        return old_owner is not new_owner
    return pairs.old_token(old_owner) != pairs.new_token(new_owner)


def _compare_order(pairs: Pairs, old: Element, new: Element) -> Iterator[Change]:
    kinds = IN_ORDER.get(new.kind)
    if kinds is None:
        return
    olds = [child for child in pairs.old.children(old) if child.kind in kinds]
    news = [child for child in pairs.new.children(new) if child.kind in kinds]
    paired = {child.id for child in news if child.id in pairs.old_of}
    olds = [c for c in olds if c.id in pairs.new_of and pairs.new_of[c.id].id in paired]
    news = [child for child in news if child.id in paired]
    if [pairs.new_of[child.id].id for child in olds] != [child.id for child in news]:
        before = ", ".join(title(pairs.old, child) for child in olds)
        after = ", ".join(title(pairs.new, child) for child in news)
        yield _pair_change(pairs, old, new, What.REORDERED, "order", before, after)


def _list_differences(pairs: Pairs, old: Element, new: Element) -> list[_Difference]:
    before, after = pairs.old_facts(old), pairs.new_facts(new)
    if [tokens for tokens, _ in before] == [tokens for tokens, _ in after]:
        return []
    differences = _subtract_both(pairs, before, after)
    # A guard is an attribute of some dialects and a constraint of others.
    texts = {(d.before, d.after) for d in differences if d.label != "constraint"}
    return [d for d in differences if d.label != "constraint" or (d.before, d.after) not in texts]


def _subtract_both(
    pairs: Pairs, before: list[TokenisedFact], after: list[TokenisedFact]
) -> list[_Difference]:
    """Return one difference for each key of the facts that only one side has."""
    removed = _subtract(before, after)
    added = _subtract(after, before)
    keys = dict.fromkeys(key for (key, _), _ in (*removed, *added))
    return [_difference_of_key(pairs, key, removed, added) for key in keys]


def _list_declared(
    pairs: Pairs, old: Element, new: Element, differences: list[_Difference]
) -> list[_Difference]:
    """Return differences of declarations in SysML v2 that other differences do not express.

    There are none if only one model is in SysML v2.
    """
    before = tokenise(iter_statements(pairs.old, old), pairs.old_token)
    after = tokenise(iter_statements(pairs.new, new), pairs.new_token)
    if not before or not after:
        return []
    reported = {name for d in differences for name in (*d.names, d.label)}
    reported.update(DECLARED_BY["keyword"] if old.kind is not new.kind else ())
    declared = _subtract_both(pairs, before, after)
    return [d for d in declared if reported.isdisjoint(DECLARED_BY.get(d.label, {d.label}))]


def _subtract(facts: list[TokenisedFact], others: list[TokenisedFact]) -> list[TokenisedFact]:
    """Return *facts* without those of *others*, as multisets."""
    counts = Counter(tokens for tokens, _ in others)
    remaining = []
    for tokens, fact in facts:
        if counts[tokens]:
            counts[tokens] -= 1
        else:
            remaining.append((tokens, fact))
    return remaining


def _difference_of_key(
    pairs: Pairs, key: Token, removed: list[TokenisedFact], added: list[TokenisedFact]
) -> _Difference:
    olds = [fact for (fact_key, _), fact in removed if fact_key == key]
    news = [fact for (fact_key, _), fact in added if fact_key == key]
    fact = (news or olds)[0]
    names = frozenset(part for part in fact.key if isinstance(part, str))
    before, after = _format_difference(pairs, olds, news, is_connector=fact.key == BETWEEN)
    return _Difference(names, fact.what, fact.label, before, after)


def _format_difference(
    pairs: Pairs, olds: list[Fact], news: list[Fact], *, is_connector: bool
) -> tuple[str, str]:
    """Return the texts before and after, as short as possible but different."""
    before = ", ".join(fact.text(pairs.old) for fact in olds)
    after = ", ".join(fact.text(pairs.new) for fact in news)
    if before == after and is_connector:
        before = ", ".join(format_ends_with_owners(pairs.old, f.about) for f in olds if f.about)
        after = ", ".join(format_ends_with_owners(pairs.new, f.about) for f in news if f.about)
    if before == after:
        before = ", ".join(format_value_exactly(pairs.old, fact.value) for fact in olds)
        after = ", ".join(format_value_exactly(pairs.new, fact.value) for fact in news)
    return before, after


# -- units -------------------------------------------------------------------------------------

_UNIT = frozenset({"unit"})
_MEASURES = frozenset({Kind.UNIT.value, Kind.QUANTITY_KIND.value})


def _omit_consequences_of_unit(pairs: Pairs, old: Element, new: Element) -> list[_Difference]:
    """Return the differences, without those that follow from a change of unit.

    A change of unit may also change the quantity kind and a type that only adds the unit.
    """
    differences = _list_differences(pairs, old, new)
    if not any(difference.names == _UNIT for difference in differences):
        return differences
    has_same_types = _list_types_without_unit(
        pairs.old, old, pairs.old_token
    ) == _list_types_without_unit(pairs.new, new, pairs.new_token)
    return [
        difference
        for difference in differences
        if not difference.names & _MEASURES
        if not (has_same_types and difference.names == {Edge.TYPED_BY.value})
    ]


def _list_types_without_unit(
    side: Side, element: Element, to_token: Callable[[Element], Token]
) -> list[Token]:
    types = side.edges.get(element.id, {}).get(Edge.TYPED_BY, ())
    return [to_token(_strip_unit(side, type_)) for type_ in types]


def _strip_unit(side: Side, type_: Element) -> Element:
    """Return the general type of a derived type that only adds a unit (docs/automationml.md)."""
    is_derived = type_.kind is Kind.DATA_TYPE and type_.attrs.get("library") and not type_.source
    if not (is_derived and type_.name.endswith("]")):
        return type_
    return next(iter(side.edges.get(type_.id, {}).get(Edge.SPECIALIZES, ())), type_)


# -- changes -----------------------------------------------------------------------------------


def _pair_change(
    pairs: Pairs, old: Element, new: Element, what: What, aspect: str, before: str, after: str
) -> Change:
    return Change(
        what=what,
        owner=_name_owner(pairs.new, new),
        name=title(pairs.new, new),
        kind=kind_title(pairs.new, new),
        aspect=aspect,
        before=before,
        after=after,
        old=_make_ref(pairs.old, old),
        new=_make_ref(pairs.new, new),
    )


def _make_ref(side: Side, element: Element) -> Ref:
    return Ref(element.id, qualified_title(side, element), element.source, element.ordinal)


def _name_owner(side: Side, element: Element) -> str:
    """Return the qualified name of the owner; empty without an owner."""
    owner = side.graph.owner(element)
    return "" if owner is None else qualified_title(side, owner)
