"""The builds of ``sysmlc watch``: compile when the inputs have changed and are completely saved.

Tools save in pieces, so size and time of a file show whether it is still being saved.
"""

import gc
import stat
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING
from zlib import crc32

from msgspec import Struct

from sysmlc.cli import terminal
from sysmlc.cli.limits import LIMITS

if TYPE_CHECKING:
    from sysmlc.cli.session import Settings
    from sysmlc.cli.units import Unit
    from sysmlc.config import Config
    from sysmlc.driver import Outcome, Target


_STEP = 0.05
"""Seconds after which files are looked at again, if they are to rest for longer."""
_LONGEST = 30.0
"""Seconds after which files that never rest are compiled as they are."""

_FOLDER = (0, 0)
"""A folder looks the same whatever is in it: our own outputs may be."""

Stamps = Mapping[Path, tuple[int, int] | None]
"""Size and time of change of each file; None for one that is not there."""


def read_stamps(paths: Iterable[Path]) -> Stamps:
    """Return size and time of each file."""
    return {path: _read_stamp(path) for path in paths}


def wait_until_stable(paths: Iterable[Path], seconds: float) -> Stamps:
    """Wait until no file has changed for so many seconds; return size and time of each."""
    paths = list(paths)
    start = since = time.monotonic()
    last = read_stamps(paths)
    while time.monotonic() - since < seconds and time.monotonic() - start < _LONGEST:
        time.sleep(min(_STEP, seconds))
        current = read_stamps(paths)
        if current != last:
            last, since = current, time.monotonic()
    return last


def is_fresh(seen: Stamps, seconds: float) -> bool:
    """Whether a file is missing or was changed in the last seconds, so that it may be half
    saved.
    """
    current_time = time.time()
    return any(
        stamp is None or abs(current_time - stamp[1] / 1e9) < seconds for stamp in seen.values()
    )


def find_empty_files(seen: Stamps) -> frozenset[Path]:
    """Return the files that are empty or missing."""
    return frozenset(
        path
        for path, stamp in seen.items()
        if stamp is None or (stamp[0] == 0 and stamp != _FOLDER)
    )


def _read_stamp(path: Path) -> tuple[int, int] | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return _FOLDER if stat.S_ISDIR(status.st_mode) else (status.st_size, status.st_mtime_ns)


# -- builds ------------------------------------------------------------------------------------

_PATIENCE = 1.5
"""Seconds without a save before what looks half saved is believed, if files must rest at all."""
_PATIENT = 5
"""Settling times for the same, if that is longer."""
_ROUNDS = 20
_MOST = 8
"""Compilations without a pause, after which what they left is collected all the same."""


class CompiledUnit(Struct, frozen=True):
    """A unit with the outcome of its compilation."""

    unit: "Unit"
    target: "Target"
    outcome: "Outcome"


class Watch:
    """The watched inputs, and their state at the last build."""

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
        self._early: Sequence[CompiledUnit] = ()
        """What was compiled before anybody told of saves."""

    def list_folders(self) -> list[Path]:
        """Return the folders of the inputs; exit with code 2 if one is missing."""
        from sysmlc.cli.session import fail

        folders_found = {path if path.is_dir() else path.parent for path in self._named}
        missing = sorted(str(folder) for folder in folders_found if not folder.exists())
        if missing:
            fail(f"there is no folder '{missing[0]}' to watch")
        return sorted({*folders_found, *([self._config] if self._config else [])})

    def build_if_changed(self, saved: Iterable[Path]) -> None:
        """Compile if the inputs, or the files saved meanwhile, differ from the last build."""
        self._paths |= dict.fromkeys(saved)
        state, (early, self._early) = read_stamps(self._paths), (self._early, ())
        with suppress(SystemExit):
            if state != self._built or not self._is_current(early):
                self._built = state
                self.build()
            else:
                self.clean_up()

    def start(self) -> None:
        """Compile, unless a limit has just ended a build of this state; then wait for the next
        save.
        """
        if LIMITS.has_ended_build(self._digest_inputs()):
            self._built = read_stamps(self._paths)
        else:
            self.build()

    def _digest_inputs(self) -> int:
        """Return a digest of size and time of the named inputs."""
        return crc32(
            repr(sorted(read_stamps(self._named).items())).encode("utf-8", "surrogatepass")
        )

    def build(self) -> None:
        """Compile the saved inputs, print the findings, and write the outputs if there are no
        errors.
        """
        is_first = not self._built
        units = self._compile_stable_inputs()
        self._early = units if is_first else ()
        for path, stamp in list(self._built.items()):
            if stamp is None and path not in self._named:
                del self._paths[path]
        self._built = {path: self._built.get(path) for path in self._paths}
        with LIMITS.apply_to_block():
            for unit in units:
                publish(unit, self._settings, self._keep_going)
        self._left += 1
        if self._left >= _MOST:
            self._collect_garbage()

    def clean_up(self) -> None:
        """Do work that nobody waits for while no file is being saved."""
        if self._left:
            self._collect_garbage()

    def _collect_garbage(self) -> None:
        """Free syntax trees, whose nodes refer to one another."""
        gc.unfreeze()
        gc.collect()
        self._left = 0

    def _compile_stable_inputs(self) -> "list[CompiledUnit]":
        """Return the units compiled from completely saved inputs."""
        for _ in range(_ROUNDS):
            before = wait_until_stable(self._paths, self._find_delay())
            with LIMITS.limit_build(self._digest_inputs()):
                units = compile_all(self._models, self._output, self._settings)
            if read_stamps(before) != before:
                continue
            new = dict.fromkeys(path for unit in units for path in _list_inputs(unit.outcome))
            self._paths |= new
            self._built = {**read_stamps(new), **before}
            if not new.keys() <= before.keys() and not self._is_current(units):
                continue
            is_reported, blank = _list_messages(units), find_empty_files(before)
            is_known = is_reported <= self._told and blank <= self._blank
            if is_known or not is_fresh(before, self._patience):
                break
            if wait_until_stable(before, self._patience) == before:
                break
        self._told, self._blank = _list_messages(units), find_empty_files(before)
        return units

    def _is_current(self, units: "Sequence[CompiledUnit]") -> bool:
        """Whether the units were compiled from the present inputs, new files included."""
        from sysmlc.cli import session
        from sysmlc.cli.units import open_units

        if not units:
            return True
        with LIMITS.apply_to_block():
            config = session.load_config(self._models, self._settings)
            opened_units = open_units(self._models, config, self._settings, self._output)
        current = [unit.opened.inputs() for unit in opened_units]
        return current == [unit.outcome.inputs for unit in units]

    def _find_delay(self) -> float:
        """Return how long files must be unchanged; configuration errors are reported at once."""
        from sysmlc.config import FILE_NAME

        named = [path for path in self._paths if path.name in (FILE_NAME, "pyproject.toml")]
        is_new = bool(named) and is_fresh(read_stamps(named), self._patience)
        return self._patience if is_new else self._settle


def compile_all(
    models: tuple[Path, ...], output: Path | None, settings: "Settings"
) -> "list[CompiledUnit]":
    """Compile every unit in this process."""
    from sysmlc.cli import session
    from sysmlc.cli.units import open_units

    # Front ends freeze the graphs that they made; those of earlier compilations may go now.
    gc.unfreeze()
    config = session.load_config(models, settings)
    units = open_units(models, config, settings, output)
    outcomes = session.compile_units(units, settings, uses_cache=False)
    return [
        CompiledUnit(unit, session.target_of(unit), outcome)
        for unit, outcome in zip(units, outcomes, strict=True)
    ]


def publish(unit: CompiledUnit, settings: "Settings", keep_going: bool = False) -> bool:
    """Print the findings; write the outputs unless there are errors."""
    from sysmlc.cli import reports
    from sysmlc.driver import publish as write_outputs

    folder, code = unit.unit.output, unit.outcome.exit_code()
    if code > 1 or (code and not keep_going):
        reports.report_outcomes([unit.outcome], settings)
        terminal.echo(f"{folder}: not updated because the model has errors")
        return False
    publication = write_outputs(unit.outcome, unit.target)
    reports.report_outcomes([unit.outcome], settings, [publication])
    if publication.is_refused:
        terminal.echo(f"{folder}: not updated")
        return False
    withheld = len(unit.outcome.withheld)
    held = f", {withheld} withheld because of errors" if withheld else ""
    terminal.echo(f"{folder}: {len(publication.changed)} changed{held}")
    return True


def _list_messages(units: "list[CompiledUnit]") -> frozenset[tuple[str, str]]:
    """Return rules and messages without lines, which may move although no finding is new."""
    diagnostics = (finding.diagnostic for unit in units for finding in unit.outcome.findings)
    return frozenset((d.rule.code, d.message) for d in diagnostics)


def _list_inputs(compilation: "Outcome") -> Iterator[Path]:
    """Return the files that a compilation read."""
    for file in compilation.inputs:
        yield compilation.root / file.path.partition("!")[0]


def _unit_files(
    models: tuple[Path, ...], settings: "Settings"
) -> "tuple[Config, tuple[Path, ...]]":
    from sysmlc.cli import session
    from sysmlc.cli.units import select

    config = session.load_config(models, settings)
    selections = select(models, config, None, ())
    return config, tuple(file for selection in selections for file in selection.files)
