"""Renderers: the formats in which diagnostics and coverage are shown."""

from collections.abc import Callable

from sysmlc.diagnostics.renderers.json_documents import (
    render_failure,
    render_json,
    render_sarif,
)
from sysmlc.diagnostics.renderers.report import Finding, Report, make_report, merge_facts, shorten
from sysmlc.diagnostics.renderers.text import (
    render_concise,
    render_github,
    render_grouped,
    render_text,
)

__all__ = [
    "FORMATS",
    "XPATH_FORMATS",
    "Finding",
    "Report",
    "make_report",
    "merge_facts",
    "render",
    "render_failure",
    "render_json",
    "shorten",
]

_RENDERERS: dict[str, Callable[[Report], str]] = {
    "concise": render_concise,
    "grouped": render_grouped,
    "json": render_json,
    "sarif": render_sarif,
    "github": render_github,
}
"""Renderers of the formats without colours."""

FORMATS = ("text", *_RENDERERS)
"""Names of the formats of ``--format``."""

XPATH_FORMATS = frozenset({"json", "sarif"})
"""Formats that give the XPath of an element; the format text does so with ``--verbose``."""


def render(report: Report, format: str, *, color: bool = False) -> str:
    """Return the report in a format; formats for people are empty if there is no finding."""
    return render_text(report, color=color) if format == "text" else _RENDERERS[format](report)
