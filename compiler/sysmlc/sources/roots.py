"""Roots: the folders outside which references in a model cannot open files."""

import os
import re
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

from msgspec import Struct

_MAX_PATH = 4096
"""File systems have no longer paths, and resolving one takes a system call for each part."""
_WORKSPACE = re.compile(r"platform:/resource/([^/]+)/(.+)")
_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+:")


class Roots(Struct, frozen=True):
    """Folders that references may lead into; files outside them are never opened."""

    folders: tuple[Path, ...]

    def resolve(self, base: Path, href: str) -> Path | None:
        """Return the file that *href* in the file *base* names, if it exists and is allowed.

        A reference with a scheme (http, pathmap) is never followed, except Eclipse's
        ``platform:/resource/Project/file``: the project is a folder above *base*, or beside one
        of these folders. Symbolic links are resolved before they are checked.
        """
        path = unquote(href.partition("#")[0])
        if not path or len(path) > _MAX_PATH or "\0" in path:
            return None
        for candidate in _iter_candidates(base, path):
            target = os.path.realpath(candidate)
            # Path.is_file raises an error for a path that no file system can hold.
            if self.allows(Path(target)) and os.path.isfile(target):  # noqa: PTH113
                return Path(target)
        return None

    def allows(self, path: Path) -> bool:
        """Whether *path*, its symbolic links resolved, is inside one of the folders."""
        real = Path(os.path.realpath(path))
        return any(real.is_relative_to(os.path.realpath(folder)) for folder in self.folders)


def _iter_candidates(base: Path, path: str) -> Iterator[Path]:
    """Yield the files that a reference may mean, the most likely first."""
    workspace = _WORKSPACE.fullmatch(path)
    if workspace is None:
        if not _SCHEME.match(path):
            yield base.parent / path
        return
    for folder in base.parents:
        if folder.name == workspace[1]:
            yield folder / workspace[2]
        yield folder / workspace[1] / workspace[2]
