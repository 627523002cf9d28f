"""The output of one compilation: artefacts with their trace, and how they reach the disk."""

import json
import os
import stat
from collections.abc import Iterable, Mapping
from pathlib import Path, PureWindowsPath

from msgspec import Struct

from sysmlc.patterns import pattern

_TEMPORARY = pattern(r"\.sysmlc-[0-9a-f]{16}")
_MODE = 0o644
"""Who may read and write a new file, as far as the user's mask lets them."""


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


def encode_json(content: object, indent: int = 1) -> str:
    """Return *content* as the text of a JSON file: indented, with a line feed at the end.

    Characters beyond ASCII stay as they are, because all files are UTF-8.
    """
    return json.dumps(content, ensure_ascii=False, indent=indent) + "\n"


def encode_row(content: object) -> str:
    """Return *content* as JSON on one line, for lists that are too long to be indented."""
    return json.dumps(content, ensure_ascii=False)


def append_members(head: Mapping[str, object], members: Iterable[str]) -> str:
    """Return a JSON file with the members of *head* and then *members*, which are JSON already."""
    start = encode_json(head, 2).removesuffix("\n}\n")
    return ",\n".join((start, *members)) + "\n}\n"


def write_if_changed(target: Path, text: str) -> bool:
    """Write UTF-8 text with LF, in one step, if the file differs; say whether it was written."""
    data = text.encode("utf-8")
    if target.is_file() and target.read_bytes() == data:
        return False
    write(target, data)
    return True


def is_temporary(name: str) -> bool:
    """Whether a file has the name of one that a process wrote and had no time to rename."""
    return _TEMPORARY.fullmatch(name) is not None


def write(target: Path | str, data: bytes) -> None:
    """Make the file, or replace it, in one step: no reader sees half of it.

    The content reaches the disk before the name does, so that not even a power failure leaves
    half a file.
    """
    temporary = write_temporary(os.path.dirname(target), data)  # noqa: PTH120
    try:
        sync(temporary)
        os.replace(temporary, target)  # noqa: PTH105 - a Path for each file costs as much again
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def write_temporary(folder: str, data: bytes) -> str:
    """Write *data* to a new file in *folder*, which is made if need be; return its path."""
    temporary = os.path.join(folder, f".sysmlc-{os.urandom(8).hex()}")  # noqa: PTH118
    handle = _opened(temporary, folder)
    try:
        try:
            _write_all(handle, data)
        finally:
            os.close(handle)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
    return temporary


def sync(path: Path | str) -> None:
    """Wait until the content of a file, or the names in a folder, are on the disk.

    Windows can do that only for files that are open for writing; there this does nothing.
    """
    if os.name == "nt":
        return
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _write_all(handle: int, data: bytes) -> None:
    """Write without a file object: there may be thousands of files."""
    written = os.write(handle, data)
    while written < len(data):
        data = data[written:]
        written = os.write(handle, data)


def _opened(temporary: str, folder: str) -> int:
    """Handle of a new file. Most folders are there: to ask for each file costs time."""
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    try:
        return os.open(temporary, flags, _MODE)
    except FileNotFoundError:
        Path(folder).mkdir(parents=True, exist_ok=True)
        return os.open(temporary, flags, _MODE)
