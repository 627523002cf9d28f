"""What ``sysmlc watch`` watches, and when it compiles: files that have come to rest."""

import gc
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING
from zlib import crc32

from msgspec import Struct

from sysmlc.cli import terminal
from sysmlc.cli.limits import LIMITS

if TYPE_CHECKING:
    from sysmlc.cli.session import Settings
    from sysmlc.cli.settling import Stamps
    from sysmlc.cli.units import Unit
    from sysmlc.config import Config
    from sysmlc.driver import Outcome, Target

_PATIENCE = 1.5
"""Seconds without a save before what looks half saved is believed, if files must rest at all."""
_PATIENT = 5
"""Settling times for the same, if that is longer."""
_ROUNDS = 20
_MOST = 8
"""Compilations without a pause, after which what they left is collected all the same."""


class Compiled(Struct, frozen=True):
    """A unit and the outcome of compiling it."""

    unit: "Unit"
    target: "Target"
    outcome: "Outcome"


class Watch:
    """What is watched, and how it looked when it was compiled last."""

    def __init__(
        self,
        models: tuple[Path, ...],
        output: Path | None,
        settings: "Settings",
        settle: float,
        keep_going: bool = False,
    ) -> None:
        self._models, self._output, self._settings = models, output, settings
        self._settle, self._keep_going = settle, keep_going
        self._patience = max(_PATIENCE, _PATIENT * settle) if settle else 0.0
        config, files = _unit_files(models, settings)
        self._config = config.folder
        named = [*files, *settings.overlay, *([config.file] if config.file else [])]
        self._named = [path.absolute() for path in named]
        self._paths = dict.fromkeys(self._named)
        self._built: Stamps = {}
        self._told: frozenset[tuple[str, str]] = frozenset()
        """Findings of what was compiled last."""
        self._blank: frozenset[Path] = frozenset()
        """Files that were empty or not there then."""
        self._left = 0
        """Compilations whose graphs and trees are still in memory."""
        self._early: Sequence[Compiled] = ()
        """What was compiled before anybody told of saves."""

    def folders(self) -> list[Path]:
        """Folders whose files are inputs; ends with exit code 2 when one is not there."""
        from sysmlc.cli.session import fail

        found = {path if path.is_dir() else path.parent for path in self._named}
        missing = sorted(str(folder) for folder in found if not folder.exists())
        if missing:
            fail(f"there is no folder '{missing[0]}' to watch")
        return sorted({*found, *([self._config] if self._config else [])})

    def build_if_changed(self, saved: Iterable[Path]) -> None:
        """Compile when one of the inputs, or of the files saved now, is not as it was.

        The first time it is looked for files that came before the system told of saves.
        """
        from sysmlc.cli.settling import stamps

        self._paths |= dict.fromkeys(saved)
        now, (early, self._early) = stamps(self._paths), (self._early, ())
        with suppress(SystemExit):
            if now != self._built or not self._is_of_now(early):
                self._built = now
                self.build()
            else:
                self.rest()

    def start(self) -> None:
        """Compile, unless a limit has just ended that; then wait for the next save."""
        from sysmlc.cli.settling import stamps

        if LIMITS.has_ended_build(self._digest_inputs()):
            self._built = stamps(self._paths)
        else:
            self.build()

    def _digest_inputs(self) -> int:
        """Return a digest of size and time of the named inputs."""
        from sysmlc.cli.settling import stamps

        return crc32(repr(sorted(stamps(self._named).items())).encode("utf-8", "surrogatepass"))

    def build(self) -> None:
        """Compile what has come to rest, show it, and write it when it has no errors."""
        is_first = not self._built
        made = self._settled()
        self._early = made if is_first else ()
        for path, stamp in list(self._built.items()):
            if stamp is None and path not in self._named:
                del self._paths[path]
        self._built = {path: self._built.get(path) for path in self._paths}
        with LIMITS.timed():
            for one in made:
                publish(one, self._settings, self._keep_going)
        self._left += 1
        if self._left >= _MOST:
            self._collect()

    def rest(self) -> None:
        """Do what nobody has to wait for: nothing is saved just now."""
        if self._left:
            self._collect()

    def _collect(self) -> None:
        """Let trees go whose nodes name one another.

        What front ends freeze no other collection looks at: each edit of the ICE laboratory left
        14 MB.
        """
        gc.unfreeze()
        gc.collect()
        self._left = 0

    def _settled(self) -> "list[Compiled]":
        """What the inputs come to when they have come to rest.

        What was saved while it was compiled is compiled again, and so is what was saved just now
        and has findings that were not there before, or a file that is empty or gone: the tool
        may be about to write the rest, or the next file.
        """
        from sysmlc.cli import settling

        for _ in range(_ROUNDS):
            before = settling.rested(self._paths, self._rest())
            with LIMITS.limit_build(self._digest_inputs()):
                made = compiled(self._models, self._output, self._settings)
            if settling.stamps(before) != before:
                continue
            new = dict.fromkeys(path for one in made for path in _read_by(one.outcome))
            self._paths |= new
            self._built = {**settling.stamps(new), **before}
            if not new.keys() <= before.keys() and not self._is_of_now(made):
                continue
            told, blank = _findings(made), settling.blank(before)
            is_known = told <= self._told and blank <= self._blank
            if is_known or not settling.is_fresh(before, self._patience):
                break
            if settling.rested(before, self._patience) == before:
                break
        self._told, self._blank = _findings(made), settling.blank(before)
        return made

    def _is_of_now(self, made: "Sequence[Compiled]") -> bool:
        """Whether these are made of what the inputs are now, new files included."""
        from sysmlc.cli import session
        from sysmlc.cli.units import open_units

        if not made:
            return True
        with LIMITS.timed():
            config = session.load_config(self._models, self._settings)
            units = open_units(self._models, config, self._settings, self._output)
        return [unit.opened.inputs() for unit in units] == [one.outcome.inputs for one in made]

    def _rest(self) -> float:
        """How long files must rest: faults of a configuration are told at once, when it is read."""
        from sysmlc.cli import settling
        from sysmlc.config import FILE_NAME

        named = [path for path in self._paths if path.name in (FILE_NAME, "pyproject.toml")]
        is_new = bool(named) and settling.is_fresh(settling.stamps(named), self._patience)
        return self._patience if is_new else self._settle


def compiled(
    models: tuple[Path, ...], output: Path | None, settings: "Settings"
) -> "list[Compiled]":
    """Compile every unit in this process.

    The cache is not used: after an edit it has no entry, and a first outcome from the cache would
    leave the standard library unread when the first edit comes.
    """
    from sysmlc.cli import session
    from sysmlc.cli.units import open_units

    # Front ends freeze the graphs that they made; those of earlier compilations may go now.
    gc.unfreeze()
    config = session.load_config(models, settings)
    units = open_units(models, config, settings, output)
    outcomes = session.compile_units(units, settings, uses_cache=False)
    return [
        Compiled(unit, session.target_of(unit), outcome)
        for unit, outcome in zip(units, outcomes, strict=True)
    ]


def publish(made: Compiled, settings: "Settings", keep_going: bool = False) -> bool:
    """Show the findings; write the outputs unless there are errors.

    Who keeps going gets those that no error concerns, as from ``build``.
    """
    from sysmlc.cli import reports
    from sysmlc.driver import publish as write_outputs

    folder, code = made.unit.output, made.outcome.exit_code()
    if code > 1 or (code and not keep_going):
        reports.report_outcomes([made.outcome], settings)
        terminal.echo(f"{folder}: not updated because the model has errors")
        return False
    publication = write_outputs(made.outcome, made.target)
    reports.report_outcomes([made.outcome], settings, [publication])
    if publication.is_refused:
        terminal.echo(f"{folder}: not updated")
        return False
    withheld = len(made.outcome.withheld)
    held = f", {withheld} withheld because of errors" if withheld else ""
    terminal.echo(f"{folder}: {len(publication.changed)} changed{held}")
    return True


def _findings(made: "list[Compiled]") -> frozenset[tuple[str, str]]:
    """Rules and messages; lines may move without anything being new."""
    found = (finding.diagnostic for one in made for finding in one.outcome.findings)
    return frozenset((one.rule.code, one.message) for one in found)


def _read_by(made: "Outcome") -> Iterator[Path]:
    """Files that a compilation read."""
    for file in made.inputs:
        yield made.root / file.path.partition("!")[0]


def _unit_files(
    models: tuple[Path, ...], settings: "Settings"
) -> "tuple[Config, tuple[Path, ...]]":
    from sysmlc.cli import selection, session

    config = session.load_config(models, settings)
    selections = selection.select(models, config, None, ())
    return config, tuple(file for selection in selections for file in selection.files)
