"""``sysmlc simulate``: run a scenario against the behaviour of a model."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from msgspec import Struct

from sysmlc.cli import options, terminal
from sysmlc.support.escapes import escape_undecodable

if TYPE_CHECKING:
    from sysmlc.backends.base import InputFile
    from sysmlc.diagnostics.renderers import Finding
    from sysmlc.sources import Source


class _Scenario(Struct, frozen=True):
    """The file of a scenario as a unit that was read."""

    root: Path
    inputs: "tuple[InputFile, ...]"


@click.command(
    "simulate",
    short_help="Run a scenario with the reference interpreter.",
    epilog="""\b
Examples:
  sysmlc simulate gate.uml --variables
  sysmlc simulate gate.uml --scenario wrong-id.yaml
  sysmlc simulate gate.uml --scenario wrong-id.yaml --junit report.xml -o out/""",
)
@options.models(required=True)
@click.option(
    "--scenario",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Inputs and the expected trace, in YAML.",
)
@click.option(
    "--variables",
    is_flag=True,
    help="List the names that scenarios and formulas may use; play nothing.",
)
@click.option("--junit", type=click.Path(path_type=Path), metavar="FILE", help="JUnit XML report.")
@options.folder("Folder for the trace as a PlantUML sequence diagram.")
@options.reporting
@options.reading
@click.pass_context
def command(
    ctx: click.Context,
    /,
    models: tuple[Path, ...],
    scenario: Path | None,
    variables: bool,
    junit: Path | None,
    output: Path | None,
    **setting_values: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Run the steps of a scenario and compare the trace with the expected one.

    Exit code 0: they are equal; 1: they differ, or the scenario is invalid or not decided; 2: a
    file cannot be read.
    """
    from sysmlc.backends.base import InputFile
    from sysmlc.cli import reports, session
    from sysmlc.diagnostics import Sink
    from sysmlc.diagnostics.renderers import make_report
    from sysmlc.simulation import list_variables, run_scenarios

    if scenario is None and not variables:
        raise click.UsageError("name a file with --scenario, or list the names with --variables")
    settings = session.Settings(**setting_values)
    config = session.load_config(models, settings)
    compilation = session.compile_unit(models, config, settings)
    if scenario is None or variables:
        reports.print_findings(reports.list_findings(compilation, only_errors=True), settings)
        terminal.echo_text("".join(f"{line}\n" for line in list_variables(compilation.graph)))
        ctx.exit(reports.exit_code_of(compilation, config, settings))
    source = _read(scenario)
    sink = Sink(config.rules)
    result = run_scenarios(compilation.graph, source, sink) if compilation.exit_code() < 2 else None
    findings = reports.list_findings(compilation, only_errors=not settings.verbose)
    findings += make_report(sink, [source]).findings
    refusals: list[Finding] = []
    if result is not None:
        file = InputFile(source.name, source.sha256, "scenario")
        units: list[reports.ReadUnit] = [compilation, _Scenario(Path.cwd(), (file,))]
        report, diagram = result.as_junit(), result.sequence_diagram()
        if junit is not None and report:
            files = [(junit.name, report)]
            refusals += reports.publish_results("simulate", files, junit.parent, units, settings)
        if output is not None and diagram:
            files = [(f"{scenario.stem}.seq.puml", diagram)]
            refusals += reports.publish_results("simulate", files, output, units, settings)
    reports.print_findings([*findings, *refusals], settings)
    if result is not None:
        terminal.echo_text(result.as_text(), nl=False, err=not reports.allows_sentences(settings))
    passed = result is not None and result.passed
    code = reports.exit_code_of(compilation, config, settings)
    ctx.exit(2 if refusals else max(code, 0 if passed else 1))


def _read(scenario: Path) -> "Source":
    from sysmlc.cli.session import fail
    from sysmlc.sources import Source, SourceError
    from sysmlc.sources.files import read_whole
    from sysmlc.sources.source import DOCUMENT_LIMITS

    name = escape_undecodable(scenario.as_posix())
    try:
        return Source(name, read_whole(scenario, name, DOCUMENT_LIMITS))
    except SourceError as problem:
        fail(f"cannot read scenario '{scenario}': {problem.message}")
