"""Diagnostics: rules, the sink that collects diagnostics, and coverage of inputs."""

from sysmlc.diagnostics.coverage import Coverage, FileCoverage, Verdict
from sysmlc.diagnostics.diagnostic import KEY_MARK, Diagnostic, Place, Subject
from sysmlc.diagnostics.rule import Rule, Severity, catalogue, rule
from sysmlc.diagnostics.sink import Sink, Wording

__all__ = [
    "KEY_MARK",
    "Coverage",
    "Diagnostic",
    "FileCoverage",
    "Place",
    "Rule",
    "Severity",
    "Sink",
    "Subject",
    "Verdict",
    "Wording",
    "catalogue",
    "rule",
]
