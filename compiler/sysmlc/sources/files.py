"""Files as sources: one file, or the model entries of one archive; and where files may lie."""

import os
import re
import stat
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import unquote
from zipfile import BadZipFile, ZipFile

from msgspec import Struct

from sysmlc.sources import amlx_package
from sysmlc.sources.archive import (
    is_archive,
    is_system_entry,
    list_entry_names,
    read_entries,
)
from sysmlc.sources.source import DEFAULT_LIMITS, Fault, Limits, Source, SourceError
from sysmlc.sources.xml import convert_to_utf8

_PAUSE = 0.1
"""Seconds to wait before a file that changed while it was read is read again."""

_State = tuple[int, int]
"""Size and time of modification of a file."""


# -- reading -----------------------------------------------------------------------------------


def read_whole(path: Path, name: str, limits: Limits) -> bytes:
    """Return the content of a regular file that did not change while it was read.

    A file that changed, because a program is saving it, is read a second time. Pipes and devices
    are not opened, because they may never end. Raises SourceError.
    """
    for is_last_attempt in (False, True):
        data, before, after = _read_with_states(path, name, limits)
        if before == after and len(data) == before[0]:
            return data
        if not is_last_attempt:
            time.sleep(_PAUSE)
    raise SourceError("changes while it is read", name, fault=Fault.CHANGING)


def _read_with_states(path: Path, name: str, limits: Limits) -> tuple[bytes, _State, _State]:
    """Return the content, and the states of the file before and after reading."""
    try:
        # Opening a pipe or a device has effects of its own, such as waking the writer of the pipe.
        _check_status(os.stat(path), name, limits)  # noqa: PTH116 - called for every file
        with open(path, "rb", opener=_open_nonblocking) as stream:
            status = os.fstat(stream.fileno())
            _check_status(status, name, limits)
            data = stream.read(status.st_size + 1)
            return data, _make_state(status), _make_state(os.fstat(stream.fileno()))
    except OSError as problem:
        message = f"cannot be opened: {problem.strerror or type(problem).__name__}"
        raise SourceError(message, name, fault=Fault.MISSING) from None


def is_special(path: Path) -> bool:
    """Whether *path* is neither a file nor a folder but a pipe, a socket or a device."""
    try:
        mode = path.stat().st_mode
    except OSError:
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def _open_nonblocking(path: str, flags: int) -> int:
    """Open a file; opening a pipe without a writer would otherwise wait for the writer."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _check_status(status: os.stat_result, name: str, limits: Limits) -> None:
    if not stat.S_ISREG(status.st_mode):
        raise SourceError("is not a regular file", name, fault=Fault.MISSING)
    if status.st_size > limits.file_size:
        message = f"larger than {limits.file_size} bytes"
        raise SourceError(message, name, fault=Fault.LIMIT)


def _make_state(status: os.stat_result) -> _State:
    return status.st_size, status.st_mtime_ns


# -- entries of archives -----------------------------------------------------------------------

_MODEL_ENTRY = re.compile(
    r"(^|/)com\.nomagic\.magicdraw\.uml_model(?!____sharepoints).*\.(shared_)?model$"
    r"|\.(uml|xmi|mdxml|aml|caex|sysml|kerml|sysmlx|kermlx)$"
)
_LIBRARY_ENTRY = re.compile(
    r"(^|/)proxy\..*_resource_com\$dnomagic\$dmagicdraw\$duml_umodel\$d(shared_u)?model\$dsnapshot$"
)
_DESCRIPTION_ENTRY = re.compile(r"(^|/)\.(project|meta)\.json$")


def is_model_entry(name: str) -> bool:
    """Whether an entry of an archive holds model content.

    In an archive of MagicDraw these are the project and its shared parts; diagrams, options and
    the snapshots of used projects are not.
    """
    return _MODEL_ENTRY.search(name) is not None


def _is_library_entry(name: str) -> bool:
    """Whether an entry of an archive is MagicDraw's snapshot of a used project."""
    return _LIBRARY_ENTRY.search(name) is not None


def is_description_entry(name: str) -> bool:
    """Whether an entry describes the project in the archive and its files (KerML 1.0, 10.3)."""
    return _DESCRIPTION_ENTRY.search(name) is not None


def _is_wanted_entry(name: str) -> bool:
    """Whether an entry of an archive is read: a model, or an entry needed to read a model."""
    is_wanted = is_model_entry(name) or _is_auxiliary_entry(name)
    return is_wanted and not is_system_entry(name)


def _is_auxiliary_entry(name: str) -> bool:
    return _is_library_entry(name) or is_description_entry(name)


def _is_plain_entry(name: str) -> bool:
    """Whether an entry is XML at the top of an archive, as in a compressed export."""
    return name.lower().endswith(".xml") and "/" not in name and not is_system_entry(name)


def load(
    path: Path,
    name: str,
    wanted: Callable[[str], bool] = _is_wanted_entry,
    limits: Limits = DEFAULT_LIMITS,
) -> list[Source]:
    """Return a file as one source, or the *wanted* entries of an archive.

    An archive is recognised by its content. *name* is the name of the file in outputs. An archive
    without wanted entries may be a compressed export: its XML entries are returned. Raises
    SourceError.
    """
    source = Source(name, read_whole(path, name, limits))
    if not is_archive(source.data):
        return [convert_to_utf8(source)]
    entry_names = list_entry_names(source)
    if amlx_package.is_package(name, entry_names):
        relationships = read_entries(source, amlx_package.holds_relationships, limits)
        amlx_package.check_package(name, entry_names, relationships)
    sources = read_entries(source, wanted, limits) or read_entries(source, _is_plain_entry, limits)
    if all(_is_auxiliary_entry(source.name.partition("!")[2]) for source in sources):
        raise SourceError("the archive holds no model", name)
    return [convert_to_utf8(source) for source in sources]


def list_archive_entries(path: Path) -> list[str]:
    """Return the names of the entries of an archive; none if the file cannot be read as one.

    Only the table at the end of the file is read.
    """
    if not path.is_file():
        return []
    try:
        with ZipFile(path) as zip_file:
            return zip_file.namelist()
    except (OSError, BadZipFile, NotImplementedError, ValueError, EOFError):
        return []


# -- folders that references may lead to -------------------------------------------------------

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
