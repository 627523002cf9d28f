"""Companion files: files beside the models that contain the authors' diagrams."""

from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path

from sysmlc.diagnostics import Sink
from sysmlc.driver import faults
from sysmlc.driver.reading import Reading
from sysmlc.frontends.base import DiagramReader
from sysmlc.sources import Roots, Source, SourceError, entries
from sysmlc.sources.limits import DEFAULT_LIMITS
from sysmlc.sources.whole import read_whole


def load_companions(reading: Reading, root: Path, sink: Sink) -> tuple[Source, ...]:
    """Load the existing companion files of all sources, sorted by name.

    Files that cannot be read are reported.
    """
    names = dict.fromkeys(
        name
        for item in reading.recognised
        if isinstance(item.frontend, DiagramReader)
        for name in item.frontend.list_companions(item.source.name)
    )
    sources = {
        source.name: source for name in names for source in _load(name, root, reading.roots, sink)
    }
    return tuple(sources[name] for name in sorted(sources))


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
            entries(source, lambda entry: _matches(entry, pattern)) if is_archive else [source]
        )
    except SourceError as problem:
        faults.report_unreadable(problem, sink)


def _matches(entry: str, pattern: str) -> bool:
    return fnmatchcase(entry.rpartition("/")[2], pattern)
