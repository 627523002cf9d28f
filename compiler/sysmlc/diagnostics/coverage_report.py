"""Coverage by file and by type, with the locations and qualified names of losses."""

from collections.abc import Callable, Iterable, Iterator, Mapping

from msgspec import Struct

from sysmlc.diagnostics.coverage import (
    Coverage,
    FileCoverage,
    Loss,
    Verdict,
    compute_covered_permille,
    sum_counts,
)
from sysmlc.diagnostics.diagnostic import Place, format_position
from sysmlc.diagnostics.locations import Location, locate
from sysmlc.sources import Source

LOSSES = (Verdict.UNSUPPORTED, Verdict.APPROXIMATED, Verdict.EXTERNAL)
"""Verdicts that are listed as losses, the worst first."""
WORST_FIRST = (*LOSSES, Verdict.MAPPED, Verdict.IGNORED_NOTATION)
"""All verdicts."""


class LostElement(Struct, frozen=True):
    """A loss with its location; ``element`` is a qualified name in the modeller's words."""

    loss: Loss
    file: str
    element: str
    line: int = 0
    column: int = 0
    xpath: str = ""

    @property
    def where(self) -> str:
        """``file:line:column`` as far as they are known."""
        return format_position(self.file, self.line, self.column)


class FileReport(Struct, frozen=True):
    """Coverage of one file: counts by verdict, counts by type, and losses."""

    file: str
    totals: Mapping[str, int]
    by_type: Mapping[str, Mapping[str, int]]
    losses: tuple[LostElement, ...]


class TypeReport(Struct, frozen=True):
    """Coverage of one type of element in all files."""

    name: str
    counts: Mapping[str, int]
    losses: tuple[LostElement, ...]


def iter_file_reports(
    coverage: Coverage, sources: Iterable[Source], name_of: Callable[[str], str]
) -> Iterator[FileReport]:
    """Yield the reports of the files, sorted by name.

    *name_of* returns the qualified name of an id of the graph.
    """
    sources_by_name = {source.name: source for source in sources}
    for file in coverage.files():
        source = sources_by_name.get(file.file)
        losses = tuple(_locate_losses(file, [source] if source else [], name_of))
        yield FileReport(file.file, file.totals(), file.by_type(), losses)


def _locate_losses(
    file: FileCoverage, sources: Iterable[Source], name_of: Callable[[str], str]
) -> Iterator[LostElement]:
    places = [Place(file.file, loss.ordinal) for loss in file.losses]
    locations = locate(sources, places, with_xpath=True)
    owners = dict.fromkeys(loss.owner for loss in file.losses)
    owner_names = {owner: name_of(owner) for owner in owners}
    for loss, place in zip(file.losses, places, strict=True):
        names = (owner_names[loss.owner], loss.name)
        element = "::".join(name for name in names if name) or file.file
        location = locations.get(place, Location(0, 0, ""))
        yield LostElement(loss, file.file, element, location.line, location.column, location.xpath)


def make_type_reports(files: Iterable[FileReport]) -> list[TypeReport]:
    """Return the reports of the types of all files.

    The type with most elements of the worst verdict comes first. The second worst verdict decides
    between types with equally many, and so on, and finally the name.
    """
    files = list(files)
    losses: dict[str, list[LostElement]] = {}
    for file in files:
        for lost in file.losses:
            losses.setdefault(lost.loss.type, []).append(lost)
    names = dict.fromkeys(name for file in files for name in file.by_type)
    reports = [
        TypeReport(
            name,
            sum_counts(file.by_type[name] for file in files if name in file.by_type),
            tuple(losses.get(name, ())),
        )
        for name in names
    ]
    return sorted(
        reports, key=lambda r: (*(-r.counts[verdict.value] for verdict in WORST_FIRST), r.name)
    )


def sort_by_coverage(files: Iterable[FileReport]) -> list[FileReport]:
    """Return the reports of files, the least covered first, and then by name."""
    return sorted(files, key=lambda file: (compute_covered_permille(file.totals), file.file))
