"""Which element of the new model is which element of the old one."""

from collections.abc import Callable, Iterator

from sysmlc.ir.compare.content import is_external
from sysmlc.ir.compare.facts import BETWEEN, Fact, facts
from sysmlc.ir.compare.plants import other_id
from sysmlc.ir.compare.side import Side
from sysmlc.ir.element import Element
from sysmlc.ir.kinds import Kind
from sysmlc.ir.query import CLASSIFIERS

Token = object
"""What a value is for both sides: equal tokens are equal values."""


class Pairs:
    """The pairs found so far, and the leftovers of both sides below the paired owners."""

    def __init__(self, old: Side, new: Side) -> None:
        self.old = old
        self.new = new
        self.new_of: dict[str, Element] = {}
        self.old_of: dict[str, Element] = {}
        self.owners: list[tuple[Element | None, Element | None]] = [(None, None)]
        """Paired owners whose children may still be unpaired; the models themselves first."""

    def put(self, old: Element, new: Element) -> None:
        """Make a pair of two elements that are in none."""
        self.new_of[old.id] = new
        self.old_of[new.id] = old
        self.owners.append((old, new))

    def left_of(self, owner: Element | None) -> list[Element]:
        """Children of an owner of the old model that are in no pair."""
        return [one for one in self.old.children(owner) if one.id not in self.new_of]

    def right_of(self, owner: Element | None) -> list[Element]:
        """Children of an owner of the new model that are in no pair."""
        return [one for one in self.new.children(owner) if one.id not in self.old_of]

    def leftovers(self) -> Iterator[tuple[list[Element], list[Element]]]:
        """Unpaired children of each pair of owners; an owner without any on one side is done."""
        still = []
        for owners in self.owners:
            left, right = self.left_of(owners[0]), self.right_of(owners[1])
            if left and right:
                still.append(owners)
                yield left, right
        self.owners = still

    # -- tokens --------------------------------------------------------------------------------

    def old_token(self, element: Element) -> Token:
        """What stands for an element of the old model: its partner, if it has one."""
        partner = self.new_of.get(element.id)
        return ("new", partner.id) if partner is not None else self._alone(self.old, element)

    def new_token(self, element: Element) -> Token:
        """What stands for an element of the new model."""
        is_paired = element.id in self.old_of
        return ("new", element.id) if is_paired else self._alone(self.new, element)

    def _alone(self, side: Side, element: Element) -> Token:
        if is_external(element):
            return ("outside", str(element.attrs.get("qualified_name") or element.name))
        if element.id in side.hidden:
            owner = side.visible(element)
            to_token = self.old_token if side is self.old else self.new_token
            return ("of", None if owner is None else to_token(owner), element.kind, element.name)
        return ("old only" if side is self.old else "new only", element.id)

    def old_facts(self, element: Element) -> list[tuple[tuple[Token, Token], Fact]]:
        """What an element of the old model says, each with a token that both sides share."""
        return _tokens(facts(self.old, element), self.old_token)

    def new_facts(self, element: Element) -> list[tuple[tuple[Token, Token], Fact]]:
        """What an element of the new model says."""
        return _tokens(facts(self.new, element), self.new_token)


def _tokens(
    found: Iterator[Fact], to_token: Callable[[Element], Token]
) -> list[tuple[tuple[Token, Token], Fact]]:
    return [(fact_token(fact, to_token), fact) for fact in found]


def fact_token(fact: Fact, to_token: Callable[[Element], Token]) -> tuple[Token, Token]:
    """Key and value of a fact for both sides; the ends of a connector have no order."""
    value = token(fact.value, to_token)
    if fact.key == BETWEEN and isinstance(value, tuple):
        value = tuple(sorted(value, key=repr))
    return token(fact.key, to_token), value


def token(value: object, to_token: Callable[[Element], Token]) -> Token:
    """The value with tokens for elements; true is not the number 1."""
    if isinstance(value, Element):
        return to_token(value)
    if isinstance(value, tuple):
        return tuple([token(part, to_token) for part in value])
    return ("truth", value) if isinstance(value, bool) else value


# -- by id -------------------------------------------------------------------------------------

_FEW = 2
_SHARE = 10


def by_id(pairs: Pairs) -> None:
    """Pair what has the same id, unless ids were given anew."""
    common = [
        (one, pairs.new.graph[one.id])
        for one in pairs.old.graph
        if one.id in pairs.new.graph
        if one.id not in pairs.old.hidden and one.id not in pairs.new.hidden
    ]
    if _are_stable(pairs, common):
        for old, new in common:
            if _are_of_a_kind(old, new) and (old.name == new.name or not is_external(old)):
                pairs.put(old, new)
        _by_other_id(pairs)


def _are_of_a_kind(old: Element, new: Element) -> bool:
    """A class may become a component; what has the id of a part may not be an instance now."""
    return old.kind is new.kind or (old.kind in CLASSIFIERS and new.kind in CLASSIFIERS)


def _by_other_id(pairs: Pairs) -> None:
    for old in pairs.old.graph.of_kind(Kind.INSTANCE):
        new = pairs.new.graph.get(other_id(old))
        is_free = new is not None and old.id not in pairs.new_of and new.id not in pairs.old_of
        if is_free and new is not None and new.kind is Kind.INSTANCE:
            pairs.put(old, new)


def _are_stable(pairs: Pairs, common: list[tuple[Element, Element]]) -> bool:
    """Whether equal ids mean the same elements.

    They do not when tools count: then what an id named before has another one now, and what it
    names now had another one before.
    """
    unequal = [(old, new) for old, new in common if _naming(old) != _naming(new)]
    if len(unequal) <= _FEW:
        return True
    before = {_naming(one) for one in pairs.old.graph}
    after = {_naming(one) for one in pairs.new.graph}
    shifted = sum(_naming(old) in after and _naming(new) in before for old, new in unequal)
    return shifted <= max(_FEW, len(common) // _SHARE)


def _naming(element: Element) -> tuple[str, str]:
    return (element.kind, element.name)


# -- by name -----------------------------------------------------------------------------------


def by_name(pairs: Pairs) -> None:
    """Pair what has the same name and kind below one owner, from the roots down.

    Where several have it, what they say decides later.
    """
    for with_kind in (True, False):
        pending = pairs.owners
        while pending:
            known = len(pairs.owners)
            for owners in pending:
                _pair_names(pairs, *owners, with_kind=with_kind)
            pending = pairs.owners[known:]


def _pair_names(pairs: Pairs, old: Element | None, new: Element | None, *, with_kind: bool) -> None:
    left = _unique(pairs.left_of(old), with_kind=with_kind)
    right = _unique(pairs.right_of(new), with_kind=with_kind) if left else {}
    for key, one in left.items():
        if key in right:
            pairs.put(one, right[key])


def _unique(elements: list[Element], *, with_kind: bool) -> dict[tuple[str, str], Element]:
    found: dict[tuple[str, str], Element] = {}
    several: set[tuple[str, str]] = set()
    for one in elements:
        key = (one.kind if with_kind else "", one.name)
        if one.name and key in found:
            several.add(key)
        elif one.name:
            found[key] = one
    return {key: one for key, one in found.items() if key not in several}
