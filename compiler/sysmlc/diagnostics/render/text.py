"""Findings for people: headline, excerpt with a caret, notes, help, and a summary line."""

import unicodedata
from collections.abc import Iterator

from sysmlc.diagnostics.render.report import Finding, Report
from sysmlc.diagnostics.rule import Severity
from sysmlc.support.escapes import escape_invisible

_COLORS = {Severity.ERROR: "31", Severity.WARNING: "33", Severity.INFO: "36"}
_WIDTH = 100
_BEFORE = 40


def render(report: Report, *, color: bool = False) -> str:
    """All findings, one block each, then how many there are.

    A finding that has an XPath shows it; whoever wants it short leaves it out.
    """
    paint = _paint if color else _plain
    blocks = ["\n".join(_block(finding, paint)) for finding in report.findings]
    return "\n\n".join([*blocks, summary_line(report)]) + "\n" if blocks else ""


def summary_line(report: Report) -> str:
    """``2 errors, 1 warning in 1 file``."""
    counts = report.summary()
    parts = [
        _format_count(counts[f"{s.value}s"], _NOUNS[s]) for s in Severity if counts[f"{s.value}s"]
    ]
    files = f" in {_format_count(counts['files'], 'file')}" if counts["files"] else ""
    return f"{', '.join(parts)}{files}" if parts else "no findings"


_NOUNS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "info"}


def _format_count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


class _Painter:
    """Colours words on a terminal."""

    def __init__(self, is_on: bool) -> None:
        self._is_on = is_on

    def __call__(self, text: str, code: str) -> str:
        return f"\x1b[{code}m{text}\x1b[0m" if self._is_on and text else text


_paint, _plain = _Painter(True), _Painter(False)


def _block(finding: Finding, paint: _Painter) -> Iterator[str]:
    diagnostic = finding.diagnostic
    severity, code = diagnostic.severity, _COLORS[diagnostic.severity]
    head = paint(f"{severity.value}[{diagnostic.rule.code} {diagnostic.rule.name}]", f"1;{code}")
    yield f"{head}: {paint(escape_invisible(diagnostic.message), '1')}"
    if finding.where or diagnostic.subject.name:
        yield "  " + paint("-->", "34") + " " + " ".join(_where(finding))
    yield from _excerpt(finding, paint, code)
    if finding.xpath:
        yield f"  xpath: {escape_invisible(finding.xpath)}"
    for note in diagnostic.notes:
        yield f"  note: {escape_invisible(note)}"
    if diagnostic.help:
        yield f"  help: {escape_invisible(diagnostic.help)}"


def _where(finding: Finding) -> Iterator[str]:
    if finding.where:
        yield escape_invisible(finding.where)
    if finding.diagnostic.subject.name:
        yield f"({escape_invisible(finding.diagnostic.subject.name)})"


def _excerpt(finding: Finding, paint: _Painter, code: str) -> Iterator[str]:
    if not finding.excerpt.strip():
        return
    shown, at = _window(finding.excerpt, max(finding.column - 1 - finding.shift, 0))
    gutter = " " * len(str(finding.line))
    yield f" {gutter} |"
    yield f" {finding.line} | {escape_invisible(shown)}"
    if finding.column:
        yield f" {gutter} | {' ' * _columns(escape_invisible(shown[:at]))}{paint('^', f'1;{code}')}"


def _window(line: str, at: int) -> tuple[str, int]:
    """The part of a long line around the place; files of one line are common in XMI."""
    line = line.replace("\t", " ")
    if len(line) <= _WIDTH:
        return line, at
    start = max(at - _BEFORE, 0)
    cut = line[start : start + _WIDTH]
    before, after = "..." if start else "", "..." if start + _WIDTH < len(line) else ""
    return f"{before}{cut}{after}", at - start + len(before)


def _columns(text: str) -> int:
    """Columns of a terminal that the text takes."""
    if text.isascii():
        return len(text)
    wide = sum(unicodedata.east_asian_width(sign) in "WF" for sign in text)
    marks = sum(unicodedata.combining(sign) > 0 for sign in text)
    return len(text) + wide - marks
