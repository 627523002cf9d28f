"""From a compilation to the output folder: only what changed is written, stale files go."""

import hashlib
import json
import os
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path, PurePosixPath

from sysmlc.driver.manifest import MANIFEST, manifest_text
from sysmlc.driver.outcome import Outcome, digest_of
from sysmlc.output import write
from sysmlc.values import dataclass


class OutputError(Exception):
    """The output folder cannot be written; the message says why."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What the output folder should hold: SHA-256 of each path, texts, and what is stale."""

    folder: Path
    digests: Mapping[str, str]
    texts: Mapping[str, str]
    manifest: str
    stale: tuple[str, ...]

    def text(self, path: str) -> str:
        """What the file at the path should hold."""
        return self.manifest if path == MANIFEST else self.texts[path]

    def missing(self) -> list[str]:
        """Paths that the folder does not hold as they should be."""
        listed = {folder: self._names(folder) for folder in {*map(_parent, self.digests)}}
        return [
            path
            for path, digest in self.digests.items()
            if path.rpartition("/")[2] not in listed[_parent(path)] or not self._holds(path, digest)
        ]

    def differences(self) -> list[str]:
        """Paths that ``apply`` would write or remove, sorted."""
        return sorted([*self.missing(), *self.stale])

    def place(self, path: str) -> str:
        """Where the file at the path is; a text, for there may be thousands."""
        return os.path.join(self.folder, path)  # noqa: PTH118

    def _names(self, folder: str) -> frozenset[str]:
        """What is in a folder: to look for each of thousands of new files takes longer."""
        try:
            return frozenset(os.listdir(self.place(folder)))  # noqa: PTH208
        except (FileNotFoundError, NotADirectoryError):
            return frozenset()

    def _holds(self, path: str, digest: str) -> bool:
        """Whether the file at the path is as it should be."""
        if path in self.texts:
            wanted = self.texts[path].encode("utf-8")
            return _content(self.place(path), len(wanted)) == wanted
        found = _content(self.place(path))
        return found is not None and hashlib.sha256(found).hexdigest() == digest


def _content(path: str, size: int | None = None) -> bytes | None:
    """The bytes of a file; None where there is none, or none of that size.

    It is read at once: of a file for which that fails, it is told that it holds something else.
    """
    try:
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_BINARY", 0))
    except (FileNotFoundError, IsADirectoryError, NotADirectoryError):
        return None
    try:
        there = os.fstat(handle).st_size
        return os.read(handle, there) if size is None or size == there else None
    except IsADirectoryError:
        return None
    finally:
        os.close(handle)


def _parent(path: str) -> str:
    return path.rpartition("/")[0]


def plan(outcome: Outcome, folder: Path) -> Plan:
    """What the folder should hold. Files that other programs made are never stale.

    When an input could not be read, what an earlier run made of it is kept and listed as such.
    """
    digests = {file.path: file.sha256 for file in outcome.files}
    left = tuple(path for path in _previous(folder, digests) if (folder / path).is_file())
    kept, stale = ((), left) if outcome.is_complete else (left, ())
    manifest = manifest_text(outcome, kept)
    digests[MANIFEST] = digest_of(manifest)
    return Plan(folder, digests, outcome.texts, manifest, stale)


def apply(plan: Plan) -> list[str]:
    """Bring the folder up to date; the paths that were written or removed.

    Every file is replaced in one step, the manifest last. Raises OutputError.
    """
    try:
        removed = [_remove(plan.folder, path) for path in plan.stale]
        changed = plan.missing()
        for path in changed:
            write(plan.place(path), plan.text(path).encode("utf-8"))
        return removed + changed
    except OSError as problem:
        where = problem.filename or plan.folder
        raise OutputError(f"cannot write {where}: {problem.strerror or problem}") from problem


def _previous(folder: Path, made: Mapping[str, str]) -> list[str]:
    """What the manifest in the folder lists beside what is made, as far as it lies in there."""
    try:
        manifest = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
        # Version 1 of the format has the member 'schema' in place of 'format'.
        if not str(manifest.get("format", manifest.get("schema"))).startswith("sysmlc-manifest/"):
            return []
        entries = (*manifest["files"], *manifest["withheld"], *manifest["kept"])
        paths = {str(entry["path"]) for entry in entries}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return []
    return sorted(filter(_inside(folder), paths - made.keys()))


def _inside(folder: Path) -> Callable[[str], bool]:
    """Whether a path lies in the folder; each folder in it is looked at once."""
    whole = folder.resolve()

    @cache
    def is_inside(parent: str) -> bool:
        return (folder / parent).resolve().is_relative_to(whole)

    def is_file_inside(path: str) -> bool:
        pure = PurePosixPath(path)
        if pure.is_absolute() or ".." in pure.parts:
            return False
        if (folder / path).is_symlink():
            return (folder / path).resolve().parent.is_relative_to(whole)
        return is_inside(path.rpartition("/")[0])

    return is_file_inside


def _remove(folder: Path, path: str) -> str:
    (folder / path).unlink()
    for parent in (folder / path).parents:
        if parent == folder or any(parent.iterdir()):
            break
        parent.rmdir()
    return path
