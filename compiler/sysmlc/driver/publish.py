"""From a compilation to the output folder: only what changed is written, stale files go."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from sysmlc.driver.compilation import Compilation
from sysmlc.driver.manifest import (
    COVERAGE,
    MANIFEST,
    TRACE,
    coverage_text,
    manifest_text,
    trace_text,
)
from sysmlc.output import write_if_changed


class OutputError(Exception):
    """The output folder cannot be written; the message says why."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What the output folder should hold, and what in it is stale."""

    folder: Path
    files: Mapping[str, str]
    stale: tuple[str, ...]

    def differences(self) -> list[str]:
        """Paths that ``apply`` would write or remove, sorted."""
        changed = [path for path, text in self.files.items() if not self._holds(path, text)]
        return sorted([*changed, *self.stale])

    def _holds(self, path: str, text: str) -> bool:
        target = self.folder / path
        return target.is_file() and target.read_bytes() == text.encode("utf-8")


def plan(compilation: Compilation, folder: Path) -> Plan:
    """What the folder should hold. Files that other programs made are never stale.

    When an input could not be read, what an earlier run made of it is kept and listed as such.
    """
    files = {artefact.path: artefact.text for artefact in compilation.written()}
    files[COVERAGE] = coverage_text(compilation)
    files[TRACE] = trace_text(compilation)
    left = tuple(p for p in _previous(folder) if p not in files and (folder / p).is_file())
    kept, stale = ((), left) if compilation.is_complete else (left, ())
    files[MANIFEST] = manifest_text(compilation, kept)
    return Plan(folder, files, stale)


def apply(plan: Plan) -> list[str]:
    """Bring the folder up to date; the paths that were written or removed.

    Every file is replaced in one step, the manifest last. Raises OutputError.
    """
    try:
        removed = [_remove(plan.folder, path) for path in plan.stale]
        return removed + [
            path for path, text in plan.files.items() if write_if_changed(plan.folder / path, text)
        ]
    except OSError as problem:
        where = problem.filename or plan.folder
        raise OutputError(f"cannot write {where}: {problem.strerror or problem}") from problem


def _previous(folder: Path) -> list[str]:
    """What the manifest in the folder lists, as far as it lies in the folder."""
    try:
        manifest = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
        if not str(manifest["schema"]).startswith("sysmlc-manifest/"):
            return []
        entries = (*manifest["files"], *manifest["withheld"], *manifest["kept"])
        paths = {str(entry["path"]) for entry in entries}
    except (OSError, ValueError, KeyError, TypeError):
        return []
    return sorted(path for path in paths if _is_inside(folder, path))


def _is_inside(folder: Path, path: str) -> bool:
    pure = PurePosixPath(path)
    if pure.is_absolute() or ".." in pure.parts:
        return False
    return (folder / path).resolve().parent.is_relative_to(folder.resolve())


def _remove(folder: Path, path: str) -> str:
    (folder / path).unlink()
    for parent in (folder / path).parents:
        if parent == folder or any(parent.iterdir()):
            break
        parent.rmdir()
    return path
