"""``sysmlc watch``: compile again at every save."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options

if TYPE_CHECKING:
    from sysmlc.cli.session import Settings


@click.command(
    "watch",
    short_help="Compile again at every save.",
    epilog="""\b
Example:
  sysmlc watch plant.uml -o out/           ends with Ctrl-C""",
)
@options.models()
@options.output_folder
@options.emitting
@options.reporting
@options.reading
@options.caching
def command(
    models: tuple[Path, ...],
    output: Path | None,
    **given: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Compile MODEL... now and at every save; keep the last good outputs.

    While the model has errors nothing in the output folder changes.
    """
    from contextlib import suppress

    from sysmlc.cli import session

    settings = session.Settings(**given)
    changes = _changes(_watched(models, settings))
    rebuild(models, output, settings)
    for _ in changes:
        with suppress(SystemExit):
            rebuild(models, output, settings)


def rebuild(models: tuple[Path, ...], output: Path | None, settings: "Settings") -> bool:
    """Compile each unit once; write those that have no error. Say whether all were written."""
    from sysmlc.cli import session
    from sysmlc.driver import OutputError, apply, plan

    config = session.load_config(models, settings.config)
    good = True
    for unit in session.units(models, config, output, settings.emit):
        made = session.outcome_of(unit, config, settings)
        session.report([made], settings)
        if made.exit_code():
            good = False
            click.echo(f"{unit.output}: kept as it is, the model has errors")
        else:
            try:
                changed = apply(plan(made, unit.output))
            except OutputError as problem:
                session.fail(str(problem))
            click.echo(f"{unit.output}: {len(changed)} changed")
    return good


def _watched(models: tuple[Path, ...], settings: "Settings") -> list[Path]:
    from sysmlc.cli import session

    config = session.load_config(models, settings.config)
    files = {file for unit in session.units(models, config, None, ()) for file in unit.files}
    folders = {file if file.is_dir() else file.absolute().parent for file in files}
    missing = sorted(str(folder) for folder in folders if not folder.exists())
    if missing:
        session.fail(f"there is no folder '{missing[0]}' to watch")
    settled = {*folders, *([config.folder] if config.folder else [])}
    return sorted(settled)


def _changes(folders: Iterable[Path]) -> Iterator[object]:
    from sysmlc.cli.session import fail

    try:
        from watchfiles import watch
    except ImportError:
        fail("'watch' needs the package watchfiles: pip install 'sysmlc[watch]'")
    return watch(*folders, watch_filter=_is_input, raise_interrupt=False)


def _is_input(_change: object, path: str) -> bool:
    """Whether a saved file may be an input; our own outputs must not start the next run."""
    from sysmlc.config import FILE_NAME
    from sysmlc.driver.inputs import SUFFIXES

    file = Path(path)
    return file.suffix.lower() in SUFFIXES or file.name in (FILE_NAME, "pyproject.toml")
