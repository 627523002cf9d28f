"""Snapshots of used projects inside a MagicDraw archive: parts of libraries, by id.

The fourth dialect: XMI 2.0 with ``xsi:type``, an ``ID`` for each element, and applications of
stereotypes inside the elements they are applied to.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator

from sysmlc.sources import DEFAULT_LIMITS, Fault, Source, SourceError
from sysmlc.sources.xml import parse, parser, too_deep

_HEAD = 4096
_NAMESPACE = re.compile(rb"""["']https?://www\.nomagic\.com/magicdraw/UML/""")
_ENTRY = re.compile(r"[!/][^!/]*snapshot$")
_TYPE = "http://www.w3.org/2001/XMLSchema-instance}type"


class Entry:
    """One element of a snapshot.

    ``references`` are ids by feature; ``values`` the attributes as written. ``size`` counts
    the elements inside it: a library's own snapshot has more of it than those of others.
    """

    __slots__ = ("feature", "id", "ordinal", "owner", "references", "size", "source", "values")

    def __init__(
        self, id: str, feature: str, ordinal: int, source: str, owner: str, values: dict[str, str]
    ) -> None:
        self.id = id
        self.feature = feature
        self.ordinal = ordinal
        self.source = source
        self.owner = owner
        self.values = values
        self.size = 0
        self.references = _NO_REFERENCES

    @property
    def name(self) -> str:
        """Its name, or the empty string."""
        return self.values.get("name", "")

    @property
    def type(self) -> str:
        """Its metaclass as written (a root's is its tag), or the empty string."""
        written = self.values.get(_TYPE)
        if written is None:
            return "" if self.feature[0].islower() else self.feature
        return written.rpartition(":")[2]

    @property
    def written(self) -> str:
        """Its type as coverage calls it."""
        return self.feature if self.type in ("", self.feature) else f"uml:{self.type}"

    def targets(self, feature: str) -> list[str]:
        """Ids that the feature refers to, as attribute or as children."""
        return self.references.get(feature) or self.values.get(feature, "").split()

    def refer(self, feature: str, href: str) -> None:
        """Note what a child without ID refers to; the owner of a root is written so too."""
        target = href.rpartition("#")[2]
        if feature == "owningPackage":
            self.owner = self.owner or target
        elif feature != "packagedElement":
            if self.references is _NO_REFERENCES:
                self.references = {}
            self.references.setdefault(feature, []).append(target)


_NO_REFERENCES: dict[str, list[str]] = {}
"""Shared by the many elements that refer to nothing; never changed."""


def is_snapshot(source: Source) -> bool:
    """Whether the source is a snapshot: told by the namespace that only they have."""
    is_entry = _ENTRY.search(source.name) is not None
    return is_entry and _NAMESPACE.search(source.data, 0, _HEAD) is not None


class Snapshots:
    """The elements of all snapshots of a unit, each once.

    Snapshots overlap: each holds what one used project needs of the others. Of several copies
    the one with most inside counts, with the references that only the others have. What
    cannot be read is left out and added to ``problems``; what exceeds the limits raises
    SourceError.
    """

    def __init__(self, sources: Iterable[Source], problems: list[SourceError]) -> None:
        self.entries: dict[str, Entry] = {}
        self.counts: dict[str, Counter[str]] = {}
        self.attributes: dict[str, frozenset[str]] = {}
        """Names of attributes in each snapshot, and some more."""
        self._owned: dict[str, list[Entry]] = {}
        for source in sorted(sources, key=lambda one: one.name):
            self._read(source, problems)
        for entry in sorted(self.entries.values(), key=place):
            if entry.owner:
                self._owned.setdefault(entry.owner, []).append(entry)

    def owned(self, id: str) -> list[Entry]:
        """What the element owns, in document order."""
        return self._owned.get(id, [])

    def path(self, entry: Entry) -> Iterator[Entry]:
        """The element and its owners, nearest first."""
        seen: set[str] = set()
        at: Entry | None = entry
        while at is not None and at.id not in seen:
            seen.add(at.id)
            yield at
            at = self.entries.get(at.owner)

    def _read(self, source: Source, problems: list[SourceError]) -> None:
        try:
            found, self.counts[source.name], self.attributes[source.name] = _entries(source)
        except SourceError as problem:
            if problem.fault is Fault.LIMIT:
                raise
            problems.append(problem)
            return
        for entry in found:
            self._add(entry)

    def _add(self, entry: Entry) -> None:
        known = self.entries.get(entry.id)
        if known is None:
            self.entries[entry.id] = entry
            return
        best, other = (entry, known) if entry.size > known.size else (known, entry)
        best.references = other.references | best.references
        best.values = other.values | best.values
        best.owner = best.owner or other.owner
        self.entries[entry.id] = best


def place(entry: Entry) -> tuple[str, int]:
    """Where the element stands, for ordering."""
    return entry.source, entry.ordinal


def _entries(source: Source) -> tuple[list[Entry], Counter[str], frozenset[str]]:
    """The elements with an ID, owned before owner; the number of all by type; and names.

    The names are those of attributes, as far as no tag has them, as the parser keeps them.

    Raises SourceError.
    """
    made = parser()
    name, limit = source.name, DEFAULT_LIMITS.depth
    found: list[Entry] = []
    features: list[str] = []
    types: list[str | None] = []
    local: dict[str, str] = {}
    stack: list[Entry | None] = [None]

    def start(tag: str, values: dict[str, str]) -> None:
        above = stack[-1]
        feature = local.get(tag) or local.setdefault(tag, tag.rpartition("}")[2])
        id = values.get("ID")
        if id:
            owner = above.id if above is not None else ""
            stack.append(Entry(id, feature, len(features), name, owner, values))
        else:
            if above is not None and "href" in values:
                above.refer(feature, values["href"])
            stack.append(above)
        features.append(feature)
        types.append(values.get(_TYPE))
        if len(stack) > limit:
            too_deep(source, made)

    def end(_tag: str) -> None:
        entry = stack.pop()
        above = stack[-1]
        if entry is not None and entry is not above:
            if above is not None:
                above.size += entry.size + 1
            found.append(entry)

    made.StartElementHandler = start
    made.EndElementHandler = end
    parse(source, made)
    counts = Counter(t or f for t, f in zip(types, features, strict=True))
    return found, counts, frozenset(made.intern.keys() - local.keys())
