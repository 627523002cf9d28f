"""Coverage with lines, columns and names, ready to be shown."""

from collections.abc import Callable, Iterable, Iterator, Mapping

from msgspec import Struct

from sysmlc.diagnostics.coverage import Coverage, Loss, Verdict, covered_tenths, sum_counts
from sysmlc.diagnostics.diagnostic import Place
from sysmlc.diagnostics.locate import Location, locate
from sysmlc.sources import Source

LOSSES = (Verdict.UNSUPPORTED, Verdict.APPROXIMATED, Verdict.EXTERNAL)
"""What matters of what is not mapped, the worst first."""


class LostElement(Struct, frozen=True):
    """One loss, and where it is; ``element`` is a qualified name in the modeller's words."""

    loss: Loss
    file: str
    element: str
    line: int = 0
    column: int = 0
    xpath: str = ""

    @property
    def where(self) -> str:
        """``file:line:column`` as far as it is known."""
        return ":".join([self.file, *(str(n) for n in (self.line, self.column) if n)])


class FileReport(Struct, frozen=True):
    """Coverage of one file: counts by verdict, counts by type, what is lost."""

    file: str
    totals: Mapping[str, int]
    by_type: Mapping[str, Mapping[str, int]]
    losses: tuple[LostElement, ...]


class TypeReport(Struct, frozen=True):
    """Coverage of one type of element in all files."""

    name: str
    counts: Mapping[str, int]
    losses: tuple[LostElement, ...]


def file_reports(
    coverage: Coverage, sources: Iterable[Source], name_of: Callable[[str], str]
) -> Iterator[FileReport]:
    """The files by name; ``name_of`` gives the qualified name of an id of the graph."""
    by_name = {source.name: source for source in sources}
    for file in coverage.files():
        places = [Place(file.file, loss.ordinal) for loss in file.losses]
        source = [by_name[file.file]] if file.file in by_name else []
        found = locate(source, places, with_xpath=True)
        names = {owner: name_of(owner) for owner in dict.fromkeys(x.owner for x in file.losses)}
        pairs = zip(file.losses, places, strict=True)
        lost = tuple(_lost(loss, place, names[loss.owner], found) for loss, place in pairs)
        yield FileReport(file.file, file.totals(), file.by_type(), lost)


def _lost(loss: Loss, place: Place, owner: str, found: Mapping[Place, Location]) -> LostElement:
    name = "::".join(part for part in (owner, loss.name) if part) or place.file
    at = found.get(place)
    if at is None:
        return LostElement(loss, place.file, name)
    return LostElement(loss, place.file, name, at.line, at.column, at.xpath)


def type_reports(files: Iterable[FileReport]) -> list[TypeReport]:
    """The types of all files, worst first: by number of elements of each verdict, then by name."""
    files = list(files)
    lost: dict[str, list[LostElement]] = {}
    for file in files:
        for one in file.losses:
            lost.setdefault(one.loss.type, []).append(one)
    names = dict.fromkeys(name for file in files for name in file.by_type)
    every = [
        TypeReport(
            name,
            sum_counts(file.by_type[name] for file in files if name in file.by_type),
            tuple(lost.get(name, ())),
        )
        for name in names
    ]
    return sorted(every, key=lambda one: (*_badness(one.counts), one.name))


def worst_first(files: Iterable[FileReport]) -> list[FileReport]:
    """The files that are covered least first; of equal ones by name."""
    return sorted(files, key=lambda file: (covered_tenths(file.totals), file.file))


def _badness(counts: Mapping[str, int]) -> tuple[int, ...]:
    order = (*LOSSES, Verdict.MAPPED, Verdict.IGNORED_NOTATION)
    return tuple(-counts[verdict.value] for verdict in order)
