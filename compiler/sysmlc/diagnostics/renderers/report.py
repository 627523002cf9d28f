"""Findings: diagnostics with what renderers show, such as line, column and excerpt."""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping

from msgspec import Struct
from msgspec.structs import replace

from sysmlc.diagnostics.diagnostic import Diagnostic, Place, format_position
from sysmlc.diagnostics.locations import Location, locate
from sysmlc.diagnostics.rule import Severity
from sysmlc.sources import Source


class Finding(Struct, frozen=True):
    """A diagnostic with its location; lines and columns count characters from 1, 0 is unknown."""

    diagnostic: Diagnostic
    file: str = ""
    line: int = 0
    column: int = 0
    excerpt: str = ""
    """The line of the input, without its line end; of a long line the part around the column."""
    xpath: str = ""
    """XPath of the element, or of the innermost element that is open at the location."""
    shift: int = 0
    """Number of characters of the line before the excerpt."""
    end_line: int = 0
    end_column: int = 0
    """Column behind the start tag or the word that stands at the location."""

    @property
    def where(self) -> str:
        """``file:line:column`` as far as they are known, empty without a file."""
        return format_position(self.file, self.line, self.column) if self.file else ""

    @property
    def position(self) -> str:
        """``line:column`` as far as they are known."""
        return self.where.removeprefix(self.file).removeprefix(":")


class Report(Struct, frozen=True):
    """The findings of one compilation, in order."""

    findings: tuple[Finding, ...]
    hidden: tuple[Finding, ...] = ()
    """Findings that are counted but not shown."""
    folded: tuple[Finding, ...] = ()
    """Findings of which the text for people has one line for each rule."""

    def summary(self) -> dict[str, int]:
        """Return the number of findings of each severity, and of files with findings."""
        findings = (*self.findings, *self.hidden, *self.folded)
        counts = Counter(finding.diagnostic.severity for finding in findings)
        files = {finding.file for finding in findings if finding.file}
        numbers = {f"{severity.value}s": counts[severity] for severity in Severity}
        return {**numbers, "files": len(files)}


def shorten(findings: Iterable[Finding], limit: int) -> Report:
    """Return a report that shows the *limit* most severe findings, in order; 0 shows all."""
    all_findings = list(findings)
    order = list(Severity)
    ranked = sorted(
        range(len(all_findings)),
        key=lambda index: order.index(all_findings[index].diagnostic.severity),
    )
    shown = set(ranked[:limit] if limit else ranked)
    return Report(
        tuple(finding for index, finding in enumerate(all_findings) if index in shown),
        tuple(finding for index, finding in enumerate(all_findings) if index not in shown),
    )


def make_report(
    diagnostics: Iterable[Diagnostic],
    sources: Iterable[Source],
    shown_name: Callable[[str], str] = str,
) -> Report:
    """Return the diagnostics with lines, columns, excerpts and XPaths.

    *shown_name* converts the name of a file in the compile unit to the name that users see, which
    is usually relative to the working folder.
    """
    diagnostics = list(diagnostics)
    places = [d.subject.place for d in diagnostics if d.subject.place]
    locations = locate(sources, places, with_xpath=True)
    return Report(tuple(_make_finding(d, locations, shown_name) for d in diagnostics))


# -- findings about one fact -------------------------------------------------------------------


def merge_facts(findings: Iterable[Finding]) -> list[Finding]:
    """Return the first finding about each fact in a file, with a note for each further one.

    Findings of one severity with the same cause are about one fact. So are warnings and infos of
    one rule with the same message; errors are not, because each of them has to be corrected.
    """
    return _merge(_merge(findings, _key_by_cause), _key_by_message)


def _key_by_cause(finding: Finding) -> tuple[str, ...]:
    diagnostic = finding.diagnostic
    return (finding.file, diagnostic.severity, diagnostic.cause) if diagnostic.cause else ()


def _key_by_message(finding: Finding) -> tuple[str, ...]:
    diagnostic = finding.diagnostic
    is_error = diagnostic.is_error
    return () if is_error else (finding.file, diagnostic.rule.code, diagnostic.message)


def _merge(
    findings: Iterable[Finding], key_of: Callable[[Finding], tuple[str, ...]]
) -> list[Finding]:
    """Return the findings, one for each key; those with an empty key are not merged."""
    groups: dict[object, list[Finding]] = {}
    for number, finding in enumerate(findings):
        groups.setdefault(key_of(finding) or number, []).append(finding)
    return [_add_places(first, others) for first, *others in groups.values()]


def _add_places(finding: Finding, others: list[Finding]) -> Finding:
    """Return a finding with the number of places of the fact, and notes about the others."""
    if not others:
        return finding
    diagnostic = finding.diagnostic
    places = {(each.where, each.diagnostic.subject.name) for each in (finding, *others)}
    message = diagnostic.message + (f" ({len(places)} places)" if len(places) > 1 else "")
    notes = [*diagnostic.notes]
    for other in others:
        notes += [_describe_other(finding, other), *other.diagnostic.notes]
    merged = replace(diagnostic, message=message, notes=tuple(dict.fromkeys(notes)))
    return replace(finding, diagnostic=merged)


def _describe_other(finding: Finding, other: Finding) -> str:
    """Return the place of another finding about the fact, with what differs in it."""
    diagnostic, name = other.diagnostic, other.diagnostic.subject.name
    where = f" ({other.where})" if other.where else ""
    if name != finding.diagnostic.subject.name:
        return f"also {name}{where}"
    if diagnostic.message != finding.diagnostic.message:
        return f"also: {diagnostic.message}{where}"
    return f"also{where}"


def _make_finding(
    diagnostic: Diagnostic, locations: Mapping[Place, Location], shown_name: Callable[[str], str]
) -> Finding:
    place = diagnostic.subject.place
    if place is None:
        return Finding(diagnostic)
    file, location = shown_name(place.file), locations.get(place)
    if location is None:
        return Finding(diagnostic, file, place.line, place.column)
    return Finding(
        diagnostic,
        file,
        location.line,
        location.column,
        location.text,
        location.xpath,
        location.shift,
        location.end_line,
        location.end_column,
    )
