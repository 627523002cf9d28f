"""The verdict on every element of a unit's inputs, for ``sysmlc coverage``.

Only the front ends run: no pass and no back end is needed.
"""

from pathlib import Path

from msgspec import Struct

from sysmlc.diagnostics import Coverage, Diagnostic
from sysmlc.diagnostics.coverage_report import FileReport, iter_file_reports
from sysmlc.driver import faults
from sysmlc.driver.compilation import OpenedUnit, Request, open_unit
from sysmlc.ir import Graph
from sysmlc.sources import Source, SourceError


class UnitCoverage(Struct, frozen=True):
    """The coverage of one unit, and the diagnostics of reading its files."""

    root: Path
    files: tuple[FileReport, ...]
    diagnostics: tuple[Diagnostic, ...]
    sources: tuple[Source, ...]


def measure_coverage(request: Request, opened: OpenedUnit | None = None) -> UnitCoverage:
    """Read the inputs of a request and collect the verdicts on their elements."""
    opened = opened or open_unit(request)
    coverage, graph = Coverage(is_detailed=True), Graph()
    sources = opened.reading.sources()
    for frontend in opened.frontends:
        own_sources = [r.source for r in opened.reading.recognised if r.frontend is frontend]
        try:
            if own_sources:
                frontend.read(own_sources, graph, opened.sink, coverage)
        except SourceError as problem:
            faults.report_unreadable(problem, opened.sink)
    return UnitCoverage(
        opened.root,
        tuple(iter_file_reports(coverage, sources, lambda id: _find_name(graph, id))),
        tuple(opened.sink),
        sources,
    )


def _find_name(graph: Graph, id: str) -> str:
    element = graph.get(id)
    return graph.qualified_name(element) if element is not None else ""
