"""Coverage: what became of every element of the inputs."""

from collections import Counter
from dataclasses import dataclass, field
from enum import StrEnum


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


@dataclass(slots=True)
class FileCoverage:
    """Verdicts on the elements of one file; every element is counted exactly once."""

    file: str
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
    """Coverage of all files of one compilation."""

    def __init__(self) -> None:
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
        total = {v.value: sum(f.totals()[v.value] for f in files) for v in Verdict}
        rows = [
            {"file": f.file, "elements": f.elements, **f.totals(), "by_type": f.by_type()}
            for f in files
        ]
        return {"files": rows, "total": {"elements": sum(total.values()), **total}}
