"""Findings in one line each, as compilers print them: editors and grep read it."""

from sysmlc.diagnostics.render.report import Finding, Report
from sysmlc.diagnostics.render.text import summary_line
from sysmlc.support.escapes import escape_invisible


def render(report: Report, *, color: bool = False) -> str:
    """One line a finding, then the summary."""
    lines = [_line(finding) for finding in report.findings]
    return "\n".join([*lines, summary_line(report)]) + "\n" if lines else ""


def _line(finding: Finding) -> str:
    diagnostic = finding.diagnostic
    where = f"{finding.where}: " if finding.where else ""
    rule = f"{diagnostic.rule.code} {diagnostic.rule.name}"
    element = f" ({diagnostic.subject.name})" if diagnostic.subject.name else ""
    return escape_invisible(
        f"{where}{diagnostic.severity.value}[{rule}]: {diagnostic.message}{element}"
    )
