"""Findings as text.

``text`` shows people a headline, an excerpt with a caret, notes and help for each finding. The
other formats have one line for each finding: ``concise`` for editors and grep, ``grouped`` for
people, and ``github`` for GitHub Actions.
"""

import unicodedata
from collections.abc import Callable, Iterable, Iterator
from itertools import groupby

from sysmlc.diagnostics.renderers.report import Finding, Report
from sysmlc.diagnostics.rule import Severity
from sysmlc.support.escapes import escape_invisible

_COLORS = {Severity.ERROR: "31", Severity.WARNING: "33", Severity.INFO: "36"}
_NOUNS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "info"}
_MAX_WIDTH = 100
"""Characters of an excerpt; files of one line are common in XMI."""
_CONTEXT = 40
"""Characters of a longer line that are shown before the location."""

_Paint = Callable[[str, str], str]
"""Returns a text in the colour of an ANSI code."""


def render_text(report: Report, *, color: bool = False) -> str:
    """Return one block for each finding, and the summary; nothing if there is no finding.

    Folded findings share one line for each rule. The XPath of a finding is shown if it has one;
    callers drop XPaths for short output.
    """
    paint = paint_text if color else lambda text, _: text
    blocks = ["\n".join(_format_block(finding, paint)) for finding in report.findings]
    if report.folded:
        blocks.append("\n".join(_format_folded(report.folded, paint)))
    summary = _format_summary(report)
    if report.folded:
        summary += "; --min-severity info shows each info"
    return "\n\n".join([*blocks, summary]) + "\n" if blocks else ""


def _format_summary(report: Report) -> str:
    """Return the line ``2 errors, 1 warning in 1 file``."""
    counts = report.summary()
    parts = [
        _format_count(counts[f"{s.value}s"], _NOUNS[s]) for s in Severity if counts[f"{s.value}s"]
    ]
    files = f" in {_format_count(counts['files'], 'file')}" if counts["files"] else ""
    return f"{', '.join(parts)}{files}" if parts else "no findings"


def paint_text(text: str, code: str) -> str:
    """Return *text* in the colour of an ANSI code; an empty text stays empty."""
    return f"\x1b[{code}m{text}\x1b[0m" if text else text


def _format_count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _format_block(finding: Finding, paint: _Paint) -> Iterator[str]:
    """Yield the lines of a finding."""
    diagnostic = finding.diagnostic
    color = _COLORS[diagnostic.severity]
    message = paint(escape_invisible(diagnostic.message), "1")
    yield f"{_format_head(finding, paint)}: {message}"
    element = f"({diagnostic.subject.name})" if diagnostic.subject.name else ""
    if finding.where or element:
        location = " ".join(escape_invisible(text) for text in (finding.where, element) if text)
        yield f"  {paint('-->', '34')} {location}"
    yield from _format_excerpt(finding, paint, color)
    if finding.xpath:
        yield f"  xpath: {escape_invisible(finding.xpath)}"
    for note in diagnostic.notes:
        yield f"  note: {escape_invisible(note)}"
    if diagnostic.help:
        yield f"  help: {escape_invisible(diagnostic.help)}"


def _format_folded(findings: Iterable[Finding], paint: _Paint) -> Iterator[str]:
    """Yield a line for each rule: its first finding, and the number of the others."""
    by_rule: dict[str, list[Finding]] = {}
    for finding in findings:
        by_rule.setdefault(finding.diagnostic.rule.code, []).append(finding)
    for _, (first, *others) in sorted(by_rule.items()):
        message = escape_invisible(first.diagnostic.message)
        if len(message) > _MAX_WIDTH:
            message = f"{message[: _MAX_WIDTH - 3]}..."
        where = [escape_invisible(first.where)] if first.where else []
        where += [f"{len(others)} more"] if others else []
        suffix = f" ({' and '.join(where)})" if where else ""
        yield f"{_format_head(first, paint)}: {message}{suffix}"


def _format_head(finding: Finding, paint: _Paint) -> str:
    diagnostic = finding.diagnostic
    severity = diagnostic.severity
    head = f"{severity.value}[{diagnostic.rule.code} {diagnostic.rule.name}]"
    return paint(head, f"1;{_COLORS[severity]}")


def _format_excerpt(finding: Finding, paint: _Paint, color: str) -> Iterator[str]:
    """Yield the line of the input with a caret below the column."""
    if not finding.excerpt.strip():
        return
    line, index = _cut_line(finding.excerpt, max(finding.column - 1 - finding.shift, 0))
    gutter = " " * len(str(finding.line))
    yield f" {gutter} |"
    yield f" {finding.line} | {escape_invisible(line)}"
    if finding.column:
        indent = " " * _measure_columns(escape_invisible(line[:index]))
        yield f" {gutter} | {indent}{paint('^', f'1;{color}')}"


def _cut_line(line: str, index: int) -> tuple[str, int]:
    """Return the part of a long line around the character *index*, and its index in the part."""
    line = line.replace("\t", " ")
    if len(line) <= _MAX_WIDTH:
        return line, index
    start = max(index - _CONTEXT, 0)
    part = line[start : start + _MAX_WIDTH]
    prefix, suffix = "..." if start else "", "..." if start + _MAX_WIDTH < len(line) else ""
    return f"{prefix}{part}{suffix}", index - start + len(prefix)


def _measure_columns(text: str) -> int:
    """Return the number of terminal columns: two for a wide character, none for an accent."""
    if text.isascii():
        return len(text)
    wide = sum(unicodedata.east_asian_width(char) in "WF" for char in text)
    marks = sum(unicodedata.combining(char) > 0 for char in text)
    return len(text) + wide - marks


_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def render_concise(report: Report) -> str:
    """Return one line for each finding, as compilers print them, and the summary."""
    return _join_lines(
        [_format_line(finding, finding.where) for finding in report.findings], report
    )


def render_grouped(report: Report) -> str:
    """Return the findings below the names of their files, and the summary."""
    lines: list[str] = []
    by_file = sorted(report.findings, key=lambda finding: finding.file)
    for file, findings in groupby(by_file, key=lambda finding: finding.file):
        lines.append(escape_invisible(file) or "without a file")
        lines += [f"  {_format_line(finding, finding.position)}" for finding in findings]
        lines.append("")
    return _join_lines(lines, report)


def render_github(report: Report) -> str:
    """Return one workflow command for each finding, and the summary as a plain line.

    GitHub Actions shows workflow commands beside the lines that a pull request changes.
    """
    return _join_lines([_format_command(finding) for finding in report.findings], report)


def _join_lines(lines: list[str], report: Report) -> str:
    return "\n".join([*lines, _format_summary(report)]) + "\n" if lines else ""


def _format_line(finding: Finding, where: str) -> str:
    diagnostic = finding.diagnostic
    location = f"{where}: " if where else ""
    rule = f"{diagnostic.rule.code} {diagnostic.rule.name}"
    element = f" ({diagnostic.subject.name})" if diagnostic.subject.name else ""
    return escape_invisible(
        f"{location}{diagnostic.severity.value}[{rule}]: {diagnostic.message}{element}"
    )


def _format_command(finding: Finding) -> str:
    diagnostic = finding.diagnostic
    properties = {
        "file": finding.file,
        "line": str(finding.line or ""),
        "col": str(finding.column or ""),
        "title": f"{diagnostic.rule.code} {diagnostic.rule.name}",
    }
    fields = ",".join(
        f"{key}={_escape_property(value)}" for key, value in properties.items() if value
    )
    text = "\n".join([diagnostic.message, *diagnostic.notes, diagnostic.help]).strip()
    return f"::{_COMMANDS[diagnostic.severity]} {fields}::{_escape_data(text)}"


# The two escapes of workflow commands: properties end at a comma or a colon, data at a line end.


def _escape_data(text: str) -> str:
    escaped = text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    return escape_invisible(escaped)


def _escape_property(text: str) -> str:
    return _escape_data(text).replace(":", "%3A").replace(",", "%2C")
