"""``sysmlc check``: print the findings about models; write nothing."""

from pathlib import Path
from typing import Any

import click

from sysmlc.cli import options


@click.command(
    "check",
    short_help="Report the faults of models; write nothing.",
    epilog="""\b
Examples:
  sysmlc check models/
  sysmlc check plant.uml --strict --format github
  sysmlc check plant.uml --format sarif > findings.sarif""",
)
@options.models()
@options.emitting
@options.reporting
@options.reading
@options.caching
@click.pass_context
def command(
    ctx: click.Context,
    /,
    models: tuple[Path, ...],
    **setting_values: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Compile MODEL... in memory and report the same findings as 'build'."""
    from sysmlc.cli import reports, session
    from sysmlc.cli.units import open_units

    settings = session.Settings(**setting_values, uses_shipped_templates=True)
    config = session.load_config(models, settings)
    units = open_units(models, config, settings, None)
    outcomes = session.compile_units(units, settings, has_files=False)
    reports.report_outcomes(outcomes, settings)
    if settings.form == "text" and not any(outcome.findings for outcome in outcomes):
        click.echo("no findings", err=True)
    ctx.exit(reports.exit_code_of_all(units, outcomes, settings))
