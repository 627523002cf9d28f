"""Findings as JSON documents for programs: our own format ``json``, and SARIF 2.1.0."""

import hashlib
from collections.abc import Mapping
from urllib.parse import quote

from sysmlc import __version__
from sysmlc.diagnostics.renderers.report import Finding, Report
from sysmlc.diagnostics.rule import Rule, Severity
from sysmlc.support.output import encode_json

SARIF_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_SARIF_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}


_NO_DETAILS: Mapping[str, object] = {}


def render_json(report: Report, details: Mapping[str, object] = _NO_DETAILS) -> str:
    """Return the format ``sysmlc-diagnostics/2`` (metamodels/sysmlc-diagnostics.schema.json).

    *details* are further members of the document.
    """
    return encode_json(
        {
            "format": "sysmlc-diagnostics/2",
            "diagnostics": [_describe_finding(finding) for finding in report.findings],
            "summary": report.summary(),
            **details,
        }
    )


def _describe_finding(finding: Finding) -> dict[str, object]:
    diagnostic = finding.diagnostic
    return {
        "file": finding.file or None,
        "line": finding.line or None,
        "column": finding.column or None,
        "end_line": finding.end_line or None,
        "end_column": finding.end_column or None,
        "xpath": finding.xpath or None,
        "severity": diagnostic.severity.value,
        "code": diagnostic.rule.code,
        "name": diagnostic.rule.name,
        "message": diagnostic.message,
        "element": diagnostic.subject.name or None,
        "notes": list(diagnostic.notes),
        "help": diagnostic.help or None,
    }


# -- SARIF -------------------------------------------------------------------------------------


def render_sarif(report: Report) -> str:
    """Return a SARIF log with one run, for code scanning services."""
    rules_by_code = {f.diagnostic.rule.code: f.diagnostic.rule for f in report.findings}
    rules = [rules_by_code[code] for code in sorted(rules_by_code)]
    rule_index = {rule.code: index for index, rule in enumerate(rules)}
    results = [_describe_result(finding, rule_index) for finding in report.findings]
    return _encode_sarif(rules, results)


def _encode_sarif(rules: list[Rule], results: list[dict[str, object]], **members: object) -> str:
    """Return a SARIF log with one run; *members* are further members of the run."""
    run = {
        "tool": {"driver": _describe_tool(rules)},
        "columnKind": "unicodeCodePoints",
        "results": results,
        **members,
    }
    return encode_json({"$schema": SARIF_SCHEMA, "version": "2.1.0", "runs": [run]})


def render_failure(message: str, format: str) -> str:
    """Return the document of a command that could not do its work, in ``json`` or ``sarif``.

    A program that reads the output gets a valid document with the reason instead of an empty file.
    """
    if format == "json":
        return render_json(Report(()), {"failure": message})
    notification = {"level": "error", "message": {"text": message}}
    invocation = {"executionSuccessful": False, "toolExecutionNotifications": [notification]}
    return _encode_sarif([], [], invocations=[invocation])


def _describe_tool(rules: list[Rule]) -> dict[str, object]:
    return {
        "name": "sysmlc",
        "semanticVersion": __version__,
        "rules": [
            {
                "id": rule.code,
                "name": rule.name,
                "shortDescription": {"text": rule.name.replace("-", " ")},
                "fullDescription": {"text": rule.read_page().why},
                "defaultConfiguration": {"level": _SARIF_LEVELS[rule.severity]},
            }
            for rule in rules
        ],
    }


def _describe_result(finding: Finding, rule_index: dict[str, int]) -> dict[str, object]:
    diagnostic = finding.diagnostic
    code = diagnostic.rule.code
    texts = (diagnostic.message, *diagnostic.notes, diagnostic.help)
    result: dict[str, object] = {
        "ruleId": code,
        "ruleIndex": rule_index[code],
        "level": _SARIF_LEVELS[diagnostic.severity],
        "message": {"text": "\n".join(text for text in texts if text)},
        "partialFingerprints": {"sysmlc/v1": _compute_fingerprint(finding)},
    }
    location = _describe_location(finding)
    return {**result, "locations": [location]} if location else result


def _compute_fingerprint(finding: Finding) -> str:
    """Return a digest of rule, element and message.

    The line is not part of it: a service would drop or double an alert when lines move.
    """
    diagnostic = finding.diagnostic
    element = diagnostic.subject.id or diagnostic.subject.name
    parts = (diagnostic.rule.code, element, diagnostic.message)
    return hashlib.sha256("\x1f".join(parts).encode("utf-8")).hexdigest()[:32]


def _describe_location(finding: Finding) -> dict[str, object]:
    location: dict[str, object] = {}
    if finding.file:
        # A relative address of the archive; SARIF has none for an entry of an archive.
        artifact = {"artifactLocation": {"uri": quote(finding.file.partition("!")[0])}}
        location["physicalLocation"] = artifact | _describe_region(finding)
    if finding.diagnostic.subject.name:
        location["logicalLocations"] = [
            {"fullyQualifiedName": finding.diagnostic.subject.name, "kind": "element"}
        ]
    if finding.xpath:
        location["properties"] = {"xpath": finding.xpath}
    return location


def _describe_region(finding: Finding) -> dict[str, object]:
    if not finding.line or "!" in finding.file:
        return {}
    region = {
        "startLine": finding.line,
        "startColumn": finding.column,
        "endLine": finding.end_line,
        "endColumn": finding.end_column,
    }
    return {"region": {name: number for name, number in region.items() if number}}
