"""Findings: what the checks of recipe models return, and how it is reported."""

from collections.abc import Callable, Iterator, Mapping

from msgspec import Struct, field

from sysmlc.diagnostics import Rule, Sink, Subject
from sysmlc.recipe.model import Model
from sysmlc.recipe.tables import Tables

Locate = Callable[[str], Subject]
"""Returns the element with an id as the subject of a diagnostic."""


class Finding(Struct, frozen=True):
    """A violation of a rule: the id of an element, and the facts for the message."""

    rule: Rule
    element: str
    facts: Mapping[str, object] = field(default_factory=dict)


Check = Callable[[Model, Tables], Iterator[Finding]]
"""Yields the violations of one or more rules by a model, whose tables are given, too."""


def report_findings(findings: Iterator[Finding], sink: Sink, locate: Locate) -> None:
    """Report each finding at its element, which *locate* finds."""
    for finding in findings:
        sink.report(finding.rule, locate(finding.element), **finding.facts)  # type: ignore[arg-type]
