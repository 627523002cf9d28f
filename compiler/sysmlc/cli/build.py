"""``sysmlc build``: compile models and write the output folder."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options, terminal

if TYPE_CHECKING:
    from sysmlc.cli.session import Unit
    from sysmlc.driver import Outcome, Plan


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
    help="Write nothing; exit 1 and list the files when the output folder is not up to date.",
)
@click.pass_context
def command(
    ctx: click.Context,
    /,
    models: tuple[Path, ...],
    output: Path | None,
    check_only: bool,
    **given: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Compile MODEL... (files or folders) and write what changed to the output folder.

    Without MODEL every [[model]] of sysmlc.toml is compiled. A file that comes from an element
    with an error is withheld; the others are written.
    """
    from sysmlc.cli import session
    from sysmlc.driver import plan

    _check_command_word(models)
    settings = session.Settings(**given)
    config = session.load_config(models, settings)
    units = session.units(models, config, output, settings.emit)
    made = session.list_outcomes(units, config, settings)
    session.report(made, settings)
    code = session.exit_code(made, config, settings)
    for unit, outcome in zip(units, made, strict=True):
        if outcome.exit_code() == 2:
            continue
        planned = plan(outcome, unit.output)
        if check_only:
            code = max(code, _compare(planned))
        else:
            _write(planned, unit, outcome, session.says_more(settings), settings.verbose)
    ctx.exit(code)


def _check_command_word(models: tuple[Path, ...]) -> None:
    """``sysmlc chekc plant.uml``: no file was meant."""
    from sysmlc.cli.group import COMMANDS

    word = str(models[0]) if models else ""
    if word.isalpha() and not Path(word).exists():
        from difflib import get_close_matches

        near = get_close_matches(word, COMMANDS, n=1, cutoff=0.6)
        if near:
            raise click.UsageError(f"no command or file '{word}'; did you mean '{near[0]}'?")


def _compare(planned: "Plan") -> int:
    stale = planned.differences()
    for path in stale:
        terminal.echo(f"not up to date: {planned.folder / path}", err=True)
    return 1 if stale else 0


def _write(planned: "Plan", unit: "Unit", outcome: "Outcome", talk: bool, verbose: bool) -> None:
    from sysmlc.cli.session import fail
    from sysmlc.driver import OutputError, apply

    try:
        changed = apply(planned)
    except OutputError as problem:
        fail(str(problem))
    if verbose:
        for path in changed:
            terminal.echo(f"changed {unit.output / path}", err=True)
    if talk:
        terminal.echo(_sentence(planned, len(changed), outcome, unit.output))


def _sentence(planned: "Plan", changed: int, outcome: "Outcome", folder: Path) -> str:
    withheld = len(outcome.withheld)
    held = f", {withheld} withheld because of errors" if withheld else ""
    shown = os.path.relpath(folder) if folder.is_relative_to(Path.cwd()) else str(folder)
    return f"{shown}: {len(planned.digests)} files, {changed} changed{held}"
