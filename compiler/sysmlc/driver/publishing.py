"""Bring an output folder up to date: write changed files and remove stale ones.

A build may be killed at any moment, or the disk may be full. The next build then finds one of
these states, and what it does leads to the same folder as a build without an interruption:

1. Files that are no longer generated are removed. ``manifest.json`` still lists them; that a
   listed file is missing does no harm.
2. ``manifest.pending.json`` is written. It is the future manifest: from now on the old and the
   new digest of each file both make it ours.
3. Changed files are written to temporary files, which are renamed when all of them are on the
   disk. Temporary files of a killed build are recognised by their names and removed in step 1.
4. ``manifest.pending.json`` is renamed to ``manifest.json``, and the build is complete.

When a build replaces the pending manifest of another one, it first removes the files of which
only the old pending manifest has the digest, else nobody would own them in steps 2 and 3. Of two
builds at once, one waits for the other.

The other commands publish their results in the same way, with a manifest of their own name. They
remove no results of earlier runs.
"""

import errno
import os
import time
from collections.abc import Collection, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

from msgspec import Struct

from sysmlc.diagnostics import Diagnostic, Place, Severity, Sink, Subject, rule
from sysmlc.driver.outcome import Outcome, format_manifest
from sysmlc.driver.ownership import (
    MANIFEST,
    MANIFESTS,
    OTHER,
    RESULTS,
    ForeignManifestError,
    Ownership,
    compute_digest,
    find_unlisted,
    pending_name,
    read_ownership,
)
from sysmlc.sources import Roots
from sysmlc.support.atomic_files import is_temporary, sync, write, write_temporary
from sysmlc.support.output import find_obstacle

FOREIGN_FILE = rule(
    "SM910",
    "foreign-output-file",
    Severity.ERROR,
    "'{path}' is not overwritten: {reason}",
    help="delete or move the file, choose another folder with -o, or use '{command} --force'",
)
PROTECTED_FILE = rule(
    "SM911",
    "protected-output-file",
    Severity.ERROR,
    "'{path}' is not written: {reason}",
    help="choose another output folder with -o",
)
UNWRITABLE_FILE = rule(
    "SM912",
    "unwritable-output",
    Severity.ERROR,
    "cannot write '{path}': {reason}",
    help="free space on the disk, change the permissions, or do what the reason says; "
    "then build again",
)
EDITED_STALE_FILE = rule(
    "SM913",
    "edited-stale-output",
    Severity.WARNING,
    "'{path}' is no longer generated but was edited by hand; it is not removed",
    help="delete it if it is not needed",
)
_SYNCS = 16
"""Files to wait for at once: 500 files took 1.6 s one by one, and 0.1 s at once (ext4)."""


class Target(Struct, frozen=True):
    """The folder that takes the outputs of one unit, or the results of another command.

    The folder must lie in ``boundary`` (None: anywhere). ``configurations`` are files that are
    protected like the inputs. With ``is_forced``, foreign and edited files are replaced.
    """

    folder: Path
    boundary: Path | None = None
    configurations: tuple[Path, ...] = ()
    is_forced: bool = False
    command: str = "build"

    @property
    def manifest(self) -> str:
        """The name of the manifest that lists the files of the command."""
        return MANIFEST if self.command == "build" else RESULTS


class Publication(Struct, frozen=True):
    """The result of publishing: the paths that changed, or the reasons why nothing was written."""

    changed: tuple[str, ...]
    diagnostics: tuple[Diagnostic, ...]

    @property
    def is_refused(self) -> bool:
        """Whether the folder is not up to date now."""
        return any(diagnostic.is_error for diagnostic in self.diagnostics)


class _Plan(Struct, frozen=True):
    """The steps that bring a folder up to date: removals, then writes, the manifest last."""

    removals: tuple[str, ...]
    writes: tuple[str, ...]
    manifest: str
    has_new_manifest: bool
    refused: tuple[str, ...]
    ownership: Ownership


def publish(outcome: Outcome, target: Target) -> Publication:
    """Bring the folder up to date. Nothing is written if one of its files belongs to others."""
    sink, changed = Sink(), list[str]()
    try:
        if _check_boundary(target, sink):
            target.folder.mkdir(parents=True, exist_ok=True)
            with _lock_folder(target.folder):
                plan = _plan(outcome, target, sink)
                if not plan.refused:
                    changed = _apply(plan, outcome, target)
    except ForeignManifestError as problem:
        _report_protected(problem.file, "it is not a manifest of sysmlc", sink)
    except OSError as problem:
        place = Path(os.fsdecode(problem.filename or target.folder))
        reason = problem.strerror or str(problem)
        sink.report(UNWRITABLE_FILE, _subject(place), path=_show(place), reason=reason)
    return Publication(tuple(changed), tuple(sink))


def compare(outcome: Outcome, target: Target) -> list[str]:
    """Return the paths that are not up to date, and the unlisted files, sorted.

    Unlisted files are in folders that sysmlc wrote, but no build generates them any more.
    """
    folder = target.folder
    try:
        plan = _plan(outcome, target, Sink())
    except ForeignManifestError as problem:
        return [problem.file.name]
    listed = [file.path for file in outcome.files]
    unlisted = [] if plan.ownership.is_shared else find_unlisted(folder, listed)
    kept = [] if outcome.is_complete else plan.ownership.paths()
    manifest = [MANIFEST] if plan.has_new_manifest else []
    removals = [path for path in plan.removals if os.path.lexists(folder / path)]
    paths = {*removals, *plan.writes, *plan.refused, *manifest, *unlisted}
    return sorted(paths.difference(kept))


def _check_boundary(target: Target, sink: Sink) -> bool:
    if target.boundary is None or Roots((target.boundary,)).allows(target.folder):
        return True
    _report_protected(target.folder, f"it lies outside '{target.boundary}'", sink)
    return False


def _plan(outcome: Outcome, target: Target, sink: Sink) -> _Plan:
    """Compare the folder with the outcome; report files that must not be replaced.

    When an input could not be read, its output files of an earlier run are kept and listed as kept.
    """
    folder = target.folder
    digests = {file.path: file.sha256 for file in outcome.files}
    inputs = [outcome.root / file.path.partition("!")[0] for file in outcome.inputs]
    protected = (*target.configurations, *inputs)
    ownership = read_ownership(folder, protected, digests, target.manifest)
    removals, writes, refused = [], [], []
    for path, digest in digests.items():
        current = compute_digest(folder, path)
        if current == digest:
            continue
        if _may_write(path, current, target, ownership, sink):
            writes.append(path)
            if current is not None and ownership.is_only_pending(path, current):
                removals.append(path)
        else:
            refused.append(path)
    kept = {}
    for path in ownership.paths():
        current = None if path in digests else compute_digest(folder, path)
        if path in digests or (current is not None and ownership.is_protected(path)):
            continue
        if current is None or (outcome.is_complete and ownership.owns(path, current)):
            removals.append(path)
        elif ownership.owns(path, current):
            kept[path] = current
        elif current != OTHER and outcome.is_complete:
            sink.report(EDITED_STALE_FILE, _subject(folder / path), path=_show(folder / path))
    removals += _find_temporaries(folder, {*digests, *ownership.paths()})
    manifest = format_manifest(outcome, kept)
    is_new = _read_bytes(folder / target.manifest) != manifest.encode("utf-8")
    has_new_manifest = is_new or (folder / pending_name(target.manifest)).exists()
    return _Plan(
        tuple(removals), tuple(writes), manifest, has_new_manifest, tuple(refused), ownership
    )


def _may_write(
    path: str, current: str | None, target: Target, ownership: Ownership, sink: Sink
) -> bool:
    """Whether the file *path* may be written or overwritten; reports why not."""
    place = target.folder / path
    if path in MANIFESTS:
        _report_protected(place, "this is the name of a manifest", sink)
    elif current is None:
        return True
    elif ownership.is_protected(path):
        _report_protected(place, "it is an input or a configuration", sink)
    elif current == OTHER:
        obstacle = find_obstacle(target.folder, path) or place
        _report_protected(obstacle, "it is a link, or not of the kind that is needed", sink)
    elif target.is_forced or ownership.owns(path, current):
        return True
    else:
        is_listed = path in ownership.paths()
        reason = "it was edited after sysmlc wrote it" if is_listed else "sysmlc did not write it"
        sink.report(
            FOREIGN_FILE,
            _subject(place),
            path=_show(place),
            reason=reason,
            command=target.command,
        )
    return False


def _report_protected(place: Path, reason: str, sink: Sink) -> None:
    sink.report(PROTECTED_FILE, _subject(place), path=_show(place), reason=reason)


def _subject(place: Path) -> Subject:
    return Subject(place=Place(str(place.absolute())))


def _show(place: Path) -> str:
    """Return a path as the user knows it: relative to the working folder if it is in there."""
    path = place.absolute()
    return (path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path).as_posix()


def _find_temporaries(folder: Path, paths: Iterable[str]) -> list[str]:
    """Return temporary files of killed builds in the folders of *paths*."""
    temporaries = []
    for parent in sorted({"", *(path.rpartition("/")[0] for path in paths)}):
        try:
            names = os.listdir(folder / parent)  # noqa: PTH208
        except (FileNotFoundError, NotADirectoryError):
            continue
        temporaries += [
            f"{parent}/{name}".lstrip("/") for name in sorted(names) if is_temporary(name)
        ]
    return temporaries


def _read_bytes(path: Path) -> bytes | None:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        return None


def _apply(plan: _Plan, outcome: Outcome, target: Target) -> list[str]:
    """Carry out the steps that the docstring of the module lists; return what changed."""
    folder, pending = target.folder, pending_name(target.manifest)
    changed = [path for path in plan.removals if _remove(folder, path)]
    if plan.has_new_manifest:
        write(folder / pending, plan.manifest.encode("utf-8"))
        sync(folder)
    if plan.writes:
        _write_files(folder, {path: outcome.texts[path] for path in plan.writes})
    if plan.has_new_manifest:
        os.replace(folder / pending, folder / target.manifest)  # noqa: PTH105 - one name to intercept
        sync(folder)
    new_manifest = [target.manifest] if plan.has_new_manifest else []
    return [*dict.fromkeys([*changed, *plan.writes]), *new_manifest]


def _write_files(folder: Path, texts: Mapping[str, str]) -> None:
    temporaries: dict[str, str] = {}
    try:
        for path, text in texts.items():
            # A link that was made after the plan must not redirect the write.
            obstacle = find_obstacle(folder, path)
            if obstacle is not None:
                raise OSError(errno.ELOOP, "it was replaced by a link", str(obstacle))
            parent = str((folder / path).parent)
            temporaries[path] = write_temporary(parent, text.encode("utf-8"))
        # The contents are on the disk before the first replacement: no crash leaves half a file.
        _sync_all(temporaries.values())
        for path in texts:
            os.replace(temporaries[path], folder / path)  # noqa: PTH105
            del temporaries[path]
        for parent in sorted({str((folder / path).parent) for path in texts}):
            sync(parent)
    finally:
        for temporary in temporaries.values():
            Path(temporary).unlink(missing_ok=True)


def _sync_all(paths: Collection[str]) -> None:
    """Wait until all files are on the disk."""
    if len(paths) < _SYNCS:  # the import of threads costs 11 ms
        for path in paths:
            sync(path)
        return

    try:
        with ThreadPoolExecutor(_SYNCS) as pool:
            list(pool.map(sync, paths))
    except RuntimeError:  # a limit on memory or processes leaves no room for threads
        for path in paths:
            sync(path)


def _remove(folder: Path, path: str) -> bool:
    """Remove a file and the folders that become empty; return whether there was a file."""
    if find_obstacle(folder, path) is not None:
        return False
    try:
        os.unlink(folder / path)  # noqa: PTH108
        existed = True
    except FileNotFoundError:
        existed = False
    for parent in (folder / path).parents:
        if parent == folder:
            break
        try:
            os.rmdir(parent)  # noqa: PTH106
        except FileNotFoundError:
            continue
        except OSError as problem:
            # POSIX allows either number for a folder that is not empty.
            if problem.errno not in (errno.ENOTEMPTY, errno.EEXIST):
                raise
            break
    return existed


# -- lock --------------------------------------------------------------------------------------

_PATIENCE = 10.0
"""Seconds to wait for another process that writes to the same folder."""
_PAUSE = 0.05


@contextmanager
def _lock_folder(folder: Path) -> Iterator[None]:
    """Exclude other processes that publish to *folder*, if the system can lock folders.

    Raises OSError if another process holds the lock for too long.
    """
    # Windows has no fcntl.
    try:
        import fcntl
    except ImportError:
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        end = time.monotonic() + _PATIENCE
        while True:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                if time.monotonic() > end:
                    reason = "another sysmlc is writing to the folder"
                    raise OSError(errno.EBUSY, reason, str(folder)) from None
                time.sleep(_PAUSE)
            except OSError:
                break  # a file system without locks
            else:
                break
        yield
    finally:
        os.close(handle)  # releases the lock
