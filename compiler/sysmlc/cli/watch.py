"""``sysmlc watch``: compile again at every save."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from sysmlc.cli import options

if TYPE_CHECKING:
    from sysmlc.cli.session import Settings, Unit
    from sysmlc.cli.settling import Stamps
    from sysmlc.config import Config
    from sysmlc.driver import Outcome

_PATIENCE = 5
"""How many settling times old a save must be before an error in it is believed."""
_ROUNDS = 20
_LOOK = 1000
"""Milliseconds after which files are looked at though the system reported no change."""


@click.command(
    "watch",
    short_help="Compile again at every save.",
    epilog="""\b
Example:
  sysmlc watch plant.uml -o out/           ends with Ctrl-C""",
)
@options.models()
@options.output_folder
@click.option(
    "--settle",
    type=click.IntRange(0, 60_000),
    default=300,
    show_default=True,
    metavar="MS",
    help="How long files must rest before they are compiled; errors wait five times as long.",
)
@options.emitting
@options.reporting
@options.reading
@options.caching
def command(
    models: tuple[Path, ...],
    output: Path | None,
    settle: int,
    **given: Any,  # noqa: ANN401 - the fields of Settings
) -> None:
    """Compile MODEL... now and at every save; keep the last good outputs.

    Files that are still being saved are waited for. While the model has errors nothing in the
    output folder changes.
    """
    from sysmlc.cli import session

    watched = _Watch(models, output, session.Settings(**given), settle / 1000)
    saves = _saves(watched.folders())
    watched.build()
    for saved in saves:
        watched.build_if_changed(saved)


def rebuild(models: tuple[Path, ...], output: Path | None, settings: "Settings") -> bool:
    """Compile each unit once; write those that have no error. Say whether all were written."""
    made = _compiled(models, output, settings)
    written = [_publish(unit, one, settings) for unit, one in made]
    return all(written)


class _Watch:
    """What is watched, and how it looked when it was compiled last."""

    def __init__(
        self, models: tuple[Path, ...], output: Path | None, settings: "Settings", settle: float
    ) -> None:
        self._models, self._output, self._settings = models, output, settings
        self._settle = settle
        config, files = _unit_files(models, settings)
        self._config = config.folder
        named = [*files, config.file] if config.file else files
        self._named = [path.absolute() for path in named]
        self._paths = dict.fromkeys(self._named)
        self._built: Stamps = {}

    def folders(self) -> list[Path]:
        """Folders whose files are inputs; ends with exit code 2 when one is not there."""
        from sysmlc.cli.session import fail

        found = {path if path.is_dir() else path.parent for path in self._named}
        missing = sorted(str(folder) for folder in found if not folder.exists())
        if missing:
            fail(f"there is no folder '{missing[0]}' to watch")
        return sorted({*found, *([self._config] if self._config else [])})

    def build_if_changed(self, saved: Iterable[Path]) -> None:
        """Compile when one of the inputs, or of the files saved now, is not as it was."""
        from sysmlc.cli.settling import stamps

        self._paths |= dict.fromkeys(saved)
        now = stamps(self._paths)
        if now != self._built:
            self._built = now
            with suppress(SystemExit):
                self.build()

    def build(self) -> None:
        """Compile what has come to rest, show it, and write it when it has no errors."""
        made = self._settled()
        for path, stamp in list(self._built.items()):
            if stamp is None and path not in self._named:
                del self._paths[path]
        self._built = {path: self._built.get(path) for path in self._paths}
        for unit, one in made:
            _publish(unit, one, self._settings)

    def _settled(self) -> "list[tuple[Unit, Outcome]]":
        """What the inputs come to when they have come to rest.

        What was saved while it was compiled is compiled again, and so is what has errors and
        was saved just now: the tool may be about to write the rest, or the next file.
        """
        from sysmlc.cli import settling

        patience = self._settle * _PATIENCE
        for _ in range(_ROUNDS):
            before = settling.rested(self._paths, self._settle)
            made = _compiled(self._models, self._output, self._settings)
            if settling.stamps(before) != before:
                continue
            new = dict.fromkeys(path for _, one in made for path in _read_by(one))
            self._paths |= new
            self._built = {**settling.stamps(new), **before}
            is_doubtful = any(one.exit_code() for _, one in made)
            if not is_doubtful or not settling.is_fresh(before, patience):
                break
            if settling.rested(before, patience) == before:
                break
        return made


def _compiled(
    models: tuple[Path, ...], output: Path | None, settings: "Settings"
) -> "list[tuple[Unit, Outcome]]":
    from sysmlc.cli import session

    config = session.load_config(models, settings.config)
    units = session.units(models, config, output, settings.emit)
    return [(unit, session.outcome_of(unit, config, settings)) for unit in units]


def _publish(unit: "Unit", made: "Outcome", settings: "Settings") -> bool:
    """Show the findings; write the outputs unless there are errors."""
    from sysmlc.cli import session
    from sysmlc.driver import OutputError, apply, plan

    session.report([made], settings)
    if made.exit_code():
        click.echo(f"{unit.output}: kept as it is, the model has errors")
        return False
    try:
        changed = apply(plan(made, unit.output))
    except OutputError as problem:
        session.fail(str(problem))
    click.echo(f"{unit.output}: {len(changed)} changed")
    return True


# -- what is watched -----------------------------------------------------------------------------


def _read_by(made: "Outcome") -> Iterator[Path]:
    """Files that a compilation read."""
    for file in made.inputs:
        yield made.root / file.path.partition("!")[0]


def _unit_files(
    models: tuple[Path, ...], settings: "Settings"
) -> "tuple[Config, tuple[Path, ...]]":
    from sysmlc.cli import session

    config = session.load_config(models, settings.config)
    units = session.units(models, config, None, ())
    return config, tuple(file for unit in units for file in unit.files)


def _saves(folders: Sequence[Path]) -> Iterator[list[Path]]:
    """The files of each group of changes; none now and then, for systems that tell nothing."""
    from sysmlc.cli.session import fail

    try:
        from watchfiles import watch
    except ImportError:
        fail("'watch' needs the package watchfiles: pip install 'sysmlc[watch]'")
    changes = watch(
        *folders,
        watch_filter=_is_input,
        raise_interrupt=False,
        rust_timeout=_LOOK,
        yield_on_timeout=True,
    )
    return (sorted(Path(path).absolute() for _, path in change) for change in changes)


def _is_input(_change: object, path: str) -> bool:
    """Whether a saved file may be an input; our own outputs must not start the next run.

    Papyrus saves ``.notation`` and ``.di`` beside the model; no output depends on them.
    """
    from sysmlc.config import FILE_NAME
    from sysmlc.driver.inputs import SUFFIXES

    file = Path(path)
    return file.suffix.lower() in SUFFIXES or file.name in (FILE_NAME, "pyproject.toml")
