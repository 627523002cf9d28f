"""Outcomes of earlier runs over unchanged inputs, as JSON entries of the cache, and their keys.

A key is a digest of everything that an outcome depends on, so that an entry is either exactly right
or not found. An entry that does not decode into an outcome is a miss.
"""

import os
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path, PureWindowsPath
from typing import TYPE_CHECKING

import msgspec

from sysmlc import __version__
from sysmlc.backends.base import InputFile
from sysmlc.diagnostics.renderers import Finding
from sysmlc.diagnostics.rule import PAGES
from sysmlc.driver import registry
from sysmlc.driver.compilation import OpenedUnit, Request
from sysmlc.driver.faults import FAILED, INSTALLATION_FAULTS
from sysmlc.driver.outcome import Outcome, OutputFile, Withheld
from sysmlc.language.library import find_library_path
from sysmlc.sources import DEFAULT_LIMITS, SourceError
from sysmlc.sources.files import read_whole
from sysmlc.support import resources
from sysmlc.support.cache import Cache

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint


_PACKAGE = Path(__file__).parents[1]
_RESOURCES = ("grammars", "metamodels", "templates")


def compute_outcome_key(
    opened: OpenedUnit, request: Request, emit: Sequence[str], has_files: bool
) -> str:
    """Return the key of the outcome of a request.

    *emit* is the text of ``--emit``, which is known before a back end is loaded. Without
    *has_files* the outcome holds diagnostics only.
    """
    return _hash_texts(_list_dependencies(opened, request, emit, has_files))


@cache
def compute_tool_digest() -> str:
    """Return the digest of the running tool: versions, sysmlc's own files and those of plug-ins.

    It is computed once per process: later changes of the files do not affect loaded code.
    """
    versions = f"{__version__} {sys.version} {sys.platform}"
    groups = (registry.FRONTEND_GROUP, registry.PASS_GROUP, registry.BACKEND_GROUP)
    entries = (entry for group in groups for entry in registry.find_plug_ins(group).values())
    plug_ins = (digest for entry in entries for digest in _digest_package(entry))
    return _hash_texts([versions, *_digest_own_files(), *plug_ins])


def _list_dependencies(
    opened: OpenedUnit, request: Request, emit: Sequence[str], has_files: bool
) -> Iterator[str]:
    config, reading = request.config, opened.reading
    yield compute_tool_digest()
    yield repr((has_files, tuple(emit), request.strict_input, request.diagrams, request.library))
    yield repr((sorted(config.rules.items()), config.suppress, _sort_items(config.passes)))
    yield repr((reading.is_complete, sorted(reading.list_sibling_sources())))
    for recognised in reading.recognised:
        source = recognised.source
        yield repr((source.name, source.sha256, recognised.frontend.name))
    for overlay in reading.overlays:
        yield repr((overlay.source.name, overlay.source.sha256))
    for drawing in opened.drawings:
        yield repr((drawing.name, drawing.sha256))
    for diagnostic in opened.sink:
        yield repr((diagnostic.rule.code, diagnostic.message, diagnostic.subject, opened.root))
    if any(recognised.frontend.name == "sysml" for recognised in reading.recognised):
        yield from _digest_library(request.library)
    yield from _digest_folder(request.templates)


def _sort_items(value: object) -> object:
    """Replace mappings by sorted lists of pairs: the order of a configuration does not matter."""
    if isinstance(value, dict):
        return sorted((key, _sort_items(inner)) for key, inner in value.items())
    return value


def _digest_library(path: str) -> Iterator[str]:

    folder = find_library_path(path or None)
    yield str(folder)
    if folder is not None:
        yield from _digest_folder(folder) if folder.is_dir() else [_digest_file(str(folder))]


def _digest_own_files() -> Iterator[str]:
    """Yield digests of the package: the RECORD that pip wrote, else every file (a checkout)."""
    records = sorted(_PACKAGE.parent.glob("sysmlc-*.dist-info/RECORD"))
    if records:
        yield from map(_digest_file, map(str, records))
        return
    # The pages of rules are no part of an outcome; 440 more files would be read in each run.
    yield from _digest_folder(_PACKAGE, PAGES)
    for name in _RESOURCES:
        yield from _digest_folder(resources.path(name))


def _digest_package(entry_point: "EntryPoint") -> Iterator[str]:
    """Yield digests of the top-level package or module that an entry point names."""
    spec = find_spec(entry_point.module.partition(".")[0])
    if spec is not None and spec.origin:
        is_package = spec.submodule_search_locations is not None
        yield from (
            _digest_folder(Path(spec.origin).parent) if is_package else [_digest_file(spec.origin)]
        )


def _digest_folder(folder: Path | None, omitted: Path | None = None) -> list[str]:
    """Return the digests of all files below *folder* but not in *omitted*, sorted by path."""
    return [_digest_file(path) for path in sorted(_iter_files(folder, omitted))] if folder else []


def _iter_files(folder: Path, omitted: Path | None) -> Iterator[str]:
    for path, folders, names in os.walk(folder):
        if omitted is not None and path == str(omitted):
            continue
        # Python writes bytecode during the run; the sources determine it.
        folders[:] = [name for name in folders if name != "__pycache__"]
        yield from (os.path.join(path, name) for name in names)  # noqa: PTH118 - thousands of files


def _digest_file(path: str) -> str:
    try:
        content = read_whole(Path(path), path, DEFAULT_LIMITS)
    except SourceError:
        return f"{path} unreadable"
    return f"{path} {sha256(content).hexdigest()}"


def _hash_texts(texts: Iterable[str]) -> str:
    """Return the digest of a list of texts.

    The lengths of the texts are part of it, so that lists split in other places differ.
    """
    joined = "".join([f"{len(text)}:{text}" for text in texts])
    return sha256(joined.encode("utf-8", "surrogatepass")).hexdigest()


# -- entries -----------------------------------------------------------------------------------


class _Entry(msgspec.Struct):
    """An outcome without its folder, which may have moved."""

    inputs: tuple[InputFile, ...]
    findings: tuple[Finding, ...]
    files: tuple[OutputFile, ...]
    texts: Mapping[str, str]
    withheld: tuple[Withheld, ...]
    is_complete: bool


def store_outcome(cache: Cache, key: str, outcome: Outcome) -> None:
    """Store an outcome, unless it has a fault of sysmlc, of a plug-in or of the machine."""
    is_of_machine = any(d.rule.code in INSTALLATION_FAULTS for d in outcome.diagnostics)
    if outcome.exit_code() == FAILED or is_of_machine:
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
