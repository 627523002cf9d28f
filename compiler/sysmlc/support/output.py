"""The output of one compilation: artefacts with their trace, and valid paths for them."""

import stat
from collections.abc import Iterable
from pathlib import Path, PureWindowsPath

from msgspec import Struct


class Artefact(Struct, frozen=True):
    """One file that a back end makes.

    ``path`` is relative to the output folder, with ``/``; ``trace`` names the elements (ids)
    that the content comes from: an error about one of them withholds the file.
    """

    path: str
    text: str
    trace: tuple[str, ...] = ()
    backend: str = ""


class OutputPathError(ValueError):
    """A path leads out of the output folder, or into a repository of git."""


def check_output_path(path: str) -> None:
    """Raise OutputPathError unless *path* names a file below the output folder.

    Windows reads backslashes and drives in a path, and ignores case; so does this check.
    """
    parts = path.split("/")
    is_plain = all(part not in ("", ".", "..") for part in parts)
    if not is_plain or "\\" in path or "\0" in path or PureWindowsPath(path).drive:
        raise OutputPathError(f"output path {path!r} leaves the output folder")
    if ".git" in (part.lower() for part in parts):
        raise OutputPathError(f"output path {path!r} lies in a repository of git")


def find_obstacle(folder: Path, path: str) -> Path | None:
    """Return what prevents *path* from being a regular file in *folder*; None if nothing does.

    An obstacle is a symbolic link, a file in place of a folder, or anything but a file at *path*.
    The links that lead to *folder* itself are the user's choice. Raises OutputPathError.
    """
    check_output_path(path)
    *parents, name = path.split("/")
    place = folder
    for parent in parents:
        place /= parent
        mode = _read_mode(place)
        if mode is None:
            return None
        if not stat.S_ISDIR(mode):
            return place
    mode = _read_mode(place / name)
    return None if mode is None or stat.S_ISREG(mode) else place / name


def _read_mode(path: Path) -> int | None:
    """Return the mode of *path* itself, links not followed; None if nothing is there."""
    try:
        return path.lstat().st_mode
    except FileNotFoundError:
        return None


class Output:
    """What the back ends of one compilation have made so far."""

    def __init__(self) -> None:
        self._artefacts: dict[str, Artefact] = {}
        self._last: tuple[Iterable[str], tuple[str, ...]] = ((), ())

    def add(self, path: str, text: str, trace: Iterable[str] = (), backend: str = "") -> None:
        """Add a file. Raises ValueError when the path is taken or leaves the folder."""
        check_output_path(path)
        if path in self._artefacts:
            raise ValueError(f"output path {path!r} is written twice")
        if self._last[0] is not trace or not isinstance(trace, tuple):
            # Several files of one element often have one trace, and it can be long.
            self._last = (trace, tuple(dict.fromkeys(trace)))
        self._artefacts[path] = Artefact(path, text, self._last[1], backend)

    def artefacts(self) -> list[Artefact]:
        """All files, sorted by path."""
        return [self._artefacts[path] for path in sorted(self._artefacts)]
