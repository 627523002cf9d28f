"""Findings as workflow commands, which GitHub Actions shows beside the changed lines."""

from sysmlc.diagnostics.render.report import Finding, Report
from sysmlc.diagnostics.render.text import summary_line
from sysmlc.diagnostics.rule import Severity
from sysmlc.support.escapes import escape_invisible

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def render(report: Report, *, color: bool = False) -> str:
    """One workflow command a finding, then the summary as a plain line."""
    lines = [_line(finding) for finding in report.findings]
    return "\n".join([*lines, summary_line(report)]) + "\n" if lines else ""


def _line(finding: Finding) -> str:
    diagnostic = finding.diagnostic
    properties = {
        "file": finding.file,
        "line": str(finding.line or ""),
        "col": str(finding.column or ""),
        "title": f"{diagnostic.rule.code} {diagnostic.rule.name}",
    }
    shown = ",".join(f"{key}={_property(value)}" for key, value in properties.items() if value)
    text = "\n".join([diagnostic.message, *diagnostic.notes, diagnostic.help]).strip()
    return f"::{_COMMANDS[diagnostic.severity]} {shown}::{_data(text)}"


def _data(text: str) -> str:
    escaped = text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    return escape_invisible(escaped)


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
