"""Bytes of the inputs, with the files that they refer to, ready for the front ends."""

import os
from collections.abc import Sequence
from pathlib import Path

from msgspec import Struct

from sysmlc.diagnostics import Place, Rule, Sink, Subject
from sysmlc.driver import faults
from sysmlc.driver.inputs import Recognised, allowed_roots, collect, name_of, recognise
from sysmlc.driver.overlays import LoadedOverlay, beside, load_overlay, models_of
from sysmlc.frontends.base import Frontend, Mentioning
from sysmlc.sources import Roots, Source, SourceError, load


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


class Reading(Struct, frozen=True):
    """The recognised sources, sorted by name, and whether nothing was left out."""

    recognised: tuple[Recognised, ...]
    is_complete: bool
    roots: Roots
    """Folders that the unit may be read from."""
    overlays: tuple[LoadedOverlay, ...] = ()
    files: tuple[ReadFile, ...] = ()

    def sources(self) -> tuple[Source, ...]:
        """The sources alone."""
        return tuple(found.source for found in self.recognised)


def read_unit(
    inputs: Sequence[Path],
    root: Path,
    frontends: Sequence[Frontend],
    sink: Sink,
    overlays: Sequence[Path] = (),
    excluded: Sequence[Path] = (),
) -> Reading:
    """The sources of the unit; what cannot be read is reported.

    Folders are searched without the real paths in ``excluded``.
    """
    roots = allowed_roots((*inputs, *overlays), root)
    reader = _Reader(root, roots, frontends, sink)
    for path, named in collect(inputs, root, sink, excluded).items():
        reader.read(path, faults.UNRECOGNISED if named else faults.SKIPPED, is_named=named)
    for path in overlays:
        reader.read_overlay(path, is_named=True)
    reader.follow_links()
    ordered = tuple(reader.found[name] for name in sorted(reader.found))
    laid = tuple(reader.overlays[name] for name in sorted(reader.overlays))
    return Reading(ordered, not sink.has_errors(), roots, laid, reader.list_files())


class _Reader:
    """Reads files, and then those that they refer to inside the allowed roots."""

    def __init__(self, root: Path, roots: Roots, frontends: Sequence[Frontend], sink: Sink) -> None:
        self.found: dict[str, Recognised] = {}
        self.overlays: dict[str, LoadedOverlay] = {}
        self._root = root
        self._roots = roots
        self._frontends = frontends
        self._sink = sink
        self._seen: set[Path] = set()
        self._laid: set[Path] = set()
        self._waiting: list[tuple[Path, Recognised]] = []
        self._sources: dict[Path, list[str]] = {}
        self._references: dict[Path, set[Path]] = {}
        self._named: set[Path] = set()

    def list_files(self) -> tuple[ReadFile, ...]:
        """Return the files that were read, sorted by path, with their references."""
        return tuple(
            ReadFile(
                path,
                tuple(self._sources.get(path, ())),
                frozenset(self._references.get(path, ())),
                path in self._named,
                path in self._laid,
            )
            for path in sorted(self._seen)
        )

    def read(self, path: Path, otherwise: Rule | None, *, is_named: bool = False) -> None:
        """Read a file; ``otherwise`` is reported when no front end recognises it."""
        real = Path(os.path.realpath(path))
        if real in self._seen:
            return
        self._seen.add(real)
        if is_named:
            self._named.add(real)
        sources = _sources(path, self._root, self._sink)
        for found in recognise(sources, self._frontends, otherwise, self._sink):
            name = found.source.name
            if name in self.found:
                self._sink.report(faults.SAME_NAME, faults.about_file(name), path=name)
                continue
            self.found[name] = found
            self._sources.setdefault(real, []).append(found.source.name)
            self._waiting.append((path, found))
        overlay = beside(path) if sources else None
        if overlay is not None:
            self._refer(path, overlay)
            self.read_overlay(overlay, is_named=False)

    def read_overlay(self, path: Path, *, is_named: bool) -> None:
        """Read an overlay, and the models that its entries name."""
        real = Path(os.path.realpath(path))
        if real in self._laid:
            return
        self._laid.add(real)
        self._seen.add(real)
        found = load_overlay(path, self._root, self._roots, self._sink, is_named=is_named)
        if found is None:
            return
        self.overlays[found.source.name] = found
        self._sources[real] = [found.source.name]
        if is_named:
            self._named.add(real)
        for file in models_of(found):
            target = self._roots.resolve(path, file)
            if target is not None:
                self._refer(path, target)
                self.read(target, None)

    def follow_links(self) -> None:
        """Read what the files refer to, and so on; what is elsewhere stays external."""
        while self._waiting:
            path, found = self._waiting.pop()
            for href in found.frontend.links(found.source):
                target = self._roots.resolve(path, href)
                if target is not None:
                    self._refer(path, target)
                    self.read(target, None)
            self._check_mentioned(path, found)

    def _refer(self, path: Path, target: Path) -> None:
        references = self._references.setdefault(Path(os.path.realpath(path)), set())
        references.add(Path(os.path.realpath(target)))

    def _check_mentioned(self, path: Path, found: Recognised) -> None:
        """Tell which files of other languages are not there; parts of a package are checked."""
        source, frontend = found.source, found.frontend
        if not isinstance(frontend, Mentioning) or "!" in source.name:
            return
        gone: dict[str, Place] = {}
        for href, place in frontend.mentioned(source):
            if self._roots.resolve(path, href) is None:
                gone.setdefault(href.partition("#")[0], place)
        if gone:
            first = next(iter(gone))
            more = f" and {len(gone) - 1} more" if len(gone) > 1 else ""
            subject = Subject(source.name, place=gone[first])
            notes = tuple(gone)
            self._sink.report(faults.NOT_THERE, subject, notes=notes, file=first, more=more)


def _sources(path: Path, root: Path, sink: Sink) -> list[Source]:
    name = name_of(path, root)
    try:
        return load(path, name)
    except SourceError as problem:
        faults.report_unreadable(problem, sink)
        return []
