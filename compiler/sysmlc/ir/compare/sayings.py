"""What elements say, with all that is below them, as one number each."""

from itertools import islice

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
