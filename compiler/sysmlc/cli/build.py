"""``sysmlc build``: compile models and write the output folder."""

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options, terminal
from sysmlc.support.counts import count

if TYPE_CHECKING:
    from collections.abc import Sequence

    from sysmlc.cli.session import Settings
    from sysmlc.cli.units import Unit
    from sysmlc.driver import Outcome, Publication, Target


@click.command(
    "build",
    short_help="Compile models and write contracts, recipes and diagrams.",
    epilog="""\b
Examples:
  sysmlc build plant.uml profile.profile.uml -o out/
  sysmlc plant.mdzip --emit +graph         # also graph.json
  sysmlc plant.uml --emit plantuml         # only diagrams
  sysmlc build                             # every [[model]] of sysmlc.toml
  sysmlc build --check                     # are the committed outputs up to date?""",
)
@options.models()
@options.output_folder
@options.emitting
@options.templates
@options.reporting
@options.reading
@options.caching
@click.option(
    "--check",
    "check_only",
    is_flag=True,
    help="Write nothing; list the files that are not up to date, and exit with 1 if there are any.",
)
@options.force
@click.pass_context
def command(
    ctx: click.Context,
    /,
    models: tuple[Path, ...],
    output: Path | None,
    check_only: bool,
    is_forced: bool,
    **setting_values: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Compile MODEL... (files or folders) and write changed files to the output folder.

    Without MODEL every [[model]] of sysmlc.toml is compiled. A file that comes from an element
    with an error is withheld; the others are written.
    """
    from sysmlc.cli import reports, session
    from sysmlc.cli.units import open_units
    from sysmlc.driver import publish

    _check_command_word(models)
    settings = session.Settings(**setting_values)
    config = session.load_config(models, settings)
    units = open_units(models, config, settings, output)
    outcomes = session.compile_units(units, settings)
    code = reports.exit_code_of_all(units, outcomes, settings)
    targets = [session.target_of(unit, is_forced=is_forced) for unit in units]
    written = [
        (outcome, target)
        for outcome, target in zip(outcomes, targets, strict=True)
        if outcome.exit_code() < 2
    ]
    if check_only:
        reports.report_outcomes(outcomes, settings)
        differences = [_compare(outcome, target) for outcome, target in written]
        ctx.exit(max([code, _report_leftovers(units), *differences]))
    publications = [publish(outcome, target) for outcome, target in written]
    reports.report_outcomes(outcomes, settings, publications)
    for (outcome, target), publication in zip(written, publications, strict=True):
        if publication.is_refused:
            code = 2
        else:
            _print_changes(outcome, target.folder, publication, settings)
    _report_leftovers(units)
    ctx.exit(code)


def _check_command_word(models: tuple[Path, ...]) -> None:
    """Raise UsageError if the first model is a word that names no file, as in ``sysmlc lint``.

    The other models must not be built, because the user meant something else.
    """
    from sysmlc.cli.group import COMMANDS

    word = str(models[0]) if models else ""
    if re.fullmatch(r"[\w-]+", word) and not os.path.lexists(word):
        from sysmlc.support.suggestions import find_similar

        similar = find_similar(word, COMMANDS)
        advice = f"did you mean '{similar}'?" if similar else f"commands: {', '.join(COMMANDS)}"
        raise click.UsageError(f"no command, file or folder '{word}'; {advice}")


def _compare(outcome: "Outcome", target: "Target") -> int:
    from sysmlc.driver import compare

    paths = compare(outcome, target)
    for path in paths:
        terminal.echo(f"not up to date: {target.folder / path}", err=True)
    return 1 if paths else 0


def _print_changes(
    outcome: "Outcome", folder: Path, publication: "Publication", settings: "Settings"
) -> None:
    from sysmlc.cli import reports

    if settings.verbose:
        for path in publication.changed:
            terminal.echo(f"changed {folder / path}", err=True)
    if reports.allows_sentences(settings):
        terminal.echo(_summarise(outcome, folder, publication.changed))


def _summarise(outcome: "Outcome", folder: Path, changed: "Sequence[str]") -> str:
    from sysmlc.driver.ownership import MANIFEST

    paths = {MANIFEST, *(file.path for file in outcome.files)}
    removed = len(set(changed) - paths)
    counts = [count(len(paths), "file"), f"{len(changed) - removed} changed"]
    counts += [f"{removed} removed"] if removed else []
    counts += [f"{len(outcome.withheld)} withheld because of errors"] if outcome.withheld else []
    return f"{_relative(folder)}: {', '.join(counts)}"


def _report_leftovers(units: "Sequence[Unit]") -> int:
    """Print output folders that no longer belong to a unit; return 1 if there are any, else 0."""
    from sysmlc.cli.units import find_leftover_outputs

    folders = find_leftover_outputs(units)
    for folder in folders:
        terminal.echo(
            f"{_relative(folder)}: outputs of an earlier run; no model has this name now: "
            "delete the folder if it is not needed",
            err=True,
        )
    return int(bool(folders))


def _relative(folder: Path) -> str:
    return os.path.relpath(folder) if folder.is_relative_to(Path.cwd()) else str(folder)
