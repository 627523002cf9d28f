"""What ``sysmlc watch`` watches, and when it compiles: files that have come to rest."""

import gc
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from sysmlc.cli.session import Settings, Unit
    from sysmlc.cli.settling import Stamps
    from sysmlc.config import Config
    from sysmlc.driver import Outcome

_PATIENCE = 5
"""How many settling times old a save must be before a new finding in it is believed."""
_ROUNDS = 20


class Watch:
    """What is watched, and how it looked when it was compiled last."""

    def __init__(
        self, models: tuple[Path, ...], output: Path | None, settings: "Settings", settle: float
    ) -> None:
        self._models, self._output, self._settings = models, output, settings
        self._settle = settle
        config, files = _unit_files(models, settings)
        self._config = config.folder
        named = [*files, *settings.overlay, *([config.file] if config.file else [])]
        self._named = [path.absolute() for path in named]
        self._paths = dict.fromkeys(self._named)
        self._built: Stamps = {}
        self._told: frozenset[tuple[str, str]] = frozenset()
        """Findings of what was compiled last."""

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
            publish(unit, one, self._settings)

    def _settled(self) -> "list[tuple[Unit, Outcome]]":
        """What the inputs come to when they have come to rest.

        What was saved while it was compiled is compiled again, and so is what has errors, or
        findings that were not there before, and was saved just now: the tool may be about to
        write the rest, or the next file.
        """
        from sysmlc.cli import settling

        patience = self._settle * _PATIENCE
        for _ in range(_ROUNDS):
            before = settling.rested(self._paths, self._rest(patience))
            made = compiled(self._models, self._output, self._settings)
            if settling.stamps(before) != before:
                continue
            new = dict.fromkeys(path for _, one in made for path in _read_by(one))
            self._paths |= new
            self._built = {**settling.stamps(new), **before}
            told = _findings(made)
            is_doubtful = any(one.exit_code() for _, one in made) or not told <= self._told
            if not is_doubtful or not settling.is_fresh(before, patience):
                break
            if settling.rested(before, patience) == before:
                break
        self._told = _findings(made)
        return made

    def _rest(self, patience: float) -> float:
        """How long files must rest: faults of a configuration are told at once, when it is read."""
        from sysmlc.cli import settling
        from sysmlc.config import FILE_NAME

        named = [path for path in self._paths if path.name in (FILE_NAME, "pyproject.toml")]
        is_new = bool(named) and settling.is_fresh(settling.stamps(named), patience)
        return patience if is_new else self._settle


def compiled(
    models: tuple[Path, ...], output: Path | None, settings: "Settings"
) -> "list[tuple[Unit, Outcome]]":
    from sysmlc.cli import session

    # Front ends freeze the graphs that they made; those of earlier compilations may go now.
    gc.unfreeze()
    config = session.load_config(models, settings.config)
    units = session.units(models, config, output, settings.emit)
    return [(unit, session.outcome_of(unit, config, settings)) for unit in units]


def publish(unit: "Unit", made: "Outcome", settings: "Settings") -> bool:
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


def _findings(made: "list[tuple[Unit, Outcome]]") -> frozenset[tuple[str, str]]:
    """Rules and messages; lines may move without anything being new."""
    found = (finding.diagnostic for _, one in made for finding in one.findings)
    return frozenset((one.rule.code, one.message) for one in found)


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
