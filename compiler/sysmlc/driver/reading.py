"""Read the input files of a unit, the files that they refer to, and the files beside them.

Beside a model there may be its overlay, and companion files with the diagrams of its authors.
Overlays may also be named by the user.
"""

import os
import posixpath
from collections.abc import Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from urllib.parse import unquote

from msgspec import Struct

from sysmlc.diagnostics import Place, Rule, Sink, Subject
from sysmlc.driver import faults
from sysmlc.driver.inputs import (
    Recognised,
    ask_frontend,
    collect_files,
    find_allowed_roots,
    list_suffixes,
    name_of,
    recognise,
)
from sysmlc.driver.siblings import find_siblings
from sysmlc.frontends.base import AttachmentFrontend, DiagramReader, Frontend
from sysmlc.ir import Graph
from sysmlc.overlay import SUFFIX, Refinement, list_files, read_overlay
from sysmlc.sources import Roots, Source, SourceError, amlx_package, load, read_entries
from sysmlc.sources.archive import is_system_entry
from sysmlc.sources.files import list_archive_entries, read_whole
from sysmlc.sources.source import DEFAULT_LIMITS, DOCUMENT_LIMITS


class LoadedOverlay(Struct, frozen=True):
    """The file of an overlay and its content; no content if the overlay has errors."""

    path: Path
    source: Source
    refinement: Refinement | None


def _find_overlay(model: Path) -> Path | None:
    """Return the overlay beside a model, ``gate.overlay.yaml`` for ``gate.aml``, if it exists."""
    path = model.with_name(model.stem + SUFFIX)
    return path if os.path.lexists(path) else None


def _load_overlay(
    path: Path, root: Path, roots: Roots, sink: Sink, *, is_named: bool
) -> LoadedOverlay | None:
    """Read an overlay; report it if it cannot be read or lies outside the allowed roots.

    An overlay that the user names may lie anywhere.
    """
    name = name_of(path, root)
    if is_named and not path.exists():
        sink.report(faults.MISSING_FILE, faults.about_file(name), path=name)
        return None
    if not is_named and not roots.allows(path):
        sink.report(faults.LEADS_OUT, faults.about_file(name), path=name)
        return None
    try:
        source = Source(name, read_whole(path, name, DOCUMENT_LIMITS))
    except SourceError as problem:
        faults.report_unreadable(problem, sink)
        return None
    return LoadedOverlay(path, source, read_overlay(source, sink))


def store_refinements(overlays: Iterable[LoadedOverlay], graph: Graph) -> None:
    """Store the content of the overlays in the graph, for the pass ``overlay``."""
    refinements = [o.refinement for o in overlays if o.refinement is not None]
    if refinements:
        graph.store(Refinement, refinements)


# -- models ------------------------------------------------------------------------------------


class ReadFile(Struct, frozen=True):
    """One file that was read: the names of its sources, and the files that it refers to.

    Paths are real paths. An archive has several sources, an overlay one, a file that no front end
    recognises none.
    """

    path: Path
    sources: tuple[str, ...] = ()
    references: frozenset[Path] = frozenset()
    is_named: bool = False
    """Whether the command line or the configuration names the file itself, not its folder."""
    is_overlay: bool = False
    is_sibling: bool = False
    """Whether the file was only read because a named file uses names that it declares."""


class Reading(Struct, frozen=True):
    """The recognised sources, sorted by name, and whether all files could be read."""

    recognised: tuple[Recognised, ...]
    is_complete: bool
    roots: Roots
    """Folders that references of the unit may lead into."""
    overlays: tuple[LoadedOverlay, ...] = ()
    files: tuple[ReadFile, ...] = ()

    def list_sibling_sources(self) -> frozenset[str]:
        """Return the names of the sources that belong to siblings of the named files."""
        return frozenset(name for file in self.files if file.is_sibling for name in file.sources)

    def sources(self) -> tuple[Source, ...]:
        """Return the recognised sources without their front ends."""
        return tuple(item.source for item in self.recognised)


def read_unit(
    inputs: Sequence[Path],
    root: Path,
    frontends: Sequence[Frontend],
    sink: Sink,
    overlays: Sequence[Path] = (),
    excluded: Sequence[Path] = (),
    *,
    finds_siblings: bool = False,
) -> Reading:
    """Read the files of a unit, following references; report files that cannot be read.

    The search of folders skips the real paths in *excluded*. With *finds_siblings*, files of the
    project that declare names which a named text uses are read as well.
    """
    roots = find_allowed_roots((*inputs, *overlays), root)
    reader = _Reader(root, roots, frontends, sink)
    suffixes = list_suffixes(frontends)
    for path, is_named in collect_files(inputs, root, sink, excluded, suffixes).items():
        rule = faults.UNRECOGNISED if is_named else faults.SKIPPED
        reader.read(path, rule, is_named=is_named)
    for path in overlays:
        reader.read_overlay(path, is_named=True)
    reader.follow_links()
    if finds_siblings:
        reader.read_siblings()
    recognised_sources = tuple(reader.recognised[name] for name in sorted(reader.recognised))
    loaded_overlays = tuple(reader.overlays[name] for name in sorted(reader.overlays))
    is_complete = not sink.has_errors()
    return Reading(recognised_sources, is_complete, roots, loaded_overlays, reader.list_files())


class _Reader:
    """Reads files with a worklist of the references that lead into the allowed roots."""

    def __init__(self, root: Path, roots: Roots, frontends: Sequence[Frontend], sink: Sink) -> None:
        self.recognised: dict[str, Recognised] = {}
        self.overlays: dict[str, LoadedOverlay] = {}
        self._root = root
        self._roots = roots
        self._frontends = frontends
        self._sink = sink
        # Real paths of the files read so far, of the overlays among them, and of named files.
        self._visited: set[Path] = set()
        self._overlay_files: set[Path] = set()
        self._named: set[Path] = set()
        self._siblings: set[Path] = set()
        self._worklist: list[tuple[Path, Recognised]] = []
        self._sources: dict[Path, list[str]] = {}
        self._references: dict[Path, set[Path]] = {}

    def list_files(self) -> tuple[ReadFile, ...]:
        """Return the files that were read, sorted by path, with their references."""
        return tuple(
            ReadFile(
                path,
                tuple(self._sources.get(path, ())),
                frozenset(self._references.get(path, ())),
                path in self._named,
                path in self._overlay_files,
                path in self._siblings,
            )
            for path in sorted(self._visited)
        )

    def read(self, path: Path, otherwise: Rule | None, *, is_named: bool = False) -> None:
        """Read a file and its overlay.

        If no front end recognises the file, the rule *otherwise* is reported, unless it is None.
        """
        real = Path(os.path.realpath(path))
        if real in self._visited:
            return
        self._visited.add(real)
        if is_named:
            self._named.add(real)
        sources = _load_sources(path, self._root, self._sink)
        for item in recognise(sources, self._frontends, otherwise, self._sink):
            name = item.source.name
            if name in self.recognised:
                self._sink.report(faults.SAME_NAME, faults.about_file(name), path=name)
                continue
            self.recognised[name] = item
            self._sources.setdefault(real, []).append(name)
            self._worklist.append((path, item))
        overlay = _find_overlay(path) if sources else None
        if overlay is not None:
            self._add_reference(path, overlay)
            self.read_overlay(overlay, is_named=False)

    def read_overlay(self, path: Path, *, is_named: bool) -> None:
        """Read an overlay and the models that its entries name."""
        real = Path(os.path.realpath(path))
        if real in self._overlay_files:
            return
        self._overlay_files.add(real)
        self._visited.add(real)
        overlay = _load_overlay(path, self._root, self._roots, self._sink, is_named=is_named)
        if overlay is None:
            return
        self.overlays[overlay.source.name] = overlay
        self._sources[real] = [overlay.source.name]
        if is_named:
            self._named.add(real)
        for file in list_files(overlay.refinement) if overlay.refinement is not None else ():
            target = self._roots.resolve(path, file)
            if target is not None:
                self._add_reference(path, target)
                self.read(target, None)

    def follow_links(self) -> None:
        """Read the files that references lead to, transitively; skip those outside the roots."""
        while self._worklist:
            path, item = self._worklist.pop()
            for href in self._list_links(item):
                target = self._roots.resolve(path, href)
                if target is not None:
                    self._add_reference(path, target)
                    # A reference may lead to any file, so an unrecognised file is not a fault.
                    self.read(target, None)
            self._check_mentioned_files(path, item)

    def read_siblings(self) -> None:
        """Read the files of the project that declare names which the named texts use."""
        sources = [name for path in sorted(self._named) for name in self._sources.get(path, ())]
        texts = [self.recognised[name] for name in sources if name in self.recognised]
        for path in find_siblings(texts, self._visited, self._roots, self._frontends, self._sink):
            self.read(path, None)
            self._siblings.add(Path(os.path.realpath(path)))
            for named in self._named:
                self._add_reference(named, path)

    def _list_links(self, item: Recognised) -> list[str]:
        source, frontend = item.source, item.frontend
        return ask_frontend(frontend, source, lambda: list(frontend.links(source)), [], self._sink)

    def _add_reference(self, path: Path, target: Path) -> None:
        references = self._references.setdefault(Path(os.path.realpath(path)), set())
        references.add(Path(os.path.realpath(target)))

    def _check_mentioned_files(self, path: Path, item: Recognised) -> None:
        """Report files of other languages, such as CAD models, that do not exist.

        In a package they are its other parts; a path starts at the package or at the part.
        """
        source, frontend = item.source, item.frontend
        if not isinstance(frontend, AttachmentFrontend):
            return
        _, is_part, entry = source.name.partition("!")
        parts = frozenset(list_archive_entries(path)) if is_part else frozenset()
        missing: dict[str, Place] = {}
        documents: list[tuple[str, Place]] = ask_frontend(
            frontend, source, lambda: list(frontend.list_attachments(source)), [], self._sink
        )
        for href, place in documents:
            is_missing = self._roots.resolve(path, href) is None
            if is_part:
                is_missing = parts.isdisjoint(_list_places(entry, href))
            if is_missing:
                missing.setdefault(href.partition("#")[0], place)
        if missing:
            first = next(iter(missing))
            more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
            subject = Subject(source.name, place=missing[first])
            notes = tuple(missing)
            self._sink.report(faults.NOT_THERE, subject, notes=notes, file=first, more=more)


def _list_places(entry: str, href: str) -> set[str]:
    """Return the parts of a package that a path in one of them may mean."""
    file = unquote(href.partition("#")[0])
    folders = ("", posixpath.dirname(entry))
    return {posixpath.normpath(posixpath.join(folder, file)) for folder in folders}


def _load_sources(path: Path, root: Path, sink: Sink) -> list[Source]:
    name = name_of(path, root)
    try:
        sources = load(path, name)
    except SourceError as problem:
        faults.report_unreadable(problem, sink)
        return []
    if path.suffix.lower() == amlx_package.SUFFIX:
        _report_foreign_parts(path, name, sink)
    return sources


def _report_foreign_parts(path: Path, name: str, sink: Sink) -> None:
    foreign = [entry for entry in list_archive_entries(path) if is_system_entry(entry)]
    if foreign:
        entries = ", ".join(f"'{entry}'" for entry in sorted(foreign))
        sink.report(faults.FOREIGN_PARTS, faults.about_file(name), path=name, entries=entries)


# -- companion files ---------------------------------------------------------------------------


def load_companions(reading: Reading, root: Path, sink: Sink) -> tuple[Source, ...]:
    """Load the existing companion files of all sources, sorted by name.

    Files that cannot be read are reported.
    """
    names = dict.fromkeys(
        name for item in reading.recognised for name in _list_companions(item, sink)
    )
    sources = {
        source.name: source for name in names for source in _load(name, root, reading.roots, sink)
    }
    return tuple(sources[name] for name in sorted(sources))


def _list_companions(item: Recognised, sink: Sink) -> list[str]:
    source, frontend = item.source, item.frontend
    if not isinstance(frontend, DiagramReader):
        return []
    return ask_frontend(
        item.frontend, source, lambda: list(frontend.list_companions(source.name)), [], sink
    )


def _load(name: str, root: Path, roots: Roots, sink: Sink) -> Iterator[Source]:
    """Yield the source of a file, or the matching entries of an archive (``file!pattern``).

    A file outside the allowed roots is skipped. An archive is an input, and therefore allowed.
    """
    file, is_archive, pattern = name.partition("!")
    if not (root / file).is_file() or not (is_archive or roots.allows(root / file)):
        return
    try:
        source = Source(file, read_whole(root / file, file, DEFAULT_LIMITS))
        yield from (
            read_entries(source, lambda entry: fnmatchcase(posixpath.basename(entry), pattern))
            if is_archive
            else [source]
        )
    except SourceError as problem:
        faults.report_unreadable(problem, sink)
