"""Output files of a compilation: artefacts with their trace, valid names and paths, JSON text."""

import errno
import hashlib
import json
import os
import re
import stat
import sys
import unicodedata
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path, PureWindowsPath

from msgspec import Struct

from sysmlc.support.escapes import is_invisible


class Artefact(Struct, frozen=True):
    """One file that a back end writes.

    ``path`` is relative to the output folder, with ``/``. ``trace`` contains the ids of the
    elements from which the content is derived: the file is withheld if one of them has an error,
    unless it marks the elements with errors. ``name`` is the full name of the element, contract or
    diagram after which the file is named, which ``path`` spells as a file system can.
    """

    path: str
    text: str
    trace: tuple[str, ...] = ()
    backend: str = ""
    marks_faults: bool = False
    name: str = ""


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
    OutputPathError, and OSError if the system cannot spell *path*.
    """
    check_output_path(path)
    _check_encoding(folder / path)
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


def _check_encoding(path: Path) -> None:
    """Raise OSError if the locale names files in an encoding without a character of *path*."""
    try:
        os.fsencode(path)
    except UnicodeEncodeError:
        encoding = sys.getfilesystemencoding()
        reason = f"names of files in {encoding} lack a character of it; set PYTHONUTF8=1"
        raise OSError(errno.EILSEQ, reason, ascii(str(path))[1:-1]) from None


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
    git; the start of an absolute path and ``..``, which names of texts in memory may have) is
    percent-encoded.
    """
    parts = ["%2F" if part == "" else part for part in name.split("/")]
    parts = [part.replace(".", "%2E") if part in (".", "..") else part for part in parts]
    path = "/".join(parts).replace("!", "/").replace("\\", "%5C")
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
        name: str = "",
    ) -> None:
        """Add a file. Raises ValueError if the path is taken or leads out of the folder.

        A file with *marks_faults* shows which elements have errors, and is not withheld for them.
        The manifest lists *name*, the full name after which the file is named.
        """
        check_output_path(path)
        # Raises an error here, in the back end, instead of when the file is written.
        text.encode()
        if path in self._artefacts:
            raise ValueError(f"output path {path!r} is written twice")
        if self._last_trace[0] is not trace or not isinstance(trace, tuple):
            # Files of one component share their trace, which can have thousands of ids.
            self._last_trace = (trace, tuple(dict.fromkeys(trace)))
        trace = self._last_trace[1]
        self._artefacts[path] = Artefact(path, text, trace, backend, marks_faults, name)

    def artefacts(self) -> list[Artefact]:
        """Return all files, sorted by path."""
        return [self._artefacts[path] for path in sorted(self._artefacts)]


# -- names of files ----------------------------------------------------------------------------

_MAX_BYTES = 120
"""Bytes of a name in UTF-8: file systems allow 255, and back ends add suffixes."""
_PORTS = "0123456789¹²³"
"""Digits of ports: Windows also reads superscripts."""
_RESERVED_ON_WINDOWS = frozenset(
    ["con", "prn", "aux", "nul", *(f"{port}{digit}" for port in ("com", "lpt") for digit in _PORTS)]
)
_SPECIAL = re.compile(r"[^A-Za-z0-9_.-]")
_SELECTOR = re.compile("[\u180b-\u180d\u180f\ufe00-\ufe0f\U000e0100-\U000e01ef]")
"""Marks that select a variant of the letter before, and are invisible themselves."""
_CHARACTER = re.compile(r"%[0-7C-F][0-9A-F](?:%[89AB][0-9A-F])*|.")
"""A character of a name, or all escapes of the bytes of one character."""
_SAFE_CATEGORIES = frozenset("LMN")
"""First letters of the Unicode categories of letters, marks of letters, and numbers."""


def assign_file_names(qualified_names: Iterable[str]) -> dict[str, str]:
    """Return a file name without suffix, valid on every file system, for each qualified name.

    ``::`` becomes ``.``, and a blank ``_``. Letters and digits of all scripts stay, in normal form
    C; other characters are percent-encoded. A name has at most 120 bytes. To each of several names
    that some file system does not distinguish, ``~`` and six hexadecimal digits of the digest of
    its qualified name are appended.
    """
    encoded_names = {name: _encode(name) for name in qualified_names}
    counts = Counter(map(fold_path, encoded_names.values()))
    return {
        name: encoded if counts[fold_path(encoded)] == 1 else _append_digest(encoded, name)
        for name, encoded in encoded_names.items()
    }


def fold_path(path: str) -> str:
    """Return a key that is equal for paths that some file system does not distinguish.

    File systems may ignore case and the normal form of Unicode (Unicode 15, definition D145).
    """
    if path.isascii():
        return path.lower()
    return unicodedata.normalize("NFD", unicodedata.normalize("NFD", path).casefold())


def _encode(name: str) -> str:
    text = unicodedata.normalize("NFC", name.replace("::", ".")).strip(".")
    # Windows drops blanks at the end of a name, so that they stay apart from an underscore.
    body = text.rstrip()
    encoded = _SPECIAL.sub(_encode_special, body) + "".join(map(_escape, text[len(body) :])) or "_"
    # A program would read a name with a hyphen at the start as an option.
    if encoded.startswith("-"):
        encoded = f"%2D{encoded[1:]}"
    # Windows reserves these names with any suffix.
    if encoded.split(".")[0].lower() in _RESERVED_ON_WINDOWS:
        encoded = f"_{encoded}"
    return encoded if _count_bytes(encoded) <= _MAX_BYTES else _append_digest(encoded, name)


def _encode_special(match: re.Match[str]) -> str:
    character = match[0]
    category = unicodedata.category(character)
    if category == "Zs":
        return "_"
    is_safe = category[0] in _SAFE_CATEGORIES and not is_invisible(character)
    return character if is_safe and not _SELECTOR.match(character) else _escape(character)


def _escape(character: str) -> str:
    return "".join(f"%{byte:02X}" for byte in character.encode("utf-8", "surrogatepass"))


def _append_digest(encoded: str, name: str) -> str:
    """Return a name, cut after a whole character, with the digest of its qualified name."""
    digest = hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:6]
    start, size = "", _MAX_BYTES - 7
    for character in _CHARACTER.findall(encoded):
        size -= _count_bytes(character)
        if size < 0:
            break
        start += character
    return f"{start}~{digest}"


def _count_bytes(text: str) -> int:
    return len(text.encode("utf-8"))


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
