"""The builds of ``sysmlc watch``: compile inputs that have changed and are completely saved.

Tools write a file in several steps. The size and time of the file show whether it still changes.
"""

import gc
import stat
import time
from collections.abc import Iterable, Mapping, Sequence
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


_POLL_SECONDS = 0.05
"""Seconds between two checks of files that must be unchanged for a longer time."""
_MAX_WAIT_SECONDS = 30.0
"""Seconds after which files are compiled although they still change."""

_FOLDER_STAMP = (0, 0)
"""The stamp of every folder: a folder may contain outputs, which must not start a build."""

Stamps = Mapping[Path, tuple[int, int] | None]
"""Size and modification time of each file; None for a missing file."""


def read_stamps(paths: Iterable[Path]) -> Stamps:
    """Return the size and modification time of each file."""
    return {path: _read_stamp(path) for path in paths}


def wait_until_stable(paths: Iterable[Path], seconds: float) -> Stamps:
    """Wait until no file has changed for *seconds*; return the stamps of the files."""
    paths = list(paths)
    start = since = time.monotonic()
    last = read_stamps(paths)
    while time.monotonic() - since < seconds and time.monotonic() - start < _MAX_WAIT_SECONDS:
        time.sleep(min(_POLL_SECONDS, seconds))
        current = read_stamps(paths)
        if current != last:
            last, since = current, time.monotonic()
    return last


def is_fresh(stamps: Stamps, seconds: float) -> bool:
    """Whether a file is missing or was changed in the last *seconds*: it may be half saved."""
    current_time = time.time()
    return any(
        stamp is None or abs(current_time - stamp[1] / 1e9) < seconds for stamp in stamps.values()
    )


def find_empty_files(stamps: Stamps) -> frozenset[Path]:
    """Return the files that are empty or missing."""
    return frozenset(
        path
        for path, stamp in stamps.items()
        if stamp is None or (stamp[0] == 0 and stamp != _FOLDER_STAMP)
    )


def _read_stamp(path: Path) -> tuple[int, int] | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return _FOLDER_STAMP if stat.S_ISDIR(status.st_mode) else (status.st_size, status.st_mtime_ns)


# -- builds ------------------------------------------------------------------------------------

_MIN_CONFIRMATION_SECONDS = 1.5
"""The shortest time in seconds without a save before a new finding is reported."""
_CONFIRMATION_FACTOR = 5
"""This time as a multiple of the settling time, if the product is longer."""
_MAX_ATTEMPTS = 20
"""The largest number of compilations in one build while files are being saved."""
_MAX_UNCOLLECTED_BUILDS = 8
"""Builds after which garbage is collected even if there is no pause between saves."""


class CompiledUnit(Struct, frozen=True):
    """A compile unit with its output folder and the outcome of its compilation."""

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
        self._confirmation_seconds = (
            max(_MIN_CONFIRMATION_SECONDS, _CONFIRMATION_FACTOR * settle) if settle else 0.0
        )
        config, files = _unit_files(models, settings)
        self._config_folder = config.folder
        named = [*files, *settings.overlay, *([config.file] if config.file else [])]
        self._named_paths = [path.absolute() for path in named]
        self._watched_paths = dict.fromkeys(self._named_paths)
        self._built_stamps: Stamps = {}
        self._last_messages: frozenset[tuple[str, str]] = frozenset()
        """Rules and messages of the findings of the last build."""
        self._last_empty_files: frozenset[Path] = frozenset()
        """Files that were empty or missing in the last build."""
        self._uncollected_builds = 0
        """The number of builds whose graphs and syntax trees are still in memory."""
        self._first_units: Sequence[CompiledUnit] = ()
        """The units of the first build, during which no saves are reported."""

    def list_folders(self) -> list[Path]:
        """Return the folders of the inputs; exit with code 2 if one is missing."""
        from sysmlc.cli.session import fail

        folders_found = {path if path.is_dir() else path.parent for path in self._named_paths}
        missing = sorted(str(folder) for folder in folders_found if not folder.exists())
        if missing:
            fail(f"there is no folder '{missing[0]}' to watch")
        return sorted({*folders_found, *([self._config_folder] if self._config_folder else [])})

    def build_if_changed(self, saved: Iterable[Path]) -> None:
        """Compile if the inputs or the *saved* files have changed since the last build."""
        self._watched_paths |= dict.fromkeys(saved)
        state, (first_units, self._first_units) = (
            read_stamps(self._watched_paths),
            (self._first_units, ()),
        )
        # An invalid configuration ends other commands; this one waits for the next save.
        with suppress(SystemExit):
            if state != self._built_stamps or not self._is_current(first_units):
                self._built_stamps = state
                self.build()
            else:
                self.clean_up()

    def start(self) -> None:
        """Compile, unless an earlier child process reached a limit with the same inputs."""
        if LIMITS.has_ended_build(self._digest_inputs()):
            self._built_stamps = read_stamps(self._watched_paths)
        else:
            self.build()

    def _digest_inputs(self) -> int:
        """Return a digest of the sizes and modification times of the named inputs."""
        return crc32(
            repr(sorted(read_stamps(self._named_paths).items())).encode("utf-8", "surrogatepass")
        )

    def build(self) -> None:
        """Compile the inputs, print the findings, and write the outputs if there are no errors."""
        is_first = not self._built_stamps
        units = self._compile_stable_inputs()
        self._first_units = units if is_first else ()
        # Temporary files that a tool saved and removed are no longer watched.
        for path, stamp in list(self._built_stamps.items()):
            if stamp is None and path not in self._named_paths:
                del self._watched_paths[path]
        self._built_stamps = {path: self._built_stamps.get(path) for path in self._watched_paths}
        with LIMITS.apply_to_block():
            for unit in units:
                publish(unit, self._settings, self._keep_going)
        self._uncollected_builds += 1
        if self._uncollected_builds >= _MAX_UNCOLLECTED_BUILDS:
            self.clean_up()

    def clean_up(self) -> None:
        """Free graphs and syntax trees, whose nodes form cycles of references."""
        # Without this, each edit of the ICE laboratory left 14 MB in memory.
        if self._uncollected_builds:
            gc.collect()
            self._uncollected_builds = 0

    def _compile_stable_inputs(self) -> "list[CompiledUnit]":
        """Compile until the inputs were completely saved; return the units."""
        for _ in range(_MAX_ATTEMPTS):
            before = wait_until_stable(self._watched_paths, self._find_delay())
            with LIMITS.limit_build(self._digest_inputs()):
                units = compile_all(self._models, self._output, self._settings)
            # A file was saved during the compilation, so the units may mix two states.
            if read_stamps(before) != before:
                continue
            outcomes = [unit.outcome for unit in units]
            new = dict.fromkeys(
                o.root / f.path.partition("!")[0] for o in outcomes for f in o.inputs
            )
            self._watched_paths |= new
            # The stamps are those from before the compilation, so that later saves differ.
            self._built_stamps = {**read_stamps(new), **before}
            if not new.keys() <= before.keys() and not self._is_current(units):
                continue
            # A new finding may be due to a half-saved file: half a notation file was reported as
            # unreadable. It is reported only if the files remain unchanged for a longer time.
            messages, empty_files = _list_messages(units), find_empty_files(before)
            is_known = messages <= self._last_messages and empty_files <= self._last_empty_files
            if is_known or not is_fresh(before, self._confirmation_seconds):
                break
            if wait_until_stable(before, self._confirmation_seconds) == before:
                break
        self._last_messages, self._last_empty_files = (
            _list_messages(units),
            find_empty_files(before),
        )
        return units

    def _is_current(self, units: "Sequence[CompiledUnit]") -> bool:
        """Whether the units were compiled from the current inputs, including new files."""
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
        """Return for how many seconds files must be unchanged before they are compiled.

        It is longer for a configuration that was just saved: its errors end the compilation before
        it could be repeated.
        """
        from sysmlc.config import FILE_NAME

        named = [path for path in self._watched_paths if path.name in (FILE_NAME, "pyproject.toml")]
        is_new = bool(named) and is_fresh(read_stamps(named), self._confirmation_seconds)
        return self._confirmation_seconds if is_new else self._settle


def compile_all(
    models: tuple[Path, ...], output: Path | None, settings: "Settings"
) -> "list[CompiledUnit]":
    """Compile every unit in this process, without the cache."""
    from sysmlc.cli import session
    from sysmlc.cli.units import open_units

    config = session.load_config(models, settings)
    units = open_units(models, config, settings, output)
    outcomes = session.compile_units(units, settings, uses_cache=False)
    return [
        CompiledUnit(unit, session.target_of(unit), outcome)
        for unit, outcome in zip(units, outcomes, strict=True)
    ]


def publish(unit: CompiledUnit, settings: "Settings", keep_going: bool) -> None:
    """Print the findings, and write the outputs of a unit without errors.

    With *keep_going* a unit with errors is written, too.
    """
    from sysmlc.cli import reports
    from sysmlc.driver import publish as write_outputs

    folder, code = unit.unit.output, unit.outcome.exit_code()
    has_blocking_errors = code > 1 or (code > 0 and not keep_going)
    publication = None if has_blocking_errors else write_outputs(unit.outcome, unit.target)
    is_updated = publication is not None and not publication.is_refused
    changed = publication.changed if publication is not None and is_updated else ()
    withheld = sorted(file.path for file in unit.outcome.withheld)
    summary = {
        "folder": str(folder),
        "is_updated": is_updated,
        "changed": list(changed),
        "withheld": withheld,
    }
    publications = [publication] if publication is not None else []
    reports.report_outcomes(
        [unit.outcome], settings, publications, {"output": summary}, is_one_line=True
    )
    if not reports.allows_sentences(settings):
        return
    if has_blocking_errors:
        terminal.echo(f"{folder}: not updated because the model has errors")
    elif not is_updated:
        terminal.echo(f"{folder}: not updated")
    else:
        held = f", {len(withheld)} withheld because of errors" if withheld else ""
        terminal.echo(f"{folder}: {len(changed)} changed{held}")


def _list_messages(units: "list[CompiledUnit]") -> frozenset[tuple[str, str]]:
    """Return the rule codes and messages of the findings.

    Lines are omitted, because an edit moves findings that are not new.
    """
    diagnostics = (finding.diagnostic for unit in units for finding in unit.outcome.findings)
    return frozenset((d.rule.code, d.message) for d in diagnostics)


def _unit_files(
    models: tuple[Path, ...], settings: "Settings"
) -> "tuple[Config, tuple[Path, ...]]":
    from sysmlc.cli import session
    from sysmlc.cli.units import select

    config = session.load_config(models, settings)
    selections = select(models, config, None, ())
    return config, tuple(file for selection in selections for file in selection.files)
