"""Which files of an output folder sysmlc wrote: those in a manifest, by path and digest.

A manifest may come from a stranger's repository. It is therefore only a claim: a file counts as
ours if its content has the digest that the manifest states, and never if it is an input or a
configuration, or lies in a repository of git.
"""

import hashlib
import json
import os
import stat
from collections.abc import Iterable, Mapping
from pathlib import Path

from msgspec import Struct

from sysmlc.support.output import OutputPathError, check_output_path, find_obstacle, read_mode

MANIFEST = "manifest.json"
RESULTS = "manifest.results.json"
"""The manifest of what other commands than ``build`` wrote; a build does not remove these files."""


def pending_name(manifest: str) -> str:
    """Return the name of a manifest until all its files are there."""
    return manifest.replace(".json", ".pending.json")


MANIFESTS = frozenset({*(MANIFEST, RESULTS), *map(pending_name, (MANIFEST, RESULTS))})
FORMAT = "sysmlc-manifest/2"
_FORMATS = "sysmlc-manifest/"
_MAX_SIZE = 16 << 20
"""Bytes of a manifest that are read, enough for 80,000 files."""
_MAX_NAME = 255
"""Bytes of a name in a folder; no usual file system has longer names."""
_FOLDERS = frozenset(
    [
        *("aml", "contracts", "diagrams", "monitors", "recipes", "requirements"),
        *("sysml", "sysmlx", "uml"),
    ]
)
_FILES = frozenset(
    {"coverage.json", "graph.ir", "graph.json", "graph.xmi", "platform.json", "trace.json"}
)
OTHER = "not a file"
"""Stands for the digest of whatever is not a regular file that can be reached without links."""


class ForeignManifestError(Exception):
    """A file has the name of a manifest, but sysmlc did not write it."""

    def __init__(self, file: Path) -> None:
        super().__init__(f"'{file}' is not a manifest of sysmlc")
        self.file = file


def is_output_folder(folder: Path) -> bool:
    """Whether sysmlc wrote *folder*, so that the models in it are outputs and not inputs."""
    for name in (MANIFEST, pending_name(MANIFEST)):
        try:
            if not stat.S_ISREG(read_mode(folder / name) or 0):
                continue
            with open(folder / name, "rb", opener=_open_without_waiting) as stream:
                if f'"{_FORMATS}'.encode() in stream.read(200):
                    return True
        except OSError:
            continue
    return False


def _read_manifest(file: Path) -> dict[str, str]:
    """Return the digest of each file that a manifest lists; nothing if there is no manifest.

    Entries with a wrong type or a path out of the folder are ignored. Raises ForeignManifestError
    and OSError.
    """
    mode = read_mode(file)
    if mode is None:
        return {}
    if not stat.S_ISREG(mode):
        raise ForeignManifestError(file)
    with open(file, "rb", opener=_open_without_waiting) as stream:
        data = stream.read(_MAX_SIZE + 1)
    try:
        content = json.loads(data) if len(data) <= _MAX_SIZE else None
    except (ValueError, RecursionError):
        content = None
    # Version 1 has the key "schema". It listed neither coverage.json nor trace.json.
    form = content.get("format", content.get("schema")) if isinstance(content, dict) else None
    if not isinstance(content, dict) or not str(form).startswith(_FORMATS):
        raise ForeignManifestError(file)
    entries = [entry for key in ("files", "kept") for entry in _as_list(content.get(key))]
    return dict(pair for entry in entries if (pair := _parse_entry(entry)) is not None)


def _as_list(value: object) -> list[object]:
    return value if isinstance(value, list) else []


def _parse_entry(entry: object) -> tuple[str, str] | None:
    if not isinstance(entry, dict):
        return None
    path, digest = entry.get("path"), entry.get("sha256")
    if not isinstance(path, str) or not isinstance(digest, str) or path in MANIFESTS:
        return None
    try:
        check_output_path(path)
        names = path.encode().split(b"/")
    except (OutputPathError, UnicodeEncodeError):  # a lone surrogate is in the name of no file
        return None
    return (path, digest) if max(map(len, names)) <= _MAX_NAME else None


def compute_digest(folder: Path, path: str) -> str | None:
    """Return the SHA-256 of the file *path* of *folder*, in hex; None if nothing is there.

    No link inside *folder* is followed. Raises OSError for a file that cannot be read.
    """
    if find_obstacle(folder, path) is not None:
        return OTHER
    try:
        with open(folder / path, "rb", opener=_open_without_waiting) as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except (FileNotFoundError, NotADirectoryError):
        return None


def _open_without_waiting(path: str, flags: int) -> int:
    """Open a file that is not a link, without waiting for the writer of a pipe."""
    # A manifest of somebody else may list a pipe or a link. Windows has neither of the flags.
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOFOLLOW", 0))


class Ownership(Struct, frozen=True):
    """The claims of the manifests in one output folder, and the files that no claim covers.

    ``protected`` are inputs and configurations, by device and inode, so that hard links and other
    spellings of a name count as the same file. ``is_shared`` says whether the folder also belongs
    to others.
    """

    folder: Path
    is_shared: bool
    listed: Mapping[str, str]
    pending: Mapping[str, str]
    protected: frozenset[tuple[int, int]]

    def owns(self, path: str, digest: str) -> bool:
        """Whether the file *path*, which has *digest* now, may be overwritten or removed."""
        is_claimed = digest in (self.listed.get(path), self.pending.get(path))
        return is_claimed and not self.is_protected(path)

    def is_only_pending(self, path: str, digest: str) -> bool:
        """Whether the content of *path* is from an interrupted build, not from a complete one."""
        return digest == self.pending.get(path) != self.listed.get(path)

    def is_protected(self, path: str) -> bool:
        """Whether *path* is an input or a configuration, whatever a manifest lists."""
        try:
            status = (self.folder / path).lstat()
        except OSError:
            return False
        return (status.st_dev, status.st_ino) in self.protected

    def paths(self) -> list[str]:
        """Return all paths that a manifest lists, sorted."""
        return sorted({*self.listed, *self.pending})


def read_ownership(
    folder: Path, protected: Iterable[Path], written: Iterable[str], manifest: str = MANIFEST
) -> Ownership:
    """Read a manifest of an output folder, and the pending one of its name.

    A folder that also holds *protected* files or a repository belongs to others, too. There only
    paths of our back ends and those in *written* can be ours: a stranger's manifest may list any
    file of the repository with its right digest. Raises ForeignManifestError and OSError.
    """
    files = [file for file in protected if file.exists()]
    listed = _read_manifest(folder / manifest)
    pending = _read_manifest(folder / pending_name(manifest))
    real = folder.resolve()
    below = [file for file in files if file.resolve().is_relative_to(real)]
    is_shared = bool(below) or (real / ".git").exists()
    # Results are never removed, so that their manifest may list any file.
    if is_shared and manifest == MANIFEST:
        usual = frozenset(written)
        listed = {path: digest for path, digest in listed.items() if _is_usual(path, usual)}
        pending = {path: digest for path, digest in pending.items() if _is_usual(path, usual)}
    identities = frozenset((file.stat().st_dev, file.stat().st_ino) for file in files)
    return Ownership(folder, is_shared, listed, pending, identities)


def _is_usual(path: str, written: frozenset[str]) -> bool:
    first, slash, _ = path.partition("/")
    return path in written or (first in _FOLDERS if slash else path in _FILES)


def find_unlisted(folder: Path, listed: Iterable[str]) -> list[str]:
    """Return the files in our folders that are not in *listed*, sorted.

    Our folders are those of the back ends, and those that hold a listed file.
    """
    listed_paths = frozenset(listed)
    unlisted = []
    for name in sorted({path.partition("/")[0] for path in listed_paths if "/" in path} | _FOLDERS):
        if (folder / name).is_symlink():
            unlisted.append(name)
            continue
        for place, _, files in os.walk(folder / name):
            paths = (Path(place, file).relative_to(folder).as_posix() for file in files)
            unlisted += [path for path in paths if path not in listed_paths]
    return sorted(unlisted)
