"""Findings with everything that a renderer shows: file, line, column, excerpt, counts."""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping

from msgspec import Struct

from sysmlc.diagnostics.diagnostic import Diagnostic, Place
from sysmlc.diagnostics.locate import Location, locate
from sysmlc.diagnostics.rule import Severity
from sysmlc.sources import Source


class Finding(Struct, frozen=True):
    """One finding with its place; line and column count characters from 1, 0 is unknown."""

    diagnostic: Diagnostic
    file: str = ""
    line: int = 0
    column: int = 0
    excerpt: str = ""
    """The line of the input, without its line end; of a long line the part around the place."""
    xpath: str = ""
    """Way through the XML file to the element, or to the innermost one that is open there."""
    shift: int = 0
    """Characters of the line before the excerpt."""

    @property
    def where(self) -> str:
        """``file:line:column`` as far as it is known."""
        known = [self.file, *(str(n) for n in (self.line, self.column) if n)]
        return ":".join(known) if self.file else ""


class Report(Struct, frozen=True):
    """All findings of one compilation, in order."""

    findings: tuple[Finding, ...]
    left: tuple[Finding, ...] = ()
    """Findings that are counted but not shown."""

    def summary(self) -> dict[str, int]:
        """Number of findings of each severity, and of files that they are in."""
        every = (*self.findings, *self.left)
        counts = Counter(finding.diagnostic.severity for finding in every)
        files = {finding.file for finding in every if finding.file}
        numbers = {f"{severity.value}s": counts[severity] for severity in Severity}
        return {**numbers, "files": len(files)}


def shorten(findings: Iterable[Finding], most: int) -> Report:
    """Return a report with at most *most* findings (0: all), the worst, in their order."""
    all_findings = list(findings)
    order = list(Severity)
    ranked = sorted(
        range(len(all_findings)),
        key=lambda index: order.index(all_findings[index].diagnostic.severity),
    )
    shown = set(ranked[:most] if most else ranked)
    return Report(
        tuple(finding for index, finding in enumerate(all_findings) if index in shown),
        tuple(finding for index, finding in enumerate(all_findings) if index not in shown),
    )


def make_report(
    diagnostics: Iterable[Diagnostic],
    sources: Iterable[Source],
    shown_name: Callable[[str], str] = str,
) -> Report:
    """The findings with lines, columns, excerpts and XPaths.

    ``shown_name`` makes of a file's name in the unit the one that the reader knows (usually
    relative to the working folder).
    """
    diagnostics = list(diagnostics)
    places = [d.subject.place for d in diagnostics if d.subject.place]
    found = locate(sources, places, with_xpath=True)
    return Report(tuple(_finding(diagnostic, found, shown_name) for diagnostic in diagnostics))


def _finding(
    diagnostic: Diagnostic, found: Mapping[Place, Location], shown_name: Callable[[str], str]
) -> Finding:
    place = diagnostic.subject.place
    if place is None:
        return Finding(diagnostic)
    at = found.get(place)
    file = shown_name(place.file)
    if at is None:
        return Finding(diagnostic, file, place.line, place.column)
    return Finding(diagnostic, file, at.line, at.column, at.text, at.xpath, at.shift)
