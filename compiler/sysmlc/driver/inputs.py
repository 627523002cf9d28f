"""The files of one compile unit: search folders, recognise contents, name files in outputs."""

import os
import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TypeVar

from msgspec import Struct

from sysmlc.config import FILE_NAME, find_project_root
from sysmlc.diagnostics import Rule, Sink
from sysmlc.driver import faults, registry
from sysmlc.driver.ownership import is_output_folder
from sysmlc.frontends.base import FileNames, Frontend, UnitFrontend
from sysmlc.sources import Roots, Source, SourceError, is_model_entry
from sysmlc.sources.files import is_special, list_archive_entries
from sysmlc.support.counts import list_first
from sysmlc.support.escapes import escape_undecodable
from sysmlc.support.interpreter import describe_error
from sysmlc.support.suggestions import find_similar

_T = TypeVar("_T")
_SUFFIXES = """
    .uml .xmi .xml .mdxml .mdzip .aml .amlx .caex .mtp .ir .sysml .kerml .sysmlx .kermlx .kpar
"""
SUFFIXES = frozenset(_SUFFIXES.split())
"""Suffixes of the models that sysmlc reads without plug-ins (``list_suffixes``)."""
_ARCHIVE = ".zip"
_MAX_ENTRIES = 3
"""Entries of an archive that a message names."""


class Recognised(Struct, frozen=True):
    """One source and the front end that reads it."""

    source: Source
    frontend: Frontend


def find_unit_root(paths: Sequence[Path], preferred: Path | None) -> Path:
    """Return the folder that names in outputs are relative to.

    It is *preferred* (the folder of the configuration) if all paths are below it, else the nearest
    common folder.
    """
    absolute = [_make_absolute(path) for path in paths]
    preferred = preferred.resolve() if preferred else None
    if preferred is not None and all(path.is_relative_to(preferred) for path in absolute):
        return preferred
    folders = [path if path.is_dir() else path.parent for path in absolute]
    return Path(os.path.commonpath(folders)) if folders else Path.cwd()


def find_allowed_roots(paths: Sequence[Path], root: Path) -> Roots:
    """Return the folders that references of a unit may lead into.

    For each path that the user named this is its project root, or *root* if that is the deeper
    folder. *root* alone, the folder that outputs name files relative to, would be too wide: it
    holds all named models and could be ``/``.
    """
    projects = {find_project_root(_make_absolute(path)) for path in paths}
    return Roots(tuple(sorted(max(root, project, key=_depth) for project in projects)))


def _depth(folder: Path) -> int:
    return len(folder.parts)


def list_suffixes(frontends: Iterable[Frontend]) -> frozenset[str]:
    """Return the suffixes of models, including those of the front ends of plug-ins.

    A search of folders considers the files with these suffixes. A named file may have any suffix.
    """
    return SUFFIXES.union(*(getattr(frontend, "suffixes", ()) for frontend in frontends))


def collect_files(
    paths: Iterable[Path],
    root: Path,
    sink: Sink,
    excluded: Iterable[Path] = (),
    suffixes: frozenset[str] = SUFFIXES,
) -> dict[Path, bool]:
    """Return the files to read, sorted by name, and whether the user named each file itself.

    The search of folders skips the files and folders in *excluded*, which are real paths.
    """
    is_named: dict[Path, bool] = {}
    excluded = frozenset(excluded)
    for path in paths:
        absolute = _make_absolute(path)
        if absolute.is_dir():
            files = _search_folder(absolute, root, sink, excluded, suffixes)
            is_named = dict.fromkeys(files, False) | is_named
        elif absolute.exists():
            is_named[absolute] = True
        else:
            _report_missing(path, absolute, root, sink)
    return {path: is_named[path] for path in sorted(is_named, key=lambda p: name_of(p, root))}


def name_of(path: Path, root: Path) -> str:
    """Return the name of a file in outputs: relative to the root, with ``/``, in NFC.

    Bytes that are not UTF-8 are escaped, so that every output can hold the name.
    """
    relative = path.relative_to(root) if path.is_relative_to(root) else Path(path.name)
    return unicodedata.normalize("NFC", escape_undecodable(relative.as_posix()))


def ask_frontend(
    frontend: Frontend, source: Source, call: Callable[[], _T], default: _T, sink: Sink
) -> _T:
    """Return what *call* asks a front end about a source.

    If a front end of a plug-in fails, this is reported, and the answer is *default*.
    """
    try:
        return call()
    except (SourceError, MemoryError):
        raise
    except Exception as problem:
        plug_in = registry.describe_source(frontend, problem)
        if not plug_in:
            raise
        sink.report(
            faults.PLUG_IN_STOP,
            faults.about_file(source.name),
            where=f"front end {frontend.name}",
            problem=describe_error(problem),
            source=plug_in,
        )
        return default


def rate_source(frontend: Frontend, source: Source, sink: Sink) -> float:
    """Return how certainly the front end can read the source, 0 if it fails."""
    return ask_frontend(frontend, source, lambda: float(frontend.detect(source)), 0.0, sink)


def ask_names(frontend: Frontend, source: Source, sink: Sink) -> FileNames:
    """Return the names of a source of a ``UnitFrontend``, none if it fails."""
    assert isinstance(frontend, UnitFrontend)
    return ask_frontend(frontend, source, lambda: frontend.read_names(source), FileNames(), sink)


def recognise(
    sources: Sequence[Source], frontends: Sequence[Frontend], otherwise: Rule | None, sink: Sink
) -> Iterator[Recognised]:
    """Yield the sources that a front end recognises; report *otherwise* about the others."""
    for source in sources:
        scores = [(rate_source(frontend, source, sink), frontend) for frontend in frontends]
        score, best = max(scores, key=lambda pair: pair[0])
        if score > 0:
            if _is_blank(source.data):
                sink.report(faults.EMPTY, faults.about_file(source.name), path=source.name)
            yield Recognised(source, best)
        elif otherwise is None and _is_blank(source.data):
            # A reference leads to it, which would otherwise seem to lead to a missing file.
            sink.report(faults.EMPTY, faults.about_file(source.name), path=source.name)
        elif otherwise is not None:
            names = ", ".join(frontend.name for frontend in frontends)
            reason = "it is empty"
            if not _is_blank(source.data):
                reason = f"it is {_describe_content(source.data)}"
            subject = faults.about_file(source.name)
            sink.report(otherwise, subject, path=source.name, reason=reason, frontends=names)


def _make_absolute(path: Path) -> Path:
    """Return the absolute path, with links resolved except for a file that is itself a link."""
    return path.resolve() if path.is_dir() else path.parent.resolve() / path.name


def _search_folder(
    folder: Path, root: Path, sink: Sink, excluded: frozenset[Path], suffixes: frozenset[str]
) -> list[Path]:
    """Return the model files below *folder*; report what is skipped, and if there is no model."""
    inside = Roots((folder,))
    files = []
    for path in sorted(find_model_files(folder, excluded, suffixes | {_ARCHIVE})):
        name = name_of(path, root)
        if path.is_symlink() and not inside.allows(path):
            sink.report(faults.LEADS_OUT, faults.about_file(name), path=name)
        elif is_special(path):
            sink.report(faults.SPECIAL_FILE, faults.about_file(name), path=name)
        elif path.suffix.lower() == _ARCHIVE:
            _report_models_inside(path, name, sink)
        else:
            files.append(path)
    if not files and not any(path.is_relative_to(folder) for path in excluded):
        name = name_of(folder, root)
        shown = folder.resolve().name if name == "." else name
        sink.report(faults.NOTHING_TO_COMPILE, faults.about_file(name), path=shown)
    return files


def _report_models_inside(path: Path, name: str, sink: Sink) -> None:
    """Report a zip archive that holds models; it may be a copy of models in the folder."""
    entries = [entry for entry in list_archive_entries(path) if is_model_entry(entry)]
    if entries:
        shown = list_first([f"'{entry}'" for entry in sorted(entries)], _MAX_ENTRIES)
        sink.report(faults.NOT_OPENED, faults.about_file(name), path=name, entries=shown)


def find_model_files(
    folder: Path,
    excluded: frozenset[Path] = frozenset(),
    suffixes: frozenset[str] = SUFFIXES,
) -> Iterator[Path]:
    """Yield the files below *folder* that are named like models, in no particular order.

    Hidden folders, output folders and whatever ``excluded`` lists (real paths) are skipped.
    """
    for parent, names in _walk(folder, excluded):
        for name in names:
            is_model = Path(name).suffix.lower() in suffixes and not name.startswith(".")
            if is_model and not _is_excluded(parent / name, excluded):
                yield parent / name


def find_projects(folder: Path) -> Iterator[Path]:
    """Yield the topmost folders below *folder* that are project roots of their own.

    Such a folder has a ``sysmlc.toml``.
    """
    projects: list[Path] = []
    for parent, _ in _walk(folder, frozenset()):
        is_inside = any(parent.is_relative_to(project) for project in projects)
        if parent != folder and not is_inside and (parent / FILE_NAME).is_file():
            projects.append(parent)
            yield parent


def _walk(folder: Path, excluded: frozenset[Path]) -> Iterator[tuple[Path, list[str]]]:
    """Yield each folder to search with the names of its files."""
    for path, folders, files in os.walk(folder):
        parent = Path(path)
        yield parent, files
        # os.walk descends into what is left in the list.
        folders[:] = [
            name
            for name in folders
            if not name.startswith(".")
            and not is_output_folder(parent / name)
            and not _is_excluded(parent / name, excluded)
        ]


def _is_excluded(path: Path, excluded: frozenset[Path]) -> bool:
    return bool(excluded) and Path(os.path.realpath(path)) in excluded


def _report_missing(path: Path, absolute: Path, root: Path, sink: Sink) -> None:
    name = path.as_posix()
    folder = absolute.parent
    # Unlike iterdir, glob skips a folder that may not be listed.
    names = [p.name for p in sorted(folder.glob("*"))]
    similar = find_similar(absolute.name, [name for name in names if not name.startswith(".")])
    advice = f"did you mean '{similar}'?" if similar else ""
    if not folder.is_dir():
        advice = f"there is no folder '{path.parent.as_posix()}' either; check the spelling"
    subject = faults.about_file(name_of(absolute, root))
    sink.report(faults.MISSING_FILE, subject, help=advice and "{advice}", path=name, advice=advice)


# -- files that no front end recognises --------------------------------------------------------

_SIGNATURES = (
    (b"\x89PNG", "a PNG image"),
    (b"\xff\xd8\xff", "a JPEG image"),
    (b"GIF8", "a GIF image"),
    (b"%PDF-", "a PDF document"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"\xd0\xcf\x11\xe0", "a binary project file (OLE)"),
    (b"SQLite format 3", "an SQLite database"),
    (b"\x7fELF", "a program"),
    (b"MZ", "a program"),
)
_BLANKS = b" \t\r\n\f\v\0\xef\xbb\xbf\xff\xfe"
"""White space and bytes of byte order marks, in UTF-8 and UTF-16."""
_HTML = re.compile(rb"<(?:!doctype\s+)?html", re.IGNORECASE)
_ROOT = re.compile(rb"<([A-Za-z_][\w.:-]*)")
_OLD_XMI = re.compile(rb"""<XMI\s[^>]*\bxmi\.version\s*=\s*["'](1\.\d)["']""")
_HEAD = 4_096


def _is_blank(data: bytes) -> bool:
    """Whether a file is empty or holds only white space and a byte order mark."""
    # The head decides for nearly all files, without a copy of the whole content.
    return not data[:_HEAD].strip(_BLANKS) and not data.strip(_BLANKS)


def _describe_content(data: bytes) -> str:
    """Return a description of the content that its first bytes suggest: ``an HTML page``."""
    for signature, description in _SIGNATURES:
        if data.startswith(signature):
            return description
    head = data[:_HEAD].lstrip(_BLANKS)
    if _HTML.search(head):
        return "an HTML page"
    if head.startswith(b"<"):
        root, version = _ROOT.search(head), _OLD_XMI.search(head)
        if version is not None:
            return f"XMI {version[1].decode()}; export XMI 2.1 or later"
        return f"XML with the root element '{root[1].decode()}'" if root else "damaged XML"
    if b"\0" in data[:_HEAD]:
        return "binary data"
    return "JSON" if head.startswith((b"{", b"[")) else "plain text"
