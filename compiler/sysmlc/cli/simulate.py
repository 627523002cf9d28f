"""``sysmlc simulate``: run a scenario against the behaviour of a model."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options, terminal
from sysmlc.support.escapes import escape_undecodable

if TYPE_CHECKING:
    from sysmlc.sources import Source


@click.command(
    "simulate",
    short_help="Run a scenario with the reference interpreter.",
    epilog="""\b
Examples:
  sysmlc simulate gate.uml --scenario wrong-id.yaml
  sysmlc simulate gate.uml --scenario wrong-id.yaml --junit report.xml -o out/""",
)
@options.models(required=True)
@click.option(
    "--scenario",
    required=True,
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Inputs and the expected trace, in YAML.",
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
    scenario: Path,
    junit: Path | None,
    output: Path | None,
    **setting_values: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Run the steps of a scenario and compare the trace with the expected one.

    Exit code 0: they are equal; 1: they differ, or the scenario is invalid or not decided; 2: a
    file cannot be read.
    """
    from sysmlc.cli import reports, session
    from sysmlc.cli.reports import write_files
    from sysmlc.diagnostics import Sink
    from sysmlc.diagnostics.renderers import make_report
    from sysmlc.simulation import run_scenarios

    settings = session.Settings(**setting_values)
    config = session.load_config(models, settings)
    compilation = session.compile_unit(models, config, settings)
    source = _read(scenario)
    sink = Sink(config.rules)
    result = run_scenarios(compilation.graph, source, sink) if compilation.exit_code() < 2 else None
    findings = reports.list_findings(compilation, only_errors=not settings.verbose)
    reports.print_findings([*findings, *make_report(sink, [source]).findings], settings)
    if result is not None:
        terminal.echo_text(result.as_text(), nl=False, err=not reports.allows_sentences(settings))
        _save(junit, result.as_junit())
        diagram = result.sequence_diagram()
        if output is not None and diagram:
            write_files([(f"{scenario.stem}.seq.puml", diagram)], output)
    passed = result is not None and result.passed
    code = reports.exit_code_of(compilation, config, settings)
    ctx.exit(max(code, 0 if passed else 1))


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


def _save(target: Path | None, text: str) -> None:
    from sysmlc.cli.session import fail
    from sysmlc.support.atomic_files import write_if_changed

    if target is None or not text:
        return
    try:
        write_if_changed(target, text)
    except OSError as problem:
        fail(f"cannot write {target}: {problem.strerror}")
