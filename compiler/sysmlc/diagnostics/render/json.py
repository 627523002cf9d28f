"""Findings as one JSON document (metamodels/sysmlc-diagnostics.schema.json)."""

import json

from sysmlc.diagnostics.render.report import Finding, Report


def render(report: Report, *, color: bool = False) -> str:
    """The document, also when there is no finding."""
    content = {
        "format": "sysmlc-diagnostics/2",
        "diagnostics": [_finding(finding) for finding in report.findings],
        "summary": report.summary(),
    }
    return json.dumps(content, ensure_ascii=False, indent=1) + "\n"


def _finding(finding: Finding) -> dict[str, object]:
    diagnostic = finding.diagnostic
    return {
        "file": finding.file or None,
        "line": finding.line or None,
        "column": finding.column or None,
        "xpath": finding.xpath or None,
        "severity": diagnostic.severity.value,
        "code": diagnostic.rule.code,
        "name": diagnostic.rule.name,
        "message": diagnostic.message,
        "element": diagnostic.subject.name or None,
        "notes": list(diagnostic.notes),
        "help": diagnostic.help or None,
    }
