"""Output files of a compilation: artefacts with their trace, valid names and paths, JSON text."""

import hashlib
import json
import re
import stat
from collections.abc import Iterable, Mapping
from pathlib import Path, PureWindowsPath
from urllib.parse import quote

from msgspec import Struct


class Artefact(Struct, frozen=True):
    """One file that a back end writes.

    ``path`` is relative to the output folder, with ``/``. ``trace`` contains the ids of the
    elements from which the content is derived: the file is withheld if one of them has an error,
    unless it marks the elements with errors.
    """

    path: str
    text: str
    trace: tuple[str, ...] = ()
    backend: str = ""
    marks_faults: bool = False


class OutputPathError(ValueError):
    """A path leads out of the output folder, or into a git repository."""


def check_output_path(path: str) -> None:
    """Raise OutputPathError unless *path* names a file below the output folder.

    The check takes backslashes, drives and upper case as Windows does, on every system.
    """
    parts = path.split("/")
    is_plain = all(part not in ("", ".", "..") for part in parts)
    if not is_plain or "\\" in path or "\0" in path or PureWindowsPath(path).drive:
        raise OutputPathError(f"output path {path!r} leaves the output folder")
    if ".git" in (part.lower() for part in parts):
        raise OutputPathError(f"output path {path!r} lies in a repository of git")


def find_obstacle(folder: Path, path: str) -> Path | None:
    """Return what prevents writing a regular file *path* in *folder*; None if nothing does.

    Obstacles are symbolic links below *folder*, a file where *path* has a folder, and anything but
    a regular file at *path* itself. Links that lead to *folder* are the user's choice. Raises
    OutputPathError.
    """
    check_output_path(path)
    *parents, name = path.split("/")
    current = folder
    for parent in parents:
        current /= parent
        mode = read_mode(current)
        if mode is None:
            return None
        if not stat.S_ISDIR(mode):
            return current
    target = current / name
    mode = read_mode(target)
    return None if mode is None or stat.S_ISREG(mode) else target


def read_mode(path: Path) -> int | None:
    """Return the mode of *path* without following a link; None if nothing exists there."""
    try:
        return path.lstat().st_mode
    except FileNotFoundError:
        return None


_REPOSITORY = re.compile(r"(^|/)\.(git(?:/|$))", re.IGNORECASE)


def make_path_of_input(name: str) -> str:
    """Return the output path for an input file, whose name is relative to the unit's root.

    An archive becomes a folder. What an output path may not contain (backslashes, repositories of
    git) is percent-encoded.
    """
    path = name.replace("!", "/").replace("\\", "%5C")
    return _REPOSITORY.sub(r"\1%2E\2", path)


class Output:
    """The files that the back ends of one compilation have added so far."""

    def __init__(self) -> None:
        self._artefacts: dict[str, Artefact] = {}
        self._last_trace: tuple[Iterable[str], tuple[str, ...]] = ((), ())

    def add(
        self,
        path: str,
        text: str,
        trace: Iterable[str] = (),
        backend: str = "",
        *,
        marks_faults: bool = False,
    ) -> None:
        """Add a file. Raises ValueError if the path is taken or leads out of the folder.

        A file with *marks_faults* shows which elements have errors, and is not withheld for them.
        """
        check_output_path(path)
        if path in self._artefacts:
            raise ValueError(f"output path {path!r} is written twice")
        if self._last_trace[0] is not trace or not isinstance(trace, tuple):
            # Files of one component share their trace, which can have thousands of ids.
            self._last_trace = (trace, tuple(dict.fromkeys(trace)))
        self._artefacts[path] = Artefact(path, text, self._last_trace[1], backend, marks_faults)

    def artefacts(self) -> list[Artefact]:
        """Return all files, sorted by path."""
        return [self._artefacts[path] for path in sorted(self._artefacts)]


# -- names of files ----------------------------------------------------------------------------

_MAX_BYTES = 120
"""Bytes of a name: file systems allow 255, and back ends add suffixes."""
_RESERVED_ON_WINDOWS = frozenset(
    ["con", "prn", "aux", "nul", *(f"{p}{n}" for p in ("com", "lpt") for n in range(10))]
)


def assign_file_names(qualified_names: Iterable[str]) -> dict[str, str]:
    """Return a file name without suffix, valid on every file system, for each qualified name.

    ``::`` becomes ``.``, other special characters are percent-encoded, and a name has at most 120
    bytes. To each of several names that differ only in case, ``~`` and six hexadecimal digits of
    the digest of its qualified name are appended.
    """
    encoded_names = {name: _encode(name) for name in qualified_names}
    counts: dict[str, int] = {}
    for encoded in encoded_names.values():
        counts[encoded.lower()] = counts.get(encoded.lower(), 0) + 1
    return {
        name: encoded if counts[encoded.lower()] == 1 else _append_digest(encoded, name)
        for name, encoded in encoded_names.items()
    }


def _encode(name: str) -> str:
    encoded = quote(name.replace("::", "."), safe="-_.").replace("~", "%7E").strip(".") or "_"
    # Windows reserves these names with any suffix.
    if encoded.split(".")[0].lower() in _RESERVED_ON_WINDOWS:
        encoded = f"_{encoded}"
    return encoded if len(encoded) <= _MAX_BYTES else _append_digest(encoded, name)


def _append_digest(encoded: str, name: str) -> str:
    digest = hashlib.sha256(name.encode("utf-8")).hexdigest()[:6]
    return f"{encoded[: _MAX_BYTES - 7]}~{digest}"


# -- JSON --------------------------------------------------------------------------------------


def encode_json(content: object, indent: int = 1) -> str:
    """Return *content* as the text of a JSON file: indented, with a line feed at the end.

    Characters beyond ASCII stay as they are, because all files are UTF-8.
    """
    return json.dumps(content, ensure_ascii=False, indent=indent) + "\n"


def encode_row(content: object) -> str:
    """Return *content* as JSON on one line, for lists that are too long to be indented."""
    return json.dumps(content, ensure_ascii=False)


def append_members(head: Mapping[str, object], members: Iterable[str]) -> str:
    """Return a JSON file with the members of *head*, and then *members*, which are JSON texts."""
    start = encode_json(head, 2).removesuffix("\n}\n")
    return ",\n".join((start, *members)) + "\n}\n"
