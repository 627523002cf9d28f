"""IDs of the elements of a unit: which row has which, and how one is found."""

from bisect import bisect_right
from collections.abc import Iterator
from itertools import compress

from sysmlc.frontends.caex.document import Document, Node
from sysmlc.frontends.caex.paths import plain

Place = tuple[Document, Node]
"""A node and the file that it stands in."""

_FEW = 8
"""So many texts are looked for in all IDs at once, before these are indexed."""


class Identifiers:
    """Rows by ID. The rows of all files are numbered one after the other."""

    def __init__(self, documents: list[Document]) -> None:
        self._documents = documents
        self._starts = [0]
        for document in documents:
            self._starts.append(self._starts[-1] + len(document.tags))
        self._numbers: dict[str, int] = {}
        self._repeated: dict[str, list[int]] = {}
        self._plain: dict[str, int] | None = None
        self._paths: bool | None = None
        self._lower: str | None = None
        self._asked = 0
        written = documents[0].ids if len(documents) == 1 else [i for d in documents for i in d.ids]
        self._know(written)

    def _know(self, written: list[str]) -> None:
        rows = compress(range(len(written)), written)
        numbers: dict[str, int] = {}
        numbers.update(zip(filter(None, written), rows, strict=True))
        if len(numbers) < len(written) - written.count(""):
            numbers = {}
            for number, id in enumerate(written):
                if id and numbers.setdefault(id, number) != number:
                    self._repeated.setdefault(id, [numbers[id]]).append(number)
        self._numbers = numbers

    def __contains__(self, id: str) -> bool:
        """Whether an element has the ID, literally."""
        return id in self._numbers

    def is_repeated(self, id: str) -> bool:
        """Whether several elements have the ID."""
        return id in self._repeated

    def repeated(self) -> Iterator[tuple[str, list[Place]]]:
        """Each ID that several elements have, with these."""
        for id, numbers in self._repeated.items():
            yield id, list(map(self._place, numbers))

    def without(self, document: Document, tag: str) -> list[int]:
        """Rows of a file with this tag that have no ID."""
        ids = document.ids
        return [row for row in document.tagged(tag, 0, len(ids)) if not ids[row]]

    def find(self, id: str, document: Document | None = None) -> Place | None:
        """The node with the ID: literally, else without regard to braces, case and alias.

        Of several files that have the ID, ``document`` is the one that is meant.
        """
        if id in self._repeated:
            alike = list(map(self._place, self._repeated[id]))
            return next((one for one in alike if one[0] is document), alike[0])
        number = self._numbers.get(id)
        return self.find_plain(id.rpartition("@")[2]) if number is None else self._place(number)

    def find_plain(self, id: str) -> Place | None:
        """The node whose ID differs at most in braces and case."""
        if "/" in id and not self._has_paths():
            return None
        if not self._may_be_there(plain(id)):
            return None
        if self._plain is None:
            self._plain = {}
            for known, number in self._numbers.items():
                self._plain.setdefault(plain(known), number)
        found = self._plain.get(plain(id))
        return None if found is None else self._place(found)

    def _may_be_there(self, id: str) -> bool:
        """False for what is not even part of an ID: names of libraries, of which there are few."""
        self._asked += 1
        if self._plain is not None or self._asked > _FEW:
            return True
        if self._lower is None:
            self._lower = "\n".join(self._numbers).lower()
        return id in self._lower

    def _has_paths(self) -> bool:
        """Whether some ID looks like the path of a class: next to never."""
        if self._paths is None:
            self._paths = "/" in "".join(self._numbers)
        return self._paths

    def spot(self, id: str) -> tuple[Document, int] | None:
        """The row that has the ID literally, when it is the only one."""
        number = self._numbers.get(id)
        if number is None or id in self._repeated:
            return None
        if number < self._starts[1]:
            return self._documents[0], number
        index = bisect_right(self._starts, number) - 1
        return self._documents[index], number - self._starts[index]

    def _place(self, number: int) -> Place:
        index = bisect_right(self._starts, number) - 1
        document = self._documents[index]
        return document, document.node(number - self._starts[index])
