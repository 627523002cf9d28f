"""Findings as SARIF 2.1.0, which code scanning services read.

Fingerprints come from rule, element and message, never from the line; addresses are relative:
both otherwise make services drop or double alerts (knowledge/reference-codebases.md, section 4).
"""

import hashlib
import json
from urllib.parse import quote

from sysmlc import __version__
from sysmlc.diagnostics.render.report import Finding, Report
from sysmlc.diagnostics.rule import Rule, Severity

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}


def render(report: Report, *, color: bool = False) -> str:
    """The log with one run, also when there is no finding."""
    rules = {f.diagnostic.rule.code: f.diagnostic.rule for f in report.findings}
    ordered = [rules[code] for code in sorted(rules)]
    index = {rule.code: number for number, rule in enumerate(ordered)}
    run = {
        "tool": {"driver": _driver(ordered)},
        "columnKind": "unicodeCodePoints",
        "results": [_result(finding, index) for finding in report.findings],
    }
    log = {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}
    return json.dumps(log, ensure_ascii=False, indent=1) + "\n"


def _driver(rules: list[Rule]) -> dict[str, object]:
    return {
        "name": "sysmlc",
        "semanticVersion": __version__,
        "rules": [
            {
                "id": rule.code,
                "name": rule.name,
                "shortDescription": {"text": rule.name.replace("-", " ")},
                "fullDescription": {"text": rule.read_page().why},
                "defaultConfiguration": {"level": _LEVELS[rule.severity]},
            }
            for rule in rules
        ],
    }


def _result(finding: Finding, index: dict[str, int]) -> dict[str, object]:
    diagnostic = finding.diagnostic
    code = diagnostic.rule.code
    result: dict[str, object] = {
        "ruleId": code,
        "ruleIndex": index[code],
        "level": _LEVELS[diagnostic.severity],
        "message": {"text": _message(finding)},
        "partialFingerprints": {"sysmlc/v1": _fingerprint(finding)},
    }
    location = _location(finding)
    return {**result, "locations": [location]} if location else result


def _message(finding: Finding) -> str:
    diagnostic = finding.diagnostic
    return "\n".join(
        part for part in (diagnostic.message, *diagnostic.notes, diagnostic.help) if part
    )


def _fingerprint(finding: Finding) -> str:
    diagnostic = finding.diagnostic
    who = diagnostic.subject.id or diagnostic.subject.name
    parts = (diagnostic.rule.code, who, diagnostic.message)
    return hashlib.sha256("\x1f".join(parts).encode("utf-8")).hexdigest()[:32]


def _location(finding: Finding) -> dict[str, object]:
    location: dict[str, object] = {}
    if finding.file:
        artifact = {"artifactLocation": {"uri": quote(finding.file.partition("!")[0])}}
        location["physicalLocation"] = artifact | _region(finding)
    if finding.diagnostic.subject.name:
        location["logicalLocations"] = [
            {"fullyQualifiedName": finding.diagnostic.subject.name, "kind": "element"}
        ]
    if finding.xpath:
        location["properties"] = {"xpath": finding.xpath}
    return location


def _region(finding: Finding) -> dict[str, object]:
    if not finding.line or "!" in finding.file:
        return {}
    column = {"startColumn": finding.column} if finding.column else {}
    return {"region": {"startLine": finding.line, **column}}
