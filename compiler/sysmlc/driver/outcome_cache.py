"""Outcomes of earlier runs over unchanged inputs, as JSON entries of the cache.

A key covers everything that an outcome depends on (``cache_key``), so that an entry is either
exactly right or not found. An entry that does not decode into an outcome is a miss.
"""

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path, PureWindowsPath

import msgspec

from sysmlc.backends.base import InputFile
from sysmlc.diagnostics.render import Finding
from sysmlc.driver.faults import FAILED
from sysmlc.driver.outcome import Outcome, OutputFile, Withheld
from sysmlc.support.cache import Cache


class _Entry(msgspec.Struct):
    """An outcome without its folder, which may have moved."""

    inputs: tuple[InputFile, ...]
    findings: tuple[Finding, ...]
    files: tuple[OutputFile, ...]
    texts: Mapping[str, str]
    withheld: tuple[Withheld, ...]
    is_complete: bool


def store_outcome(cache: Cache, key: str, outcome: Outcome) -> None:
    """Store an outcome, unless an internal fault or a fault of the machine is part of it."""
    if outcome.exit_code() == FAILED:
        return
    # A file name that is not UTF-8 has lone surrogates, which JSON cannot hold.
    with suppress(UnicodeEncodeError):
        cache.put(key, _encode(outcome))


def load_outcome(cache: Cache, key: str, root: Path) -> Outcome | None:
    """Return the outcome stored under *key*, with *root* as its folder; None for a miss."""
    data = cache.get(key)
    if data is None:
        return None
    try:
        return _decode(data, root)
    except (ValueError, LookupError, RecursionError):
        # msgspec.ValidationError and DecodeError are ValueErrors.
        return None


def _encode(outcome: Outcome) -> bytes:
    entry = _Entry(
        outcome.inputs,
        outcome.findings,
        outcome.files,
        outcome.texts,
        outcome.withheld,
        outcome.is_complete,
    )
    return msgspec.json.encode(entry)


def _decode(data: bytes, root: Path) -> Outcome:
    entry = msgspec.json.decode(data, type=_Entry)
    for part in (entry.inputs, entry.files, entry.withheld):
        for named in part:
            _check_path(named.path)
    if entry.texts.keys() != {file.path for file in entry.files}:
        raise ValueError("files without texts, or texts without files")
    return Outcome(
        root,
        entry.inputs,
        entry.findings,
        entry.files,
        entry.texts,
        entry.withheld,
        entry.is_complete,
    )


def _check_path(path: str) -> None:
    """Raise ValueError for a path that could lead out of the folder that it belongs to."""
    # A Windows path splits at both separators and knows drives: the stricter reading of the two.
    windows_path = PureWindowsPath(path)
    if not path or windows_path.anchor or ".." in windows_path.parts:
        raise ValueError(path)
