"""Findings in one line each.

``concise`` is for editors and grep, ``grouped`` for people, and ``github`` for GitHub Actions.
"""

from itertools import groupby

from sysmlc.diagnostics.renderers.report import Finding, Report
from sysmlc.diagnostics.renderers.text import format_summary
from sysmlc.diagnostics.rule import Severity
from sysmlc.support.escapes import escape_invisible

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
    return "\n".join([*lines, format_summary(report)]) + "\n" if lines else ""


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
