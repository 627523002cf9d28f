"""``sysmlc coverage``: count which elements of the models are read."""

from pathlib import Path
from typing import TYPE_CHECKING

import click
from msgspec.structs import replace

from sysmlc.cli import options

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from sysmlc.diagnostics.coverage_report import FileReport
    from sysmlc.driver.coverage import UnitCoverage


@click.command(
    "coverage",
    short_help="Show which elements of models are read, and which are lost.",
    epilog="""\b
Examples:
  sysmlc coverage plant.mdzip
  sysmlc coverage models/ --elements          # every element that is not read completely
  sysmlc coverage models/ --fail-under 99.5   # for continuous integration""",
)
@options.models()
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "json", "sarif"]),
    default="text",
    show_default=True,
    help="Form of the report; json lists every element that is not mapped.",
)
@click.option(
    "--elements", "every", is_flag=True, help="List all locations, not three of each kind."
)
@click.option(
    "--fail-under",
    type=click.FloatRange(0, 100),
    metavar="PERCENT",
    help="Exit with 1 if fewer of the elements with a meaning are covered.",
)
@options.configuration
@click.pass_context
def command(
    ctx: click.Context,
    /,
    models: tuple[Path, ...],
    form: str,
    every: bool,
    fail_under: float | None,
    config: Path | None,
    isolated: bool,
) -> None:
    """Count the verdicts on every element of MODEL... by type, the worst types first.

    An element is covered if it is in the graph with its complete meaning, or refers to an element
    of another file. Drawings and settings of tools do not count.
    """
    from sysmlc.cli import session
    from sysmlc.cli.units import open_units
    from sysmlc.driver.coverage import measure_coverage

    settings = session.Settings(config, isolated)
    loaded = session.load_config(models, settings)
    units = open_units(models, loaded, settings, None)
    coverages = [measure_coverage(unit.request, unit.opened) for unit in units]
    code = max(_report_errors(coverage) for coverage in coverages)
    file_reports = {file.file: file for coverage in coverages for file in _localize_files(coverage)}
    files = [file_reports[name] for name in sorted(file_reports)]
    if code < 2 and (files or form != "text"):
        _print(files, form, every)
    ctx.exit(max(code, int(_is_below(files, fail_under))))


def _report_errors(coverage: "UnitCoverage") -> int:
    """Print the errors found while reading; return the exit code."""
    from sysmlc.cli import reports, session
    from sysmlc.diagnostics.renderers import make_report
    from sysmlc.driver import faults

    errors = [diagnostic for diagnostic in coverage.diagnostics if diagnostic.is_error]
    if errors:
        shown = reports.localize(coverage.root, make_report(errors, coverage.sources).findings)
        reports.print_findings(shown, session.Settings())
    return faults.compute_exit_code(errors)


def _localize_files(coverage: "UnitCoverage") -> "Iterable[FileReport]":
    """Return the file reports with names relative to the working folder."""
    from sysmlc.cli.reports import localize_name

    for file in coverage.files:
        name = localize_name(coverage.root, file.file)
        yield replace(file, file=name, losses=tuple(replace(x, file=name) for x in file.losses))


def _print(files: "Sequence[FileReport]", form: str, every: bool) -> None:
    import sys

    from sysmlc.cli.reports import has_color
    from sysmlc.diagnostics.renderers import coverage

    if form == "text":
        text = coverage.render_text(files, color=has_color(sys.stdout), with_all_losses=every)
    else:
        text = coverage.FORMATS[form](files)
    # has_color has decided; without color=True click would decide again.
    click.echo(text, nl=False, color=True)


def _is_below(files: "Sequence[FileReport]", limit: float | None) -> bool:
    from sysmlc.diagnostics.coverage import count_covered, count_meaningful, sum_counts

    total = sum_counts(file.totals for file in files)
    return limit is not None and 100 * count_covered(total) < limit * count_meaningful(total)
