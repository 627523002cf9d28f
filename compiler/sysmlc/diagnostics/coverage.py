"""Coverage: which elements of the inputs are represented in the graph, and how well."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from msgspec import Struct

from sysmlc.diagnostics.rule import Rule


class Verdict(StrEnum):
    """How the graph represents one element of an input."""

    MAPPED = "mapped"
    """The element is in the graph with its meaning."""
    APPROXIMATED = "approximated"
    """The element is in the graph with a part of its meaning; a diagnostic reports the rest."""
    IGNORED_NOTATION = "ignored_notation"
    """The element has no meaning beyond drawing or tool settings."""
    UNSUPPORTED = "unsupported"
    """The element has a meaning that is not in the graph."""
    EXTERNAL = "external"
    """The element is a stub for something in a file that is not part of the compile unit."""


Counts = Mapping[str, int]
"""Number of elements by the value of their verdict."""


class Loss(Struct, frozen=True):
    """An element that is not wholly in the graph.

    ``elements`` counts the element and its contents with the same verdict. ``owner`` is the id in
    the graph of the nearest enclosing element, ``name`` the element's own name as written.
    ``rule`` is the rule of the diagnostic that reports the loss; notation has none.
    """

    type: str
    verdict: Verdict
    ordinal: int
    elements: int
    owner: str = ""
    name: str = ""
    rule: Rule | None = None
    reason: str = ""


@dataclass(slots=True)
class FileCoverage:
    """Numbers of elements of one file by type and verdict; each element is counted once."""

    file: str
    losses: list[Loss] = field(default_factory=list)
    """Losses in document order; empty unless the coverage is detailed."""
    _counts: Counter[tuple[str, Verdict]] = field(default_factory=Counter)

    def count(self, type_name: str, verdict: Verdict, number: int = 1) -> None:
        """Add *number* elements of a type of the source language."""
        self._counts[type_name, verdict] += number

    @property
    def elements(self) -> int:
        """Number of all elements."""
        return self._counts.total()

    def totals(self) -> dict[str, int]:
        """Return the number of elements for each verdict, zeros included."""
        totals = dict.fromkeys((verdict.value for verdict in Verdict), 0)
        for (_, verdict), number in self._counts.items():
            totals[verdict.value] += number
        return totals

    def by_type(self) -> dict[str, dict[str, int]]:
        """Return for each type the number of elements by verdict, without zeros."""
        table: dict[str, dict[str, int]] = {}
        for (name, verdict), number in sorted(self._counts.items()):
            table.setdefault(name, {})[verdict.value] = number
        return table


class Coverage:
    """Coverage of all files of one compilation.

    If *is_detailed* is true, front ends also list each element that is not mapped.
    """

    def __init__(self, is_detailed: bool = False) -> None:
        self.is_detailed = is_detailed
        self._files: dict[str, FileCoverage] = {}

    def file(self, name: str) -> FileCoverage:
        """Return the coverage of a file, which is created empty at the first call."""
        return self._files.setdefault(name, FileCoverage(name))

    def files(self) -> list[FileCoverage]:
        """Return the coverage of all files, sorted by name."""
        return [self._files[name] for name in sorted(self._files)]

    def as_json(self) -> dict[str, object]:
        """Return the content of ``coverage.json`` (metamodels/sysmlc-coverage.schema.json)."""
        files = self.files()
        total = sum_counts(f.totals() for f in files)
        rows = [
            {"file": f.file, "elements": f.elements, **f.totals(), "by_type": f.by_type()}
            for f in files
        ]
        return {"files": rows, "total": {"elements": sum(total.values()), **total}}


# -- arithmetic --------------------------------------------------------------------------------


def sum_counts(counts: Iterable[Counts]) -> dict[str, int]:
    """Return the sum of several counts, with every verdict."""
    total = dict.fromkeys((v.value for v in Verdict), 0)
    for count in counts:
        for name, number in count.items():
            total[name] += number
    return total


def count_meaningful(counts: Counts) -> int:
    """Return the number of elements with a meaning beyond drawing."""
    return sum(counts.values()) - counts.get(Verdict.IGNORED_NOTATION.value, 0)


def count_covered(counts: Counts) -> int:
    """Return the number of elements that the graph represents wholly, external stubs included."""
    return counts.get(Verdict.MAPPED.value, 0) + counts.get(Verdict.EXTERNAL.value, 0)


def compute_covered_permille(counts: Counts) -> int:
    """Return how many of 1000 meaningful elements are covered; 1000 if none is meaningful.

    The result is rounded down, so that 1000 means that nothing is lost.
    """
    meaningful = count_meaningful(counts)
    return 1000 * count_covered(counts) // meaningful if meaningful else 1000


def compute_permille(counts: Counts) -> dict[str, int]:
    """Return how many of 1000 elements have each verdict; the shares add up to 1000.

    Shares are rounded by largest remainders; of equal remainders the first wins.
    """
    total = sum(counts.values())
    if not total:
        return dict.fromkeys(counts, 0)
    shares = {name: divmod(1000 * number, total) for name, number in counts.items()}
    missing = 1000 - sum(share for share, _ in shares.values())
    rounded_up = sorted(shares, key=lambda name: -shares[name][1])[:missing]
    return {name: share + (name in rounded_up) for name, (share, _) in shares.items()}
