"""Coverage: what became of every element of the inputs."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from msgspec import Struct

from sysmlc.diagnostics.rule import Rule


class Verdict(StrEnum):
    """What became of one element of an input."""

    MAPPED = "mapped"
    """It is in the graph with its meaning."""
    APPROXIMATED = "approximated"
    """It is in the graph with part of its meaning; a diagnostic says which part is lost."""
    IGNORED_NOTATION = "ignored_notation"
    """It has no meaning beyond drawing or tool settings."""
    UNSUPPORTED = "unsupported"
    """It has a meaning that is not in the graph."""
    EXTERNAL = "external"
    """It stands for something in a file that is not part of the compile unit."""


Counts = Mapping[str, int]
"""Number of elements for each verdict (its value)."""


class Loss(Struct, frozen=True):
    """An element that is not wholly in the graph, with what it contains that shares its verdict.

    ``elements`` counts both. ``owner`` is the id in the graph of the nearest element around
    it, ``name`` its own name as written. ``rule`` is the finding that tells of it; what is
    only drawn has none.
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
    """Verdicts on the elements of one file; every element is counted exactly once."""

    file: str
    losses: list[Loss] = field(default_factory=list)
    """In document order; empty unless the coverage is detailed."""
    _counts: Counter[tuple[str, Verdict]] = field(default_factory=Counter)

    def count(self, type_name: str, verdict: Verdict, number: int = 1) -> None:
        """Count ``number`` elements of one source type."""
        self._counts[type_name, verdict] += number

    @property
    def elements(self) -> int:
        """Number of elements counted."""
        return self._counts.total()

    def totals(self) -> dict[str, int]:
        """Number of elements for each verdict."""
        return {v.value: sum(n for (_, w), n in self._counts.items() if v is w) for v in Verdict}

    def by_type(self) -> dict[str, dict[str, int]]:
        """For each source type the number of elements for each verdict that occurs."""
        table: dict[str, dict[str, int]] = {}
        for (name, verdict), number in sorted(self._counts.items()):
            table.setdefault(name, {})[verdict.value] = number
        return table


class Coverage:
    """Coverage of all files of one compilation.

    With ``is_detailed`` front ends also list what is not mapped, element by element.
    """

    def __init__(self, is_detailed: bool = False) -> None:
        self.is_detailed = is_detailed
        self._files: dict[str, FileCoverage] = {}

    def file(self, name: str) -> FileCoverage:
        """Coverage of one file, empty when it is asked for first."""
        return self._files.setdefault(name, FileCoverage(name))

    def files(self) -> list[FileCoverage]:
        """Coverage of each file, sorted by name."""
        return [self._files[name] for name in sorted(self._files)]

    def as_json(self) -> dict[str, object]:
        """The content of ``coverage.json`` (design, section 4)."""
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


def with_meaning(counts: Counts) -> int:
    """Number of elements that mean something beyond drawing."""
    return sum(counts.values()) - counts.get(Verdict.IGNORED_NOTATION.value, 0)


def count_covered(counts: Counts) -> int:
    """Return the number of elements whose whole meaning is in the graph, external stubs
    included.
    """
    return counts.get(Verdict.MAPPED.value, 0) + counts.get(Verdict.EXTERNAL.value, 0)


def covered_tenths(counts: Counts) -> int:
    """Tenths of a per cent of ``with_meaning`` that are ``covered``, rounded down.

    1000 means all, so that no loss is rounded away; nothing to cover is covered.
    """
    whole = with_meaning(counts)
    return 1000 * count_covered(counts) // whole if whole else 1000


def tenths(counts: Counts) -> dict[str, int]:
    """Tenths of a per cent of all elements for each verdict; they add up to 1000.

    Rounded by largest remainders; of equal ones the first gets the rest.
    """
    whole = sum(counts.values())
    if not whole:
        return dict.fromkeys(counts, 0)
    shares = {name: divmod(1000 * number, whole) for name, number in counts.items()}
    rest = 1000 - sum(share for share, _ in shares.values())
    raised = sorted(shares, key=lambda name: -shares[name][1])[:rest]
    return {name: share + (name in raised) for name, (share, _) in shares.items()}
