"""What becomes of every element of a unit's inputs, for ``sysmlc coverage``: no pass, no output."""

from pathlib import Path

from msgspec import Struct

from sysmlc.diagnostics import Coverage, Diagnostic
from sysmlc.diagnostics.coverage_report import FileReport, file_reports
from sysmlc.driver import faults
from sysmlc.driver.compilation import Opened, Request, open_unit
from sysmlc.ir import Graph
from sysmlc.sources import Source, SourceError


class Covered(Struct, frozen=True):
    """The coverage of one unit, and what was found wrong while its files were read."""

    root: Path
    files: tuple[FileReport, ...]
    diagnostics: tuple[Diagnostic, ...]
    sources: tuple[Source, ...]


def cover(request: Request, opened: Opened | None = None) -> Covered:
    """Read the inputs of a request, and say what became of their elements."""
    opened = opened or open_unit(request)
    coverage, graph = Coverage(is_detailed=True), Graph()
    sources = opened.reading.sources()
    for frontend in opened.frontends:
        ours = [r.source for r in opened.reading.recognised if r.frontend is frontend]
        try:
            if ours:
                frontend.read(ours, graph, opened.sink, coverage)
        except SourceError as problem:
            faults.report_unreadable(problem, opened.sink)
    return Covered(
        opened.root,
        tuple(file_reports(coverage, sources, lambda id: _name(graph, id))),
        tuple(opened.sink),
        sources,
    )


def _name(graph: Graph, id: str) -> str:
    element = graph.get(id)
    return graph.qualified_name(element) if element is not None else ""
