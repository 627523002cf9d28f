"""A resolved unit that a process keeps: what an edit cannot change is not found out again.

A unit is made of *items*, which are the members of its root packages, and of what is around them
in each file (imports, aliases, metadata of a package). What is known of an item is made of what it
owns, of what is around it, and of what the names in it lead to, and so on from there. So it is as
it was while nothing is new that it mentions, by a name anywhere in it: ``Changes`` follows that
from item to item by their names and from file to file by those of root members.

Nothing is kept of what was found in a circle of the unit, for that depends on what was asked first
(decision 34), nor where a name of a root member is new or one that the library speaks of. Names
that lead nowhere are told anew: what may help there is looked for in the whole unit.
"""

import re
from collections.abc import Iterable, Sequence
from contextlib import suppress

from sysmlc.language.library import Library
from sysmlc.language.names import Model
from sysmlc.language.names.model import root
from sysmlc.language.tree import Document, Node
from sysmlc.sources import Source
from sysmlc.values import replace

Place = tuple[str, int]


class Kept:
    """What is known of a unit of which all references are resolved and checked.

    ``asked`` are places of literals that somebody asked for, who does not ask again.
    """

    def __init__(self, model: Model) -> None:
        self.model = model
        self.asked: frozenset[Place] = frozenset()
        self._mentions: dict[Node, frozenset[str]] = {}
        self._apart: set[Document] = set()
        """Files of the library that do not speak of the unit."""

    def documents(self, sources: Iterable[Source]) -> dict[str, Document]:
        """By path the documents of files that say what they said before."""
        known = {one.name: one for one in sources}
        return {one.path: one for one in self.model.documents if one.source == known.get(one.path)}

    def renew(self, documents: Sequence[Document], library: Library) -> bool:
        """Let the model be that of these documents, in which all is as it was that is not new.

        False where too much may be new: nothing of what was kept is to be used any more.
        """
        from sysmlc.language.changes import Changes

        model, before = self.model, {one.path: one.root for one in self.model.documents}
        if sorted(one.path for one in documents) != list(before):
            return False
        if not all(map(_is_text, (*documents, *model.documents))):
            return False
        if not library.is_same(model.library) or not self._is_apart():
            return False
        changes = Changes(model.lookup, self._mentions)
        if not all(changes.compare(before[one.path], one.root) for one in documents):
            return False
        changes.add(model.lookup.doubtful)
        changes.spread()
        roots = changes.apply()
        made = [replace(one, root=roots[before[one.path]]) for one in documents]
        model.take(made, changes.stale, changes.names)
        return True

    def _is_apart(self) -> bool:
        """Whether all that was found is as it were whatever was asked first, and by these alone."""
        lookup, roots = self.model.lookup, [one.root for one in self.model.documents]
        if lookup.abandoned or lookup.given_up or any(root(one) in roots for one in lookup.cycles):
            return False
        found = [(one.name, one.short) for node in roots for one in node.members]
        names = {one for pair in found for one in pair if one is not None}
        if not names.isdisjoint(self.model.asks()) or not all(map(_is_plain, names)):
            return False
        for one in self.model.library.loaded():
            if one not in self._apart and _mentions(one.text, names):
                return False
            self._apart.add(one)
        return True


def _is_text(document: Document) -> bool:
    """Whether a file is text of SysML; KerML may say from elsewhere what a feature belongs to."""
    return document.language == "sysml" and bool(document.text)


def _is_plain(name: str) -> bool:
    """Whether a name stands in a text as it is, without escapes."""
    return name.isprintable() and not {"'", '"', "\\"} & set(name)


def _mentions(text: str, names: Iterable[str]) -> bool:
    said = [re.escape(one) for one in names if one in text]
    return bool(said) and re.search(rf"(?<!\w)(?:{'|'.join(said)})(?!\w)", text) is not None


_LAST: list[Kept] = []
"""The unit that this process compiled last; who compiles takes it and puts there what it made."""


def take() -> Kept | None:
    """What was kept, for one compilation: until something is put there again nothing is."""
    with suppress(IndexError):
        return _LAST.pop()
    return None


def keep(kept: Kept, asked: frozenset[Place]) -> None:
    """Keep a unit, with the places of literals that were asked for in the whole compilation."""
    kept.asked = asked
    _LAST[:] = [kept]
