"""IDs of the elements of a unit: index from an ID to its row, exact and inexact lookup."""

from bisect import bisect_right
from collections.abc import Iterator
from itertools import compress

from sysmlc.frontends.caex.document import Document, Node

LocatedNode = tuple[Document, Node]
"""A node and its file."""

_UNINDEXED_LOOKUPS = 8
"""Number of inexact lookups that search all IDs as one text, before an index is built."""


class Identifiers:
    """Rows by ID. The rows of all files are numbered consecutively."""

    def __init__(self, documents: list[Document]) -> None:
        self._documents = documents
        self._starts = [0]
        for document in documents:
            self._starts.append(self._starts[-1] + len(document.tags))
        self._numbers: dict[str, int] = {}
        self._repeated: dict[str, list[int]] = {}
        self._numbers_by_plain_id: dict[str, int] | None = None
        self._has_slash: bool | None = None
        self._lower_ids: str | None = None
        self._inexact_lookups = 0
        if len(documents) == 1:
            self._index(documents[0].ids)
        else:
            self._index([id for document in documents for id in document.ids])

    def _index(self, ids: list[str]) -> None:
        """Number the IDs; an ID that occurs several times has the number of its first row."""
        rows = compress(range(len(ids)), ids)
        numbers = dict(zip(filter(None, ids), rows, strict=True))
        # Most files repeat no ID, so the loop, which is slower than the two lines above, is rare.
        if len(numbers) < len(ids) - ids.count(""):
            numbers = {}
            for number, id in enumerate(ids):
                if id and numbers.setdefault(id, number) != number:
                    self._repeated.setdefault(id, [numbers[id]]).append(number)
        self._numbers = numbers

    def __contains__(self, id: str) -> bool:
        """Whether an element has the ID, literally."""
        return id in self._numbers

    def is_repeated(self, id: str) -> bool:
        """Whether several elements have the ID."""
        return id in self._repeated

    def iter_repeated(self) -> Iterator[tuple[str, list[LocatedNode]]]:
        """Yield each ID that several elements have, with these elements."""
        for id, numbers in self._repeated.items():
            yield id, list(map(self._locate, numbers))

    def list_rows_without_id(self, document: Document, tag: str) -> list[int]:
        """Return the rows of a file with this tag that have no ID."""
        ids = document.ids
        return [row for row in document.iter_rows(tag, 0, len(ids)) if not ids[row]]

    def find(self, id: str, document: Document | None = None) -> LocatedNode | None:
        """Return the node with the ID: literally, else without regard to braces, case and alias.

        If several files have the ID, the node of *document* is preferred.
        """
        if id in self._repeated:
            nodes = list(map(self._locate, self._repeated[id]))
            return next((located for located in nodes if located[0] is document), nodes[0])
        number = self._numbers.get(id)
        return self.find_inexact(id.rpartition("@")[2]) if number is None else self._locate(number)

    def find_inexact(self, id: str) -> LocatedNode | None:
        """Return the node whose ID differs at most in braces and case."""
        if "/" in id and not self._has_id_with_slash():
            return None
        if not self._may_contain(_normalize(id)):
            return None
        if self._numbers_by_plain_id is None:
            self._numbers_by_plain_id = {}
            for literal, number in self._numbers.items():
                self._numbers_by_plain_id.setdefault(_normalize(literal), number)
        match = self._numbers_by_plain_id.get(_normalize(id))
        return None if match is None else self._locate(match)

    def _may_contain(self, id: str) -> bool:
        """Whether the ID may exist. The first lookups search one text instead of building an index.

        Most files ask only for the names of a few libraries, which are not part of any ID.
        """
        self._inexact_lookups += 1
        if self._numbers_by_plain_id is not None or self._inexact_lookups > _UNINDEXED_LOOKUPS:
            return True
        if self._lower_ids is None:
            self._lower_ids = "\n".join(self._numbers).lower()
        return id in self._lower_ids

    def _has_id_with_slash(self) -> bool:
        """Whether some ID looks like a class path, which is rare."""
        if self._has_slash is None:
            self._has_slash = "/" in "".join(self._numbers)
        return self._has_slash

    def find_unique_row(self, id: str) -> tuple[Document, int] | None:
        """Return the row that has the ID literally, if it is the only one."""
        number = self._numbers.get(id)
        if number is None or id in self._repeated:
            return None
        return self._find_row(number)

    def _find_row(self, number: int) -> tuple[Document, int]:
        if number < self._starts[1]:
            return self._documents[0], number
        index = bisect_right(self._starts, number) - 1
        return self._documents[index], number - self._starts[index]

    def _locate(self, number: int) -> LocatedNode:
        document, row = self._find_row(number)
        return document, document.node(row)


def _normalize(id: str) -> str:
    """Return an ID without braces and in lower case: tools differ in both."""
    return id.strip().strip("{}").lower()
